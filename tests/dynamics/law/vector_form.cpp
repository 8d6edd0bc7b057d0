#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <vector>

#include <dynamics/law/momentum.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/law/vector_form.hpp>

#include <support/body.hpp>
#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::cast;
using test::Digits50;
using test::MovingBody;
using test::near;
using test::same;
using test::Terms;
using test::terms;
using test::Typed;
namespace data = boost::unit_test::data;

namespace {

void near_parts(const ForceParts<Body>& x, const ForceParts<Body>& y,
                const ForceParts<Body, Terms>& scale, double k) {
  BOOST_TEST(near(x.relative.value, y.relative.value, scale.relative.value, k));
  BOOST_TEST(near(x.guide.value, y.guide.value, scale.guide.value, k));
  BOOST_TEST(near(x.coriolis.value, y.coriolis.value, scale.coriolis.value, k));
}

Momentum<Body> momentum(const Motor<Digits50>& J) { return {cast<double>(J)}; }

PlainRate<Guide, Momentum<Body>> plain(const test::Differentiated& J) {
  return {cast<double>(J.P.guide)};
}

/// The sizes of the terms of (20).
Motor<Terms> sizes_20(const MovingBody& body) {
  const Typed<Terms> t = body.terms();
  const auto J = t.T * t.V_rel;
  const auto J_f = t.T * t.F;
  const auto rate = [&](const auto& V, const auto& dV) {
    return plain_rate(momentum_rate(t.T, t.V_rel, V, dV), t.V_rel, t.T * V);
  };
  return vector_form_20(t.V_rel, t.F, J, rate(t.V_rel, t.dV_rel.guide), J_f, rate(t.F, t.dF.guide))
      .value;
}

void check_18(const MovingBody& body) {
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const auto parts = vector_form_18(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.body);
  const auto scale = vector_form_18(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.body);
  BOOST_TEST(near(parts.total().value, body.force(), scale.total().value, 16));
  const auto motors = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.body);
  const auto motor_scale = equation_of_motion(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.body);
  near_parts(parts, motors,
             {scale.relative + motor_scale.relative, scale.guide + motor_scale.guide,
              scale.coriolis + motor_scale.coriolis},
             12);
}

void check_19(const MovingBody& body) {
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const auto parts = vector_form_19(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide);
  const auto scale = vector_form_19(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.guide);
  BOOST_TEST(near(parts.total().value, body.force(), scale.total().value, 16));
  const auto motors = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide);
  const auto motor_scale = equation_of_motion(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.guide);
  near_parts(parts, motors,
             {scale.relative + motor_scale.relative, scale.guide + motor_scale.guide,
              scale.coriolis + motor_scale.coriolis},
             12);
}

void check_20(const MovingBody& body) {
  const Typed<double> b = body.numbers();
  const auto P = vector_form_20(b.V_rel, b.F, momentum(body.truth.J.value), plain(body.truth.J),
                                momentum(body.truth.J_f.value), plain(body.truth.J_f));
  BOOST_TEST(near(P.value, body.force(), sizes_20(body), 12));
}

/// A body that turns about a point fixed in a moving guide.
MovingBody fixed_point_body(unsigned seed) {
  test::Sample sample(seed);
  const std::vector<test::PointMass> masses = sample.solid_masses();
  test::Motion relative = test::motion(sample);
  for (test::Wave* const wave : {&relative.x, &relative.y, &relative.z}) {
    *wave = wave->still(0);
  }
  return {masses, test::truth(test::motion(sample), relative, Digits50(0), masses),
          test::inertia<Digits50>(masses)};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(equations_18_to_20)

BOOST_AUTO_TEST_CASE(give_the_reference_forces) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const MovingBody body = test::moving_body(c);
    check_18(body);
    check_19(body);
    check_20(body);
  }
}

BOOST_DATA_TEST_CASE(give_the_newtonian_force_part_by_part, data::xrange(300u), seed) {
  const MovingBody body = test::moving_body(seed);
  check_18(body);
  check_19(body);
  check_20(body);
}

// A massless ring has no centre of mass, but obeys the equations.
BOOST_AUTO_TEST_CASE(hold_without_mass) {
  MovingBody body = test::moving_body(3);
  body.T = {0, Vector3<Digits50>::Zero(), body.T.tensor};
  const Typed<double> b = body.numbers();
  const auto in_18 = vector_form_18(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.body).total();
  const auto in_19 = vector_form_19(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide).total();
  const auto motors = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.body).total();
  const Typed<Terms> t = body.terms();
  const auto scale = equation_of_motion(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.guide).total();
  BOOST_TEST(near(in_18.value, motors.value, scale.value, 16));
  BOOST_TEST(near(in_19.value, motors.value, scale.value, 16));
}

