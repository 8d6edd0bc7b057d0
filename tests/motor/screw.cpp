#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <limits>
#include <string>

#include <motor/error.hpp>
#include <motor/screw.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;
using test::same;
namespace data = boost::unit_test::data;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double denormal = std::numeric_limits<double>::denorm_min();

/// The sizes of both halves: the reference for the error of a screw's motor.
Motor<> halves(const Motor<>& a) {
  return {Vector3<double>::Constant(a.resultant.stableNorm()),
          Vector3<double>::Constant(a.moment.stableNorm())};
}

test::Verdict near_halves(const Motor<>& x, const Motor<>& y, double k) {
  const Motor<> scale = halves(y);
  const test::Verdict resultant = near(x.resultant, y.resultant, scale.resultant[0], k);
  return resultant ? near(x.moment, y.moment, scale.moment[0], k) : resultant;
}

bool says_axis(const InvalidInput& error) {
  return error.what() == std::string("axis_point: a motor without resultant has no axis");
}

bool says_pitch(const InvalidInput& error) {
  return error.what() == std::string("pitch: the zero motor has no pitch");
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_screw)

// Anchor: 3 rad/s about the line along z through (1, 2, 0), with a slide of 2 m per radian. The
//         origin moves with 6 along z and point cross (0, 0, 3) = (6, -3, 0).
BOOST_AUTO_TEST_CASE(by_hand) {
  const Motor<> a{{0, 0, 3}, {6, -3, 6}};
  BOOST_TEST(same(opening(a), Vector3<double>(0, 0, 3)));
  BOOST_TEST(same(length(a), Vector3<double>(0, 0, 6)));
  BOOST_TEST(same(axis_point(a), Vector3<double>(1, 2, 0)));
  BOOST_TEST(pitch(a) == 2.0);

  const Screw<> s = screw(a);
  BOOST_TEST((s.kind == ScrewKind::general));
  BOOST_TEST(same(s.direction, Vector3<double>(0, 0, 1)));
  BOOST_TEST(same(s.point, Vector3<double>(1, 2, 0)));
  BOOST_TEST(s.intensity == 3.0);
  BOOST_TEST(s.pitch == 2.0);
  BOOST_TEST(same(motor(s), a));
}

BOOST_AUTO_TEST_CASE(left_handed_screw_has_negative_pitch) {
  BOOST_TEST(pitch(Motor<>{{0, 0, -3}, {0, 0, 6}}) == -2.0);
  BOOST_TEST(same(screw(Motor<>{{0, 0, -3}, {0, 0, 6}}).direction, Vector3<double>(0, 0, -1)));
}

BOOST_AUTO_TEST_CASE(is_a_line_without_pitch) {
  const Motor<> force{{0, 2, 0}, {0, 0, 6}};  // 2 N along y through (3, 0, 0)
  const Screw<> s = screw(force);
  BOOST_TEST((s.kind == ScrewKind::line));
  BOOST_TEST(s.pitch == 0.0);
  BOOST_TEST(same(s.point, Vector3<double>(3, 0, 0)));
  BOOST_TEST(same(motor(s), force));
}

BOOST_AUTO_TEST_CASE(couple_has_infinite_pitch_and_no_axis) {
  const Motor<> couple{{0, 0, 0}, {0, -5, 0}};
  const Screw<> s = screw(couple);
  BOOST_TEST((s.kind == ScrewKind::couple));
  BOOST_TEST(same(s.direction, Vector3<double>(0, -1, 0)));
  BOOST_TEST(same(s.point, Vector3<double>(0, 0, 0)));
  BOOST_TEST(s.intensity == 5.0);
  BOOST_TEST(s.pitch == infinity);
  BOOST_TEST(same(motor(s), couple));
  BOOST_TEST(pitch(couple) == infinity);
  BOOST_TEST(same(length(couple), couple.moment));
  BOOST_CHECK_EXCEPTION((void)axis_point(couple), InvalidInput, says_axis);
}

BOOST_AUTO_TEST_CASE(zero_motor_has_no_screw) {
  const Screw<> s = screw(Motor<>{});
  BOOST_TEST((s.kind == ScrewKind::zero));
  BOOST_TEST(same(s.direction, Vector3<double>(0, 0, 0)));
  BOOST_TEST(s.intensity == 0.0);
  BOOST_TEST(s.pitch == 0.0);
  BOOST_TEST(same(motor(s), Motor<>{}));
  BOOST_TEST(same(length(Motor<>{}), Vector3<double>(0, 0, 0)));
  BOOST_CHECK_EXCEPTION((void)pitch(Motor<>{}), InvalidInput, says_pitch);
  BOOST_CHECK_EXCEPTION((void)axis_point(Motor<>{}), InvalidInput, says_axis);
}

