#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <type_traits>

#include <dynamics/law/momentum.hpp>

#include <support/body.hpp>
#include <support/cast.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>

using namespace kreisel;
using test::cast;
using test::MovingBody;
using test::near;
using test::same;
using test::Terms;
using test::terms;
using test::Typed;
namespace data = boost::unit_test::data;

namespace {

/// The sizes of the terms in (7) and (9).
Force<Body, Terms> balance_sizes(const Typed<Terms>& t) {
  const auto J = t.T * t.V_rel;
  const auto J_f = t.T * t.F;
  return momentum_balance(t.F, J, momentum_rate(t.T, t.V_rel, t.V_rel, t.dV_rel.guide), J_f,
                          momentum_rate(t.T, t.V_rel, t.F, t.dF.guide));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(momentum_motors)

BOOST_AUTO_TEST_CASE(add_up_to_the_reference_momentum) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const MovingBody body = test::moving_body(c);
    const Typed<double> b = body.numbers();
    const Typed<Terms> t = body.terms();
    const Momentum<Body> J = b.T * (b.V_rel + b.F);
    BOOST_TEST(near(J.value, cast<double>(c.momentum), (t.T * t.V_rel + t.T * t.F).value, 12));
  }
}

BOOST_DATA_TEST_CASE(agree_with_the_masses, data::xrange(200u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  BOOST_TEST(
      near((b.T * b.V_rel).value, cast<double>(body.truth.J.value), (t.T * t.V_rel).value, 8));
  BOOST_TEST(near((b.T * b.F).value, cast<double>(body.truth.J_f.value), (t.T * t.F).value, 8));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_momentum_rate)

// Anchor: a particle of 2 kg at O', which moves along x with 5. Seen from the guide its momentum is
//         constant, although its velocity relative to the guide, v = (0, 3, 0) + z cross 5 t x,
//         grows.
BOOST_AUTO_TEST_CASE(by_hand) {
  const InertiaTensor<Body> T{{2, {0, 0, 0}, {}}};
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 0}, {5, 0, 0}}};
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 1}, {0, 3, 0}}};
  const Rate<Guide, Velocity<Body, Guide, Body>> dV_rel{};
  const Rate<Guide, Velocity<Guide, Inertial, Body>> dF{};
  const auto dJ = momentum_rate(T, V_rel, V_rel, dV_rel);
  const auto dJ_f = momentum_rate(T, V_rel, F, dF);
  static_assert(std::is_same_v<decltype(dJ), const Rate<Guide, Momentum<Body>>>);
  BOOST_TEST(same(dJ.value, Motor<>{}));
  // Plainly 2 z cross 5 x = (0, 10, 0); the moment about a point fixed in the guide: 5 x cross 6 y.
  BOOST_TEST(same(dJ_f.value, Motor<>{{0, 10, 0}, {0, 0, 30}}));
}

BOOST_DATA_TEST_CASE(agrees_with_the_masses_in_the_guide, data::xrange(200u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  BOOST_TEST(near(momentum_rate(b.T, b.V_rel, b.V_rel, b.dV_rel.guide).value,
                  cast<double>(body.truth.J.T.guide),
                  momentum_rate(t.T, t.V_rel, t.V_rel, t.dV_rel.guide).value, 16));
  BOOST_TEST(near(momentum_rate(b.T, b.V_rel, b.F, b.dF.guide).value,
                  cast<double>(body.truth.J_f.T.guide),
                  momentum_rate(t.T, t.V_rel, t.F, t.dF.guide).value, 16));
}

// (1): seen from the inertial frame, the rate of T (V' + F) is the force.
BOOST_DATA_TEST_CASE(whole_momentum_rate_is_the_force, data::xrange(200u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const auto V = b.V_rel + b.F;
  const auto V_terms = t.V_rel + t.F;
  const auto dJ = momentum_rate(b.T, V, V, b.dV_rel.inertial + b.dF.inertial);
  static_assert(std::is_same_v<decltype(dJ), const Rate<Inertial, Momentum<Body>>>);
  BOOST_TEST(near(dJ.value, body.force(),
                  momentum_rate(t.T, V_terms, V_terms, t.dV_rel.inertial + t.dF.inertial).value,
                  20));
}

// Paper 002 section 2: o(T V) = oT V + T oV.
BOOST_DATA_TEST_CASE(is_a_product_rule, data::xrange(100u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const Motor<> expected = rate(b.T, b.V_rel).value * b.F.value + b.T.value * b.dF.guide.value;
  const Motor<Terms> scale =
      momentum_rate(t.T, t.V_rel, t.F, t.dF.guide).value + rate(t.T, t.V_rel).value * t.F.value;
  BOOST_TEST(near(momentum_rate(b.T, b.V_rel, b.F, b.dF.guide).value, expected, scale, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_balance_of_momentum)

BOOST_AUTO_TEST_CASE(gives_the_reference_force) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const MovingBody body = test::moving_body(c);
    const Typed<double> b = body.numbers();
    const auto dJ = momentum_rate(b.T, b.V_rel, b.V_rel, b.dV_rel.guide);
    const auto dJ_f = momentum_rate(b.T, b.V_rel, b.F, b.dF.guide);
    const auto P = momentum_balance(b.F, b.T * b.V_rel, dJ, b.T * b.F, dJ_f);
    static_assert(std::is_same_v<decltype(P), const Force<Body>>);
    BOOST_TEST(near(P.value, cast<double>(c.force), balance_sizes(body.terms()).value, 16));
  }
}

// (7), (9) with momenta and rates of the point masses themselves.
BOOST_DATA_TEST_CASE(gives_the_newtonian_force, data::xrange(300u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const auto momentum = [](const auto& x) { return Momentum<Body>{cast<double>(x)}; };
  const auto rate = [](const auto& x) { return Rate<Guide, Momentum<Body>>{cast<double>(x)}; };
  const auto P = momentum_balance(b.F, momentum(body.truth.J.value), rate(body.truth.J.T.guide),
                                  momentum(body.truth.J_f.value), rate(body.truth.J_f.T.guide));
  BOOST_TEST(near(P.value, body.force(), balance_sizes(body.terms()).value, 12));
}

BOOST_AUTO_TEST_SUITE_END()
