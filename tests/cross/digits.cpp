// Prints results to the last bit, one a line: script/cross compares them between machines.

#include <cstdio>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/gyrostat.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/guide/earth.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>

// libc++ 14 lacks the token that stops a run.
#if __has_include(<stop_token>)
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/gauss.hpp>
#endif

using namespace kreisel;

namespace {

void print(const char* name, double value) { std::printf("%-28s %.17g\n", name, value); }

void closed_forms() {
  const Eigen::Quaterniond q(0.8, 0.3, -0.2, 0.4);
  const Vector3<double> w(0.3, 1.1, 2.2);
  const exact::FreeTop free({1, 1.7, 2.5}, w, q);
  print("free top, 1e4 periods", free.at(1e4 * free.period()).attitude.x());
  const exact::Gyrostat gyrostat({1, 1.7, 2.5}, {0, 0, 0.6}, w, q);
  print("gyrostat, 1e4 periods", gyrostat.at(1e4 * gyrostat.period()).attitude.x());
  const exact::LagrangeTop heavy(1, 0.6, 2, w, q);
  print("heavy top, 1e4 nutations", heavy.at(1e4 * heavy.period()).attitude.x());
  print("pendulum, 1e4 s", exact::PendulumMotion(9.81, 1, 0.3).at(1e4).angle);
}

void deviation_of_a_pendulum() {
  EarthSite<DoubleDouble> site;
  site.latitude = 48;
  site.azimuth = 90;
  const auto guide = pendulum_guide(earth_guide(site, DoubleDouble(9.81)));
  const auto rod = PendulumBody<DoubleDouble>::thin_rod(DoubleDouble(0.5), DoubleDouble(1));
  const auto answer = deviation(rod, guide, DoubleDouble(1) / 10);
  print("deviation, rad", answer.equilibrium.exact.value);
  print("relative change of period", answer.period.relative_change_exact->value);
  print("period at 0.1 rad, s", answer.period.at_amplitude->value);
}

#if __has_include(<stop_token>)
void steps() {
  using State = Eigen::Vector2d;
  const auto swing = [](double, const State& y) { return State(y[1], -std::sin(y[0])); };
  ExplicitRungeKutta verner(swing, 0.0, State(1, 0), {.relative = 1e-13});
  print("Verner98, 100 s", verner.advance_to(100)[0]);
  GaussIRK gauss(swing, 0.0, State(1, 0), 0.2);
  gauss.advance_to(100);
  print("Gauss, 100 s", gauss.y()[0]);
}
#else
void steps() {}
#endif

}  // namespace

int main() {
  closed_forms();
  deviation_of_a_pendulum();
  steps();
}
