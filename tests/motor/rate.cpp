#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <type_traits>

#include <motor/frame.hpp>
#include <motor/rate.hpp>

#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>
#include <support/sample.hpp>
#include <support/terms.hpp>

using namespace kreisel;
using test::cast;
using test::Differentiated;
using test::Digits50;
using test::near;
using test::same;
using test::Terms;
using test::terms;
using test::Truth;
namespace data = boost::unit_test::data;

namespace {

using Relative = Velocity<Body, Guide, Body>;
using Guiding = Velocity<Guide, Inertial, Body>;
using Absolute = Velocity<Body, Inertial, Body>;

static_assert(sizeof(Rate<Guide, Relative>) == 6 * sizeof(double));
static_assert(sizeof(Rate<Body, Rate<Guide, Force<Body>>>) == 6 * sizeof(double));
static_assert(sizeof(PlainRate<Guide, Relative>) == 6 * sizeof(double));

/// Numbers of a kinematic truth, rounded to double, with their types.
struct Rounded {
  explicit Rounded(const Truth& truth)
      : V_rel{cast<double>(truth.V_rel.value)}, F{cast<double>(truth.F.value)} {}

  Relative V_rel;
  Guiding F;
  Absolute V = V_rel + F;

  /// The velocity of New against Old.
  template <class New, class Old>
  [[nodiscard]] Velocity<New, Old, Body> of() const {
    if constexpr (std::is_same_v<New, Old>) {
      return {};
    } else if constexpr (std::is_same_v<New, Body>) {
      if constexpr (std::is_same_v<Old, Guide>) return V_rel;
      if constexpr (std::is_same_v<Old, Inertial>) return V;
    } else if constexpr (std::is_same_v<New, Guide> && std::is_same_v<Old, Inertial>) {
      return F;
    } else {
      return -of<Old, New>();
    }
  }
};

Truth random_truth(unsigned seed) {
  test::Sample sample(seed);
  return truth(sample, sample.masses());
}

/// The scale of all sums of a rate and one product, and the residue of a zero in 50 digits.
Motor<Terms> scale(const Motor<>& rate, const Motor<>& velocity, const Motor<>& q) {
  const Vector3<Terms> zero = Vector3<Terms>::Constant(1e-30);
  return terms(rate) + cross(terms(velocity), terms(q)) + Motor<Terms>{zero, zero};
}

template <class New, class Old, class Q>
void check_seen_from(const Rounded& n, const Differentiated& truth, const Q& q) {
  const Rate<Old, Q> old{cast<double>(truth.T.by<Old>())};
  const auto V = n.of<New, Old>();
  const Rate<New, Q> seen = seen_from<New>(old, V, q);
  BOOST_TEST(
      near(seen.value, cast<double>(truth.T.by<New>()), scale(old.value, V.value, q.value), 12));
}

template <class Q>
void check_all_observers(const Rounded& n, const Differentiated& truth, const Q& q) {
  check_seen_from<Body, Guide>(n, truth, q);
  check_seen_from<Body, Inertial>(n, truth, q);
  check_seen_from<Guide, Body>(n, truth, q);
  check_seen_from<Guide, Inertial>(n, truth, q);
  check_seen_from<Inertial, Body>(n, truth, q);
  check_seen_from<Inertial, Guide>(n, truth, q);
}

template <class Observer, class Q>
void check_plain(const Rounded& n, const Differentiated& truth, const Q& q) {
  const Velocity<Body, Observer, Body> V = n.of<Body, Observer>();
  const Rate<Observer, Q> T{cast<double>(truth.T.by<Observer>())};
  const PlainRate<Observer, Q> P{cast<double>(truth.P.by<Observer>())};
  const Motor<Terms> size = scale(T.value, V.value, q.value) + terms(P.value);
  BOOST_TEST(near(plain_rate(T, V, q).value, P.value, size, 8));
  BOOST_TEST(near(true_rate(P, V, q).value, T.value, size, 8));
  BOOST_TEST(near(true_rate(plain_rate(T, V, q), V, q).value, T.value, size, 4));
  if constexpr (std::is_same_v<Observer, Body>) {
    BOOST_TEST(same(plain_rate(T).value, P.value));
    BOOST_TEST(same(true_rate(P).value, T.value));
  }
}

template <class Q>
void check_plain_all(const Rounded& n, const Differentiated& truth, const Q& q) {
  check_plain<Body>(n, truth, q);
  check_plain<Guide>(n, truth, q);
  check_plain<Inertial>(n, truth, q);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_rate)

// Anchor: for an observer who turns about z, a resting vector along x turns backwards, to -y.
BOOST_AUTO_TEST_CASE(rotates_backwards_for_a_turning_observer) {
  const Force<Body> weight{{{1, 0, 0}, {0, 0, 0}}};
  const Rate<Inertial, Force<Body>> none{};
  const Velocity<Guide, Inertial, Body> spin{{{0, 0, 1}, {0, 0, 0}}};
  BOOST_TEST(same(seen_from<Guide>(none, spin, weight).value, Motor<>{{0, -1, 0}, {0, 0, 0}}));
}

// Anchor: a resting force along z, seen from a frame that moves along x. In that frame its line
//         moves along -x, so that the moment about the frame's origin changes by -x cross z = y.
BOOST_AUTO_TEST_CASE(is_opposite_for_a_moving_observer) {
  const Force<Body> weight{{{0, 0, 1}, {0, 0, 0}}};
  const Rate<Inertial, Force<Body>> none{};
  const Velocity<Guide, Inertial, Body> along{{{0, 0, 0}, {1, 0, 0}}};
  BOOST_TEST(same(seen_from<Guide>(none, along, weight).value, Motor<>{{0, 0, 0}, {0, 1, 0}}));
}

BOOST_DATA_TEST_CASE(agrees_with_differentiated_coordinates, data::xrange(200u), seed) {
  const Truth truth = random_truth(seed);
  const Rounded n(truth);
  check_all_observers(n, truth.V_rel, n.V_rel);
  check_all_observers(n, truth.F, n.F);
  check_all_observers(n, truth.J, Momentum<Body>{cast<double>(truth.J.value)});
  check_all_observers(n, truth.J_f, Momentum<Body>{cast<double>(truth.J_f.value)});
}

// (3a)-(3c), (4a)-(4c): the equal pairs, because no velocity transports itself.
BOOST_DATA_TEST_CASE(is_equal_for_both_frames_of_a_velocity, data::xrange(100u), seed) {
  const Truth truth = random_truth(seed);
  const Rounded n(truth);
  const Rate<Body, Relative> own{cast<double>(truth.V_rel.T.body)};
  const Rate<Guide, Guiding> guide{cast<double>(truth.F.T.guide)};
  BOOST_TEST(near(seen_from<Guide>(own, -n.V_rel, n.V_rel).value, own.value,
                  scale(own.value, n.V_rel.value, n.V_rel.value), 2));
  BOOST_TEST(near(seen_from<Inertial>(guide, -n.F, n.F).value, guide.value,
                  scale(guide.value, n.F.value, n.F.value), 2));
  BOOST_TEST(near(own.value, cast<double>(truth.V_rel.T.guide),
                  scale(own.value, n.V_rel.value, n.V_rel.value), 1));
  BOOST_TEST(near(guide.value, cast<double>(truth.F.T.inertial),
                  scale(guide.value, n.F.value, n.F.value), 1));
}

BOOST_DATA_TEST_CASE(is_additive, data::xrange(100u), seed) {
  const Truth truth = random_truth(seed);
  const Rate<Guide, Relative> dV_rel{cast<double>(truth.V_rel.T.guide)};
  const Rate<Guide, Guiding> dF{cast<double>(truth.F.T.guide)};
  const auto dV = dV_rel + dF;
  static_assert(std::is_same_v<decltype(dV), const Rate<Guide, Absolute>>);
  BOOST_TEST(same(dV.value, dV_rel.value + dF.value));
  static_assert(std::is_same_v<decltype(-dV_rel), Rate<Guide, Velocity<Guide, Body, Body>>>);
  static_assert(std::is_same_v<decltype(dV - dF), Rate<Guide, Relative>>);
  const PlainRate<Guide, Relative> pV{dV_rel.value};
  const PlainRate<Guide, Guiding> pF{dF.value};
  static_assert(std::is_same_v<decltype(pV + pF), PlainRate<Guide, Absolute>>);
  static_assert(std::is_same_v<decltype(-pV), PlainRate<Guide, Velocity<Guide, Body, Body>>>);
  BOOST_TEST(same((pV + pF).value, dV.value));
}

// Frame by frame or at once: the body's rate from the inertial one through the guide.
BOOST_DATA_TEST_CASE(is_converted_along_a_chain_of_frames, data::xrange(100u), seed) {
  const Truth truth = random_truth(seed);
  const Rounded n(truth);
  const Momentum<Body> J{cast<double>(truth.J.value)};
  const Rate<Inertial, Momentum<Body>> dJ{cast<double>(truth.J.T.inertial)};
  const auto guide = seen_from<Guide>(dJ, n.F, J);
  const auto steps = seen_from<Body>(guide, n.V_rel, J);
  const auto at_once = seen_from<Body>(dJ, n.V, J);
  const Motor<Terms> size =
      scale(dJ.value, n.F.value, J.value) + scale(dJ.value, n.V_rel.value, J.value);
  BOOST_TEST(near(steps.value, at_once.value, size, 12));
}

// A rate is a motor: rewritten in another frame it is the rate of the rewritten motor.
BOOST_DATA_TEST_CASE(may_be_written_in_any_frame, data::xrange(100u), seed) {
  const Truth truth = random_truth(seed);
  const Rounded n(truth);
  const Displacement<Guide, Body> X_GB{cast<double>(truth.X_GB)};
  const Rate<Guide, Relative> dV{cast<double>(truth.V_rel.T.guide)};
  const auto dV_G = X_GB * dV;
  static_assert(std::is_same_v<decltype(dV_G), const Rate<Guide, Velocity<Body, Guide, Guide>>>);
  const auto there = seen_from<Inertial>(dV_G, X_GB * -n.F, X_GB * n.V_rel);
  const auto here = X_GB * seen_from<Inertial>(dV, -n.F, n.V_rel);
  const auto X = terms(X_GB.value);
  const Motor<Terms> size = X * terms(dV.value) +
                            cross(X * terms(n.F.value), X * terms(n.V_rel.value)) +
                            X * cross(terms(n.F.value), terms(n.V_rel.value));
  BOOST_TEST(near(there.value, here.value, size, 20));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_second_rate)

// (d/dt)_o (d/dt)_o Q from the rates in the inertial frame. The guide turns steadily about z, so
// that F is constant for itself. Q is the quadratic motor Q0 + t Q1 + t^2 Q2 in inertial
// coordinates. In guide coordinates Q is exp(-t F) Q(t): its second derivative at t = 0 is 2 Q2 - 2
// [F Q1] + [F [F Q0]].
BOOST_DATA_TEST_CASE(follows_from_two_conversions, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const Velocity<Guide, Inertial, Body> F{sample.motor(-1, 1)};
  const Force<Body> Q{sample.motor(-1, 1)};
  const Rate<Inertial, Force<Body>> dQ{sample.motor(-1, 1)};
  const Rate<Inertial, Rate<Inertial, Force<Body>>> ddQ{sample.motor(-1, 1)};

  // F is constant for both observers: (d/dt) of o(Q) = .Q - [F Q], term by term.
  const auto oQ = seen_from<Guide>(dQ, F, Q);
  const Rate<Inertial, Rate<Guide, Force<Body>>> of_oQ{ddQ.value - cross(F.value, dQ.value)};
  const auto ooQ = seen_from<Guide>(of_oQ, F, oQ);
  static_assert(std::is_same_v<decltype(ooQ), const Rate<Guide, Rate<Guide, Force<Body>>>>);

  const Motor<> expected =
      ddQ.value - 2.0 * cross(F.value, dQ.value) + cross(F.value, cross(F.value, Q.value));
  const Motor<Terms> f = terms(F.value);
  const Motor<Terms> size =
      terms(ddQ.value) + Terms(2) * cross(f, terms(dQ.value)) + cross(f, cross(f, terms(Q.value)));
  BOOST_TEST(near(ooQ.value, expected, size, 12));

  // The same from the displacement itself: the guide's coordinates of Q at +-h, in 50 digits.
  const auto at = [&](const Digits50& t) {
    const Motor<Digits50> moved = cast<Digits50>(Q.value) + t * cast<Digits50>(dQ.value) +
                                  (t * t / 2) * cast<Digits50>(ddQ.value);
    return exp(-t * cast<Digits50>(F.value)) * moved;
  };
  const Digits50 h("1e-12");
  const Motor<Digits50> second = (at(h) - Digits50(2) * at(0) + at(-h)) / (h * h);
  const Vector3<Terms> tiny = Vector3<Terms>::Constant(1e-3);  // h^2 / u
  BOOST_TEST(near(ooQ.value, cast<double>(second), size + Motor<Terms>{tiny, tiny}, 12));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(plain_and_true)

// Anchor: a resting force, with its moment taken at a point that moves along x. It has no rate, but
//         the moment at the point changes by -x cross force.
BOOST_AUTO_TEST_CASE(differ_by_the_moving_point) {
  const Force<Body> force{{{0, 1, 0}, {0, 0, 0}}};
  const Rate<Guide, Force<Body>> none{};
  const Velocity<Body, Guide, Body> leaving{{{0, 0, 0}, {1, 0, 0}}};
  BOOST_TEST(same(plain_rate(none, leaving, force).value, Motor<>{{0, 0, 0}, {0, 0, -1}}));
}

BOOST_DATA_TEST_CASE(agree_with_differentiation, data::xrange(200u), seed) {
  const Truth truth = random_truth(seed);
  const Rounded n(truth);
  check_plain_all(n, truth.V_rel, n.V_rel);
  check_plain_all(n, truth.F, n.F);
  check_plain_all(n, truth.J, Momentum<Body>{cast<double>(truth.J.value)});
  check_plain_all(n, truth.J_f, Momentum<Body>{cast<double>(truth.J_f.value)});
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_references)

// The kinematics of these tests and the reference file were written independently. Agreement to 23
// digits shows that neither is wrong.
BOOST_AUTO_TEST_CASE(agree_with_the_kinematics_of_these_tests) {
  const double k = 1e-23 / static_cast<double>(test::u<Digits50>);
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const Truth truth = test::truth(c.guide, c.relative, c.t, c.masses);
    const Digits50 one(1);
    const auto agree = [&](const test::Derivatives& x, const test::Derivatives& y) {
      BOOST_TEST(near(x.body, y.body, one, k));
      BOOST_TEST(near(x.guide, y.guide, one, k));
      BOOST_TEST(near(x.inertial, y.inertial, one, k));
    };
    const auto agree_plain = [&](const test::Derivatives& x, const test::Derivatives& y) {
      BOOST_TEST(near(x.body.moment, y.body.moment, one, k));
      BOOST_TEST(near(x.guide.moment, y.guide.moment, one, k));
      BOOST_TEST(near(x.inertial.moment, y.inertial.moment, one, k));
    };
    BOOST_TEST_CONTEXT(c.name) {
      BOOST_TEST(near(truth.V_rel.value, c.V_rel, one, k));
      BOOST_TEST(near(truth.F.value, c.F, one, k));
      agree(truth.V_rel.T, c.dV_rel);
      agree(truth.F.T, c.dF);
      agree_plain(truth.V_rel.P, c.dV_rel_plain);
      agree_plain(truth.F.P, c.dF_plain);
      BOOST_TEST(near(truth.J.value + truth.J_f.value, c.momentum, Digits50(32), k));
      BOOST_TEST(near(truth.force, c.force, Digits50(32), k));
    }
  }
}

template <class Observer, class Q>
void check_reference(const Rounded& n, const test::Derivatives& T, const test::Derivatives& P,
                     const Q& q) {
  const Rate<Observer, Q> rate{cast<double>(T.by<Observer>())};
  const auto V = n.of<Body, Observer>();
  const Motor<Terms> size = scale(rate.value, V.value, q.value);
  BOOST_TEST(near(plain_rate(rate, V, q).value.moment, cast<double>(P.by<Observer>().moment),
                  size.moment, 6));
}

BOOST_AUTO_TEST_CASE(convert_between_plain_and_true) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const Rounded n(test::truth(c.guide, c.relative, c.t, c.masses));
    check_reference<Body>(n, c.dV_rel, c.dV_rel_plain, n.V_rel);
    check_reference<Guide>(n, c.dV_rel, c.dV_rel_plain, n.V_rel);
    check_reference<Inertial>(n, c.dV_rel, c.dV_rel_plain, n.V_rel);
    check_reference<Body>(n, c.dF, c.dF_plain, n.F);
    check_reference<Guide>(n, c.dF, c.dF_plain, n.F);
    check_reference<Inertial>(n, c.dF, c.dF_plain, n.F);
  }
}

BOOST_AUTO_TEST_SUITE_END()
