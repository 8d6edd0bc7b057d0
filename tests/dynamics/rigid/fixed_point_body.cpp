#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <dynamics/guide/chain.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/guide/tabulated.hpp>
#include <dynamics/law/vector_form.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/attitude.hpp>

#include <support/json.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::Json;
using test::near;
using test::number;
namespace data = boost::unit_test::data;

namespace {

Vector3<double> vector(const Json& list) {
  return {number(list.at(0)), number(list.at(1)), number(list.at(2))};
}

Matrix3<double> matrix(const Json& rows) {
  Matrix3<double> m;
  m << vector(rows.at(0)), vector(rows.at(1)), vector(rows.at(2));
  return m.transpose();
}

/// c0 + c1 t + c2 t^2 + A sin(w t + p).
struct Wave {
  double c0, c1, c2, A, w, p;

  explicit Wave(const Json& j)
      : c0(number(j.at("c0"))),
        c1(number(j.at("c1"))),
        c2(number(j.at("c2"))),
        A(number(j.at("A"))),
        w(number(j.at("w"))),
        p(number(j.at("p"))) {}

  template <class T>
  T operator()(const T& t) const {
    using std::sin;
    return c0 + c1 * t + c2 * t * t + A * sin(w * t + p);
  }
};

/// The guide of a reference case, Rz(yaw) Ry(pitch) Rx(roll) at (x, y, z).
struct ReferenceGuide {
  Wave yaw, pitch, roll, x, y, z;

  explicit ReferenceGuide(const Json& g)
      : yaw(g.at("yaw")),
        pitch(g.at("pitch")),
        roll(g.at("roll")),
        x(g.at("x")),
        y(g.at("y")),
        z(g.at("z")) {}

  template <class T>
  Pose<T> operator()(const T& t) const {
    return {YawPitchRoll<T>{yaw(t), pitch(t), roll(t)}.rotation(), Vector3<T>(x(t), y(t), z(t))};
  }
};

std::vector<Json> reference_cases() { return test::reference_file("fixed-point.json").at("cases"); }

auto reference_body(const Json& c) {
  return FixedPointBody(InertiaTensor<Body>::about_origin(number(c.at("mass")), vector(c.at("r_s")),
                                                          matrix(c.at("Theta"))),
                        vector(c.at("rho")), posed(ReferenceGuide(c.at("guide"))),
                        UniformGravity<Inertial>{vector(c.at("g"))},
                        ViscousDrag<>{number(c.at("damping"))},
                        ConstantLoad<Guide>{.torque = vector(c.at("tau_guide"))});
}

template <class B>
typename B::State reference_start(const B&, const Json& c) {
  const Json& r = c.at("Rr0");
  const YawPitchRoll<> a{number(r.at("yaw")), number(r.at("pitch")), number(r.at("roll"))};
  return {Eigen::Quaterniond(a.rotation()), vector(c.at("u_rel0"))};
}

InertiaTensor<Body> lopsided_body() {
  Matrix3<double> Theta;
  Theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  return InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, Theta);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_body_with_a_fixed_point)

// Final attitude and angular velocity of the 25-digit trajectories.
BOOST_AUTO_TEST_CASE(agrees_with_the_references) {
  const std::vector<Json> cases = reference_cases();
  BOOST_TEST(cases.size() == 3U);
  for (const Json& c : cases) {
    const auto body = reference_body(c);
    Integrator run(body, 0, reference_start(body, c));
    const double t = number(c.at("t_end"));
    const auto end = run.to(t);
    const auto s = body.situation(t, end);
    const Json& result = c.at("result");
    const Vector3<double> u_rel = vector(result.at("u_rel_body_axes"));
    const Vector3<double> u = vector(result.at("omega_body_axes"));
    const Matrix3<double> R = matrix(result.at("R_body_to_inertial"));
    const auto found = (s.guide.X * s.X).value.rotation;
    const Vector3<double> absolute = (s.V_rel + s.X.inverse() * s.guide.V).value.resultant;
    BOOST_TEST_MESSAGE(c.at("name")
                       << ": u' " << (end.angular_velocity - u_rel).norm() / u_rel.norm()
                       << ", attitude " << (found - R).norm() / std::sqrt(2.0) << ", "
                       << run.effort().evaluations << " evaluations");
    BOOST_TEST((end.angular_velocity - u_rel).norm() <= 1e-12 * u_rel.norm());
    BOOST_TEST((absolute - u).norm() <= 1e-12 * u.norm());
    BOOST_TEST((found - R).norm() / std::sqrt(2.0) <= 1e-12);
  }
}

