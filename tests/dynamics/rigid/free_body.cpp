#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <limits>
#include <type_traits>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/law/vector_form.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/attitude.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

/// A guide that yaws, pitches, rolls and is shaken.
constexpr auto rough = [](const auto& t) {
  using std::sin;
  using S = std::decay_t<decltype(t)>;
  const YawPitchRoll<S> a{S(0.5 * t), S(0.3 * sin(1.1 * t)), S(0.4 * sin(0.8 * t + 2.0))};
  return Pose<S>{a.rotation(), Vector3<S>(S(0.4 * t * t), S(0.6 * sin(1.4 * t)), S(5.0 * t))};
};

InertiaTensor<Body> lopsided_body() {
  Matrix3<double> Theta;
  Theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  return InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, Theta);
}

const double tight = 1e-12 / test::u<>;  // 1e-12 in units of rounding

}  // namespace

BOOST_AUTO_TEST_SUITE(a_free_body)

// Without loads the centre of mass moves straight and the momentum is constant, in the inertial
// frame. Seen from the rough guide that is a wild motion, and the guide's own motion must cancel.
BOOST_AUTO_TEST_CASE(moves_straight_for_any_guide_motion) {
  const auto guide = posed(rough);
  const FreeBody body(lopsided_body(), guide);
  const decltype(body)::State start{
      Eigen::Quaterniond(0.5, 0.1, -0.7, 0.2), {1, 2, -1}, {{{0.3, -2, 1}, {0.5, 0.1, -0.2}}}};
  const auto momentum = [&](double t, const auto& state) {
    const auto r = body.body_outputs(t, state);
    const auto to_inertial = (r.situation.guide.X * r.situation.X).value;
    return to_inertial * r.momentum.value;  // about the inertial origin
  };
  const auto centre = [&](double t, const auto& state) {
    const auto s = body.situation(t, state);
    return s.template position<Inertial>(s.centre());
  };
  const Motor<double> J = momentum(0, start);
  const Vector3<double> c = centre(0, start);
  Integrator run(body, 0, start);
  for (const double t : {1.0, 2.5, 5.0}) {
    const auto state = run.to(t);
    BOOST_TEST(near(momentum(t, state), J, 100.0, tight));
    BOOST_TEST(near(centre(t, state), Vector3<double>(c + J.resultant / 2 * t), 100.0, tight));
  }
}

// (21): a point mass, like the centre of mass of a body that does not turn.
BOOST_DATA_TEST_CASE(is_a_particle_with_all_mass_at_the_origin, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const double m = sample.magnitude(-1, 1);
  const auto T = InertiaTensor<Body>::about_centre(m, {0, 0, 0}, Matrix3<double>::Identity());
  const RotatingFrame<> guide{sample.direction(), sample.direction(), {}, sample.direction()};
  const Vector3<double> force = 3 * sample.direction();
  const FreeBody body(T, guide, ConstantLoad<Guide>{.force = force});
  const Vector3<double> r = 2 * sample.direction();
  const Vector3<double> v = 2 * sample.direction();
  const auto s = body.situation(0.3, {Eigen::Quaterniond::Identity(), r, {{{0, 0, 0}, v}}});
  const Vector3<double> dv = body.acceleration(s).value.moment;
  const auto motion = guide(0.3);
  const Vector3<double> needed = particle_force(m, r, v, dv, motion.V.value, motion.dV.value);
  BOOST_TEST(near(needed, force, 20 * std::max(m, 1.0), 16));
}

// A body on a spring, on rubber and in a field, in a guide at rest: its energy is constant.
BOOST_AUTO_TEST_CASE(keeps_its_energy_on_springs) {
  Matrix3<double> K;
  K << 30, 2, 0, 2, 20, 1, 0, 1, 25;
  const FreeBody body(
      lopsided_body(), RestingFrame<>{}, UniformGravity<Guide>{{0.5, 0, -9.81}},
      Spring<>{{0, 0, 2}, {0.1, 0.2, 0}, 40, 0.5}, Spring<>{{1, 1, 1}, {0, 0, 0}, 10},
      ElasticMount<>{{0.3, 0, 0}, {0.2, 0, 0.1}, K, Matrix3<double>::Zero(), {1, 2, 3}});
  const decltype(body)::State start{Eigen::Quaterniond(0.5, 0.1, -0.7, 0.2),
                                    {0.1, 0.2, -0.1},
                                    {{{0.3, -2, 1}, {0.5, 0.1, -0.2}}}};
  const auto energy = [&](double t, const auto& state) {
    const auto r = body.body_outputs(t, state);
    return r.kinetic_energy + r.potential_energy;
  };
  Integrator run(body, 0, start);
  BOOST_TEST(near(energy(5, run.to(5)), energy(0, start), 100.0, tight));
}

