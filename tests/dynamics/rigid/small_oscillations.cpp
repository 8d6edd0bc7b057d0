#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/translating.hpp>
#include <dynamics/rigid/small_oscillations.hpp>
#include <dynamics/study/linear_error.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

Symmetric3<double> turned_exactly(const Symmetric3<double>& T, const Vector3<double>& angles) {
  const Matrix3<double> R = exp(Motor<double>{angles, {0, 0, 0}}).rotation;
  return Symmetric3<double>::from(Matrix3<double>(R * T.matrix() * R.transpose()));
}

/// An aircraft in a turn that rolls in gusts.
constexpr auto aircraft = [](const auto& t) {
  using std::sin;
  using S = std::decay_t<decltype(t)>;
  const YawPitchRoll<S> a{S(0.2 * t), S(0.05 * sin(1.7 * t)), S(0.3 + 0.1 * sin(2.3 * t + 1.0))};
  return Pose<S>{a.rotation(),
                 Vector3<S>(S(60.0 * t), S(0.1 * sin(3.0 * t)), S(0.2 * sin(2.0 * t)))};
};

/// An engine of 150 kg on four mounts below its centre of mass, z down, displaced by `off` from the
/// position with unloaded mounts.
template <class M>
auto engine(M guide, double stiffness, const Vector3<double>& gravity = {0, 0, 9.81},
            const Vector3<double>& off = {0, 0, 0}) {
  Matrix3<double> Theta;
  Theta << 6, 0.3, -0.5, 0.3, 12, 0.2, -0.5, 0.2, 11;
  const auto T = InertiaTensor<Body>::about_centre(150, {0.02, -0.01, -0.05}, Theta);
  std::vector<ElasticMount<>> mounts;
  for (const double x : {-0.4, 0.4}) {
    for (const double y : {-0.3, 0.3}) {
      const Vector3<double> foot(x, y, 0.25);
      const Vector3<double> k = stiffness * Vector3<double>(0.6, 0.7, 1);
      // Preload by a quarter of the weight: at rest the engine is in its drawn position.
      mounts.push_back(
          {foot + off, foot, k.asDiagonal(), (0.005 * k).asDiagonal(), {0, 0, -150 * 9.81 / 4}});
    }
  }
  return SmallOscillations(T, std::move(guide), mounts, gravity);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_first_order_tensor)

// Its error falls with the square of the angles.
BOOST_DATA_TEST_CASE(has_an_error_of_second_order, data::xrange(20u), seed) {
  test::Sample sample(seed);
  const Symmetric3<double> T{2, 3, 4.5, 0.3, -0.2, 0.5};
  const Vector3<double> direction = sample.direction();
  const auto error = [&](double angle) {
    const Vector3<double> angles = angle * direction;
    return (first_order_tensor(T, angles) - turned_exactly(T, angles)).matrix().norm();
  };
  BOOST_TEST(std::log2(error(1e-3) / error(5e-4)) > 1.95);
  BOOST_TEST(error(1e-3) < 1e-6 * 2 * 4.5);
}

