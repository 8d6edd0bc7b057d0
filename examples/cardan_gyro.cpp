#include <fmt/os.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>

#include <dynamics/gimbal/cardan_gyro_laws.hpp>
#include <dynamics/step/integrator.hpp>

// A free gyro in Cardan's suspension, tilted by 0.5 rad, gets a knock and nutates. Its rings have
// mass, so it also drifts about the outer axis, as the square of the knock. Prints the drift by the
// exact equations and by Magnus's law; with a file name (.svg) it also draws the nutations.

using namespace kreisel;

namespace {

const CardanMoments moments{.rotor = {0.005, 0.005, 0.008},
                            .inner_ring = {0.002, 0.0015, 0.0028},
                            .outer_ring = {0.006, 0.0045, 0.005}};
constexpr double tilt = 0.5;
constexpr double spin = 50;
const double pi = std::acos(-1.0);

void drift() {
  const CardanGyro gyro(moments, {}, RestingFrame<>{});
  fmt::print("knock, rad/s   nutation, rad   drift, rad/s   by the law\n");
  for (const double knock : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const GimbalDrift law = gimbal_drift(moments, tilt, 0, knock, spin);
    Integrator run(gyro, 0, {.beta = tilt, .beta_rate = knock, .phi_rate = spin});
    // Mean of alpha' over 60 nutations; a bell-shaped weight makes the ends unimportant.
    double sum = 0, weights = 0;
    const double end = 60 * 2 * pi / law.nutation_frequency;
    for (int i = 1; i < 1000; ++i) {
      const double weight = std::pow(std::sin(pi * i / 1000), 6);
      sum += weight * run.to(end * i / 1000).alpha_rate;
      weights += weight;
    }
    fmt::print("{:12.2f}{:16.6f}{:15.4e}{:13.4e}\n", knock, law.nutation_amplitude, sum / weights,
               law.drift);
  }
}

void draw(const std::string& picture) {
  const CardanGyro gyro(moments, {}, RestingFrame<>{});
  fmt::ostream out = fmt::output_file(picture + ".gp");
  for (const double knock : {2.0, 4.0, 8.0}) {
    out.print("$knock{} << END\n", knock);
    const double n = gimbal_drift(moments, tilt, 0, knock, spin).nutation_frequency;
    Integrator run(gyro, 0, {.beta = tilt, .beta_rate = knock, .phi_rate = spin});
    for (int i = 0; i <= 900; ++i) {
      const auto s = run.to(15 * 2 * pi / n * i / 900);
      out.print("{} {}\n", s.alpha, s.beta);
    }
    out.print("END\n");
  }
  out.print(
      "set terminal svg size 720,480 background 'white'\nset output '{}'\nset size ratio -1\n"
      "set xlabel 'alpha, rad'\nset ylabel 'beta, rad'\n"
      "set title 'Nutation and drift of a free gyro in rings with mass'\nset key outside\n"
      "plot $knock8 with lines lc rgb '#cc79a7' title '8 rad/s', "
      "$knock4 with lines lc rgb '#0072b2' title '4 rad/s', "
      "$knock2 with lines lc rgb '#009e73' title '2 rad/s'\n",
      picture);
  out.close();
  if (std::system(("gnuplot '" + picture + ".gp'").c_str())) throw ComputationFailed("gnuplot");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    drift();
    if (argc > 1) draw(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "cardan_gyro: {}\n", error.what());
    return 3;
  }
}