// The work of loads equals the loss of their potentials, minus the work of their dampers. Lengths
// and positions a little before and after give the differences, which err by (3 h)^2/6 and by
// 1e-14/h.
BOOST_DATA_TEST_CASE(loses_the_power_of_its_dampers, data::xrange(20u), seed) {
  test::Sample sample(seed);
  LoadContext<> s;
  s.inertia = lopsided_body();
  s.X.value = exp(Motor<double>{2 * sample.direction(), sample.direction()});
  s.V_rel.value = {2 * sample.direction(), 2 * sample.direction()};
  const auto rate = [&s](const auto& of) {
    const double h = 1e-5;
    const auto after = [&s](double t) {
      LoadContext<> moved = s;
      moved.X.value = s.X.value * exp(t * s.V_rel.value);
      return moved;
    };
    return decltype(of(s))((of(after(h)) - of(after(-h))) / (2 * h));
  };
  const auto given = [&](const auto& load) {
    return power(load(s), s.V_rel) +
           rate([&](const LoadContext<>& at) { return load.potential(at); });
  };
  const double tolerance = 1e-9 / test::u<>;

  const Vector3<double> end(0.1, 0.2, 0);
  const Vector3<double> from(0, 0.5, 3);
  const double stretching =
      rate([&](const LoadContext<>& at) { return (at.position<Guide>(end) - from).norm(); });
  BOOST_TEST(
      near(given(Spring<>{from, end, 40, 0.5, 3}), -3 * stretching * stretching, 200.0, tolerance));

  const Matrix3<double> K = Vector3<double>(30, 20, 25).asDiagonal();
  Matrix3<double> D;
  D << 3, 0.2, 0, 0.2, 2, 0.1, 0, 0.1, 2.5;
  const Vector3<double> velocity =
      rate([&](const LoadContext<>& at) -> Vector3<double> { return at.position<Guide>(end); });
  BOOST_TEST(near(given(ElasticMount<>{from, end, K, D, {1, 2, 3}}), -velocity.dot(D * velocity),
                  200.0, tolerance));

  const Vector3<double> origin = rate([&](const LoadContext<>& at) -> Vector3<double> {
    return at.position<Guide>({0, 0, 0});
  });
  BOOST_TEST(near(power(ViscousDrag<>{2, 3}(s), s.V_rel),
                  -3 * origin.squaredNorm() - 2 * s.V_rel.value.resultant.squaredNorm(), 200.0,
                  tolerance));
}

// On a steadily turning guide the energy with the centrifugal potential -F.(T F)/2 is constant
// (Jacobi's integral).
BOOST_AUTO_TEST_CASE(keeps_jacobis_integral_on_a_turntable) {
  SteadyFrame<> turntable;
  turntable.V = {{{0, 0, 1.5}, {0, 0, 0}}};
  const FreeBody body(lopsided_body(), turntable, UniformGravity<Guide>{{0, 0, -9.81}},
                      Spring<>{{0, 0, 2}, {0.1, 0.2, 0}, 60, 0.5});
  const decltype(body)::State start{Eigen::Quaterniond(0.5, 0.1, -0.7, 0.2),
                                    {0.1, 0.2, -0.1},
                                    {{{0.3, -2, 1}, {0.5, 0.1, -0.2}}}};
  const auto integral = [&](double t, const auto& state) {
    const auto r = body.body_outputs(t, state);
    const auto F = r.situation.X.inverse() * r.situation.guide.V;
    return r.relative_kinetic_energy + r.potential_energy -
           reciprocal((r.situation.inertia * F).value, F.value) / 2;
  };
  Integrator run(body, 0, start);
  BOOST_TEST(near(integral(5, run.to(5)), integral(0, start), 100.0, tight));
}

