#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <vector>

#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/pendulum/pendulum_cases.hpp>

using namespace kreisel;
using namespace kreisel::test::pendulum;
using test::Sample;
namespace data = boost::unit_test::data;

namespace {

Exact total(const PendulumCoefficients<Exact>& c) {
  return abs(c.e()) + abs(c.f) + abs(c.h) + abs(c.k);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(derivation)

// (23) against Newton's law for every point mass, in the inertial frame written on guide axes:
//   sum m [r, g + G r - (dv + [u v] + [du r] + [u [u r]] + 2 [u r'] + r'')]_z = 0.
BOOST_DATA_TEST_CASE(field_agrees_with_newtons_law, data::xrange(100u), seed) {
  Sample sample(seed);
  const std::vector<PointMass> points = random_points(sample);
  const Vector3<Exact> rotation = vector(sample, 5);
  const Vector3<Exact> rotation_rate = vector(sample, 3);
  const Vector3<Exact> velocity = vector(sample, 10);
  const Vector3<Exact> velocity_rate = vector(sample, 5);
  const Vector3<Exact> gravity = vector(sample, 10);
  Matrix3<Exact> gradient = Matrix3<Exact>::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) gradient(i, j) = gradient(j, i) = sample.uniform(-20, 20);
  }
  const Exact phi = sample.uniform(-3, 3);
  const Exact rate = sample.uniform(-4, 4);
  const Exact friction = sample.uniform(-1, 1);

