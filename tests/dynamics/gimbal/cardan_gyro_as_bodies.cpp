// A Cardan gyro as three bodies in three joints: two independent ways to the same numbers.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/integrator.hpp>

#include <support/gyro_as_bodies.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Sample;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

PendulousBodies bodies_of(const CardanMoments& moments) {
  const auto body = [](const Vector3<double>& m) {
    return Inertia<>{2, Vector3<double>::Zero(), {m.x(), m.y(), m.z()}};
  };
  return {body(moments.rotor), body(moments.inner_ring), body(moments.outer_ring)};
}

/// The gyro's angles are 0 with slack springs, the bodies' at the joints' zero.
Vector6 counted_from_zero(const CardanBearings& b, Vector6 y) {
  y[0] += b.outer.reference;
  y[1] += b.inner.reference;
  return y;
}

Vector3<double> rotated(int axis, double angle, const Vector3<double>& v) {
  return Eigen::AngleAxisd(angle, Vector3<double>::Unit(axis)) * v;
}

struct Worst {
  double accelerations = 0;
  double reactions = 0;
};

/// Accelerations, the nine moments and the motor's, each relative to the greatest of its kind.
template <class M, class Rotor>
void compare(const CardanMoments& m, const CardanBearings& b, const M& guide, const Rotor& rotor,
             double t, const Vector6& y, Worst& worst) {
  const CardanGyro gyro(m, b, guide, rotor);
  const BodySystem<M> bodies = test::as_bodies(bodies_of(m), b, guide, rotor);
  BodyWorkspace w = bodies.workspace();
  const Eigen::VectorXd z = counted_from_zero(b, y);
  const Vector3<double> dv = gyro.rates(t, y).template tail<3>();
  const Vector3<double> dv_bodies = bodies.rates(t, z).template tail<3>();
  worst.accelerations = test::worst_of(
      worst.accelerations,
      (dv - dv_bodies).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / dv.cwiseAbs().maxCoeff());

  // In a system of bodies the reaction is that of the outer body of two, on the axes of the inner
  // one.
  const CardanReactions mine = gyro.reactions(t, gyro.from_vector(y));
  JointReactions theirs;
  bodies.reactions(t, z, theirs, w);
  const auto moment = [&](std::size_t i) { return theirs.on_body[i].value.moment; };
  const std::array<Vector3<double>, 4> off{
      mine.guide_on_outer_ring - moment(0),
      mine.inner_ring_on_outer_ring + rotated(1, z[1], moment(1)),
      mine.rotor_on_inner_ring + rotated(2, z[2], moment(2)),
      {std::is_same_v<Rotor, RegulatedRotor> ? mine.motor_torque - theirs.drive[2] : 0, 0, 0}};
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) size = std::max(size, moment(i).cwiseAbs().maxCoeff());
  for (const Vector3<double>& v : off) {
    worst.reactions =
        test::worst_of(worst.reactions, v.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / size);
  }
}

CardanMoments moments_at_random(Sample& sample) {
  const auto body = [&sample] {  // a box, so that the triangle inequality holds
    const Vector3<double> s(sample.magnitude(-3, -1), sample.magnitude(-3, -1),
                            sample.magnitude(-3, -1));
    return Vector3<double>(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
  };
  CardanMoments m{body(), body(), body()};
  if (sample.once_in(4)) m.rotor = m.rotor.x() * Vector3<double>(1, 1, 1.5);
  if (sample.once_in(6)) m.inner_ring.setZero();
  return m;
}

HarmonicFrame<> ship(Sample& sample) {
  const auto series = [&sample](double size) {
    HarmonicSeries<> s{size * sample.direction(), {}};
    for (int i = 0; i < 2; ++i) {
      s.terms.push_back({size * sample.direction(), sample.uniform(0.2, 3), sample.uniform(-3, 3)});
    }
    return s;
  };
  return {series(0.7), series(3), 0, 2};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_cardan_gyro_and_three_bodies)

BOOST_AUTO_TEST_CASE(have_the_same_accelerations_and_reactions) {
  Worst worst;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Sample sample(seed);
    const CardanMoments m = moments_at_random(sample);
    const CardanBearings b{{sample.magnitude(-2, 1), 0.01, sample.uniform(-1, 1)},
                           {sample.magnitude(-2, 1), 0.02, sample.uniform(-1, 1)}};
    Vector6 y;
    y << sample.uniform(-4, 4), sample.uniform(-4, 4), sample.uniform(-10, 10),
        sample.uniform(-5, 5), sample.uniform(-5, 5), sample.uniform(-100, 100);
    const double drive = sample.number(-2, 0);
    const double t = sample.uniform(0, 2);
    const auto on = [&](const auto& guide) {
      compare(m, b, guide, FreeRotor{0.001}, t, y, worst);
      compare(m, b, guide, DrivenRotor{drive, 0.001}, t, y, worst);
      compare(m, b, guide, RegulatedRotor{0.001}, t, y, worst);
    };
    on(RestingFrame<>{});
    on(RotatingFrame<>{.angular_velocity = sample.vector(-1, 1),
                       .origin_acceleration = sample.vector(-1, 1),
                       .origin_velocity = sample.vector(-1, 1)});
    on(ship(sample));
  }
  BOOST_TEST_MESSAGE("accelerations " << worst.accelerations << ", reactions " << worst.reactions);
  BOOST_TEST(worst.accelerations < 1e-12);
  BOOST_TEST(worst.reactions < 1e-12);
}

BOOST_AUTO_TEST_CASE(move_together) {
  Sample sample(7);
  const HarmonicFrame<> guide = ship(sample);
  const CardanMoments m{{.0055, .0045, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
  const CardanBearings b{{2, 0.002, 0.25}, {1.5, 0.003, -0.5}};
  const CardanGyro gyro(m, b, guide, DrivenRotor{0.005, 0.0001});
  const auto bodies = test::as_bodies(bodies_of(m), b, guide, DrivenRotor{0.005, 0.0001});
  const Vector6 start = (Vector6() << 0.1, -0.2, 0.3, 0.5, -0.4, 60).finished();
  Integrator run(gyro, 0, gyro.from_vector(start));
  Integrator bodies_run(bodies, 0, bodies.from_vector(counted_from_zero(b, start)));
  double worst = 0;
  for (int i = 1; i <= 8; ++i) {
    const Vector6 y = counted_from_zero(b, gyro.to_vector(run.to(0.25 * i)));
    const Vector6 z = bodies.to_vector(bodies_run.to(0.25 * i));
    for (int k = 0; k < 6; ++k) {
      worst = test::worst_of(worst, std::abs(y[k] - z[k]) / std::max(std::abs(y[k]), 1.0));
    }
  }
  BOOST_TEST_MESSAGE("trajectories differ by " << worst);
  BOOST_TEST(worst < 1e-11);
}

BOOST_AUTO_TEST_SUITE_END()