// The joint carries force but no torque, and the parts add up to the total load.
BOOST_AUTO_TEST_CASE(gives_the_parts_of_its_reaction) {
  const Json c = reference_cases().at(2);
  const auto body = reference_body(c);
  const auto r = body.body_outputs(1.3, reference_start(body, c));
  const double size = 20;
  BOOST_TEST(near(r.reaction.value.moment, Vector3<double>(0, 0, 0), size, 8));
  BOOST_TEST(near(r.parts.total().value, (r.applied + r.reaction).value, size, 2));
  // The force at the joint accelerates the centre of mass: m a_s = weight + reaction, a_s from the
  // motion.
  const auto& [t, X, V_rel, guide, T] = r.situation;
  const Vector3<double> force = r.parts.total().value.resultant;
  const auto V_dot = r.dV_rel.value.resultant;
  const Vector3<double> u = X.value.rotation.transpose() * guide.V.value.resultant;
  const Vector3<double> du = X.value.rotation.transpose() * guide.dV.value.resultant;
  const Vector3<double> w = V_rel.value.resultant + u;
  const Vector3<double> dw = V_dot + du + u.cross(V_rel.value.resultant);
  const Vector3<double> rho = X.value.translation;
  const Vector3<double> a_joint =
      X.value.rotation.transpose() *
      (guide.origin_acceleration() + guide.dV.value.resultant.cross(rho) +
       guide.V.value.resultant.cross(guide.V.value.resultant.cross(rho)));
  const Vector3<double> r_s = body.situation(0, {}).centre();
  const Vector3<double> a_s = a_joint + dw.cross(r_s) + w.cross(w.cross(r_s));
  BOOST_TEST(near(force, Vector3<double>(T.value.mass * a_s), size, 16));
}

// d/dt (V'.T V')/2 = (T *V').V': in the guide only loads and the guide part do work.
BOOST_DATA_TEST_CASE(balances_its_power, data::xrange(3), number) {
  const Json c = reference_cases().at(static_cast<std::size_t>(number));
  const auto body = reference_body(c);
  const auto start = reference_start(body, c);
  for (const double t : {0.0, 0.5, 2.0}) {
    const auto r = body.body_outputs(t, start);
    const double rate = reciprocal(r.dV_rel.value, r.relative_momentum.value);
    const double scale = std::abs(r.applied_power) + std::abs(r.guide_power) + std::abs(rate);
    BOOST_TEST(near(rate, r.applied_power - r.guide_power, scale, 40));
    BOOST_TEST(near(power(r.parts.coriolis, r.situation.V_rel), 0.0, scale + 1, 40));
  }
}

// Guide at rest, and no loads: Euler's equations.
BOOST_DATA_TEST_CASE(agrees_with_eulers_top_on_a_guide_at_rest, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const auto T = lopsided_body();
  const FixedPointBody body(T, {1, 2, 3}, RestingFrame<>{});
  const Vector3<double> u = sample.magnitude(-2, 2) * sample.direction();
  const Vector3<double> du =
      body.acceleration(body.situation(0, {Eigen::Quaterniond::Identity(), u}));
  const double size = 0.5 * u.squaredNorm();
  BOOST_TEST(near(euler_torque(T.value.tensor, u, du), Vector3<double>(0, 0, 0), size, 16));
}

