#include <fmt/core.h>

#include <cmath>
#include <exception>

#include <dynamics/step/integrator.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/tree/body_system.hpp>

// A satellite with two momentum wheels in a V, 20 degrees either side of its axis y. It nutates
// after a knock and precesses under a transverse torque, with free wheels and with regulated ones.

using namespace kreisel;

namespace {

constexpr double slant = 0.349, C = 0.1, speed = 200, torque = 0.01, hour = 3600;

BodySystem<RestingFrame<>> satellite(RotorMode mode, bool pushed = false) {
  std::vector<BodyDescription> bodies(3);
  bodies[0].name = "satellite";
  bodies[0].joint.kind = JointKind::spherical;
  const Vector3<double> moments(120, 80, 150);
  bodies[0].inertia = InertiaTensor<Body>::about_centre(500, {0, 0, 0}, moments.asDiagonal());
  if (pushed) bodies[0].loads = {ConstantLoad<Guide>{.torque = {torque, 0, 0}}};
  for (std::size_t i = 1; i < 3; ++i) {
    const Vector3<double> e(0, std::cos(slant), std::sin(i == 1 ? slant : -slant));
    const Matrix3<double> tensor = 0.06 * Matrix3<double>::Identity() + 0.04 * e * e.transpose();
    bodies[i].name = i == 1 ? "wheel +" : "wheel -", bodies[i].parent = "satellite";
    bodies[i].joint = {.kind = JointKind::revolute, .axis = e};
    bodies[i].inertia = InertiaTensor<Body>::about_centre(10, {0, 0, 0}, tensor);
    bodies[i].rotor = Rotor{.mode = mode};
  }
  return {RestingFrame<>{}, bodies};
}

void report(const char* name, RotorMode mode) {
  const auto system = satellite(mode);
  auto start = system.rest();
  start.rates.tail(2).setConstant(speed);
  const auto linear = linearize<Guide, Body>(system, 0, system.to_vector(start));
  const double nutation = std::abs(spectrum(linear.A).back().root.imag());
  const auto pushed = satellite(mode, true);
  const auto q = Integrator(pushed, 0, start).to(hour).coordinates;
  const Vector3<double> axis = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).matrix().col(1);
  start.rates[2] = 1e-3;  // about z
  Integrator run(system, 0, start);
  BodyWorkspace w(system.tree());
  JointReactions r;
  double motor = 0, wheel = 0, last = 0, first = 0, before = 1e-3, turns = -1;
  for (int i = 1; i <= 4000; ++i) {
    const auto s = run.to(0.05 * i);
    system.reactions(0, system.to_vector(s), r, w);
    motor = std::max(motor, std::abs(r.drive.tail(1)[0]));
    wheel = std::max(wheel, std::abs(s.rates.tail(1)[0] - speed));
    if (before < 0 && s.rates[2] >= 0) {  // 0 by the secant
      last = 0.05 * (i - s.rates[2] / (s.rates[2] - before));
      if (turns++ < 0) first = last;
    }
    before = s.rates[2];
  }
  const double found = 2 * std::acos(-1.0) * turns / (last - first);
  const double law = std::atan(torque * hour / (2 * C * speed * std::cos(slant)));
  fmt::print("{:<11}{:.8f}  {:.8f}   {:.4e}    {:.4e}      {:.6f}   {:.6f}\n", name, nutation,
             found, motor, wheel, std::atan2(axis.x(), axis.y()), law);
}

}  // namespace

int main() try {
  fmt::print(
      "           nutation, rad/s          motor, N m    wheel, rad/s    precession, rad\n"
      "wheels     linear      exact        (greatest after a knock)      in 1 h     by the law\n");
  report("free", RotorMode::free);
  report("regulated", RotorMode::regulated);
} catch (const std::exception& error) {
  fmt::print(stderr, "momentum_wheel_satellite: {}\n", error.what());
  return 3;
}
