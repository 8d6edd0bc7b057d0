// Courses over the ellipsoid: paths against GeographicLib's geodesics, rates against closed forms
// and against differences of the pose.

#include <GeographicLib/Geodesic.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>
#include <string>

#include <dynamics/guide/course.hpp>
#include <dynamics/guide/earth_frame.hpp>

#include <support/near.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

using Number = Signal<double>;
using Level = FrameMotion<detail::LevelAxes, detail::EarthAxes>;

constexpr double a = Wgs84::radius;
constexpr double spin = Wgs84::rotation_rate;
const double degree = std::acos(-1.0) / 180;

/// North, east and up of the ellipsoid.
struct Compass {
  Compass(double latitude, double longitude) {
    const auto [s, c] = sine_cosine_degrees(latitude);
    const auto [sl, cl] = sine_cosine_degrees(longitude);
    north = {-s * cl, -s * sl, c};
    east = {-sl, cl, 0};
    up = {c * cl, c * sl, s};
  }
  Vector3<double> north, east, up;
};

Vector3<double> geocentric(double latitude, double longitude, double height) {
  Vector3<double> p;
  GeographicLib::Geocentric::WGS84().Forward(latitude, longitude, height, p.x(), p.y(), p.z());
  return p;
}

/// Radii of curvature of the meridian and of the prime vertical.
struct Radii {
  explicit Radii(double latitude) {
    const double s = std::sin(latitude * degree);
    const double w = 1 - Wgs84::e2 * s * s;
    across = a / std::sqrt(w);
    along = across * (1 - Wgs84::e2) / w;
  }
  double along, across;
};

/// A course that turns, climbs and accelerates.
CoursePlan winding() {
  return {.latitude = 62,
          .longitude = 25,
          .height = 3000,
          .heading = 210,
          .speed = 240,
          .turn_rate = Number(0.004, 1e-5, {{0.01, 0.03, 0.4}}),
          .acceleration = Number(0.05, 0, {{0.2, 0.02, 0}}),
          .climb = Number(1, 0, {{4, 0.025, 2}})};
}

/// The derivative by central differences of eighth order.
template <class F>
auto slope(const F& f, double t, double h) {
  const auto off = [&](int k) { return (f(t + k * h) - f(t - k * h)).eval(); };
  return ((672 * off(1) - 168 * off(2) + 32 * off(3) - 3 * off(4)) / (840 * h)).eval();
}

/// Velocity, angular velocity and their rates are the derivatives of the pose. The differences have
/// an error of h^8/630 of the ninth derivative, below 2e-14 of the change here, and twice the
/// rounding over h: 1e-9 m, 3e-16 rad, 1e-13 m/s.
template <class Frame>
void check_rates(const Frame& frame, double t) {
  constexpr double h = 1;
  const auto now = frame(t);
  const Matrix3<double> back = now.X.value.rotation.transpose();
  const auto place = [&](double s) { return Vector3<double>(frame(s).X.value.translation); };
  const auto axes = [&](double s) { return Matrix3<double>(frame(s).X.value.rotation); };
  const auto twist = [&](double s) {
    const Motor<> V = frame(s).V.value;
    return (Eigen::Matrix<double, 6, 1>() << V.resultant, V.moment).finished();
  };
  const Vector3<double> v = back * slope(place, t, h);
  BOOST_TEST((v - now.V.value.moment).norm() <= 1e-8, v << "\nis\n" << now.V.value.moment);
  const Matrix3<double> turning = back * slope(axes, t, h);
  BOOST_TEST((turning - skew(now.V.value.resultant)).norm() <= 2e-14);
  const auto dV = slope(twist, t, h);
  BOOST_TEST((dV.template head<3>() - now.dV.value.resultant).norm() <= 2e-15,
             dV << "\nis\n"
                << now.dV.value.resultant);
  BOOST_TEST((dV.template tail<3>() - now.dV.value.moment).norm() <= 2e-12,
             dV << "\nis\n"
                << now.dV.value.moment);
}