// With its centre of mass at the fixed point and no loads, a body does not depend on the guide.
BOOST_AUTO_TEST_CASE(ignores_the_guide_if_fixed_at_its_centre) {
  const auto swing = [](const auto& t) {
    using std::sin;
    using S = std::decay_t<decltype(t)>;
    return Pose<S>{YawPitchRoll<S>{S(0.5 * t), S(0.3 * sin(1.1 * t)), S(0.2 * sin(t))}.rotation(),
                   Vector3<S>(S(t * t), S(sin(2.0 * t)), S(0))};
  };
  Matrix3<double> Theta = Vector3<double>(1, 2, 2.5).asDiagonal();
  const auto T = InertiaTensor<Body>::about_centre(3, {0, 0, 0}, Theta);
  const auto moving = posed(swing);
  const FixedPointBody watched(T, {1, -1, 0.5}, moving);
  const FixedPointBody euler(T, {1, -1, 0.5}, RestingFrame<>{});
  const Vector3<double> w(0.4, 1.7, -0.3);  // absolute
  const auto start = moving(0);
  const auto end = moving(5);
  const Eigen::Quaterniond q0(start.X.value.rotation.transpose());
  decltype(watched)::State state{q0, w - start.X.value.rotation * start.V.value.resultant};
  state.angular_velocity = w - Pose<>::from(q0).rotation.transpose() * start.V.value.resultant;
  const auto a = Integrator(watched, 0, state).to(5);
  const auto b = Integrator(euler, 0, {Eigen::Quaterniond::Identity(), w}).to(5);
  const Matrix3<double> found = end.X.value.rotation * Pose<>::from(a.attitude).rotation;
  BOOST_TEST(near(found, Pose<>::from(b.attitude).rotation, 1.0, 1e-12 / test::u<>));
}

// (22): a body at rest in the guide needs only the force of the guide part.
BOOST_DATA_TEST_CASE(at_rest_in_the_guide_obeys_22, data::xrange(50u), seed) {
  test::Sample sample(seed);
  const auto T = lopsided_body();
  const RotatingFrame<> guide{sample.direction(), sample.direction(), {}, sample.direction()};
  const FixedPointBody body(T, {0, 0, 0}, guide);
  const auto r = body.body_outputs(0.7, {});
  const auto motion = guide(0.7);
  const Velocity<Body, Inertial, Body> F{motion.V.value};
  const Rate<Body, Velocity<Body, Inertial, Body>> dF{motion.dV.value};
  BOOST_TEST(near(r.parts.guide.value, carried_body_force(T, F, dF).value, 20.0, 16));
  BOOST_TEST(near(r.parts.coriolis.value, Motor<double>{}, 20.0, 1));
}

namespace {

template <class M>
Eigen::Matrix<double, 7, 1> swung(M guide) {
  const FixedPointBody body(lopsided_body(), {0.1, 0.2, 0.3}, guide,
                            UniformGravity<Inertial>{{0, 0, -9.81}}, ViscousDrag<>{0.01});
  const auto end = Integrator(body, 0, {Eigen::Quaterniond(0.8, 0.6, 0, 0), {0.5, 1, 0.2}}).to(2);
  return decltype(body)::to_vector(end);
}

}  // namespace

// u = 0 in any kind of guide: exactly the same numbers.
BOOST_AUTO_TEST_CASE(moves_alike_on_all_guides_at_rest) {
  struct Ship {};
  const auto rest = swung(RestingFrame<>{});
  BOOST_TEST(swung(RotatingFrame<>{}) == rest);
  BOOST_TEST(swung(SteadyFrame<>{}) == rest);
  BOOST_TEST(swung(HarmonicFrame<>({}, {}, 0, 2)) == rest);
  BOOST_TEST(swung(HarmonicFrame<>({{0, 0, 0}, {{{0, 0, 0}, 3, 1}}}, {}, 0, 2)) == rest);
  BOOST_TEST(swung(Chain(RestingFrame<Ship, Inertial>{}, RestingFrame<Guide, Ship>{})) == rest);
  MotionLog<> log;
  for (int i = 0; i <= 8; ++i) {
    log.times.push_back(0.25 * i);
    log.attitudes.push_back(Eigen::Quaterniond::Identity());
  }
  BOOST_TEST(swung(TabulatedFrame<>(log)) == rest);
  BOOST_TEST(swung(posed([](const auto& t) { return Pose<std::decay_t<decltype(t)>>{}; })) == rest);
  BOOST_TEST(swung([](double) { return FrameMotion<Guide, Inertial>{}; }) == rest);
}

