#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/guide/translating.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

// Parts that a scene omits by its type change no number. Compared with the same scene on a guide
// and with loads of unknown type.

using namespace kreisel;
namespace data = boost::unit_test::data;

namespace {

template <class M>
auto any_guide(const M& guide) {
  return [guide](double t) { return guide(t); };
}

template <class L>
auto any_load(const L& load) {
  return [load](const LoadContext<>& s) { return load(s); };
}

/// The rates of angles and positions, and those of velocities, each relative to their greatest.
/// Accelerations are also relative to terms that may have cancelled, 10 m/s^2 of gravity.
template <class Vector>
double difference(const Vector& found, const Vector& expected) {
  const Eigen::Index velocities = expected.size() / 2;
  const Eigen::Index places = expected.size() - velocities;
  const auto off = [](const auto& a, const auto& b, double term) {
    return (a - b).cwiseAbs().template maxCoeff<Eigen::PropagateNaN>() /
           std::max(b.cwiseAbs().maxCoeff(), term);
  };
  return test::worst_of(off(found.head(places), expected.head(places), 0.0),
                        off(found.tail(velocities), expected.tail(velocities), 10.0));
}

constexpr double limit = 1e-14;

Eigen::Matrix<double, 7, 1> held_state(test::Sample& sample) {
  Eigen::Matrix<double, 7, 1> y;
  y << sample.direction(), 0.6, 3 * sample.direction();  // a quaternion of another norm than 1
  return y;
}

Eigen::Matrix<double, 13, 1> free_state(test::Sample& sample) {
  Eigen::Matrix<double, 13, 1> y;
  y << sample.direction(), 0.6, sample.direction(), 3 * sample.direction(), 2 * sample.direction();
  return y;
}

InertiaTensor<Body> lopsided(test::Sample& sample) {
  Matrix3<double> T = Vector3<double>(0.25, 0.27, 0.2).asDiagonal();
  const Vector3<double> a = 0.03 * sample.direction();
  T += 0.5 *
       (a * Vector3<double>(1, 0.5, -1).transpose() + Vector3<double>(1, 0.5, -1) * a.transpose());
  return InertiaTensor<Body>::about_centre(2, 0.2 * sample.direction(), T);
}

InertiaTensor<Body> principal(double arm) {
  return InertiaTensor<Body>::about_centre(
      2, {0, 0, arm}, Matrix3<double>(Vector3<double>(0.25, 0.27, 0.06).asDiagonal()));
}

/// On a guide and on one with hidden type, under loads of all kinds: fixed point and free.
template <class M>
void agrees_on(const M& guide, test::Sample& sample) {
  const double t = 3 * sample.direction().x();
  const Vector3<double> point = sample.direction();
  const UniformGravity<Guide> plumb{9.81 * sample.direction()};
  const UniformGravity<Inertial> gravitation{9.81 * sample.direction()};
  const ViscousDrag<> drag{0.02, 0.1};
  const Spring<> spring{{2, 1, 1}, {0.1, 0.2, 0}, 30, 0.5, 0.2};
  const auto hidden = any_guide(guide);
  const auto compare = [&](const auto& body, const auto&... loads) {
    const auto y = held_state(sample);
    const FixedPointBody pruned(body, point, guide, loads...);
    const FixedPointBody general(body, point, hidden, any_load(loads)...);
    BOOST_TEST(difference(pruned.rates(t, y), general.rates(t, y)) <= limit);
    const auto z = free_state(sample);
    const FreeBody free(body, guide, loads...);
    const FreeBody general_free(body, hidden, any_load(loads)...);
    BOOST_TEST(difference(free.rates(t, z), general_free.rates(t, z)) <= limit);
  };
  const auto any = lopsided(sample);
  compare(any);
  compare(any, plumb);
  compare(any, gravitation);
  compare(any, plumb, gravitation, drag);
  compare(any, gravitation, spring);
  compare(principal(0.3), plumb, Without<FirstMoment, Axis::x, Axis::y>{});
  compare(principal(0.3), gravitation, drag, Without<FirstMoment, Axis::x, Axis::y>{},
          Without<ProductsOfInertia>{});
  compare(principal(0), plumb, Without<FirstMoment>{}, Without<ProductsOfInertia>{});
  compare(principal(0), spring, Without<FirstMoment>{});
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pruning)

BOOST_DATA_TEST_CASE(changes_no_number_of_a_body, data::xrange(25u), seed) {
  test::Sample sample(seed);
  const Displacement<Inertial, Guide> X{exp(Motor<>{sample.direction(), sample.direction()})};
  agrees_on(RestingFrame<>{X}, sample);
  const Vector3<double> place = sample.direction();
  const Vector3<double> along = sample.direction();
  agrees_on(TranslatingFrame([&](double t) {
              return Translation<>{place + std::sin(t) * along, std::cos(t) * along,
                                   -std::sin(t) * along};
            }),
            sample);
  agrees_on(RotatingFrame<>{sample.direction(), sample.direction(), X, sample.direction()}, sample);
  agrees_on(SteadyFrame<>{X, {{sample.direction(), sample.direction()}}}, sample);
}

BOOST_DATA_TEST_CASE(changes_no_number_with_absent_components, data::xrange(25u), seed) {
  test::Sample sample(seed);
  const auto y = held_state(sample);
  const RotatingFrame<> earth{{-5e-5, 0, 5e-5}};
  const UniformGravity<Guide> down{{0, 0, -9.81}};
  const FixedPointBody pruned(
      principal(-0.4), {0, 0, 0}, earth, down, Without<GuideRate, Axis::y>{},
      Without<ApparentGravity, Axis::x, Axis::y>{}, Without<ProductsOfInertia>{},
      Without<FirstMoment, Axis::x, Axis::y>{});
  const FixedPointBody general(principal(-0.4), {0, 0, 0}, any_guide(earth), any_load(down));
  BOOST_TEST(difference(pruned.rates(0, y), general.rates(0, y)) <= limit);
}

BOOST_DATA_TEST_CASE(changes_no_number_of_a_top, data::xrange(25u), seed) {
  test::Sample sample(seed);
  const auto y = held_state(sample);
  const auto body = principal(0.3);
  const UniformGravity<Guide> down{{0, 0, -9.81}};
  const auto& [m, s, T] = body.value;
  const EulerTop top({T.xx, T.yy, T.zz}, 9.81 * s);
  const FixedPointBody general(body, {0, 0, 0}, any_guide(RestingFrame<>{}), any_load(down));
  BOOST_TEST(difference(top.rates(0, y), general.rates(0, y)) <= limit);
}

BOOST_DATA_TEST_CASE(changes_no_number_of_a_cardan_gyro, data::xrange(50u), seed) {
  test::Sample sample(seed);
  Eigen::Matrix<double, 6, 1> y;
  y << sample.direction(), 3 * sample.direction().head<2>(), 200;
  const Vector3<double> rotor = seed % 2 == 0 ? Vector3<double>(5, 5, 8) : Vector3<double>(5, 6, 8);
  const CardanMoments moments{rotor, {2, 3, 2.5}, {4, 4, 4.5}};
  const double reference = seed % 3 == 0 ? 0.3 : 0;
  const CardanBearings bearings{{0.5, 0.1, reference}, {1, 2, 0}};
  const auto compare = [&](const auto& guide, const auto& rotor_kind, const auto& general_rotor) {
    const CardanGyro pruned(moments, bearings, guide, rotor_kind);
    const CardanGyro general(moments, bearings, any_guide(guide), general_rotor);
    BOOST_TEST(difference(pruned.rates(0.7, y), general.rates(0.7, y)) <= limit);
  };
  const RotatingFrame<> table{sample.direction(), sample.direction()};
  const SteadyFrame<> steady{{exp(Motor<>{sample.direction(), {}})},
                             {{sample.direction(), sample.direction()}}};
  for (const auto& guide : {table}) {
    compare(guide, FrictionlessRotor{}, FreeRotor{});
    compare(guide, RegulatedRotor{}, RegulatedRotor{});
    compare(guide, DrivenRotor{3.0, 0.1}, DrivenRotor{3.0, 0.1});
  }
  compare(steady, FreeRotor{0.2}, FreeRotor{0.2});
  compare(RestingFrame<>{}, FrictionlessRotor{}, FreeRotor{});
  compare(RestingFrame<>{}, RegulatedRotor{}, RegulatedRotor{});
  const TranslatingFrame lift([](double t) { return Translation<>{{t, 0, 0}, {1, 0, 0}, {}}; });
  compare(lift, FrictionlessRotor{}, FreeRotor{});
  compare(lift, RegulatedRotor{}, RegulatedRotor{});
  // Without springs and friction; a reference angle makes the general gyro test for them
  // nevertheless.
  const CardanGyro loose(moments, {}, table);
  const CardanGyro general(moments, {{}, {0, 0, 1e-300}}, any_guide(table));
  BOOST_TEST(difference(loose.rates(0.7, y), general.rates(0.7, y)) <= limit);
}

BOOST_DATA_TEST_CASE(changes_no_number_of_a_plane_pendulum, data::xrange(25u), seed) {
  test::Sample sample(seed);
  const PendulumState<> y(3 * sample.direction().x(), 1);
  const auto rod = PendulumBody<>::from_reduced_length(0.5);
  PendulumGuide<> guide{sample.direction(), sample.direction(), 9.81 * sample.direction(), {}};
  const auto hidden = [&guide](double) { return guide; };
  const PendulumField general(rod, hidden);
  const Without<ProductsOfInertia> principal_axes;
  const PendulumField steady(rod, guide);
  const PendulumField stated(rod, guide, NoDamping{}, principal_axes);
  const PendulumField moving(rod, hidden, NoDamping{}, principal_axes);
  BOOST_TEST(difference(steady(0, y), general(0, y)) <= limit);
  BOOST_TEST(difference(stated(0, y), general(0, y)) <= limit);
  BOOST_TEST(difference(moving(0, y), general(0, y)) <= limit);
  guide = {{0, 0, 0}, {0, 0, 0}, {9.81, 0, 0}, {}};
  const PendulumField upright(rod, RestingPendulumGuide<>{9.81});
  BOOST_TEST(difference(upright(0, y), general(0, y)) <= limit);
}

// Quantities that are declared absent are compared with the numbers.
BOOST_AUTO_TEST_CASE(refuses_to_drop_terms_that_are_not_zero) {
  const RotatingFrame<> table{{0.1, 0.2, 0.3}};
  const UniformGravity<Guide> slanting{{1, 0, -9.81}};
  const auto held = [&](const InertiaTensor<Body>& T, const auto&... parts) {
    return FixedPointBody(T, {0, 0, 0}, table, slanting, parts...);
  };
  test::Sample sample(1);
  const auto any = lopsided(sample);
  BOOST_CHECK_THROW(held(any, Without<FirstMoment, Axis::x>{}), InvalidInput);
  BOOST_CHECK_THROW(held(any, Without<ProductsOfInertia>{}), InvalidInput);
  BOOST_CHECK_THROW(held(any, Without<GuideRate, Axis::y>{}), InvalidInput);
  BOOST_CHECK_THROW(held(any, Without<ApparentGravity, Axis::x>{}), InvalidInput);
  BOOST_CHECK_NO_THROW(held(any, Without<ApparentGravity, Axis::y>{}));
  BOOST_CHECK_THROW(FreeBody(any, table, Without<FirstMoment>{}), InvalidInput);
  BOOST_CHECK_THROW(FreeBody(any, table, Without<ProductsOfInertia>{}), InvalidInput);
  PendulumBody<> crooked = PendulumBody<>::thin_rod(1);
  crooked.theta_a = 0.1;
  crooked.phi_c = 0.01;
  const PendulumGuide<> guide{{}, {}, {9.81, 0, 0}, {}};
  BOOST_CHECK_THROW(PendulumField(crooked, guide, NoDamping{}, Without<ProductsOfInertia>{}),
                    InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
