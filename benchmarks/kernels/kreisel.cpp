// With frames in the types, and without. The types exist only at compile time.

#include <Eigen/Core>

#include <vector>

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>
#include <motor/frame.hpp>
#include <motor/motor.hpp>
#include <motor/rate.hpp>

#include "contender.hpp"

namespace kernels {

namespace {

using ::kreisel::Body;
using ::kreisel::Displacement;
using ::kreisel::Guide;
using ::kreisel::Inertia;
using ::kreisel::Inertial;
using ::kreisel::InertiaTensor;
using ::kreisel::Momentum;
using ::kreisel::Motor;
using ::kreisel::Pose;
using ::kreisel::Rate;
using ::kreisel::Velocity;
using Vector3 = ::kreisel::Vector3<double>;

Motor<> motor(const std::array<double, 6>& a) { return {Vector3(a.data()), Vector3(a.data() + 3)}; }

Pose<> pose(const std::array<double, 12>& X) {
  return {::kreisel::Matrix3<double>(X.data()), Vector3(X.data() + 9)};
}

Inertia<> inertia(const Numbers& n) {
  const auto& [m, x, y, z, xx, yy, zz, xy, xz, yz] = n.inertia;
  return {m, {x, y, z}, {xx, yy, zz, xy, xz, yz}};
}

std::vector<double> flat(const Motor<>& a) {
  std::vector<double> result(a.resultant.begin(), a.resultant.end());
  result.insert(result.end(), a.moment.begin(), a.moment.end());
  return result;
}

std::vector<double> flat(const Pose<>& X) {
  std::vector<double> result(X.rotation.data(), X.rotation.data() + 9);
  result.insert(result.end(), X.translation.begin(), X.translation.end());
  return result;
}

std::vector<double> flat(const Inertia<>& T) {
  const auto& s = T.first_moment;
  const auto& t = T.tensor;
  return {T.mass, s.x(), s.y(), s.z(), t.xx, t.yy, t.zz, t.xy, t.xz, t.yz};
}

const auto numbers_of = [](const auto& result) {
  if constexpr (requires { result.value; }) {
    return flat(result.value);
  } else {
    return flat(result);
  }
};

struct Plain {
  Motor<> a, b;
  Pose<> X, Y;
  Inertia<> T;
};

struct Tagged {
  Velocity<Body, Guide, Body> a;
  Rate<Guide, Momentum<Body>> b;
  Displacement<Guide, Body> X;
  Displacement<Body, Inertial> Y;
  InertiaTensor<Body> T;
};

}  // namespace

std::vector<Contender> kreisel(const All& numbers) {
  const auto all_plain = each(numbers, [](const Numbers& n) {
    return Plain{motor(n.a), motor(n.b), pose(n.pose), pose(n.other), inertia(n)};
  });
  const auto all_tagged = each(numbers, [](const Numbers& n) {
    return Tagged{{motor(n.a)}, {motor(n.b)}, {pose(n.pose)}, {pose(n.other)}, {inertia(n)}};
  });
  const auto plain = [&](const char* operation, auto operate) {
    return contender(operation, "kreisel", all_plain, operate, numbers_of);
  };
  const auto tagged = [&](const char* operation, auto operate) {
    return contender(operation, "kreisel, tagged", all_tagged, operate, numbers_of);
  };
  return {
      plain("motor product", [](const Plain& n) { return cross(n.a, n.b); }),
      plain("inertia times motor", [](const Plain& n) { return n.T * n.a; }),
      tagged("inertia times motor", [](const Tagged& n) { return n.T * n.a; }),
      plain("displace a motor", [](const Plain& n) { return n.X * n.a; }),
      tagged("displace a motor", [](const Tagged& n) { return n.X * n.a; }),
      plain("displace an inertia", [](const Plain& n) { return n.X * n.T; }),
      tagged("displace an inertia", [](const Tagged& n) { return n.X * n.T; }),
      plain("compose displacements", [](const Plain& n) { return n.X * n.Y; }),
      tagged("compose displacements", [](const Tagged& n) { return n.X * n.Y; }),
      plain("momentum bias", [](const Plain& n) { return cross(n.a, n.T * n.a); }),
      plain("Newton-Euler residual",
            [](const Plain& n) { return n.T * n.b + cross(n.a, n.T * n.a); }),
      plain("rate seen from elsewhere", [](const Plain& n) { return n.b - cross(n.a, n.T * n.a); }),
      tagged("rate seen from elsewhere",
             [](const Tagged& n) { return seen_from<Body>(n.b, n.a, n.T * n.a); }),
      plain("exponential", [](const Plain& n) { return exp(n.a); }),
      plain("logarithm", [](const Plain& n) { return log(n.X); }),
  };
}

}  // namespace kernels
