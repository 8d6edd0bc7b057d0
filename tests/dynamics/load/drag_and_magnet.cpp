// Forces of drags and magnets against their formulas, their work, and their derivatives.

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>

#include <dynamics/guide/resting.hpp>
#include <dynamics/load/drag.hpp>
#include <dynamics/load/magnet.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/sample.hpp>

using namespace kreisel;
using test::Sample;

namespace {

using Vector = Vector3<double>;

/// A body at an attitude in the guide, with velocities on its own axes.
LoadContext<> moving(const Eigen::Quaterniond& q, const Vector& w, const Vector& v) {
  return {.t = 0.3, .X = {{q.toRotationMatrix(), {1, 2, 3}}}, .V_rel = {{w, v}}};
}

double off(const Force<Body>& found, const Vector& force, const Vector& torque) {
  const auto& [F, M] = found.value;
  return std::max((F - force).norm(), (M - torque).norm());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(drag_and_magnet)

// v at the point (0, 0, 2) of a body that turns about x by 0.5: (3, 4, 0) + (0, -1, 0).
BOOST_AUTO_TEST_CASE(drag_at_a_point) {
  const Drag<> drag{.linear = Vector(1, 2, 4).asDiagonal(),
                    .quadratic = Vector(0.5, 0.25, 1).asDiagonal(),
                    .angular = Vector(8, 1, 1).asDiagonal(),
                    .point = {0, 0, 2}};
  const auto now = moving(Eigen::Quaterniond(0.6, 0, 0.8, 0), {0.5, 0, 0}, {3, 5, 0});
  const Vector force(-3 - 5 * 0.5 * 3, -2 * 4 - 5 * 0.25 * 4, 0);
  BOOST_TEST(off(drag(now), force, Vector(0, 0, 2).cross(force) - Vector(4, 0, 0)) <= 1e-14);
  BOOST_TEST(off(drag(moving({1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0})), {0, 0, 0}, {0, 0, 0}) == 0);
}

// m v' = -l v - q v^2:  v = l v0/((l + q v0) e^(l t/m) - q v0)
BOOST_AUTO_TEST_CASE(drag_of_a_straight_flight) {
  const double m = 2, l = 0.3, q = 0.7, v0 = 5, t = 3;
  BodyDescription body;
  body.name = "body";
  body.joint = {.kind = JointKind::free};
  body.inertia = InertiaTensor<Body>::about_centre(m, {0, 0, 0}, Matrix3<double>::Identity());
  body.loads = {Drag<>{.linear = l * Matrix3<double>::Identity(),
                       .quadratic = q * Matrix3<double>::Identity()}};
  const BodySystem system(RestingFrame<>{}, {body});
  auto y = system.to_vector(system.rest());
  y.tail(3) = v0 * Vector(0.6, 0, 0.8);
  const auto run = solve(system, system.from_vector(y), {.t_end = t, .tolerance = 1e-12});
  const double v = l * v0 / ((l + q * v0) * std::exp(l * t / m) - q * v0);
  const auto end = system.to_vector(run.states.back());
  BOOST_TEST((end.tail(3) - v * Vector(0.6, 0, 0.8)).norm() <= 1e-12 * v0);
}

// A turn by a small angle about n changes the potential by -M.n times the angle.
BOOST_AUTO_TEST_CASE(torque_of_a_magnet) {
  const Magnet magnet{{0.3, -1, 2}, Vector(2, 0.5, -1)};
  BOOST_TEST(magnet.keeps_energy());
  Sample sample(4);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Quaterniond q(sample.rotation());
    const auto torque = magnet(moving(q, {0, 0, 0}, {0, 0, 0})).value;
    BOOST_TEST(torque.resultant.norm() == 0);
    const Vector n = sample.direction();
    const double h = 1e-5;  // third derivatives are below 6: 1e-10, and rounding 1e-10
    const auto potential = [&](double angle) {
      return magnet.potential(moving(q * Eigen::AngleAxisd(angle, n), {0, 0, 0}, {0, 0, 0}));
    };
    BOOST_TEST(std::abs((potential(h) - potential(-h)) / (2 * h) + torque.moment.dot(n)) <= 2e-10);
  }
}

BOOST_AUTO_TEST_CASE(changing_fields_have_no_potential) {
  const Magnet magnet{{0, 0, 2}, {{1, 0, 0}, {0, 1, 0}, {}}};
  const auto now = moving(Eigen::Quaterniond::Identity(), {0, 0, 0}, {0, 0, 0});
  BOOST_TEST(!magnet.keeps_energy());
  BOOST_TEST(magnet.potential(now) == 0);
  BOOST_TEST((magnet(now).value.moment - Vector(0, 0, 2).cross(Vector(1, 0.3, 0))).norm() <= 1e-15);
}

BOOST_AUTO_TEST_CASE(which_have_series) {
  const Matrix3<double> one = Matrix3<double>::Identity();
  BOOST_TEST(!Drag<>{.quadratic = one}.analytic());
  BOOST_TEST(!Drag<>{.linear = one}.analytic()->is_analytic(false));
  BOOST_TEST(!Drag<>{.angular = one}.analytic()->is_analytic(false));
  BOOST_TEST(Drag<>{.linear = one}.analytic()->is_analytic(true));
  BOOST_TEST(Magnet{}.analytic()->is_analytic(false));
}

BOOST_AUTO_TEST_SUITE_END()
