// Gyros in two rings with centres of mass off the axes. The second way to the exact equations are
// three bodies in joints.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/gyro_small_oscillations.hpp>
#include <dynamics/gimbal/pendulous_oscillations.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/study/floquet.hpp>

#include <support/gyro_as_bodies.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Sample;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix4 = Eigen::Matrix4d;

Inertia<> body(Sample& sample) {
  const Vector3<double> s(sample.uniform(.1, 1), sample.uniform(.1, 1), sample.uniform(.1, 1));
  const Matrix3<double> R = Pose<>::from(Eigen::Quaterniond(sample.rotation())).rotation;
  const Vector3<double> moments(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
  return InertiaTensor<Body>::about_centre(sample.uniform(0.5, 2), 0.3 * sample.direction(),
                                           R * moments.asDiagonal() * R.transpose())
      .value;
}

PendulousBodies bodies_at_random(Sample& sample) {
  return {body(sample), body(sample), body(sample), sample.direction()};
}

HarmonicFrame<> ship(Sample& sample) {
  const auto series = [&sample](double size) {
    HarmonicSeries<> s{size * sample.direction(), {}};
    s.terms.push_back({size * sample.direction(), sample.uniform(0.2, 3), sample.uniform(-3, 3)});
    return s;
  };
  return {series(0.7), series(3), 0, 2};
}

template <class M, class Rotor, class Field>
double difference(Sample& sample, const PendulousBodies& b, const M& guide, const Rotor& rotor,
                  const Field& field) {
  const CardanBearings bearings{{2, 0.01, 0.3}, {1, 0.02, -0.2}};
  const PendulousGyro gyro(b, bearings, guide, rotor, field);
  const auto bodies = test::as_bodies(b, bearings, guide, rotor, field);
  Vector6 y;
  for (double& number : y) number = sample.uniform(-3, 3);
  Eigen::VectorXd z = y;
  z[0] += bearings.outer.reference;
  z[1] += bearings.inner.reference;
  const double t = sample.uniform(0, 2);
  const Vector3<double> mine = gyro.rates(t, y).template tail<3>();
  const Vector3<double> theirs = bodies.rates(t, z).template tail<3>();
  return (mine - theirs).norm() / theirs.norm();
}

const Inertia<> none{};

/// Principal moments, and a first moment along z.
Inertia<> centred(const Vector3<double>& moments, double pendulosity = 0) {
  return {1, {0, 0, pendulosity}, {moments.x(), moments.y(), moments.z()}};
}

const Vector3<double> unsymmetric(.0055, .0045, .008);
const Vector3<double> inner(.002, .0015, .0028);
const Vector3<double> outer(.006, .0045, .005);
const CardanBearings springs{{2, 0.01}, {1.5, 0.02}};

template <class A, class B>
double off(const A& a, const B& b) {
  return test::worst_of((a.mass - b.mass).norm() / b.mass.norm(),
                        (a.damping - b.damping).norm() / b.damping.norm(),
                        (a.stiffness - b.stiffness).norm() / b.stiffness.norm());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(pendulous_gyros)

BOOST_AUTO_TEST_CASE(have_the_accelerations_of_three_bodies) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    Sample sample(seed);
    const PendulousBodies b = bodies_at_random(sample);
    const UniformGravity<Guide> on_guide{5 * sample.direction()};
    const UniformGravity<Inertial> inertial{5 * sample.direction()};
    const auto on = [&](const auto& guide) {
      worst = test::worst_of(worst, difference(sample, b, guide, FreeRotor{0.001}, on_guide),
                             difference(sample, b, guide, DrivenRotor{0.7, 0.001}, inertial),
                             difference(sample, b, guide, RegulatedRotor{}, inertial));
    };
    on(RestingFrame<>{});
    on(RotatingFrame<>{.angular_velocity = sample.direction(),
                       .origin_acceleration = 3 * sample.direction()});
    on(ship(sample));
  }
  BOOST_TEST_MESSAGE("accelerations differ by " << worst);
  BOOST_TEST(worst < 1e-12);
}

// Half the amplitude has a quarter of the field's error, and without amplitude nothing is left.
BOOST_AUTO_TEST_CASE(oscillations_have_second_order) {
  double least = 10;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Sample sample(seed);
    const double speed = sample.uniform(-8, 8);
    const PendulousOscillations gyro(bodies_at_random(sample), {{3}, {2}}, speed, ship(sample),
                                     UniformGravity<Inertial>{5 * sample.direction()});
    const double t = sample.uniform(0, 2);
    const Eigen::Vector4d direction(sample.uniform(-1, 1), sample.uniform(-1, 1),
                                    sample.uniform(-1, 1), sample.uniform(-1, 1));
    const auto error = [&](double eps) {
      const Eigen::Vector4d y = eps * direction;
      Vector6 z;
      z << y[0], y[1], speed * t, y[2], y[3], speed;
      const Vector6 exact = gyro.exact().rates(t, z);
      return (gyro.rates(t, y).tail<2>() - exact.segment<2>(3)).norm() / exact.segment<2>(3).norm();
    };
    BOOST_TEST(error(0) < 1e-13);
    const double order = std::log2(error(2e-4) / error(1e-4));
    BOOST_TEST(std::abs(order - 2) < 0.05, "seed " << seed << ": order " << order);
    least = std::min(least, order);
  }
  BOOST_TEST_MESSAGE("least order " << least);
}

