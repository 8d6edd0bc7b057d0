#include <fmt/core.h>

#include <type_traits>
#include <vector>

#include <dynamics/guide/posed.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/attitude.hpp>

// A crane on the deck of a rolling ship: a steadily driven column, a jib locked at an angle, and a
// load that swings below it. Prints the swing of the load, the torque of the motor, and the load of
// the bearing on the deck by cause.

using namespace kreisel;

namespace {

/// Ship axes: x forward, y to port, z up; 8 degrees of roll in 9 s, 5 m above the axis of roll.
auto rolling_ship() {
  return posed([](const auto& t) {
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const T roll = 0.14 * sin(0.7 * t);
    const Matrix3<T> R = YawPitchRoll<T>{T(0), T(0), roll}.rotation();
    return Pose<T>{R, R * Vector3<T>(T(0), T(0), T(5))};
  });
}

InertiaTensor<Body> bar(double mass, double x, double z, const Vector3<double>& moments) {
  return InertiaTensor<Body>::about_centre(mass, {x, 0, z}, moments.asDiagonal().toDenseMatrix());
}

std::vector<BodyDescription> crane() {
  const Vector3<double> x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  return {{.name = "column",
           .joint = {.kind = JointKind::revolute, .axis = z},
           .inertia = bar(4000, 0, 3, {12000, 12000, 800}),
           .rule = JointRule::driven},
          {.name = "jib",
           .parent = "column",
           .joint = {.kind = JointKind::revolute, .axis = y, .position = {0, 0, 6}},
           .inertia = bar(1500, 5, 0, {100, 12500, 12500}),
           .rule = JointRule::held},
          {.name = "load",
           .parent = "jib",
           .joint = {JointKind::universal, y, x, {10, 0, 0}},
           .inertia = bar(2000, 0, -4, {500, 500, 300})}};
}

}  // namespace

int main() {
  using State = Eigen::Matrix<double, 8, 1>;  // angles: column, jib, load about y, about x; rates
  const BodySystem system(rolling_ship(), crane(), UniformGravity<Inertial>{{0, 0, -9.81}});
  State start = State::Zero();
  start[1] = -0.3;  // the jib upwards
  start[2] = 0.3;   // the load straight below it
  start[4] = 0.1;   // rad/s, the column
  const auto field = [&](double t, const State& y) { return State(system.rates(t, y)); };
  ExplicitRungeKutta<State, decltype(field)> steps(field, 0, start, {.relative = 1e-12});
  BodyWorkspace w = system.workspace();
  JointReactions reactions;
  std::vector<ReactionParts> parts;
  fmt::print("      load swings    motor   torque on the column about its x and y, kN m, from\n");
  fmt::print(" t, s     rad        kN m        spin            guide           gravity\n");
  for (int t = 0; t <= 20; t += 2) {
    const State y = steps.advance_to(t);
    system.reactions(t, y, reactions, w);
    system.reaction_parts(t, y, parts, w);
    fmt::print("{:4}{:8.3f}{:8.3f}{:9.2f}", t, y[1] + y[2], y[3], reactions.drive[0] / 1e3);
    for (const auto& part : {parts[0].spin, parts[0].guide, parts[0].gravity}) {
      fmt::print("{:9.2f}{:8.2f}", part.value.moment.x() / 1e3, part.value.moment.y() / 1e3);
    }
    fmt::print("\n");
  }
}
