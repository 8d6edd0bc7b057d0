#include <fmt/core.h>

#include <cmath>
#include <exception>

#include <dynamics/gimbal/cardan_gyro_laws.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/step/integrator.hpp>

// A free gyro on a ship that rolls about x by 10 degrees, every 8 s, and yaws about z by 2 degrees,
// every 20 s. Its outer axis is x; its spin axis is 30 degrees out of the plane across x. In rings
// without mass the spin axis keeps its direction in space. Prints the angles of the rings, the
// deviation of the axis, and the moment on the ship.

using namespace kreisel;

namespace {

constexpr double degree = 0.017453292519943295;
constexpr double turn = 6.283185307179586;

const HarmonicFrame<> ship({.terms = {{{10 * degree * turn / 8, 0, 0}, turn / 8, turn / 4},
                                      {{0, 0, 2 * degree* turn / 20}, turn / 20, turn / 4}}},
                           {}, 0, 60);

const CardanMoments heavy{.rotor = {0.005, 0.005, 0.008},
                          .inner_ring = {0.002, 0.0015, 0.0028},
                          .outer_ring = {0.006, 0.0045, 0.005}};
const CardanMoments light{.rotor = heavy.rotor};

/// The rotor's axis in the inertial frame.
Vector3<double> axis(double t, double alpha, double beta) {
  return ship(t).X.value.rotation * GimbalAngles{alpha, beta}.axis();
}

void sail() {
  const GimbalAngles start{0, 30 * degree};
  const auto s = riding_rates(start, 0, 300, ship(0).V.value.resultant);
  const CardanGyro gyro(heavy, {}, ship);
  const CardanGyro ideal(light, {}, ship);
  const Accuracy accuracy{.relative = 1e-12};
  Integrator run(gyro, 0, {s.alpha, s.beta, s.phi, s.alpha_rate, s.beta_rate, s.phi_rate},
                 accuracy);
  Integrator ideal_run(ideal, 0, run.state(), accuracy);
  const Vector3<double> n = axis(0, start.alpha, start.beta);
  const auto off = [&](double t, double alpha, double beta) {
    const Vector3<double> now = axis(t, alpha, beta);
    return std::atan2(now.cross(n).norm(), now.dot(n));
  };
  fmt::print("   t, s   alpha, deg    beta, deg   axis off, rad  (massless)   ship, N m\n");
  for (int i = 0; i <= 10; ++i) {
    const double t = 6.0 * i;
    const auto now = run.to(t);
    const auto best = ideal_run.to(t);
    fmt::print("{:7.0f}{:13.6f}{:13.6f}{:16.2e}{:12.0e}{:12.6f}\n", t, now.alpha / degree,
               now.beta / degree, off(t, now.alpha, now.beta), off(t, best.alpha, best.beta),
               gyro.reactions(t, now).guide_on_outer_ring.norm());
  }
}

}  // namespace

int main() {
  try {
    sail();
  } catch (const std::exception& error) {
    fmt::print(stderr, "gyro_on_ship: {}\n", error.what());
    return 3;
  }
}
