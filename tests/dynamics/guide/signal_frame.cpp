// A frame whose pose is given, against the textbook's rates of its angles, and a pendulum on it.

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>

#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

namespace {

using Number = Signal<double>;
using Vector = Signal<Vector3<double>>;
using Real = long double;

constexpr double u = std::numeric_limits<double>::epsilon() / 2;

PoseSignals ship() {
  return {Vector({1, -2, 0.5}, {3, 0, 0}, {{{0, 0.4, 1.2}, 0.7, 1.5}, {{0.1, 0, 0}, 1.9, 0}}),
          Number(0.3, 0.02, {{0.05, 0.31, 0}}), Number(0, 0, {{0.1, 0.9, 0.2}}),
          Number(-0.1, 0, {{0.4, 0.7, 1}})};
}

struct Angle {
  Real value, rate, bend;
};

Angle angle(const Number& signal, double t) {
  return {Real(signal(t)), Real(signal.derivative(t, 1)), Real(signal.derivative(t, 2))};
}

/// The angular velocity on the rotated axes, from the rates of yaw, pitch and roll.
///
///   (r' - y' sin p, p' cos r + y' cos p sin r, -p' sin r + y' cos p cos r)
Vector3<Real> turning(const Angle& y, const Angle& p, const Angle& r) {
  using std::cos, std::sin;
  return {r.rate - y.rate * sin(p.value),
          p.rate * cos(r.value) + y.rate * cos(p.value) * sin(r.value),
          -p.rate * sin(r.value) + y.rate * cos(p.value) * cos(r.value)};
}

/// Its derivative.
Vector3<Real> turning_up(const Angle& y, const Angle& p, const Angle& r) {
  using std::cos, std::sin;
  const Real sp = sin(p.value), cp = cos(p.value), sr = sin(r.value), cr = cos(r.value);
  return {r.bend - y.bend * sp - y.rate * cp * p.rate,
          p.bend * cr - p.rate * sr * r.rate + y.bend * cp * sr - y.rate * sp * p.rate * sr +
              y.rate * cp * cr * r.rate,
          -p.bend * sr - p.rate * cr * r.rate + y.bend * cp * cr - y.rate * sp * p.rate * cr -
              y.rate * cp * sr * r.rate};
}

double off(const Vector3<double>& a, const Vector3<Real>& b) {
  return double((a.cast<Real>() - b).norm());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(frames_of_signals)

BOOST_AUTO_TEST_CASE(turn_and_move_as_the_textbook_has_it) {
  const PoseSignals pose = ship();
  const SignalFrame<> frame(pose);
  for (const double t : {0.0, 0.4, 3.3, 17.0, 1e4}) {
    const auto y = angle(pose.yaw, t), p = angle(pose.pitch, t), r = angle(pose.roll, t);
    const Matrix3<Real> R = (Eigen::AngleAxis<Real>(y.value, Vector3<Real>::UnitZ()) *
                             Eigen::AngleAxis<Real>(p.value, Vector3<Real>::UnitY()) *
                             Eigen::AngleAxis<Real>(r.value, Vector3<Real>::UnitX()))
                                .toRotationMatrix();
    const FrameMotion<Guide, Inertial> now = frame(t);
    BOOST_TEST((now.X.value.rotation.cast<Real>() - R).norm() <= 16 * u);
    BOOST_TEST((now.X.value.translation == pose.position(t)));
    // 4u of the sum of terms, all below 2.
    BOOST_TEST(off(now.V.value.resultant, turning(y, p, r)) <= 16 * u);
    BOOST_TEST(off(now.dV.value.resultant, turning_up(y, p, r)) <= 16 * u);
    BOOST_TEST(off(now.V.value.moment,
                   R.transpose() * pose.position.derivative(t, 1).cast<Real>()) <= 64 * u);
    BOOST_TEST(off(now.origin_acceleration(),
                   R.transpose() * pose.position.derivative(t, 2).cast<Real>()) <= 64 * u);
  }
}

BOOST_AUTO_TEST_CASE(series_is_that_of_the_motion) {
  const SignalFrame<> frame(ship());
  const detail::Components<double> g{0, 0, -9.81};
  const GuideSeries s = frame.series(0.8, 0.1, 20, g);
  const FrameMotion<Guide, Inertial> then = frame(0.85);
  Vector3<double> turns = Vector3<double>::Zero();
  Vector3<double> felt = Vector3<double>::Zero();
  for (int k = 19; k >= 0; --k) {
    const auto at = static_cast<std::size_t>(k);
    turns = 0.5 * turns + Vector3<double>(s.u[at].x, s.u[at].y, s.u[at].z);
    felt = 0.5 * felt + Vector3<double>(s.g[at].x, s.g[at].y, s.g[at].z);
  }
  const Vector3<double> down(0, 0, -9.81);
  const Vector3<double> expected =
      then.X.value.rotation.transpose() * down - then.origin_acceleration();
  BOOST_TEST((turns - then.V.value.resultant).norm() <= 100 * u);
  BOOST_TEST((felt - expected).norm() <= 400 * u);
}

BOOST_AUTO_TEST_CASE(dual_times_give_the_jerk) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  const PoseSignals pose{ship().position, 0.0, 0.0, 0.0};
  const SignalFrame<> frame(pose);
  Dual t(0.6);
  t.derivatives()[0] = 1;
  const FrameMotion<Guide, Inertial, Dual> now = frame(t);
  const Vector3<double> jerk = pose.position.derivative(0.6, 3);
  for (int i = 0; i < 3; ++i) {
    BOOST_TEST(std::abs(now.dV.value.moment[i].derivatives()[0] - jerk[i]) <= 16 * u);
  }
}

BOOST_AUTO_TEST_CASE(jumps_of_velocity_are_refused) {
  const Number broken = Number::broken_line({{0, 0}, {1, 0.2}});
  BOOST_CHECK_THROW(SignalFrame<>({Vector(), broken, 0.0, 0.0}), InvalidInput);
  const Vector steps = Vector::steps({{0, {0, 0, 1}}});
  BOOST_CHECK_THROW(SignalFrame<>({steps, 0.0, 0.0, 0.0}), InvalidInput);
}

/// A pendulum in the xz plane on a pivot at (x, z)(t):  L q'' = -(g + z'') sin q - x'' cos q,  by
/// Runge-Kutta steps in long double.
BOOST_AUTO_TEST_CASE(pendulum_on_a_moved_pivot) {
  const Real length = 0.8L, g = 9.81L;
  const Vector position({0, 0, 0}, {1.5, 0, 0}, {{{0.2, 0, 0}, 2.1, 0.4}, {{0, 0, 0.3}, 3.7, 1}});
  using State = std::array<Real, 2>;
  const auto rates = [&](Real t, const State& y) -> State {
    const Real ax = -0.2L * Real(2.1) * Real(2.1) * std::sin(Real(2.1) * t + Real(0.4));
    const Real az = -Real(0.3) * Real(3.7) * Real(3.7) * std::sin(Real(3.7) * t + 1);
    return {y[1], -((g + az) * std::sin(y[0]) + ax * std::cos(y[0])) / length};
  };
  State y{0.4L, 0};
  const int steps = 40'000;
  const Real h = 5.0L / steps;
  for (int i = 0; i < steps; ++i) {
    const Real t = Real(i) * h;
    const auto moved = [&y](Real by, const State& k) -> State {
      return {y[0] + by * k[0], y[1] + by * k[1]};
    };
    const State a = rates(t, y);
    const State b = rates(t + h / 2, moved(h / 2, a));
    const State c = rates(t + h / 2, moved(h / 2, b));
    const State d = rates(t + h, moved(h, c));
    for (std::size_t k = 0; k < 2; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  BodyDescription body;
  body.name = "pendulum";
  body.joint = {.kind = JointKind::revolute, .axis = {0, -1, 0}};
  body.inertia = InertiaTensor<Body>::about_centre(2, {0, 0, -0.8}, Matrix3<double>::Zero(),
                                                   Mass::zero_allowed);
  const BodySystem<SignalFrame<>> system(SignalFrame<>({position, 0.0, 0.0, 0.0}), {body},
                                         UniformGravity<Inertial>{{0, 0, -9.81}});
  BOOST_TEST(system.knows_series());
  auto start = system.rest();
  start.coordinates[0] = 0.4;
  for (const Method method : {Method::taylor, Method::verner98}) {
    const auto run =
        solve(system, start, {.output_times = {5}, .tolerance = 1e-12, .method = method});
    BOOST_TEST(run.report.tolerance_kept);
    BOOST_TEST(std::abs(run.states.back().coordinates[0] - double(y[0])) <= 2e-12);
    BOOST_TEST(std::abs(run.states.back().rates[0] - double(y[1])) <= 1e-11);
  }
}

BOOST_AUTO_TEST_SUITE_END()