  Exact without = 0;  // the moment without r''; r'' = phi.. e_z x r - phi.^2 r
  Exact inertia = 0;
  for (const auto& [m, p] : points) {
    const Exact s = sin(phi);
    const Exact c = cos(phi);
    const Vector3<Exact> r(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    const Vector3<Exact> across(-r.y(), r.x(), 0);
    const Vector3<Exact> r_dot = rate * across;
    const Vector3<Exact> inward = -rate * rate * Vector3<Exact>(r.x(), r.y(), 0);
    const Vector3<Exact> acceleration = velocity_rate + rotation.cross(velocity) +
                                        rotation_rate.cross(r) +
                                        rotation.cross(Vector3<Exact>(rotation.cross(r))) +
                                        Exact(2) * rotation.cross(r_dot) + inward;
    const Vector3<Exact> pull = gravity + gradient * r;
    without += m * r.cross(Vector3<Exact>(pull - acceleration)).z();
    inertia += m * r.cross(across).z();
  }
  const Exact expected = (without - friction * rate) / inertia;

  const auto motion = [&](const Exact&) {
    return PendulumGuide<Exact>{
        rotation, rotation_rate,
        effective_gravity<Exact>(gravity, rotation, velocity, velocity_rate), gradient};
  };
  const auto damping = [&](const Exact& w) { return Exact(friction * w); };
  const PendulumField<Exact, decltype(motion), decltype(damping)> field(body_of(points), motion,
                                                                        damping);
  const PendulumState<Exact> result = field(Exact(0), PendulumState<Exact>(phi, rate));
  BOOST_TEST(result[0] == rate);
  BOOST_TEST(abs(Exact(result[1] - expected)) <= Exact("1e-46") * (abs(without) / inertia + 300));
}

// E, F, H, K as the paper prints them, without g', weight or gradients.
BOOST_DATA_TEST_CASE(coefficients_are_those_below_23, data::xrange(50u), seed) {
  Sample sample(seed);
  const PendulumBody<Exact> b = body_of(random_points(sample));
  const Vector3<Exact> w = vector(sample, 5);
  const Vector3<Exact> dw = vector(sample, 3);
  const Vector3<Exact> v = vector(sample, 10);
  const Vector3<Exact> dv = vector(sample, 5);
  const Vector3<Exact> g = vector(sample, 10);
  const PendulumGuide<Exact> guide{w, dw, effective_gravity<Exact>(g, w, v, dv), {}};
  const PendulumCoefficients<Exact> c = coefficients(b, guide);
  const Exact ma = b.mass * b.arm;
  const Exact e = -ma * (dv.x() - w.z() * v.y() + w.y() * v.z()) -
                  b.phi_a * (w.z() * w.y() - dw.x()) - b.phi_b * (w.z() * w.x() + dw.y()) +
                  ma * g.x();
  const Exact f = ma * (dv.y() + w.z() * v.x() - w.x() * v.z()) -
                  b.phi_a * (w.z() * w.x() + dw.y()) + b.phi_b * (w.z() * w.y() - dw.x()) -
                  ma * g.y();
  const Exact h =
      b.phi_c * (w.y() * w.y() - w.x() * w.x()) + (b.theta_b - b.theta_a) * w.x() * w.y();
  const Exact k =
      -2 * b.phi_c * w.x() * w.y() + (b.theta_a - b.theta_b) * (w.x() * w.x() - w.y() * w.y()) / 2;
  const Exact tiny = Exact("1e-46") * (total(c) + ma * 100);
  BOOST_TEST(abs(Exact(c.e() - e)) <= tiny);
  BOOST_TEST(abs(Exact(c.f - f)) <= tiny);
  BOOST_TEST(abs(Exact(c.h - h)) <= tiny);
  BOOST_TEST(abs(Exact(c.k - k)) <= tiny);
  BOOST_TEST(c.weight == ma * guide.effective_gravity.norm());
}

// A guide that turns with u acts like a guide at rest in the gradient u^2 - u u^t.
BOOST_DATA_TEST_CASE(centrifugal_terms_equal_those_of_a_gradient, data::xrange(20u), seed) {
  Sample sample(seed);
  const PendulumBody<Exact> body = body_of(random_points(sample));
  const Vector3<Exact> w = vector(sample, 5);
  const Vector3<Exact> g = vector(sample, 10);
  const Matrix3<Exact> gradient = w.squaredNorm() * Matrix3<Exact>::Identity() - w * w.transpose();
  const auto turning = coefficients(body, PendulumGuide<Exact>{w, {0, 0, 0}, g, {}});
  const auto resting = coefficients(body, PendulumGuide<Exact>{{0, 0, 0}, {0, 0, 0}, g, gradient});
  const Exact tiny = Exact("1e-47") * total(turning);
  BOOST_TEST(abs(Exact(turning.e() - resting.e())) <= tiny);
  BOOST_TEST(abs(Exact(turning.f - resting.f)) <= tiny);
  BOOST_TEST(abs(Exact(turning.h - resting.h)) <= tiny);
  BOOST_TEST(abs(Exact(turning.k - resting.k)) <= tiny);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(field)

BOOST_AUTO_TEST_CASE(steady_and_moving_guide_give_the_same) {
  const Given<double> in = given<double>(cases().back());
  const PendulumField<double> steady(in.body, in.guide);
  const auto motion = [&](double) { return in.guide; };
  const PendulumField<double, decltype(motion)> moving(in.body, motion);
  const PendulumState<double> state(0.3, -0.7);
  BOOST_TEST((steady(0.0, state) == moving(0.0, state)));
}

// dE/dt = Theta_C phi. phi.. + moment phi. = -f(phi.) phi.
BOOST_AUTO_TEST_CASE(damping_takes_its_power_from_the_energy) {
  const Given<double> in = given<double>(cases()[5]);
  const auto damping = [](double w) { return 0.03 * w + 0.02 * w * w * w; };
  const PendulumField<double, PendulumGuide<double>, decltype(damping)> damped(in.body, in.guide,
                                                                               damping);
  const auto c = coefficients(in.body, in.guide);
  const PendulumState<double> state(0.8, 1.7);
  const PendulumState<double> rate = damped(0.0, state);
  const double power = (in.body.theta_c * rate[1] + c.moment(state[0])) * state[1];
  BOOST_TEST(near(power, -damping(1.7) * 1.7, 10, 4));
}

BOOST_AUTO_TEST_CASE(derivatives_give_stiffness_and_power) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  const Given<double> in = given<double>(cases()[11]);
  const PendulumField<double> f(in.body, in.guide);
  const auto c = coefficients(in.body, in.guide);
  const PendulumState<Dual> state(Dual(0.4, 2, 0), Dual(-1.1, 2, 1));
  const PendulumState<Dual> rate = f(0.0, state);
  const double size = std::abs(c.e()) + std::abs(c.f) + 4 * (std::abs(c.h) + std::abs(c.k));
  BOOST_TEST(near(rate[1].derivatives()[0] * in.body.theta_c, -c.stiffness(0.4), size, 8));
  BOOST_TEST(rate[1].derivatives()[1] == 0);
  // The energy is an invariant: its gradient is normal to the field.
  const Dual e = energy(in.body, c, state);
  const double along = e.derivatives()[0] * rate[0].value() + e.derivatives()[1] * rate[1].value();
  BOOST_TEST(near(along, 0, size, 8));
}

// Sensitivities: a body in dual numbers, seeded in the arm.
BOOST_AUTO_TEST_CASE(bodies_may_be_dual_numbers) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  PendulumBody<Dual> body{Dual(2.0), Dual(0.3, 1, 0), Dual(0.1), Dual(0.4),
                          Dual(0.5), Dual(0.01),      Dual(0.0), Dual(0.02)};
  PendulumGuide<Dual> guide;
  guide.angular_velocity = {Dual(1.0), Dual(2.0), Dual(0.5)};
  guide.effective_gravity = {Dual(9.0), Dual(0.5), Dual(0.0)};
  const PendulumCoefficients<Dual> c = coefficients(body, guide);
  BOOST_TEST(near(c.e().derivatives()[0], 2 * 9.0, 18, 4));
  BOOST_TEST(near(c.f.derivatives()[0], -2 * 0.5, 1, 4));
}

BOOST_AUTO_TEST_CASE(linearized_field_is_the_tangent_at_0) {
  const Given<double> in = given<double>(cases().back());
  const auto c = coefficients(in.body, in.guide);
  const LinearPendulum<double> linear = linearized(in.body, c);
  BOOST_TEST(near(linear.acceleration(0.0) * in.body.theta_c, -c.moment(0.0), c.weight, 4));
  BOOST_TEST(linear.stiffness == c.stiffness(0.0));
  const double phi = 1e-3;
  BOOST_TEST(near(linear.acceleration(phi) * in.body.theta_c,
                  -c.moment(0.0) - c.stiffness(0.0) * phi, c.weight * phi, 16));
}

BOOST_AUTO_TEST_SUITE_END()