// The same load given on three kinds of axes that coincide.
BOOST_AUTO_TEST_CASE(accepts_loads_on_any_axes) {
  const Pose<double> tilt{YawPitchRoll<>{0.3, -0.5, 1.1}.rotation(), {1, 2, 3}};
  const Pose<double> lean{YawPitchRoll<>{-0.7, 0.2, 0.4}.rotation(), {-1, 0, 2}};
  LoadContext<> s;
  s.inertia = lopsided_body();
  s.guide.X = {tilt};
  s.X = {lean};
  const Vector3<double> f(1, -2, 0.5), m(0.1, 0.2, -0.3), p(0.4, 0, -0.1);
  const Matrix3<double>& to_guide = lean.rotation;
  const Matrix3<double> to_inertial = tilt.rotation * to_guide;
  const Motor<double> body = ConstantLoad<Body>{f, m, p}(s).value;
  BOOST_TEST(near(ConstantLoad<Guide>{to_guide * f, to_guide * m, p}(s).value, body, 3.0, 8));
  BOOST_TEST(
      near(ConstantLoad<Inertial>{to_inertial * f, to_inertial * m, p}(s).value, body, 3.0, 8));
  BOOST_TEST(near(body.moment, Vector3<double>(m + p.cross(f)), 3.0, 4));
  BOOST_TEST(near(UniformGravity<Inertial>{to_inertial * f}(s).value,
                  UniformGravity<Guide>{to_guide * f}(s).value, 5.0, 8));
}

BOOST_AUTO_TEST_CASE(accepts_a_function_as_a_load) {
  const auto thrust = [](const LoadContext<>& s) { return Force<Body>{{{s.t, 0, 0}, {0, 0, 0}}}; };
  const auto T = InertiaTensor<Body>::about_centre(2, {0, 0, 0}, Matrix3<double>::Identity());
  const FreeBody body(T, RestingFrame<>{}, thrust);
  const auto end = Integrator(body, 0, {}).to(3);
  BOOST_TEST(near(end.position, Vector3<double>(27.0 / 12, 0, 0), 2.25, 100));  // t^3 / (6 m)
}

BOOST_AUTO_TEST_CASE(is_refused_if_impossible) {
  BOOST_CHECK_THROW(FreeBody(InertiaTensor<Body>{}, RestingFrame<>{}), InvalidInput);
  const Matrix3<double> needle = Vector3<double>(1, 1, 0).asDiagonal();
  const auto T = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, needle);
  BOOST_CHECK_THROW(FreeBody(T, RestingFrame<>{}), ComputationFailed);
  // A body that rounding has made thick is refused too, on any axis.
  for (int axis = 0; axis < 3; ++axis) {
    Matrix3<double> rounded = Matrix3<double>::Identity();
    rounded(axis, axis) = 1e-17;
    BOOST_CHECK_THROW(
        FreeBody(InertiaTensor<Body>::about_centre(1, {0, 0, 0}, rounded), RestingFrame<>{}),
        ComputationFailed);
  }
}

// Gravity and acceleration are computed once for a guide in steady motion, and at each evaluation
// for any other.
BOOST_AUTO_TEST_CASE(has_the_same_field_on_a_known_guide) {
  const RotatingFrame<> steady{{0.3, -0.2, 0.5}, {1, 2, 3}};
  const auto on = [](const auto& guide) {
    return FreeBody(lopsided_body(), guide, UniformGravity<Inertial>{{0.1, 0.2, -9.81}},
                    UniformGravity<Guide>{{4, 5, 6}});
  };
  const auto known = on(steady);
  const auto felt = on([steady](double t) { return steady(t); });
  const auto y = known.to_vector(
      {Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5), {0.4, -1, 2}, {{{0.3, 0.2, -0.1}, {1, 2, -3}}}});
  for (const double t : {0.0, 0.7, 5.0}) {
    BOOST_TEST(near(known.rates(t, y), felt.rates(t, y), 100.0, 8));
  }
}