BOOST_DATA_TEST_CASE(restores_its_motor, data::xrange(400u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  BOOST_TEST(near_halves(motor(screw(a)), a, 8));
}

BOOST_DATA_TEST_CASE(agrees_with_its_parts, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  if (a.resultant == Vector3<double>::Zero()) return;
  const Screw<> s = screw(a);
  BOOST_TEST(s.pitch == pitch(a));
  BOOST_TEST(same(s.point, axis_point(a)));
  BOOST_TEST(near(s.direction.norm(), 1.0, 1.0, 4));
  BOOST_TEST(near(s.intensity, opening(a).norm(), opening(a).norm(), 6));
}

// (11): v_0 = v_n + r_0 x u. On the axis the moment equals the length.
BOOST_DATA_TEST_CASE(has_its_length_on_its_axis, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  if (a.resultant == Vector3<double>::Zero()) return;
  const Vector3<double> r_0 = axis_point(a);
  const double size = a.moment.norm();
  BOOST_TEST(near(Vector3<double>(length(a) + r_0.cross(opening(a))), a.moment, size, 12));
  BOOST_TEST(near(a.reduced_at(r_0).moment, length(a), size, 12));
  BOOST_TEST(near(Vector3<double>(pitch(a) * opening(a)), length(a), size, 12));
  BOOST_TEST(near(r_0.dot(opening(a)), 0.0, size, 12));
}

BOOST_DATA_TEST_CASE(has_the_same_length_in_every_frame, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const Motor<> a = sample.motor();
  if (a.resultant == Vector3<double>::Zero()) return;
  const Vector3<double> p = sample.vector();
  const Motor<> b = a.reduced_at(p);
  const double size = a.moment.norm() + a.resultant.norm() * p.norm();
  BOOST_TEST(near(length(b), length(a), size, 16));
  BOOST_TEST(near(pitch(b), pitch(a), size / a.resultant.norm(), 16));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(sizes_near_the_ends_of_double)

// Squares of these vanish or overflow.
const double sizes[] = {1e-300, 1e-170, 1e-100, 1, 1e100, 1e160, 1e300};

BOOST_DATA_TEST_CASE(restore_their_motor, data::make(sizes), size) {
  const Motor<> unit{{3, -4, 12}, {0.5, 7, -2}};
  const Motor<> a = size * unit;
  BOOST_TEST(near_halves(motor(screw(a)), a, 8));
  BOOST_TEST(near(pitch(a), pitch(unit), 1.0, 12));
  BOOST_TEST(near(axis_point(a), axis_point(unit), 1.0, 12));
  BOOST_TEST(near(length(a), Vector3<double>(size * length(unit)), size, 64));
}

BOOST_DATA_TEST_CASE(restore_a_couple, data::make(sizes), size) {
  const Motor<> couple{{0, 0, 0}, {3 * size, -4 * size, 12 * size}};
  BOOST_TEST(near(screw(couple).intensity, 13 * size, size, 40));
  BOOST_TEST(near_halves(motor(screw(couple)), couple, 8));
}

BOOST_AUTO_TEST_CASE(restore_halves_of_very_different_size) {
  for (const double small : {1e-170, 1e-140}) {
    const Motor<> slow{small * Vector3<double>(1, 2, -2), Vector3<double>(5, 3, 1)};
    BOOST_TEST(near_halves(motor(screw(slow)), slow, 8));
    const Motor<> fast{Vector3<double>(1, 2, -2) / small, Vector3<double>(5, 3, 1)};
    BOOST_TEST(near_halves(motor(screw(fast)), fast, 8));
  }
}

// The numbers have lost their digits, but the direction has all of its own.
BOOST_AUTO_TEST_CASE(keep_the_direction_of_subnormal_numbers) {
  const Motor<> a{denormal * Vector3<double>(1, 1, 1), {0, 0, 0}};
  const Screw<> s = screw(a);
  BOOST_TEST((s.kind == ScrewKind::line));
  BOOST_TEST(near(s.direction.norm(), 1.0, 1.0, 4));
  BOOST_TEST(std::abs(s.intensity - 2 * denormal) <= denormal);
  const Vector3<double> back = motor(s).resultant;
  BOOST_TEST((back - a.resultant).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <= denormal);

  const Screw<> couple = screw(Motor<>{{0, 0, 0}, denormal * Vector3<double>(1, 1, 1)});
  BOOST_TEST((couple.kind == ScrewKind::couple));
  BOOST_TEST(near(couple.direction.norm(), 1.0, 1.0, 4));
}

BOOST_AUTO_TEST_SUITE_END()