// Slowly, down to the smallest numbers: no division by |u|, nothing but rounding changes.
BOOST_AUTO_TEST_CASE(is_exact_on_a_guide_that_hardly_turns) {
  const auto rest = swung(RestingFrame<>{});
  for (const double u : {1e-20, 1e-160, 1e-300, 1e-320}) {
    const auto y = swung(RotatingFrame<>{{0, u, u}, {0, 0, 0}, {}, {0, 0, 0}});
    BOOST_TEST(near(y, rest, 2.0, 64));
  }
}

// Gravity and acceleration are computed once for a guide in steady motion, and at each evaluation
// for any other.
BOOST_AUTO_TEST_CASE(has_the_same_field_on_a_known_guide) {
  const RotatingFrame<> steady{{0.3, -0.2, 0.5}, {1, 2, 3}};
  const auto on = [](const auto& guide) {
    return FixedPointBody(lopsided_body(), Vector3<double>(0.4, -0.1, 0.2), guide,
                          UniformGravity<Inertial>{{0.1, 0.2, -9.81}},
                          UniformGravity<Guide>{{4, 5, 6}});
  };
  const auto known = on(steady);
  const auto felt = on([steady](double t) { return steady(t); });
  const auto y = known.to_vector({Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5), {0.4, -1, 2}});
  for (const double t : {0.0, 0.7, 5.0}) {
    BOOST_TEST(near(known.rates(t, y), felt.rates(t, y), 100.0, 8));
  }
}

// The guide stops in its pose at 2 s; the effect of its motion at the fixed point is kept.
BOOST_AUTO_TEST_CASE(without_guide_rate_it_is_as_on_one_at_rest) {
  const Vector3<double> u(0.3, -0.2, 0.5);
  const Vector3<double> a(1, 2, 3);
  const Vector3<double> point(0.4, -0.1, 0.2);
  const UniformGravity<Inertial> gravity{{0.1, 0.2, -9.81}};
  const RotatingFrame<> guide{u, a};
  const FixedPointBody body(lopsided_body(), point, guide, gravity);
  const FixedPointBody same(lopsided_body(), point, RestingFrame<>{guide(2).X}, gravity,
                            UniformGravity<Guide>{-a - u.cross(u.cross(point))});
  const auto y = body.to_vector({Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5), {0.4, -1, 2}});
  BOOST_TEST(near(body.without(GuideRate{}, 1, 3).rates(0, y), same.rates(0, y), 10.0, 8));
}

BOOST_AUTO_TEST_CASE(is_refused_if_its_rotation_is_undetermined) {
  const RestingFrame<> guide;
  const auto held = [&](const InertiaTensor<Body>& T) {
    return FixedPointBody(T, {0, 0, 0}, guide);
  };
  const Matrix3<double> needle = Vector3<double>(1, 1, 0).asDiagonal();
  BOOST_CHECK_THROW(held(InertiaTensor<Body>::about_centre(1, {0, 0, 0}, needle)), InvalidInput);
  BOOST_CHECK_THROW(held(InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Zero())),
                    InvalidInput);
  // Away from the fixed point the same needle is a valid body.
  BOOST_CHECK_NO_THROW(held(InertiaTensor<Body>::about_centre(1, {0.1, 0, 0}, needle)));
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW(FixedPointBody(lopsided_body(), {nan, 0, 0}, guide), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