// The guide stops in its pose at 2 s; the effect of its origin's acceleration is kept.
BOOST_AUTO_TEST_CASE(without_guide_rate_it_is_as_on_one_at_rest) {
  const Vector3<double> a(1, 2, 3);
  const UniformGravity<Inertial> gravity{{0.1, 0.2, -9.81}};
  const RotatingFrame<> guide{{0.3, -0.2, 0.5}, a};
  const FreeBody body(lopsided_body(), guide, gravity);
  const FreeBody same(lopsided_body(), RestingFrame<>{guide(2).X}, gravity,
                      UniformGravity<Guide>{-a});
  const auto y = body.to_vector(
      {Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5), {0.4, -1, 2}, {{{0.3, 0.2, -0.1}, {1, 2, -3}}}});
  BOOST_TEST(near(body.without(GuideRate{}, 1, 3).rates(0, y), same.rates(0, y), 10.0, 8));
}

BOOST_AUTO_TEST_CASE(reports_a_spring_without_direction) {
  LoadContext<> s;
  s.inertia = lopsided_body();
  BOOST_CHECK_THROW((void)(Spring<>{{0, 0, 0}, {0, 0, 0}, 10, 0.5}(s)), ComputationFailed);
  BOOST_TEST((Spring<>{{0, 0, 0}, {0, 0, 0}, 10, 0}(s).value.resultant) ==
             Vector3<double>(0, 0, 0));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(oblate_gravitation)

// The force is the gradient of the potential, and the sphere has GM/r^2.
BOOST_DATA_TEST_CASE(has_a_potential, data::xrange(20u), seed) {
  test::Sample sample(seed);
  const OblateGravitation<> field;
  const Vector3<double> p = sample.uniform(6.3e6, 3e7) * sample.direction();
  const auto potential = [&](const Vector3<double>& place) {
    LoadContext<> s;
    s.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
    s.X.value.translation = place;
    return field.potential(s);
  };
  const Vector3<double> g = field(p);
  for (int i = 0; i < 3; ++i) {
    const Vector3<double> h = 1000 * Vector3<double>::Unit(i);
    const double slope = (8 * (potential(p + h) - potential(p - h)) -
                          (potential(p + 2 * h) - potential(p - 2 * h))) /
                         12000;
    BOOST_TEST(near(g[i], -slope, 10.0, 1e-9 / test::u<>));
  }
  const OblateGravitation<> sphere{.j2 = 0};
  BOOST_TEST(near(sphere(p).norm(), 3.986004418e14 / p.squaredNorm(), 10.0, 8));
}

// Fields of gravity treat a wheel alike at all its angles: the wheel as a rotor moves its carrier
// like an ordinary body. Other loads may depend on the angle.
BOOST_AUTO_TEST_CASE(gravitation_may_act_on_a_rotor) {
  const auto satellite = [](auto load, bool rotor) {
    BodyDescription carrier;
    carrier.name = "carrier";
    carrier.joint.kind = JointKind::free;
    carrier.inertia = lopsided_body();
    BodyDescription wheel;
    wheel.name = "wheel";
    wheel.parent = "carrier";
    wheel.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}, .position = {0.1, 0, 0.2}};
    wheel.inertia = InertiaTensor<Body>::about_centre(
        1, {0, 0, 0.05}, Vector3<double>(0.1, 0.1, 0.2).asDiagonal().toDenseMatrix());
    wheel.loads = {load};
    if (rotor) wheel.rotor = Rotor{};
    return BodySystem<RestingFrame<>>({}, {carrier, wheel});
  };
  Eigen::VectorXd y(15);
  y << 0.1, -0.2, 0.3, 0.9, 6.5e6, 1e6, 2e6, 0.4, 0.1, -0.2, 0.3, 1, 2, 3, 70;
  const auto compare = [&](auto load) {
    const Eigen::VectorXd as_body = satellite(load, false).rates(0, y);
    const Eigen::VectorXd off = satellite(load, true).rates(0, y) - as_body;
    BOOST_TEST(off.norm() <= 1e-13 * as_body.tail(7).norm());
  };
  compare(UniformGravity<Guide>{{1, 2, -9}});
  compare(UniformGravity<Inertial>{{1, 2, -9}});
  compare(OblateGravitation<>{});
  BOOST_CHECK_THROW((void)satellite(ConstantLoad<Guide>{.torque = {0, 0, 1}}, true), InvalidInput);
  BOOST_CHECK_THROW((void)satellite(UniformGravity<Body>{{1, 2, -9}}, true), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