// The nine entries as the paper has them, Phi the negative off-diagonals.
BOOST_AUTO_TEST_CASE(is_the_papers_matrix) {
  const double A = 2, B = 3, C = 4.5, Pa = 0.1, Pb = -0.2, Pc = 0.3;
  const double a = 0.01, b = -0.02, c = 0.03;
  const Vector3<double> angles(a, b, c);
  const auto T = first_order_tensor(Symmetric3<double>{A, B, C, -Pc, -Pb, -Pa}, angles);
  BOOST_TEST(near(T.xx, A + 2 * Pc * c - 2 * Pb * b, 4.0, 2));
  BOOST_TEST(near(T.yy, B + 2 * Pa * a - 2 * Pc * c, 4.0, 2));
  BOOST_TEST(near(T.zz, C + 2 * Pb * b - 2 * Pa * a, 4.0, 2));
  BOOST_TEST(near(T.xy, -Pc + (A - B) * c - Pa * b + Pb * a, 4.0, 2));
  BOOST_TEST(near(T.xz, -Pb + (C - A) * b - Pc * a + Pa * c, 4.0, 2));
  BOOST_TEST(near(T.yz, -Pa + (B - C) * a + Pc * b - Pb * c, 4.0, 2));
  const auto principal = first_order_tensor(Vector3<double>(A, B, C), angles);
  const auto general = first_order_tensor(Symmetric3<double>{A, B, C, 0, 0, 0}, angles);
  BOOST_TEST(near(principal.matrix(), general.matrix(), 4.0, 2));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(small_oscillations)

// f - C q' - K q is the residual force of the exact equations at q'' = 0, to first order: its
// difference quotients in each of the twelve variables. At other q'' the exact equations also
// contain products of q and q'', the first-order part of the tensor.
BOOST_AUTO_TEST_CASE(are_the_exact_equations_linearized) {
  const auto linear = engine(posed(aircraft), 2e5, {0, 0, 9.81}, {0.002, -0.001, 0.003});
  const auto exact = linear.exact();
  using Linear = std::remove_const_t<decltype(linear)>;
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Vector12 = Eigen::Matrix<double, 12, 1>;
  const auto force = [&](double t, const Vector12& y) {
    const auto s = exact.situation(t, Linear::exact_state(Linear::from_vector(y)));
    const auto& [u, v] = s.V_rel.value;
    const Motor<double> steady{{0, 0, 0}, -u.cross(v)};  // r'' = 0 on guide axes
    const Motor<double> left = s.inertia.value * (exact.acceleration(s).value - steady);
    const Matrix3<double>& R = s.X.value.rotation;
    return Vector6((Vector6() << R * left.resultant, R * left.moment).finished());
  };
  for (const double t : {0.0, 0.4, 2.0, 7.5}) {
    const auto c = linear.coefficients(t);
    BOOST_TEST(near(c.force, force(t, Vector12::Zero()), 1500.0, 64));
    constexpr double h = 1e-5;
    for (int i = 0; i < 12; ++i) {
      const Vector12 step = h * Vector12::Unit(i);
      const Vector6 slope =
          (8 * (force(t, step) - force(t, -step)) - (force(t, 2 * step) - force(t, -2 * step))) /
          (12 * h);
      const Vector6 column = i < 6 ? c.stiffness.col(i) : c.damping.col(i - 6);
      // Rounding of sums of the weight, 1500 N, over h: 2e-6 of stiffnesses up to 8e5 N/m.
      BOOST_TEST(near(slope, Vector6(-column), 1500 / h, 100));
    }
  }
}

// A guide of unknown type computes them anew each time.
BOOST_AUTO_TEST_CASE(do_not_depend_on_the_guides_type) {
  const auto hold = [](const auto& guide, const Vector3<double>& gravity) {
    const auto hidden = [guide](double t) { return guide(t); };
    const auto known = engine(guide, 2e5, gravity);
    const auto found = engine(hidden, 2e5, gravity);
    for (const double t : {0.0, 0.7, 30.0}) {
      const auto c = known.coefficients(t);
      const auto truth = found.coefficients(t);
      BOOST_TEST(near(c.stiffness, truth.stiffness, 1e6, 4));
      BOOST_TEST(near(c.damping, truth.damping, 1e4, 4));
      BOOST_TEST(near(c.force, truth.force, 1500.0, 4));
      const auto y = Eigen::Matrix<double, 12, 1>::LinSpaced(-0.01, 0.02);
      BOOST_TEST(near(known.rates(t, y), found.rates(t, y), 1e4, 16));
    }
  };
  const Vector3<double> gravity(1, 2, 9);
  const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {0.1, 0.2, 0.3}};
  const TranslatingFrame lift([](double t) {
    return Translation<>{{0, 0, t * t}, {0, 0, 2 * t}, {0, 0, 2}};
  });
  hold(RestingFrame<>{}, gravity);
  hold(turntable, {0, 0, 0});
  hold(turntable, gravity);
  hold(lift, gravity);
}

