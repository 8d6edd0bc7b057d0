// Dzhanibekov's top for 100 s by kreisel and by the installed engines with their default settings:
// drift of energy, momentum and attitude, and the cost. Usage: peers_drift

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/solve/solve.hpp>

#include "peers_drift/engine.hpp"
#include <tests/support/worst.hpp>

namespace peers {

namespace {

using kreisel::EulerTop;
using kreisel::Method;
using kreisel::Vector3;

constexpr double end = 100;
constexpr int count = 100;
const Top top{{1, 2, 3}, {1e-3, 2, 1e-3}};

Vector3<double> vector(const Triple& v) { return {v[0], v[1], v[2]}; }

/// The motion by solve(), to a tolerance.
std::vector<Turning> ours(const Top& t, Method method, double tolerance) {
  const EulerTop body(vector(t.moments));
  kreisel::SolveOptions options{.output_times = {}, .tolerance = tolerance, .method = method};
  for (int i = 1; i <= count; ++i) options.output_times.push_back(end * i / count);
  std::vector<Turning> motion;
  for (const auto& s :
       solve(body, {Eigen::Quaterniond::Identity(), vector(t.rate)}, options).states) {
    const Eigen::Quaterniond q = s.attitude.normalized();
    const Vector3<double> w = q * s.angular_velocity;
    motion.push_back({{q.w(), q.x(), q.y(), q.z()}, {w.x(), w.y(), w.z()}});
  }
  return motion;
}

std::vector<Engine> engines() {
  const auto kreisel = [](const char* how, Method method, double tolerance) {
    return Engine{"kreisel", "", how,
                  [=](const Top& t, double, int) { return ours(t, method, tolerance); }};
  };
  std::vector<Engine> all{kreisel("closed form", Method::automatic, 1e-10),
                          kreisel("verner98 to 1e-8, error estimated", Method::verner98, 1e-8),
                          kreisel("verner98 to 1e-3, error estimated", Method::verner98, 1e-3)};
  const auto add = [&all](std::vector<Engine> (*library)()) {
    for (Engine& e : library()) all.push_back(std::move(e));
  };
#ifdef PEERS_DRIFT_WITH_BULLET
  add(&bullet);
#endif
#ifdef PEERS_DRIFT_WITH_DART
  add(&dart);
#endif
#ifdef PEERS_DRIFT_WITH_MUJOCO
  add(&mujoco);
#endif
#ifdef PEERS_DRIFT_WITH_ODE
  add(&ode);
#endif
#ifdef PEERS_DRIFT_WITH_SIMBODY
  add(&simbody);
#endif
  (void)add;
  return all;
}

/// The greatest errors of a motion over its times.
struct Drift {
  double energy = 0;    ///< relative, with its sign
  double momentum = 0;  ///< of the vector in inertial space, relative
  double attitude = 0;  ///< in rad
};

Drift drift(const std::vector<Turning>& motion) {
  const Vector3<double> I = vector(top.moments);
  const Vector3<double> w0 = vector(top.rate);
  const Vector3<double> L0 = I.cwiseProduct(w0);
  const kreisel::exact::FreeTop truth(I, w0, Eigen::Quaterniond::Identity());
  Drift worst;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const auto& [w, x, y, z] = motion[i].attitude;
    const Eigen::Quaterniond q = Eigen::Quaterniond(w, x, y, z).normalized();
    const Vector3<double> rate = q.conjugate() * vector(motion[i].rate);
    const Vector3<double> L = I.cwiseProduct(rate);
    const double energy = L.dot(rate) / L0.dot(w0) - 1;
    if (std::abs(energy) > std::abs(worst.energy)) worst.energy = energy;
    worst.momentum = kreisel::test::worst_of(worst.momentum, (q * L - L0).norm() / L0.norm());
    const auto there = truth.at(end * static_cast<double>(i + 1) / count);
    worst.attitude = kreisel::test::worst_of(worst.attitude, q.angularDistance(there.attitude));
  }
  return worst;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void print() {
  fmt::print(
      "Moments {}, {}, {} kg m^2, rates {}, {}, {} rad/s, {} s.\n\n"
      "| by | how | energy error | momentum error | attitude error, rad | ms |\n"
      "|---|---|---|---|---|---|\n",
      top.moments[0], top.moments[1], top.moments[2], top.rate[0], top.rate[1], top.rate[2], end);
  for (const Engine& engine : engines()) {
    const std::string name = engine.name + (engine.version.empty() ? "" : " " + engine.version);
    try {
      std::vector<double> times;
      std::vector<Turning> motion;
      for (int i = 0; i < 3; ++i) {
        const double begin = cpu_seconds();
        motion = engine.run(top, end, count);
        times.push_back(1e3 * (cpu_seconds() - begin));
      }
      std::sort(times.begin(), times.end());
      const Drift d = drift(motion);
      fmt::print("| {} | {} | {:+.1e} | {:.1e} | {:.1e} | {:.2g} |\n", name, engine.how, d.energy,
                 d.momentum, d.attitude, times[1]);
    } catch (const std::exception& error) {
      fmt::print("| {} | {} | - | - | - | {} |\n", name, engine.how, error.what());
    }
  }
}

}  // namespace

}  // namespace peers

int main() { peers::print(); }
