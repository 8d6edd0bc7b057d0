#include <boost/test/unit_test.hpp>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <type_traits>
#include <utility>

#include <dynamics/guide/analytic.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/series.hpp>

using namespace kreisel;
using test::hold_samples;
using test::near;

namespace {

const Vector3<double> point(0.3, 0.1, -0.2);
const UniformGravity<Guide> in_guide{{0.5, 1, -9}};
const UniformGravity<Inertial> inertial{{-1, 0.3, -5}};
const RotatingFrame<> turntable{{0.3, -0.8, 0.5}, {0.1, 0.2, 0.3}};

InertiaTensor<Body> inertia() {
  Matrix3<double> Theta;
  Theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  return InertiaTensor<Body>::about_origin(1, {0.05, -0.02, -0.2}, Theta);
}

InertiaTensor<Body> principal_inertia() {
  const Vector3<double> moments(0.25, 0.27, 0.06);
  return InertiaTensor<Body>::about_origin(1, {0.05, -0.02, -0.2},
                                           Matrix3<double>(moments.asDiagonal()));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(attitude_series)

BOOST_AUTO_TEST_CASE(agrees_for_bodies_with_a_fixed_point) {
  const Vector3<double> none = Vector3<double>::Zero();
  hold_samples("at rest, free", FixedPointBody(inertia(), point, RestingFrame<>{}));
  hold_samples("at rest, heavy", FixedPointBody(inertia(), point, RestingFrame<>{}, inertial));
  hold_samples("turning", FixedPointBody(inertia(), point, turntable));
  hold_samples("turning, gravity on it", FixedPointBody(inertia(), point, turntable, in_guide));
  hold_samples("turning, gravity turns", FixedPointBody(inertia(), point, turntable, inertial));
  hold_samples("turning, both", FixedPointBody(inertia(), point, turntable, inertial, in_guide));
  hold_samples(
      "turning about a slanting axis, gravity turns",
      FixedPointBody(
          inertia(), point,
          RotatingFrame<>{
              {0.3, -0.8, 0.5}, none, {{Pose<>::from(Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2))}}},
          inertial));
  SteadyFrame<> screw;
  screw.V.value = {{0.2, 0.1, -0.4}, {1, 2, 3}};
  hold_samples("in a steady screw", FixedPointBody(inertia(), point, screw, in_guide));
}

BOOST_AUTO_TEST_CASE(agrees_for_bodies_on_analytic_guides) {
  HarmonicSeries<> u{{0.1, -0.2, 0.3}, {{{0.3, 0.1, -0.2}, 1.3, 0.4}, {{0.1, 0.5, 0.2}, 2.9, 1}}};
  HarmonicSeries<> a{{0.1, 0.2, 9}, {{{1, -0.5, 2}, 0.7, 0.2}}};
  const HarmonicFrame<> harmonic(u, a, 0, 2);
  hold_samples("on a harmonic guide",
               FixedPointBody(inertia(), point, harmonic, inertial, in_guide));
  hold_samples("at the guide's origin", FixedPointBody(inertia(), {0, 0, 0}, harmonic, inertial));
  const auto ship = analytic([](const auto& t) {
    using std::exp;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const YawPitchRoll<T> turn{T(0.3 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.2 * sin(0.9 * t))};
    return Pose<T>{turn.rotation(), Vector3<T>(T(5.0 * t), T(0.5 * sin(0.7 * t)), T(exp(-t)))};
  });
  hold_samples("on a ship", FixedPointBody(inertia(), point, ship, inertial, in_guide));
  hold_samples("on a ship, without gravity", FixedPointBody(inertia(), point, ship));
  hold_samples("body of revolution on a ship",
               AxisymmetricBody(1, -0.3, 0.25, 0.06, point, ship, inertial));
}

// A series of the guide serves the steps of the body within its reach, and no others.
BOOST_AUTO_TEST_CASE(continues_beyond_the_guides_series) {
  const HarmonicFrame<> slow({{0.1, -0.2, 0.3}, {{{0.3, 0.1, -0.2}, 1.3, 0.4}}},
                             {{0.1, 0.2, 9}, {{{1, -0.5, 2}, 0.7, 0.2}}}, 0, 60);
  const FixedPointBody body(inertia(), point, slow, inertial);
  constexpr int order = decltype(body.series())::most_order;
  Eigen::Matrix<double, 7, order + 1> followed;
  followed.col(0) << 0.1, -0.2, 0.3, 0.9, 1, 2, 3;
  auto series = body.series();
  constexpr double h = 0.125;
  for (int step = 0; step < 400; ++step) {
    series(h * step, h, order, followed);
    auto anew = followed;
    body.series()(h * step, h, order, anew);
    BOOST_TEST_REQUIRE((followed - anew).norm() <= 1e-14 * anew.norm(), "at " << h * step << " s");
  }
}

// The apparent field against that of the guide's own motion, at any times in any order. Steps are
// nearly as long as the series reaches, and in one case every other coefficient vanishes.
BOOST_AUTO_TEST_CASE(gives_the_apparent_field_at_any_time) {
  const HarmonicSeries<> heave{{0.1, 0.2, 9}, {{{1, -0.5, 2}, 0.7, std::numbers::pi / 2}}};
  const HarmonicFrame<> even({{0.1, -0.2, 0.3}, {}}, heave, -60, 60);
  const HarmonicFrame<> uneven({{0.1, -0.2, 0.3}, {{{0.3, 0.1, -0.2}, 1.3, 0.4}}}, heave, -60, 60);
  for (const HarmonicFrame<>& guide : {even, uneven}) {
    const auto anew = [&guide] {
      return detail::ApparentSeries(guide, detail::components(point),
                                    detail::components(in_guide.g), detail::ZeroVector{});
    };
    const auto hold = [&guide](auto& felt, double t, double h) {
      const GuideSeries series = felt.at(t, h, most_series_order);
      for (const double s : {-1.0, 0.0, 0.5, 1.25}) {
        Motor<> sum;
        for (std::size_t k = most_series_order + 1; k-- > 0;) {
          sum = Motor<>{detail::vector(series.u[k]), detail::vector(series.g[k])} + s * sum;
        }
        const auto now = guide(t + s * h);
        const auto& [u, v] = now.V.value;
        const Vector3<double> du = now.dV.value.resultant;
        const Vector3<double> g =
            in_guide.g - now.origin_acceleration() - du.cross(point) - u.cross(u.cross(point));
        // Angles to 13 rad are rounded in both, 25 terms are summed.
        BOOST_TEST(near(sum.resultant, u, 1.0, 64));
        BOOST_TEST(near(sum.moment, g, 20.0, 64));
      }
    };
    auto felt = anew();
    constexpr double longest = 0.9;
    for (const auto& [t, h] : {std::pair(0.0, 0.125),
                               {10.0, 0.125},
                               {-10.0, 0.125},
                               {-0.5, 0.125},
                               {0.0, longest},
                               {longest, longest},
                               {2 * longest, longest},
                               {3 * longest, -longest}}) {
      hold(felt, t, h);
    }
    // After a step between two close jumps, powers of the ratio of both units would overflow.
    auto after_little = anew();
    hold(after_little, 0, 0x1p-55);
    hold(after_little, 0x1p-55, longest);
    for (int i = 1; i <= 20; ++i) {
      auto once = anew();
      hold(once, 0, longest);
      hold(once, 0.1 * i, longest);
    }
  }
}

BOOST_AUTO_TEST_CASE(omits_terms_that_the_body_omits) {
  using Principal = Without<ProductsOfInertia>;
  const InertiaTensor<Body> balanced{
      {1, Vector3<double>::Zero(), {0.25, 0.27, 0.06, 0.01, 0.02, 0.03}}};
  hold_samples("principal axes",
               FixedPointBody(principal_inertia(), point, turntable, inertial, Principal{}));
  hold_samples("at its centre of mass",
               FixedPointBody(balanced, point, turntable, inertial, Without<FirstMoment>{}));
  hold_samples("slow guide", FixedPointBody(inertia(), point, RotatingFrame<>{{0, 0, 0.8}},
                                            in_guide, Without<GuideRate, Axis::x, Axis::y>{}));
}

BOOST_AUTO_TEST_CASE(agrees_for_axisymmetric_bodies) {
  const auto body = [](const auto& guide, const auto&... loads) {
    return AxisymmetricBody(1, -0.3, 0.25, 0.06, point, guide, loads...);
  };
  hold_samples("at rest, free", body(RestingFrame<>{}));
  hold_samples("at rest, heavy", body(RestingFrame<>{}, inertial));
  hold_samples("turning, heavy", body(turntable, in_guide));
  hold_samples("turning, gravity turns", body(turntable, inertial));
}

BOOST_AUTO_TEST_CASE(agrees_for_tops) {
  hold_samples("free", EulerTop({1, 1.7, 2.4}));
  hold_samples("heavy", EulerTop({1, 1.7, 2.4}, {0.5, -0.3, 2}));
  hold_samples("with a rotor", EulerTop({1, 1.7, 2.4}, {0.5, -0.3, 2}, {0.3, 1, -0.4}));
}

// A symmetric body keeps its spin exactly: all coefficients of the spin are 0.
BOOST_AUTO_TEST_CASE(keeps_the_spin_of_symmetric_bodies) {
  auto series = EulerTop({2, 2, 3}, {0, 0, 5}).series();
  Eigen::Matrix<double, 7, 25> c;
  c.col(0) << 0.1, -0.2, 0.3, 0.9, 1, 2, 30;
  series(0, 0.01, 24, c);
  BOOST_TEST(c.row(6).tail(24).isZero(0));
}

BOOST_AUTO_TEST_SUITE_END()
