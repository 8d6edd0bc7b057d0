// Linear equations by dual numbers, with quaternions in the state and without, and equilibria.

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include <dynamics/gimbal/cardan_gyro_laws.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/spectrum.hpp>

using namespace kreisel;

namespace {

const CardanMoments symmetric{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
const CardanBearings springs{{2}, {1.5}};

/// A heavy symmetric top whose centre of mass lies on its axis, on x' = (quaternion; w).
struct Top {
  using Vector = Eigen::Matrix<double, 7, 1>;
  double A, C, weight_moment;

  [[nodiscard]] static std::array<int, 1> quaternions() { return {0}; }

  template <class S>
  [[nodiscard]] Eigen::Matrix<S, 7, 1> rates(const S& /*t*/,
                                             const Eigen::Matrix<S, 7, 1>& y) const {
    const Eigen::Quaternion<S> q(y[3], y[0], y[1], y[2]);
    const Vector3<S> w(y[4], y[5], y[6]);
    const Eigen::Matrix<S, 4, 1> dq = attitude_rate(q, w);
    const S scale = S(2.0) / (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] + y[3] * y[3]);
    const S up_x = scale * (y[0] * y[2] - y[3] * y[1]);
    const S up_y = scale * (y[1] * y[2] + y[3] * y[0]);
    Eigen::Matrix<S, 7, 1> dy;
    for (int i = 0; i < 4; ++i) dy[i] = dq[i];
    dy[4] = (weight_moment * up_y + (A - C) * w.y() * w.z()) / A;
    dy[5] = (-weight_moment * up_x + (C - A) * w.z() * w.x()) / A;
    dy[6] = S(0);
    return dy;
  }
};

/// A scene in which nothing is ever at rest.
struct Never {
  using Vector = Eigen::Matrix<double, 1, 1>;
  template <class S>
  [[nodiscard]] Eigen::Matrix<S, 1, 1> rates(const S& /*t*/,
                                             const Eigen::Matrix<S, 1, 1>& y) const {
    Eigen::Matrix<S, 1, 1> dy;
    dy[0] = S(1.0) + y[0] * y[0];
    return dy;
  }
};

/// Distance of a root from the nearest mode.
double nearest(const std::vector<Mode>& modes, const std::complex<double>& root) {
  double least = std::numeric_limits<double>::infinity();
  for (const Mode& mode : modes) least = std::min(least, std::abs(mode.root - root));
  return least;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(linear_equations)

// Exact gyro: reference/cardan-gyro.json, foeppl_T4.
BOOST_AUTO_TEST_CASE(cardan_gyro_has_foeppls_frequencies) {
  const CardanGyro gyro(symmetric, springs, RestingFrame<>{});
  const auto linear = linearize<Guide, Guide>(gyro, 0, gyro.to_vector({.phi_rate = 50}));
  BOOST_TEST(linear.unsteadiness.norm() == 0);
  BOOST_TEST(linear.rate[2] == 50);
  BOOST_TEST(linear.names.at(3) == "y3");
  const std::vector<Mode> modes = spectrum(linear.A);
  for (const double expected : {47.56483992374473274113525, 3.961377526098568127462464}) {
    const double off = nearest(modes, {0, expected});
    BOOST_TEST(off < 1e-13 * 47.6, expected << ": " << off);
  }
  // phi and its rate.
  BOOST_TEST(std::abs(modes[0].root) < 1e-7);
  BOOST_TEST(std::abs(modes[1].root) < 1e-7);
}

// The matrix itself, entry by entry.
BOOST_AUTO_TEST_CASE(cardan_gyro_has_foeppls_equations) {
  const FoepplGyro<> foeppl(symmetric, {{2, 0.01}, {1.5, 0.02}}, 50);
  const auto& exact = foeppl.exact();
  const auto linear = linearize<Guide, Guide>(exact, 0, exact.to_vector({.phi_rate = 50}));
  const auto approximate = linearize<Guide, Guide>(foeppl, 0, Eigen::Vector4d::Zero());
  BOOST_TEST(approximate.names.at(2) == "alpha'");
  const std::vector<int> kept = {0, 1, 3, 4};
  const Eigen::Matrix4d off = linear.A(kept, kept) - approximate.A;
  BOOST_TEST(off.norm() < 1e-14 * approximate.A.norm(), off);
}

// The upright top: A nu^2 - C w nu + k = 0 in space, i (nu - w) on its own axes.
BOOST_AUTO_TEST_CASE(top_has_no_root_for_the_norm) {
  const Top top{0.3, 0.1, 2.5};
  for (const double w : {10.0, 30.0}) {
    for (const double norm : {1.0, 1.7}) {
      Top::Vector y;
      y << 0, 0, norm * std::sin(0.4), norm * std::cos(0.4), 0, 0, w;
      const auto linear = linearize<Inertial, Body>(top, 0, y);
      BOOST_TEST(linear.A.rows() == 6);
      BOOST_TEST(linear.names.at(1) == "angle about y");
      BOOST_TEST(linear.names.at(3) == "y4");
      BOOST_TEST(std::abs(linear.rate[2] - w) < 1e-14 * w);
      BOOST_TEST(linear.unsteadiness.norm() < 1e-12);
      const std::vector<Mode> modes = spectrum(linear.A);
      const std::complex<double> D =
          std::sqrt(std::complex<double>(top.C * top.C * w * w - 4 * top.A * top.weight_moment));
      for (const double sign : {1.0, -1.0}) {
        const std::complex<double> nu = (top.C * w + sign * D) / (2 * top.A);
        const std::complex<double> root = std::complex<double>(0, 1) * (nu - w);
        BOOST_TEST(nearest(modes, root) < 1e-12 * w);
        BOOST_TEST(nearest(modes, std::conj(root)) < 1e-12 * w);
      }
      BOOST_TEST(std::abs(modes[0].root) < 1e-6);
    }
  }
}

// On axes that do not spin the roots are those in space, i nu.
BOOST_AUTO_TEST_CASE(top_on_resting_axes_has_its_roots_in_space) {
  const double A = 0.3, C = 0.1, arm = 0.25;
  const UniformGravity<Guide> down{{0, 0, -10}};
  const AxisymmetricBody top(1.0, arm, A, C, Vector3<double>::Zero(), RestingFrame<>{}, down);
  const double w = 40;
  const auto start = top.to_vector({.angular_velocity = {0, 0, w}});
  const auto linear = linearize<Guide, Guide>(top, 0, start);
  BOOST_TEST(linear.unsteadiness.norm() == 0);
  BOOST_TEST(linear.rate[6] == w);  // the spin
  const std::vector<Mode> modes = spectrum(linear.A);
  const double D = std::sqrt(C * C * w * w - 4 * A * 10 * arm);
  for (const double sign : {1.0, -1.0}) {
    BOOST_TEST(nearest(modes, {0, (C * w + sign * D) / (2 * A)}) < 1e-13 * w);
  }
}

// An unsteady motion is reported as such.
BOOST_AUTO_TEST_CASE(unsteadiness_is_reported) {
  const Top top{0.3, 0.1, 2.5};
  Top::Vector y;
  y << std::sin(0.2), 0, 0, std::cos(0.2), 0, 0, 10;
  BOOST_TEST((linearize<Inertial, Body>(top, 0, y).unsteadiness.norm() > 1));
}

BOOST_AUTO_TEST_CASE(scenes_must_accept_dual_numbers) {
  static_assert(Differentiable<Top>);
  static_assert(Differentiable<CardanGyro<RestingFrame<>>>);
  static_assert(Differentiable<EulerTop>);
  static_assert(Differentiable<AxisymmetricBody<RestingFrame<>>>);
  using Weight = UniformGravity<Guide>;
  static_assert(Differentiable<FixedPointBody<RestingFrame<>, Weight>>);
  static_assert(Differentiable<FreeBody<RotatingFrame<>, Weight>>);
  const auto load = [](const LoadContext<>&) { return Force<Body>{}; };
  static_assert(!Differentiable<FixedPointBody<RestingFrame<>, decltype(load)>>,
                "its load is of double: its users are told");
  BOOST_CHECK_THROW(Tangent(7, {4}), InvalidInput);
  BOOST_CHECK_THROW(Tangent(9, {0, 3}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(equilibria)

// On a turntable, with massive rings and springs: the gyro tilts and stays tilted.
BOOST_AUTO_TEST_CASE(regulated_gyro_on_a_turntable) {
  const CardanGyro gyro(symmetric, springs, RotatingFrame<>{{0.3, -0.2, 0.5}}, RegulatedRotor{});
  const auto found = find_equilibrium(gyro, 0, gyro.to_vector({.phi_rate = 50}), {{2, 5}, {2}});
  BOOST_TEST(found.residual < 1e-12);
  BOOST_TEST(found.step < 1e-15);
  BOOST_TEST(found.neutral == 0);
  BOOST_TEST(found.iterations < 8);
  BOOST_TEST(std::abs(found.state[0]) > 0.01);
  BOOST_TEST(found.state[5] == 50);
  const auto linear = linearize<Guide, Guide>(gyro, 0, found.state);
  BOOST_TEST(linear.unsteadiness.norm() < 1e-10);
  // The reactions agree: springs alone hold it.
  const auto r = gyro.reactions(0, gyro.from_vector(found.state));
  BOOST_TEST(std::abs(r.guide_on_outer_ring.x() + 2 * found.state[0]) < 1e-14);
}

// The hanging top from a distant guess: the nearest such attitude, with one free direction.
BOOST_AUTO_TEST_CASE(hanging_top) {
  const Top top{0.3, 0.1, 2.5};
  Top::Vector guess;
  guess << std::sin(1.2), 0.1, 0.2, std::cos(1.2), 0.1, 0, 0;
  const auto found = find_equilibrium(top, 0, guess);
  BOOST_TEST(found.residual < 1e-14);
  BOOST_TEST(found.neutral == 1);
  const auto& y = found.state;
  const double norm = y.head<4>().squaredNorm();
  BOOST_TEST(std::abs((y[3] * y[3] + y[2] * y[2] - y[0] * y[0] - y[1] * y[1]) / norm + 1) < 1e-14);
  const auto modes = spectrum(linearize<Inertial, Body>(top, 0, y).A);
  BOOST_TEST(nearest(modes, {0, std::sqrt(2.5 / 0.3)}) < 1e-7);  // a double root
}

BOOST_AUTO_TEST_CASE(nonexistent_ones_are_not_found) {
  Never::Vector guess;
  guess[0] = 0.7;
  BOOST_CHECK_THROW((void)find_equilibrium(Never{}, 0, guess), ComputationFailed);
  BOOST_CHECK_THROW((void)find_equilibrium(Never{}, 0, guess, {{1}}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