// (19a), (19b) with the plain derivative of v at the moving O': the factor 2 of u x v' is 1.
BOOST_DATA_TEST_CASE(equation_19_needs_the_true_derivative, data::xrange(100u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const Rate<Guide, Velocity<Guide, Inertial, Body>> misread{cast<double>(body.truth.F.P.guide)};
  const auto parts = vector_form_19(b.T, b.V_rel, b.F, b.dV_rel.body, misread);
  const Vector3<double> once = b.F.value.resultant.cross(b.V_rel.value.moment);
  const Motor<> surplus{b.T.value.mass * once, b.T.value.first_moment.cross(once)};
  const auto scale = vector_form_19(t.T, t.V_rel, t.F, t.dV_rel.body, t.dF.guide).total();
  BOOST_TEST(near(parts.total().value - surplus, body.force(), scale.value, 16));
}

// The same equation with true rates, the moments of o(T V') and o(T F), without v'.
BOOST_DATA_TEST_CASE(printed_20_holds_for_true_rates, data::xrange(100u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Motor<> sum = momentum(body.truth.J.value).value + momentum(body.truth.J_f.value).value;
  const Motor<> rate = cast<double>(body.truth.J.T.guide) + cast<double>(body.truth.J_f.T.guide);
  const auto& [u, v] = b.F.value;
  const Motor<> printed{rate.resultant + u.cross(sum.resultant),
                        rate.moment + u.cross(sum.moment) + v.cross(sum.resultant)};
  BOOST_TEST(near(printed, body.force(), sizes_20(body), 12));
}

// (48) as printed lacks v x (G + G_f), the momentum times the velocity of the fixed point. This
// term is 0 only if the point rests or the body is fixed at its centre of mass.
BOOST_AUTO_TEST_CASE(equation_48_needs_the_guide_velocity) {
  double largest = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const MovingBody body = fixed_point_body(seed);
    const Typed<double> b = body.numbers();
    BOOST_TEST(b.V_rel.value.moment.norm() <= 1e-30);
    const Motor<> sum = momentum(body.truth.J.value).value + momentum(body.truth.J_f.value).value;
    const Vector3<double> rate =
        (cast<double>(body.truth.J.P.guide) + cast<double>(body.truth.J_f.P.guide)).moment;
    const auto& [u, v] = b.F.value;
    const Vector3<double> printed = rate + u.cross(sum.moment);
    const Vector3<double> missing = v.cross(sum.resultant);
    BOOST_TEST(
        near(Motor<>{body.force().resultant, printed + missing}, body.force(), sizes_20(body), 12));
    largest = std::max(largest, missing.norm() / body.force().moment.norm());
  }
  BOOST_TEST(largest > 0.5);
}

// Counterexample L: the guide is inertial, nothing acts. S moves with (1, 0, 0), the body spins
// with (0, 0, 1), and S is at (1, 0, 0) from O'. O' therefore moves with (1, 0, 0) - z cross x =
// (1, -1, 0), and the momentum about it changes by -v' x G. The printed (20b) has no v' x G and
// requires a torque of -1.
BOOST_AUTO_TEST_CASE(printed_20_has_a_spurious_torque) {
  const InertiaTensor<Body> T{{1, {1, 0, 0}, {0, 1, 1, 0, 0, 0}}};
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 1}, {1, -1, 0}}};
  const Velocity<Guide, Inertial, Body> F{};
  const Momentum<Body> J = T * V_rel;
  BOOST_TEST(same(J.value, Motor<>{{1, 0, 0}, {0, 0, 0}}));

  // The momentum as a motor is constant; its moment at the receding point O' changes by -v' x G.
  const Rate<Guide, Momentum<Body>> none{};
  const PlainRate<Guide, Momentum<Body>> dJ = plain_rate(none, V_rel, J);
  const Motor<> printed{dJ.value.resultant + F.value.resultant.cross(J.value.resultant),
                        dJ.value.moment + F.value.resultant.cross(J.value.moment) +
                            F.value.moment.cross(J.value.resultant)};
  BOOST_TEST(same(printed, Motor<>{{0, 0, 0}, {0, 0, -1}}));
  BOOST_TEST(same(vector_form_20(V_rel, F, J, dJ, Momentum<Body>{}, {}).value, Motor<>{}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(equation_21)

// Anchor: at (3, 0, 0) in a guide that turns with 1 rad/s, moving with 5 along x: -6 and 20 on 2 kg.
BOOST_AUTO_TEST_CASE(by_hand) {
  const Motor<> F{{0, 0, 1}, {0, 0, 0}};
  BOOST_TEST(same(particle_force<double>(2, {3, 0, 0}, {5, 0, 0}, {0, 0, 0}, F, Motor<>{}),
                  Vector3<double>(-6, 20, 0)));
}

// Anchor: a guide whose origin moves with 10 along x and turns with 1 about z. Bodies in it need 10
//         along y. With 1 rad/s^2 they need 3 along y at (3, 0, 0).
BOOST_AUTO_TEST_CASE(by_hand_with_an_accelerated_guide) {
  BOOST_TEST(same(particle_force<double>(1, {0, 0, 0}, {0, 0, 0}, {0, 0, 0},
                                         Motor<>{{0, 0, 1}, {10, 0, 0}}, Motor<>{}),
                  Vector3<double>(0, 10, 0)));
  BOOST_TEST(same(particle_force<double>(1, {3, 0, 0}, {0, 0, 0}, {0, 0, 0}, Motor<>{},
                                         Motor<>{{0, 0, 1}, {0, 0, 7}}),
                  Vector3<double>(0, 3, 7)));
}

// A particle at O': its position, velocity and acceleration in the guide are those of O'.
BOOST_DATA_TEST_CASE(gives_the_newtonian_force, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const double mass = sample.magnitude();
  const test::Truth truth = test::truth(sample, {{mass, {0, 0, 0}}});
  const Matrix3<Digits50>& to_guide = truth.X_GB.rotation;
  const Vector3<double> r = cast<double>(truth.r_G);
  const Vector3<double> v = cast<double>(Vector3<Digits50>(to_guide * truth.V_rel.value.moment));
  const Vector3<double> dv = cast<double>(Vector3<Digits50>(to_guide * truth.V_rel.P.guide.moment));
  const Vector3<double> force = cast<double>(Vector3<Digits50>(to_guide * truth.force.resultant));
  const Motor<> F = cast<double>(truth.F_G);
  const Motor<> dF = cast<double>(truth.dF_G);
  const Vector3<Terms> scale =
      particle_force(Terms(mass), terms(r), terms(v), terms(dv), terms(F), terms(dF)) +
      Vector3<Terms>::Constant(1e-30);
  BOOST_TEST(near(particle_force(mass, r, v, dv, F, dF), force, scale, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(equation_22)

// A body that rests in the guide, on guide axes.
BOOST_DATA_TEST_CASE(gives_the_newtonian_force, data::xrange(200u), seed) {
  test::Sample sample(seed);
  const std::vector<test::PointMass> masses = sample.solid_masses();
  const test::Motion guide = test::motion(sample);
  const test::Truth truth = test::truth(guide, test::Motion{}, Digits50(0), masses);
  const Inertia<> T = cast<double>(test::inertia<Digits50>(masses));
  const Motor<> F = cast<double>(truth.F_G);
  const Motor<> dF = cast<double>(truth.dF_G);
  using Guiding = Velocity<Guide, Inertial, Guide>;
  using Sizes = Velocity<Guide, Inertial, Guide, Terms>;
  const auto P = carried_body_force(InertiaTensor<Guide>{T}, Guiding{F}, Rate<Guide, Guiding>{dF});
  static_assert(std::is_same_v<decltype(P), const Force<Guide>>);
  const Vector3<Terms> zero = Vector3<Terms>::Constant(1e-30);
  const auto scale = carried_body_force(InertiaTensor<Guide, Terms>{terms(T)}, Sizes{terms(F)},
                                        Rate<Guide, Sizes>{terms(dF) + Motor<Terms>{zero, zero}});
  BOOST_TEST(near(P.value, cast<double>(truth.force), scale.value, 16));
}

// The motor form of this equation: T oF + [F (T F)].
BOOST_DATA_TEST_CASE(equals_the_guide_part, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Inertia<> T = test::inertia(sample.masses());
  const Motor<> F = sample.motor();
  const Motor<> dF = sample.motor();
  using Guiding = Velocity<Guide, Inertial, Guide>;
  const auto P = carried_body_force(InertiaTensor<Guide>{T}, Guiding{F}, Rate<Guide, Guiding>{dF});
  const Motor<Terms> scale = terms(T) * terms(dF) + cross(terms(F), terms(T) * terms(F));
  BOOST_TEST(near(P.value, T * dF + cross(F, T * F), scale, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(equations_of_euler)

// Anchor: moments 1, 2, 3; spinning with (1, 1, 1): u x T u = (1, -2, 1).
BOOST_AUTO_TEST_CASE(by_hand) {
  const Symmetric3<> T{1, 2, 3, 0, 0, 0};
  BOOST_TEST(same(euler_torque<double>(T, {1, 1, 1}, {0, 0, 0}), Vector3<double>(1, -2, 1)));
  BOOST_TEST(same(euler_torque<double>(T, {0, 0, 0}, {1, 1, 1}), Vector3<double>(1, 2, 3)));
}

// Fixed at its origin: only the rotation is left of the equation of motion.
BOOST_DATA_TEST_CASE(give_the_newtonian_torque, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const std::vector<test::PointMass> masses = sample.solid_masses();
  test::Motion turning = test::motion(sample);
  turning.x = turning.y = turning.z = {};
  const test::Truth truth = test::truth(test::Motion{}, turning, Digits50(0), masses);
  const Symmetric3<> T = cast<double>(test::inertia<Digits50>(masses)).tensor;
  const Vector3<double> u = cast<double>(truth.V_rel.value.resultant);
  const Vector3<double> du = cast<double>(truth.V_rel.T.body.resultant);
  const Vector3<Terms> scale =
      euler_torque(terms(T), terms(u), terms(du)) + Vector3<Terms>::Constant(1e-30);
  BOOST_TEST(near(euler_torque(T, u, du), cast<double>(truth.force.moment), scale, 12));
}

BOOST_AUTO_TEST_SUITE_END()
