#include <fmt/core.h>

#include <cmath>
#include <exception>
#include <iostream>
#include <type_traits>

#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/earth_frame.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/load/earth_gravitation.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <motor/attitude.hpp>

// A pendulum in a ball joint above the deck of a ship that rolls in a swell, on the rotating earth.
// Prints the torque of its motion by cause. Earth, ship and pendulum keep their own frames, so the
// parts of the law can be read one by one.

using namespace kreisel;

namespace {

struct Earth {};

/// The ship against the earth at its berth: roll, pitch and heave, x down, y north, z east.
constexpr auto swell = [](const auto& t) {
  using std::sin;
  using T = std::decay_t<decltype(t)>;
  const YawPitchRoll<T> turn{T(0.05 * sin(0.5 * t)), T(0.2 * sin(0.9 * t + 0.4)), T(0)};
  return Pose<T>{turn.rotation(), Vector3<T>(T(0.8 * sin(0.6 * t)), T(5.0 * t), T(0))};
};

void print(const char* name, const Motor<double>& P) {
  fmt::print("  {:<10}{:13.9f}{:13.9f}{:13.9f}\n", name, P.moment.x(), P.moment.y(), P.moment.z());
}

void swing() {
  const EarthSite<double> berth{.latitude = 53.5, .azimuth = 90};
  const Chain ship(earth_frame<Earth>(berth), posed<Guide, Earth>(swell));

  // A rod of 1 m and 2 kg hangs down along its x axis, 4 m above the ship's axis of roll.
  const auto rod = InertiaTensor<Body>::about_centre(
      2, {0.5, 0, 0}, Matrix3<double>(Vector3<double>(1e-3, 1.0 / 6, 1.0 / 6).asDiagonal()));
  const FixedPointBody pendulum(rod, {-4, 0, 0}, ship, EarthGravitation{}, ViscousDrag<>{0.02});

  const auto run = solve(pendulum, {}, {.output_times = {0, 5, 10}, .tolerance = 1e-10});
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const auto r = pendulum.body_outputs(run.times[i], run.states[i]);
    const Vector3<double> force = r.reaction.value.resultant;
    fmt::print("t = {:.0f} s, torque about the joint on the rod's axes, N m\n", run.times[i]);
    print("relative", r.parts.relative.value);
    print("guide", r.parts.guide.value);
    print("Coriolis", r.parts.coriolis.value);
    print("loads", r.applied.value);
    fmt::print("  the joint bears {:.6f} N\n", force.norm());
  }
  std::cout << run.report;
}

}  // namespace

int main() {
  try {
    swing();
  } catch (const std::exception& error) {
    fmt::print(stderr, "ship_on_earth: {}\n", error.what());
    return 3;
  }
}