std::string refusal(const CoursePlan& plan, double end = 100) {
  try {
    const Course course(plan, end);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_ellipsoid)

// J2 of WGS84 in twelve digits changes gravity by up to 1e-13 m/s^2.
BOOST_AUTO_TEST_CASE(has_the_gravitation_of_the_library) {
  for (const double latitude : {-90.0, -61.0, 0.0, 3.0, 45.0, 90.0}) {
    for (const double height : {-1000.0, 0.0, 4e4, 1e6}) {
      const Vector3<double> p = geocentric(latitude, 20, height);
      BOOST_TEST((normal_gravitation(p) - detail::gravitation(p)).norm() <= 2e-13);
      const Vector3<double> there = point_above(Compass(latitude, 20).up, height);
      BOOST_TEST((there - p).norm() <= 4e-9);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_course)

// Rounding of the normal is 1.1e-16 of 6.4e6 m for each component, and up to 5 rounding errors meet.
BOOST_DATA_TEST_CASE(without_turning_is_a_geodesic,
                     data::make({40.0, 0.0, -75.0, 89.999, 90.0}) *
                         data::make({0.0, 90.0, 37.0, -140.0, 179.9}) * data::make({1e6, 1e7, 3e7}),
                     latitude, heading, distance) {
  const double speed = 250;
  const Course course({.latitude = latitude, .longitude = 11, .heading = heading, .speed = speed},
                      distance / speed);
  const Level there = course.at(distance / speed).level;
  double to_latitude = 0, to_longitude = 0, to_heading = 0;
  GeographicLib::Geodesic::WGS84().Direct(latitude, 11, heading, distance, to_latitude,
                                          to_longitude, to_heading);
  const Compass compass(to_latitude, to_longitude);
  BOOST_TEST((there.X.value.translation - geocentric(to_latitude, to_longitude, 0)).norm() <= 1e-8);
  const auto [s, c] = sine_cosine_degrees(to_heading);
  const Vector3<double> ahead = c * compass.north + s * compass.east;
  BOOST_TEST(near(Vector3<double>(there.X.value.rotation.col(2)), ahead, 1.0, 20));
  BOOST_TEST(
      near(Vector3<double>(there.X.value.rotation.col(0)), Vector3<double>(-compass.up), 1.0, 20));
}

// The meridian is crossed at the pole, where the heading turns from north to south.
BOOST_AUTO_TEST_CASE(goes_through_the_pole) {
  const Course course({.latitude = 89, .longitude = 30, .heading = 0, .speed = 200}, 2000);
  double distance = 0;
  GeographicLib::Geodesic::WGS84().Inverse(89, 30, 90, 0, distance);
  const Level pole = course.at(distance / 200).level;
  BOOST_TEST((pole.X.value.translation - geocentric(90, 0, 0)).norm() <= 4e-9);
  BOOST_TEST(near(Vector3<double>(pole.X.value.rotation.col(2)), Compass(90, 30).north, 1.0, 8));
  const double meridian = a * a / (a * (1 - Wgs84::flattening));  // radius at the pole
  BOOST_TEST(near(pole.V.value.resultant.y(), 200 / meridian, 200 / meridian, 8));
  BOOST_TEST(std::abs(pole.V.value.resultant.z()) <= 1e-20);
}

// The transport rate of the textbook, with turn_rate that keeps the heading.
BOOST_DATA_TEST_CASE(has_the_transport_rate,
                     data::make({0.0, 50.0, -70.0}) * data::make({0.0, 90.0, 250.0}), latitude,
                     heading) {
  const double h = 9000, v = 230;
  const Radii radii(latitude);
  const double north = v * std::cos(heading * degree), east = v * std::sin(heading * degree);
  const double convergence = east * std::tan(latitude * degree) / (radii.across + h);
  const Course course({.latitude = latitude,
                       .height = h,
                       .heading = heading,
                       .speed = v,
                       .turn_rate = -convergence},
                      10);
  const Level now = course.at(0).level;
  const Compass compass(latitude, 0);
  const Vector3<double> wanted = east / (radii.across + h) * compass.north -
                                 north / (radii.along + h) * compass.east +
                                 convergence * compass.up;
  BOOST_TEST(near(Vector3<double>(now.X.value.rotation * now.V.value.resultant), wanted,
                  wanted.norm(), 16));
}

// A parallel is left by 1e-9 m after a turn around the pole.
BOOST_DATA_TEST_CASE(along_a_parallel_keeps_its_latitude, data::make({0.0, 30.0, 85.0}), latitude) {
  const double v = 300;
  const Radii radii(latitude);
  const double around = 2 * std::acos(-1.0) * radii.across * std::cos(latitude * degree) / v;
  const Course course({.latitude = latitude,
                       .heading = 90,
                       .speed = v,
                       .turn_rate = -v * std::tan(latitude * degree) / radii.across},
                      around);
  for (const double share : {0.2, 0.7, 1.0}) {
    const Level now = course.at(share * around).level;
    const Vector3<double> wanted = geocentric(latitude, 360 * share, 0);
    BOOST_TEST((now.X.value.translation - wanted).norm() <= 2e-8);
    BOOST_TEST(near(Vector3<double>(now.X.value.rotation.col(2)),
                    Compass(latitude, 360 * share).east, 1.0, 64));
  }
}

// Distance and height are the integrals of their rates over every jump.
BOOST_AUTO_TEST_CASE(meets_jumps_exactly) {
  const CoursePlan plan{.heading = 90,
                        .speed = 100,
                        .acceleration = Number::steps({{0, 0}, {1000, 0.5}, {1200, -0.25}}),
                        .climb = Number::broken_line({{100, 0}, {500, 8}, {700, 0}})};
  BOOST_TEST(plan.discontinuities(2000) == std::vector<double>({100, 500, 700, 1000, 1200}),
             boost::test_tools::per_element());
  const Course course(plan, 2000);
  const Level now = course.at(2000).level;
  BOOST_TEST(near(now.V.value.moment.z(), 100 + 100 - 200.0, 200.0, 4));
  BOOST_TEST(near(now.X.value.translation.norm(), a + 2400, a, 4));
  // At the height h the distance to the axis is a + h.
  const auto angle = [](double from, double to, double speed, double height) {
    return (to - from) * speed / (a + height);
  };
  // First h = s^2/100 for 400 s.
  const double climbing = 100 * 10 / std::sqrt(a) * std::atan(400 / (10 * std::sqrt(a)));
  // Then h = 1600 + 8 s - s^2/50 for 200 s.
  const double top = std::sqrt(50 * (a + 1600 + 800));
  const double sinking = 100 * 50 / top * std::atanh(200 / top);
  const double rest =
      angle(0, 100, 100, 0) + angle(700, 1000, 100, 2400) + (200 * 150 + 800 * 100.0) / (a + 2400);
  const double longitude = std::atan2(now.X.value.translation.y(), now.X.value.translation.x());
  BOOST_TEST(near(longitude, climbing + sinking + rest, 1.0, 4));
}

BOOST_AUTO_TEST_CASE(is_refused_if_it_is_none) {
  const auto check = [](const CoursePlan& plan, const std::string& wanted, double end = 100) {
    const std::string found = refusal(plan, end);
    BOOST_TEST(found.find(wanted) != std::string::npos, found << " is not " << wanted);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  check({.latitude = 91}, "latitude = 91 degrees lies outside");
  check({.longitude = 400}, "longitude = 400 degrees lies outside");
  check({.height = 2e7}, "height = 20000000 m lies outside");
  check({.heading = nan}, "heading = nan degrees lies outside");
  check({.speed = nan}, "speed = nan m/s lies outside");
  check({.gravity = 0}, "gravity = 0 m/s^2 must be");
  check({}, "end of the course", nan);
  check({}, "end of the course", 0);
  check({.turn_rate = Number::steps({{50, 1}})}, "turn_rate jumps, or its rate does, at t = 50 s");
  check({.turn_rate = Number::steps({{0, 0.1}, {100, 0}})}, "none");
  check({.climb = Number::steps({{50, 1}})}, "climb jumps");
  check({.bank = Number::broken_line({{50, 1}, {60, 2}})}, "bank jumps");
  const Number kinks = Number::broken_line({{50, 1}, {60, 2}});
  check({.turn_rate = kinks}, "none");
  check({.turn_rate = kinks, .is_coordinated = true}, "turn_rate jumps");
  check({.climb = kinks, .is_coordinated = true}, "climb jumps");
  check({.acceleration = kinks, .is_coordinated = true}, "none");
  check({.acceleration = Number::steps({{50, 1}}), .is_coordinated = true}, "acceleration jumps");
  check({.climb = -200}, "height at t = 100 s = -20000 m lies outside");
  check({.turn_rate = Number(0, 0, {{1, 1e7, 0}})}, "by more than 4e4 rad");
  check({.speed = 10, .climb = Number(0, 0, {{3, 7.7, 0}}), .is_coordinated = true},
        "where apparent gravity vanishes");
  const Course course({}, 100);
  BOOST_CHECK_THROW((void)course.at(-1e-9), InvalidInput);
  BOOST_CHECK_THROW((void)course.at(100.1), InvalidInput);
  BOOST_CHECK_THROW((void)course.at(nan), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_vehicle_as_a_guide)

BOOST_DATA_TEST_CASE(at_rest_is_the_earth_frame,
                     data::make({47.0, -90.0, 0.0}) * data::make({30.0, 270.0}), latitude,
                     heading) {
  const CourseFrame<> vehicle({.latitude = latitude, .heading = heading}, 1e5);
  const auto earth = earth_frame({latitude, heading, 0});
  for (const double t : {0.0, 1000.0, 1e5}) {
    const auto x = vehicle(t), y = earth(t);
    BOOST_TEST(near(x.X.value.rotation, y.X.value.rotation, 1.0, 8));
    BOOST_TEST(
        near(Vector3<double>(x.X.value.translation), Vector3<double>(y.X.value.translation), a, 4));
    BOOST_TEST(near(x.V.value.resultant, y.V.value.resultant, spin, 8));
    BOOST_TEST(near(x.V.value.moment, y.V.value.moment, 465.0, 8));
    BOOST_TEST((x.dV.value.resultant.isZero(0)));
    BOOST_TEST(near(x.origin_acceleration(), y.origin_acceleration(), 0.034, 8));
  }
}

// Eotvos: on the equator the vehicle circles the axis with the speed (a + h) u + v.
BOOST_DATA_TEST_CASE(along_the_equator_has_the_eotvos_effect, data::make({90.0, 270.0}), heading) {
  const double h = 10000, v = 250;
  const CourseFrame<> vehicle({.height = h, .heading = heading, .speed = v}, 1000);
  const double s = (a + h) * spin + (heading == 90 ? v : -v);
  for (const double t : {0.0, 777.0}) {
    const auto now = vehicle(t);
    BOOST_TEST(near(now.origin_acceleration(), {s * s / (a + h), 0, 0}, 0.1, 8));
    BOOST_TEST(near(now.X.value.translation.norm(), a + h, a, 4));
  }
}

// To the right of the heading, which is -y.
BOOST_AUTO_TEST_CASE(in_a_turn_has_its_centripetal_part) {
  const CoursePlan plan{.latitude = 50, .heading = 20, .speed = 60, .turn_rate = 0.05};
  CoursePlan straight = plan;
  straight.turn_rate = {};
  const Vector3<double> part = CourseFrame<>(plan, 10)(0).origin_acceleration() -
                               CourseFrame<>(straight, 10)(0).origin_acceleration();
  BOOST_TEST(near(part, {0, -60 * 0.05, 0}, 3.0 + 0.05 * 465, 4));
  // Clockwise seen from above: the heading goes from north to east.
  const Vector3<double> ahead = Course({.latitude = 50, .turn_rate = 0.1}, 20)
                                    .at(10 * std::acos(-1.0) / 2)
                                    .level.X.value.rotation.col(2);
  BOOST_TEST(near(ahead, Compass(50, 0).east, 1.0, 8));
}

BOOST_AUTO_TEST_CASE(has_the_derivatives_of_its_pose) {
  CoursePlan plan = winding();
  check_rates(CourseFrame<>(plan, 1000), 300);
  plan.bank = Number(0.1, 0, {{0.3, 0.03, 1}});
  check_rates(CourseFrame<>(plan, 1000), 300);
  plan.bank = {};
  plan.is_coordinated = true;
  check_rates(CourseFrame<>(plan, 1000), 300);
  plan.gravity = 9.8;
  check_rates(CourseFrame<>(plan, 1000), 300);
  plan.latitude = 90;  // at 16 s it is 3 km from the pole
  check_rates(CourseFrame<>(plan, 1000), 16);
}

BOOST_AUTO_TEST_CASE(lowers_its_right_side_by_a_positive_bank) {
  const CourseFrame<> vehicle({.latitude = 50, .heading = 20, .speed = 60, .bank = 0.2}, 10);
  const CourseFrame<> level({.latitude = 50, .heading = 20, .speed = 60}, 10);
  const Matrix3<double> R = vehicle(3).X.value.rotation;
  const Matrix3<double> to = level(3).X.value.rotation;
  const Vector3<double> right = -R.col(1);
  BOOST_TEST(near(right.dot(to.col(0)), std::sin(0.2), 1.0, 4));
  BOOST_TEST(near(right.dot(to.col(1)), -std::cos(0.2), 1.0, 4));
  BOOST_TEST(near(Vector3<double>(R.col(2)), Vector3<double>(to.col(2)), 1.0, 4));
}

// Apparent gravity by GeographicLib's field, whose J2 has other digits.
BOOST_AUTO_TEST_CASE(without_lateral_gravity_if_coordinated) {
  CoursePlan plan = winding();
  plan.is_coordinated = true;
  const CourseFrame<> vehicle(plan, 1000);
  for (const double t : {0.0, 130.0, 700.0, 1000.0}) {
    const auto now = vehicle(t);
    const Vector3<double> g =
        now.X.value.rotation.transpose() * detail::gravitation(now.X.value.translation) -
        now.origin_acceleration();
    BOOST_TEST(std::abs(g.y()) <= 4e-13, g);
    BOOST_TEST(g.x() > 9);
  }
  // In a steady turn to the right tan(bank) = v w/g, here to the Coriolis acceleration.
  const Course turn({.speed = 100, .turn_rate = 0.05, .is_coordinated = true}, 10);
  BOOST_TEST(std::abs(std::tan(turn.at(5).bank) - 5 / 9.78) <= 2e-3);
}

// With gravity as a number the centrifugal acceleration is a part of it.
BOOST_AUTO_TEST_CASE(in_given_gravity_has_no_centrifugal_part) {
  CoursePlan plan = winding();
  plan.is_coordinated = true;
  plan.gravity = 9.8;
  const CourseFrame<> whole(plan, 1000);
  const CourseAxes<> axes(plan, 1000);
  CoursePlan unbanked = plan;
  unbanked.is_coordinated = false;
  const CourseFrame<> level(unbanked, 1000);
  for (const double t : {0.0, 400.0}) {
    const auto x = axes(t), y = whole(t);
    const Vector3<double> p = y.X.value.translation;
    const Vector3<double> centrifugal =
        y.X.value.rotation.transpose() *
        Vector3<double>(spin * spin * p.x(), spin * spin * p.y(), 0);
    BOOST_TEST(near(x.origin_acceleration(), Vector3<double>(y.origin_acceleration() + centrifugal),
                    10.0, 64));
    BOOST_TEST((x.V.value.moment.isZero(0) && x.X.value.translation.isZero(0)));
    BOOST_TEST(near(x.X.value.rotation, y.X.value.rotation, 1.0, 4));
    BOOST_TEST(near(x.V.value.resultant, y.V.value.resultant, 0.02, 8));
    BOOST_TEST(near(x.dV.value.resultant, y.dV.value.resultant, 0.02, 8));
    const Vector3<double> down = y.X.value.rotation.transpose() * level(t).X.value.rotation.col(0);
    BOOST_TEST(std::abs((9.8 * down - x.origin_acceleration()).y()) <= 1e-13);
  }
}

BOOST_AUTO_TEST_SUITE_END()