BOOST_AUTO_TEST_CASE(list_their_terms) {
  const auto kept = [](const auto& scene) {
    std::string all;
    for (const Term& term : terms(scene)) {
      all += term.kept ? '1' : '0';
      BOOST_TEST((term.kept || !term.why.empty()), term.name);
    }
    return all;
  };
  const Vector3<double> none(0, 0, 0);
  const Vector3<double> down(0, 0, 9.81);
  const RotatingFrame<> turntable{{0.3, -0.8, 0.5}};
  const TranslatingFrame lift([](double) { return Translation<>{}; });
  // M, turning, unsteady, accelerated, Coriolis, gravity, mounts
  BOOST_TEST(kept(engine(RestingFrame<>{}, 2e5, none)) == "1000001");
  BOOST_TEST(kept(engine(RestingFrame<>{}, 2e5, down)) == "1000011");
  BOOST_TEST(kept(engine(lift, 2e5, none)) == "1001001");
  BOOST_TEST(kept(engine(turntable, 2e5, none)) == "1101101");
  BOOST_TEST(kept(engine(posed(aircraft), 2e5, down)) == "1111111");
  const SmallOscillations loose(
      InertiaTensor<Body>::about_centre(2, {0, 0, 0}, Matrix3<double>::Identity()),
      RestingFrame<>{}, std::vector<ElasticMount<>>{});
  BOOST_TEST(kept(loose) == "1000000");
}

// Half the motion, a quarter of the error.
BOOST_AUTO_TEST_CASE(err_by_the_square_of_the_motion) {
  const auto linear = engine(RestingFrame<>{}, 2e5);
  const auto error = [&](double size) {
    decltype(linear)::State start;
    start.displacement = size * Vector3<double>(0.01, -0.02, 0.01);
    start.angles = size * Vector3<double>(0.03, 0.02, -0.04);
    return linear_error(linear, start, 0, 0.2, 20);
  };
  const auto whole = error(1);
  const auto half = error(0.5);
  BOOST_TEST_MESSAGE("angles to " << whole.greatest_angle << ": error " << whole.angle << " rad, "
                                  << whole.displacement << " m");
  BOOST_TEST(std::log2(whole.angle / half.angle) > 1.8);
  BOOST_TEST(std::log2(whole.displacement / half.displacement) > 1.8);
}

// On an aircraft in a turn the engine follows, up to the square of its swing.
BOOST_AUTO_TEST_CASE(describe_an_engine_on_an_aircraft) {
  const auto linear = engine(posed(aircraft), 2e5);
  const auto error = linear_error(linear, {}, 0, 1, 20);
  BOOST_TEST_MESSAGE("angles to " << error.greatest_angle << ": error " << error.angle << " rad, "
                                  << error.displacement << " m");
  BOOST_TEST(error.greatest_angle > 1e-4);
  BOOST_TEST(error.angle < 10 * error.greatest_angle * error.greatest_angle);
}

// One mass on one spring.
BOOST_AUTO_TEST_CASE(have_the_period_of_a_mass_on_a_spring) {
  const auto T = InertiaTensor<Body>::about_centre(2, {0, 0, 0}, Matrix3<double>::Identity());
  const ElasticMount<> mount{{0, 0, 0}, {0, 0, 0}, 50 * Matrix3<double>::Identity()};
  const SmallOscillations linear(T, RestingFrame<>{}, {mount});
  const auto end = Integrator(linear, 0, {{0.1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}})
                       .to(2 * std::acos(-1.0) / 5);
  BOOST_TEST(near(end.displacement, Vector3<double>(0.1, 0, 0), 0.1, 1e-12 / test::u<>));
}

BOOST_AUTO_TEST_SUITE_END()