// The laws of the paper are special cases, whose coefficients were derived by hand.
BOOST_AUTO_TEST_CASE(contain_the_equations_of_the_paper) {
  const double speed = 50;
  const double t = 0.137;
  const PendulousBodies with_rings{centred(unsymmetric), centred(inner), centred(outer)};
  const PendulousOscillations all(with_rings, springs, speed, RestingFrame<>{});
  const UnsymmetricRotor weigand({unsymmetric, inner, outer}, springs, speed);
  BOOST_TEST(off(all.coefficients(t), weigand.coefficients(t)) < 1e-14);

  const Vector3<double> round(.005, .005, .008);
  const PendulousOscillations fast({centred(round), centred(inner), centred(outer)}, springs, speed,
                                   RestingFrame<>{});
  const FoepplGyro<> foeppl({round, inner, outer}, springs, speed);
  BOOST_TEST(off(fast.coefficients(t), foeppl.coefficients()) < 1e-14);

  Sample sample(5);
  const auto guide = ship(sample);
  const PendulousOscillations turned({centred(unsymmetric), none, none}, springs, speed, guide);
  const GyroSmallOscillations law(unsymmetric, springs, speed, guide);
  BOOST_TEST(off(turned.coefficients(t), law.coefficients(t)) < 1e-12);
  const Eigen::Vector2d force = law.coefficients(t).force;
  BOOST_TEST((turned.coefficients(t).force - force).norm() < 1e-12 * force.norm());
}

// (48) with its missing term: the acceleration a of a vehicle is the torque m s a on a pendulous
// gyro.
BOOST_AUTO_TEST_CASE(acceleration_is_a_torque_as_weight_is) {
  const double m_s = -0.02;
  const PendulousBodies low{centred({.005, .005, .008}, m_s), none, none};
  const RotatingFrame<> vehicle{.angular_velocity = {0, 0, 0},
                                .origin_acceleration = {1.5, -0.5, 0}};
  const PendulousOscillations gyro(low, {}, 50, vehicle, UniformGravity<Guide>{{0, 0, -9.81}});
  const auto c = gyro.coefficients(0);
  // s x (g - a), s = (0, 0, m_s).
  BOOST_TEST(std::abs(c.force[0] - m_s * -0.5) < 1e-15);
  BOOST_TEST(std::abs(c.force[1] + m_s * 1.5) < 1e-15);
  BOOST_TEST(std::abs(c.stiffness(0, 0) + m_s * 9.81) < 1e-15);
  BOOST_TEST(std::abs(c.stiffness(1, 1) + m_s * 9.81) < 1e-15);
}

// Fuchs' heavy rotor: c = -m g s. The closed conditions against multipliers over half a turn.
BOOST_AUTO_TEST_CASE(heavy_rotor_has_the_closed_boundary) {
  int unstable = 0;
  int judged = 0;
  for (const double pendulosity : {0.05, -0.05}) {
    for (const Vector3<double>& rotor :
         {Vector3<double>(1.1, .9, 1.5), Vector3<double>(1.1, .9, 1.0),
          Vector3<double>(1.1, .9, .5)}) {
      const double c = -9.81 * pendulosity;
      for (int i = 1; i <= 24; ++i) {
        const double speed = 0.3 + 0.1 * i;
        struct HalfTurn : PendulousOscillations<RestingFrame<>, UniformGravity<Guide>> {
          using PendulousOscillations::PendulousOscillations;
          [[nodiscard]] double period() const { return PendulousOscillations::period() / 2; }
        };
        const HalfTurn gyro({centred(rotor, pendulosity), none, none}, {}, speed, RestingFrame<>{},
                            UniformGravity<Guide>{{0, 0, -9.81}});
        const bool told = is_stable_in_equal_springs(rotor, c, speed);
        const double growth = paired_multipliers(gyro, {.relative = 1e-12}).growth();
        ++judged;
        if (!told) ++unstable;
        BOOST_TEST((growth < 1 + 1e-6) == told,
                   "c " << c << ", C " << rotor.z() << ", speed " << speed << ": " << growth);
      }
    }
  }
  BOOST_TEST_MESSAGE(unstable << " of " << judged << " are unstable");
  BOOST_TEST(unstable > 20);
  BOOST_TEST(judged - unstable > 20);
}

BOOST_AUTO_TEST_CASE(refuse_impossible_bodies) {
  const Inertia<> good = centred({.005, .005, .008});
  const auto with = [&](const Inertia<>& rotor, const CardanBearings& b) {
    return PendulousGyro({rotor, none, none}, b, RestingFrame<>{});
  };
  BOOST_CHECK_NO_THROW(with(good, {}));
  BOOST_CHECK_THROW(with(centred({1, 1, 3}), {}), InvalidInput);
  BOOST_CHECK_THROW(with(centred({1, 1, 0}), {}), InvalidInput);
  BOOST_CHECK_THROW(with(good, {{-1}, {}}), InvalidInput);
  BOOST_CHECK_THROW((void)is_stable_in_equal_springs({1, 0, 1}, 1, 1), InvalidInput);
  Vector6 y = Vector6::Zero();
  y[1] = std::acos(-1.0) / 2;
  BOOST_CHECK_THROW((void)with(good, {}).rates(0, y), ComputationFailed);  // gimbal lock
}

BOOST_AUTO_TEST_SUITE_END()
