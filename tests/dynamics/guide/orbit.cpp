#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>

#include <dynamics/guide/orbit.hpp>
#include <dynamics/tree/description.hpp>

#include <support/near.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

using Real = long double;
using Digits = boost::multiprecision::cpp_bin_float_50;
using Dual = detail::AlongOne;

template <class S = double>
OrbitElements<S> inclined(S j2 = S(0)) {
  return {.semi_major_axis = S(9e6),
          .eccentricity = S(0.3),
          .inclination = S(1),
          .node = S(0.4),
          .perigee = S(2.5),
          .anomaly = S(4),
          .j2 = j2};
}

/// The derivative by differences of fourth order in the step.
template <class F>
auto slope(const F& f, Real t, Real h) {
  return ((8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h)).eval();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(kepler)

// Compared in 50 digits; the mean anomaly is computed from a given E and rounded.
BOOST_DATA_TEST_CASE(is_solved_to_the_last_digits, data::xrange(2000u), seed) {
  const double shares[] = {0, 1e-12, 0.01, 0.3, 0.9, 0.999, 1 - 1e-9, 1 - 1e-15};
  const double e = shares[seed % 8];
  const double exponent = (seed / 8) % 50 * -0.3;
  const double M = 3.1415 * std::pow(10.0, exponent) * (seed % 3 == 0 ? -1 : 1);
  Digits E = detail::eccentric_anomaly(M, e);
  const double found = static_cast<double>(E);
  for (int i = 0; i < 8; ++i) E -= (E - Digits(e) * sin(E) - M) / (1 - Digits(e) * cos(E));
  BOOST_TEST(near(found, static_cast<double>(E), std::abs(found), 4), "e " << e << " M " << M);
}

BOOST_AUTO_TEST_CASE(takes_any_number_of_turns) {
  for (const double M : {-1000.25, -3.2, 3.2, 7.0, 1e4}) {
    const double E = detail::eccentric_anomaly(M, 0.4);
    BOOST_TEST(std::abs(std::remainder(E - 0.4 * std::sin(E) - M, 2 * std::acos(-1.0))) <
               4e-16 * (1 + std::abs(M)));
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(an_orbit_as_a_guide)

BOOST_AUTO_TEST_CASE(begins_at_its_true_anomaly) {
  const OrbitElements<> o = inclined();
  const FrameMotion<Guide, Inertial> now = OrbitFrame<>(o)(0.0);
  const double p = o.semi_major_axis * (1 - o.eccentricity * o.eccentricity);
  const Vector3<double> x = now.X.value.translation;
  BOOST_TEST(near(x.norm(), p / (1 + o.eccentricity * std::cos(o.anomaly)), x.norm(), 8));
  const Vector3<double> node(std::cos(o.node), std::sin(o.node), 0);
  const Vector3<double> normal(std::sin(o.inclination) * std::sin(o.node),
                               -std::sin(o.inclination) * std::cos(o.node),
                               std::cos(o.inclination));
  const double angle = o.perigee + o.anomaly;
  BOOST_TEST(near(Vector3<double>(x / x.norm()),
                  Vector3<double>(std::cos(angle) * node + std::sin(angle) * normal.cross(node)),
                  1.0, 8));
  BOOST_TEST(
      near(Vector3<double>(now.X.value.rotation.col(0)), Vector3<double>(x / x.norm()), 1.0, 4));
  BOOST_TEST(near(Vector3<double>(now.X.value.rotation.col(2)), normal, 1.0, 4));
}

// Newton's law, and the invariants of the elements.
BOOST_DATA_TEST_CASE(falls_freely, data::xrange(20u), k) {
  const OrbitElements<> o = inclined();
  const auto now = OrbitFrame<>(o)(977.0 * k);
  const Matrix3<double>& R = now.X.value.rotation;
  const Vector3<double> x = now.X.value.translation;
  const Vector3<double> v = R * now.V.value.moment;
  const double r = x.norm();
  const Vector3<double> g = -o.parameter / (r * r * r) * x;
  BOOST_TEST(near(Vector3<double>(R * now.origin_acceleration()), g, g.norm(), 16));
  const double energy = v.squaredNorm() / 2 - o.parameter / r;
  BOOST_TEST(near(energy, -o.parameter / (2 * o.semi_major_axis), o.parameter / r, 16));
  const double momentum = std::sqrt(o.parameter * o.semi_major_axis * (1 - 0.3 * 0.3));
  BOOST_TEST(near(x.cross(v).norm(), momentum, momentum, 16));
}

BOOST_AUTO_TEST_CASE(comes_back_after_a_period) {
  const OrbitFrame<> frame(inclined());
  const double period = 2 * std::acos(-1.0) / frame.orbit().mean_motion();
  BOOST_TEST(near(Vector3<double>(frame(period).X.value.translation),
                  Vector3<double>(frame(0.0).X.value.translation), 9e6, 40));
}

// A circle has a constant rate only.
BOOST_AUTO_TEST_CASE(turns_evenly_on_a_circle) {
  const OrbitElements<> circle{.semi_major_axis = 7e6, .inclination = 0.5, .anomaly = 1};
  const OrbitFrame<> frame(circle);
  for (const double t : {0.0, 1234.5}) {
    const auto now = frame(t);
    BOOST_TEST((now.V.value.resultant == Vector3<double>(0, 0, frame.orbit().mean_motion())));
    BOOST_TEST((now.dV.value.resultant == Vector3<double>::Zero()));
    BOOST_TEST((now.V.value.moment.x() == 0));
  }
}

// Velocity and acceleration are the derivatives of the pose, also if node and perigee precess.
BOOST_DATA_TEST_CASE(moves_as_its_pose_does, data::xrange(8u), k) {
  const OrbitFrame<Guide, Inertial, Real> frame(inclined<Real>(k % 2 ? 1e-3L : 0));
  const Real t = 1000 * k;
  const auto now = frame(t);
  const auto pose = [&](Real s) { return frame(s).X.value; };
  const auto velocity = [&](Real s) { return frame(s).V.value; };
  const Matrix3<Real> R = now.X.value.rotation;
  const Vector3<Real> v = slope([&](Real s) { return pose(s).translation; }, t, 0.5L);
  BOOST_TEST((R.transpose() * v - now.V.value.moment).norm() < 1e-9L);
  const Matrix3<Real> turning =
      R.transpose() * slope([&](Real s) { return pose(s).rotation; }, t, 0.5L);
  BOOST_TEST((turning - skew(now.V.value.resultant)).norm() < 1e-15L);
  const Vector3<Real> du = slope([&](Real s) { return velocity(s).resultant; }, t, 0.5L);
  BOOST_TEST((du - now.dV.value.resultant).norm() < 1e-18L);
  const Vector3<Real> dv = slope([&](Real s) { return velocity(s).moment; }, t, 0.5L);
  BOOST_TEST((dv - now.dV.value.moment).norm() < 1e-12L);
}

// precession is the acceleration by the mean rates, added to the Kepler acceleration.
BOOST_DATA_TEST_CASE(says_what_precession_adds, data::xrange(8u), k) {
  const OrbitElements<Real> o = inclined<Real>(1e-3L);
  const OrbitFrame<Guide, Inertial, Real> frame(o);
  const Real t = 1000 * k;
  const auto point = frame.orbit().at(t);
  const Vector3<Real> kepler(-o.parameter / (point.radius * point.radius), 0, 0);
  BOOST_TEST((frame(t).origin_acceleration() - kepler - point.precession).norm() < 1e-17L);
  BOOST_TEST(point.precession.norm() > 1e-4L);
}

// A sun-synchronous orbit of 800 km: once around in a year. Vallado 11.4 has 98.6 degrees.
BOOST_AUTO_TEST_CASE(keeps_up_with_the_sun) {
  const double degree = std::acos(-1.0) / 180;
  const Orbit<> orbit(OrbitElements<>{
      .semi_major_axis = 7178137, .inclination = 98.603 * degree, .j2 = 1.08262982131e-3});
  BOOST_TEST(std::abs(orbit.node_rate() / degree * 86400 - 360 / 365.2422) < 1e-4);
  const Orbit<> critical(OrbitElements<>{.semi_major_axis = 2.6e7,
                                         .eccentricity = 0.7,
                                         .inclination = std::acos(std::sqrt(0.2)),
                                         .j2 = 1.08262982131e-3});
  BOOST_TEST(std::abs(critical.perigee_rate()) < 1e-22);
}

BOOST_AUTO_TEST_CASE(has_derivatives_by_time_and_elements) {
  const OrbitFrame<> frame(inclined(1e-3));
  Dual t(500);
  t.derivatives()[0] = 1;
  const auto now = frame(t);
  const auto plain = frame(500.0);
  const Vector3<double> du(now.V.value.resultant.x().derivatives()[0],
                           now.V.value.resultant.y().derivatives()[0],
                           now.V.value.resultant.z().derivatives()[0]);
  BOOST_TEST(near(du, Vector3<double>(plain.dV.value.resultant), 1e-6, 8));
  // The derivative by the eccentricity, against a difference in long double.
  OrbitElements<Dual> dual;
  dual.semi_major_axis = 9e6;
  dual.eccentricity = 0.3;
  dual.eccentricity.derivatives()[0] = 1;
  dual.anomaly = 1;
  const auto by_dual = OrbitFrame<Guide, Inertial, Dual>(dual)(Dual(2000)).X.value.translation;
  const auto place = [](Real e) {
    const OrbitElements<Real> o{.semi_major_axis = 9e6L, .eccentricity = e, .anomaly = 1};
    return OrbitFrame<Guide, Inertial, Real>(o)(2000.0L).X.value.translation;
  };
  const Vector3<Real> by_difference = slope(place, 0.3L, 1e-4L);
  for (int i = 0; i < 2; ++i) {
    const double d = by_dual[i].derivatives()[0];
    BOOST_TEST(std::abs(d - static_cast<double>(by_difference[i])) < 1e-9 * 9e6);
  }
}

BOOST_DATA_TEST_CASE(has_a_series, data::xrange(6u), k) {
  const OrbitFrame<> frame(inclined(k % 2 ? 1e-3 : 0));
  const double t = 2000.0 * k, h = 100;
  const GuideSeries series = frame.series(t, h, 24, {1, 2, 3});
  Vector3<double> u = Vector3<double>::Zero(), g = u;
  for (std::size_t i = 0; i < series.u.size(); ++i) {
    u += Vector3<double>(series.u[i].x, series.u[i].y, series.u[i].z);
    g += Vector3<double>(series.g[i].x, series.g[i].y, series.g[i].z);
  }
  const auto then = frame(t + h);
  BOOST_TEST(near(u, Vector3<double>(then.V.value.resultant), 1e-3, 40));
  const Vector3<double> fall = then.X.value.rotation.transpose() * Vector3<double>(1, 2, 3);
  BOOST_TEST(near(g, Vector3<double>(fall - then.origin_acceleration()), 10.0, 40));
}

BOOST_AUTO_TEST_CASE(must_be_an_ellipse) {
  const auto refused = [](OrbitElements<> o, const std::string& key) {
    BOOST_CHECK_EXCEPTION(OrbitFrame<>{o}, InvalidInput, [&](const InvalidInput& error) {
      return std::string(error.what()).starts_with(key);
    });
  };
  refused({.semi_major_axis = 0}, "semi_major_axis = 0 must be");
  refused({.semi_major_axis = 7e6, .eccentricity = 1}, "eccentricity = 1 must be");
  refused({.semi_major_axis = 7e6, .eccentricity = -0.1}, "eccentricity");
  refused({.semi_major_axis = 7e6, .parameter = 0}, "mu");
  refused({.semi_major_axis = 7e6, .inclination = std::numeric_limits<double>::quiet_NaN()},
          "inclination");
}

BOOST_AUTO_TEST_SUITE_END()
