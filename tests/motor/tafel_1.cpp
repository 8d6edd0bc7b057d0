#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cstddef>
#include <functional>

#include <dynamics/inertia.hpp>
#include <dynamics/law/relative.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>
#include <motor/screw.hpp>

#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>
#include <support/sample.hpp>

/// Paper 002, (11)-(17) and Tafel 1, as corrected in docs/errata.md.
///
/// The letters are the paper's: u, v the guide motor F and u1, v1 the relative motor V' at O'. A
/// mark star, ring, dot names the observer: body, guide, inertial frame. T is the moment of the
/// differentiated motor, P the derivative of the vector at the moving O'.

using namespace kreisel;
using test::cast;
using test::Digits50;
using test::near;
using test::Truth;
namespace data = boost::unit_test::data;

namespace {

using Vector = Vector3<double>;
using Relative = Velocity<Body, Guide, Body>;
using Guiding = Velocity<Guide, Inertial, Body>;

Vector x(const Vector& a, const Vector& b) { return a.cross(b); }

/// Derivatives of one motor's vectors in one sense.
struct Marked {
  Motor<> star, ring, dot;
};

/// All symbols of (12)-(17) and Tafel 1 at one time.
struct Symbols {
  Motor<> V_rel, F;
  Marked T_rel, T_guide, P_rel, P_guide;
  Displacement<Guide, Body> X_GB;
  Displacement<Inertial, Guide> X_IG;

  /// A scale for every relation: each is a sum of these rates and of products of velocities.
  [[nodiscard]] double size() const {
    const double products =
        (test::size(V_rel) + test::size(F)) * (test::size(V_rel) + test::size(F));
    double rates = 0;
    for (const Marked& marked : {T_rel, T_guide, P_rel, P_guide}) {
      rates += test::size(marked.star) + test::size(marked.ring) + test::size(marked.dot);
    }
    return products + rates + 1e-30;
  }
};

Marked rounded(const test::Derivatives& d) {
  return {cast<double>(d.body), cast<double>(d.guide), cast<double>(d.inertial)};
}

/// All of it from differentiating coordinates.
Symbols differentiated(const Truth& t) {
  return {cast<double>(t.V_rel.value), cast<double>(t.F.value),
          rounded(t.V_rel.T),          rounded(t.F.T),
          rounded(t.V_rel.P),          rounded(t.F.P),
          {cast<double>(t.X_GB)},      {cast<double>(t.X_IG)}};
}

/// The same from V', F, *V' and oF by the library's conversions alone.
Symbols converted(const Symbols& s) {
  const Relative V_rel{s.V_rel};
  const Guiding F{s.F};
  const auto V = V_rel + F;
  const Rate<Body, Relative> starV{s.T_rel.star};
  const Rate<Guide, Guiding> ringF{s.T_guide.ring};
  const auto ringV = seen_from<Guide>(starV, -V_rel, V_rel);
  const auto dotV = seen_from<Inertial>(ringV, -F, V_rel);
  const auto starF = seen_from<Body>(ringF, V_rel, F);
  const auto dotF = seen_from<Inertial>(ringF, -F, F);

  Symbols c = s;
  c.T_rel = {starV.value, ringV.value, dotV.value};
  c.T_guide = {starF.value, ringF.value, dotF.value};
  c.P_rel = {plain_rate(starV).value, plain_rate(ringV, V_rel, V_rel).value,
             plain_rate(dotV, V, V_rel).value};
  c.P_guide = {plain_rate(starF).value, plain_rate(ringF, V_rel, F).value,
               plain_rate(dotF, V, F).value};
  return c;
}

Symbols random_symbols(unsigned seed) {
  test::Sample sample(seed);
  return differentiated(truth(sample, {}));
}

Truth reference_truth(std::size_t number) {
  const test::ReferenceCase c = test::reference_cases().at(number);
  return test::truth(c.guide, c.relative, c.t, {});
}

/// A relation  left = right  between the symbols in one sense.
struct Relation {
  const char* number;
  std::function<Vector(const Symbols&, const Marked&rel, const Marked&guide)> left, right;
  bool holds_in_T, holds_in_P;
};

// One relation a line.
// clang-format off
#define SIDE(expression)                                                   \
  [](const Symbols& s, const Marked& rel, const Marked& guide) -> Vector { \
    const auto& [u1, v1] = s.V_rel;                                        \
    const auto& [u, v] = s.F;                                              \
    (void)u1;                                                              \
    (void)v1;                                                              \
    (void)u;                                                               \
    (void)v;                                                               \
    (void)rel;                                                             \
    (void)guide;                                                           \
    return expression;                                                     \
  }

const Relation relations[] = {
    {"16a", SIDE(rel.star.resultant), SIDE(rel.ring.resultant), true, true},
    {"16b", SIDE(rel.star.resultant), SIDE(rel.dot.resultant - x(u, u1)), true, true},
    {"16c", SIDE(rel.ring.resultant), SIDE(rel.dot.resultant - x(u, u1)), true, true},
    {"16d", SIDE(guide.dot.resultant), SIDE(guide.ring.resultant), true, true},
    {"16e", SIDE(guide.dot.resultant), SIDE(guide.star.resultant - x(u, u1)), true, true},
    {"16f", SIDE(guide.ring.resultant), SIDE(guide.star.resultant - x(u, u1)), true, true},
    // as printed
    {"17a", SIDE(rel.star.moment), SIDE(rel.ring.moment - x(u1, v1)), false, true},
    {"17b", SIDE(rel.star.moment), SIDE(rel.dot.moment - x(u1, v1) + x(u1, v) + x(v1, u)), false,
     false},
    {"17c", SIDE(rel.ring.moment), SIDE(rel.dot.moment + x(u1, v) + x(v1, u)), true, false},
    {"17d", SIDE(guide.dot.moment), SIDE(guide.ring.moment + x(u, v)), false, true},
    {"17e", SIDE(guide.dot.moment), SIDE(guide.star.moment + x(u, v) + x(u1, v) + x(v1, u)), false,
     false},
    {"17f", SIDE(guide.ring.moment), SIDE(guide.star.moment + x(u1, v) + x(v1, u)), true, false},
    // corrected: the value in the other sense
    {"17a in T", SIDE(rel.star.moment), SIDE(rel.ring.moment), true, false},
    {"17b in T", SIDE(rel.star.moment), SIDE(rel.dot.moment + x(u1, v) + x(v1, u)), true, false},
    {"17b in P", SIDE(rel.star.moment), SIDE(rel.dot.moment - x(u + u1, v1)), false, true},
    {"17c in P", SIDE(rel.ring.moment), SIDE(rel.dot.moment - x(u, v1)), false, true},
    {"17d in T", SIDE(guide.dot.moment), SIDE(guide.ring.moment), true, false},
    {"17e in T", SIDE(guide.dot.moment), SIDE(guide.star.moment + x(u1, v) + x(v1, u)), true,
     false},
    {"17e in P", SIDE(guide.dot.moment), SIDE(guide.star.moment + x(u + u1, v)), false, true},
    {"17f in P", SIDE(guide.ring.moment), SIDE(guide.star.moment + x(u1, v)), false, true},
};

/// A cell of Tafel 1: the moment at O' of a differentiated motor, expressed by the derivatives of
/// the column's frame. Bracket relations as printed, all symbols in the sense T.
struct Cell {
  const char* name;
  std::function<Vector(const Symbols&, const Marked& rel, const Marked& guide)> moment;
};

const Cell cells[6][3] = {{{"*V' in S*", SIDE(rel.star.moment)},
                           {"*V' in So", SIDE(rel.ring.moment)},
                           {"*V' in S'", SIDE(rel.dot.moment + x(u1, v) + x(v1, u))}},
                          {{"oV' in S*", SIDE(rel.star.moment)},
                           {"oV' in So", SIDE(rel.ring.moment)},
                           {"oV' in S'", SIDE(rel.dot.moment + x(u1, v) + x(v1, u))}},
                          {{".V' in S*", SIDE(rel.star.moment + x(v, u1) + x(u, v1))},
                           {".V' in So", SIDE(rel.ring.moment + x(v, u1) + x(u, v1))},
                           {".V' in S'", SIDE(rel.dot.moment)}},
                          {{"*F in S*", SIDE(guide.star.moment)},
                           {"*F in So", SIDE(guide.ring.moment + x(v, u1) + x(u, v1))},
                           {"*F in S'", SIDE(guide.dot.moment + x(v, u1) + x(u, v1))}},
                          {{"oF in S*", SIDE(guide.star.moment + x(u1, v) + x(v1, u))},
                           {"oF in So", SIDE(guide.ring.moment)},
                           {"oF in S'", SIDE(guide.dot.moment)}},
                          {{".F in S*", SIDE(guide.star.moment + x(u1, v) + x(v1, u))},
                           {".F in So", SIDE(guide.ring.moment)},
                           {".F in S'", SIDE(guide.dot.moment)}}};

/// The corrected table in P, one entry for all three columns.
const Cell plain_cells[6] = {{"*V'", SIDE(rel.star.moment)},
                             {"oV'", SIDE(rel.ring.moment + x(v1, u1))},
                             {".V'", SIDE(rel.dot.moment + x(v + v1, u1))},
                             {"*F", SIDE(guide.star.moment)},
                             {"oF", SIDE(guide.ring.moment + x(v1, u))},
                             {".F", SIDE(guide.dot.moment + x(v + v1, u))}};

#undef SIDE
// clang-format on

test::Verdict holds(const Relation& r, const Symbols& s, const Marked& rel, const Marked& guide) {
  return near(r.left(s, rel, guide), r.right(s, rel, guide), s.size(), 8, r.number);
}

void check_relations(const Symbols& s) {
  for (const Relation& r : relations) {
    if (r.holds_in_T) BOOST_TEST(holds(r, s, s.T_rel, s.T_guide));
    if (r.holds_in_P) BOOST_TEST(holds(r, s, s.P_rel, s.P_guide));
  }
}

/// The differentiated motor in the frame of a column, with its moment at O' there; on body axes
/// again, so that one vector is compared.
Vector moment_in_body(const Symbols&, const Motor<>& rate) { return rate.moment; }

Vector moment_in_guide(const Symbols& s, const Motor<>& rate) {
  const Pose<>& X = s.X_GB.value;
  return X.rotation.transpose() * (X * rate).reduced_at(X.translation).moment;
}

Vector moment_in_inertial(const Symbols& s, const Motor<>& rate) {
  const Pose<> X = (s.X_IG * s.X_GB).value;
  return X.rotation.transpose() * (X * rate).reduced_at(X.translation).moment;
}

void check_table(const Symbols& s) {
  const Motor<> rows[6] = {s.T_rel.star,   s.T_rel.ring,   s.T_rel.dot,
                           s.T_guide.star, s.T_guide.ring, s.T_guide.dot};
  const auto columns = {moment_in_body, moment_in_guide, moment_in_inertial};
  const double leverage = 1 + (s.X_IG * s.X_GB).value.translation.norm() +
                          s.X_GB.value.translation.norm() + s.X_IG.value.translation.norm();
  for (int row = 0; row < 6; ++row) {
    int column = 0;
    for (const auto& moment_at_Oprime : columns) {
      const Cell& cell = cells[row][column++];
      BOOST_TEST(near(moment_at_Oprime(s, rows[row]), cell.moment(s, s.T_rel, s.T_guide),
                      s.size() * leverage, 32, cell.name));
      BOOST_TEST(near(moment_at_Oprime(s, rows[row]),
                      plain_cells[row].moment(s, s.P_rel, s.P_guide), s.size() * leverage, 32,
                      plain_cells[row].name));
    }
  }
}

/// The derivative of the length v_n = u (u . v)/(u . u) by the quotient rule.
Vector length_rate(const Motor<>& a, const Motor<>& d) {
  const auto& [u, v] = a;
  const auto& [du, dv] = d;
  const double uu = u.dot(u);
  const double p = u.dot(v) / uu;
  const double dp = (du.dot(v) + u.dot(dv) - p * 2 * u.dot(du)) / uu;
  return dp * u + p * du;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(relations_16_and_17)

BOOST_DATA_TEST_CASE(hold_as_the_errata_state, data::xrange(200u), seed) {
  const Symbols s = random_symbols(seed);
  check_relations(s);
  check_relations(converted(s));
}

BOOST_AUTO_TEST_CASE(hold_in_the_reference_case) {
  const Symbols s = differentiated(reference_truth(0));
  check_relations(s);
  check_relations(converted(s));
}

// In a motion as general as I1 none of them holds by chance.
BOOST_AUTO_TEST_CASE(fail_as_the_errata_state) {
  const Symbols s = differentiated(reference_truth(0));
  for (const Relation& r : relations) {
    const Vector in_T = r.left(s, s.T_rel, s.T_guide) - r.right(s, s.T_rel, s.T_guide);
    const Vector in_P = r.left(s, s.P_rel, s.P_guide) - r.right(s, s.P_rel, s.P_guide);
    BOOST_TEST_CONTEXT("(" << r.number << ")") {
      BOOST_TEST((in_T.norm() < 1e-12) == r.holds_in_T);
      BOOST_TEST((in_P.norm() < 1e-12) == r.holds_in_P);
      BOOST_TEST((r.holds_in_T || in_T.norm() > 0.1));
      BOOST_TEST((r.holds_in_P || in_P.norm() > 0.1));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(relations_11_to_15)

// (12), (13) hold for plain vectors: .v_0 = ov_0 + [u v_0]. The moments of .F and oF are equal.
BOOST_DATA_TEST_CASE(equation_13_holds_for_plain_vectors_only, data::xrange(100u), seed) {
  const Symbols s = random_symbols(seed);
  BOOST_TEST(near(s.P_guide.dot.moment,
                  Vector(s.P_guide.ring.moment + x(s.F.resultant, s.F.moment)), s.size(), 8));
  BOOST_TEST(near(s.T_guide.dot.moment, s.T_guide.ring.moment, s.size(), 8));
}

// Corrected (14): the length v_n of F is along u, so .v_n = *v_n + [(u + u') v_n] = *v_n + [u' v_n].
BOOST_DATA_TEST_CASE(equation_14_has_a_superfluous_term, data::xrange(100u), seed) {
  const Symbols s = random_symbols(seed);
  if (s.F.resultant.norm() < 1e-20) return;
  const Vector v_n = length(s.F);
  const Vector dot = length_rate(s.F, s.P_guide.dot);
  const Vector star = length_rate(s.F, s.P_guide.star);
  const double scale = s.size() * (1 + test::size(s.F) / s.F.resultant.norm());
  BOOST_TEST(near(dot, Vector(star + x(s.V_rel.resultant, v_n)), scale, 32));
}

BOOST_AUTO_TEST_CASE(printed_14_errs_by_its_last_term) {
  const Symbols s = differentiated(reference_truth(0));
  const Vector last = x(s.V_rel.moment, s.F.resultant);
  const Vector printed =
      length_rate(s.F, s.P_guide.star) + x(s.V_rel.resultant, length(s.F)) + last;
  BOOST_TEST(near(Vector(printed - length_rate(s.F, s.P_guide.dot)), last, s.size(), 32));
  BOOST_TEST(last.norm() > 0.1);
}

// The length does not depend on the point; its derivative is the same in the plain and the true
// sense.
BOOST_DATA_TEST_CASE(the_length_is_the_same_in_T_and_in_P, data::xrange(100u), seed) {
  const Symbols s = random_symbols(seed);
  if (s.F.resultant.norm() < 1e-20) return;
  const double scale = s.size() * (1 + test::size(s.F) / s.F.resultant.norm());
  BOOST_TEST(near(length_rate(s.F, s.T_guide.dot), length_rate(s.F, s.P_guide.dot), scale, 32));
  BOOST_TEST(near(length_rate(s.F, s.T_guide.ring), length_rate(s.F, s.P_guide.ring), scale, 32));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(tafel_1)

BOOST_AUTO_TEST_CASE(corrected_is_right_in_the_reference_case) {
  const Symbols s = differentiated(reference_truth(0));
  check_table(s);
  check_table(converted(s));
}

BOOST_DATA_TEST_CASE(corrected_is_right, data::xrange(200u), seed) {
  const Symbols s = random_symbols(seed);
  check_table(s);
  check_table(converted(s));
}

// Example K (reference case I3): a particle of 1 kg at O'. The guide turns about a fixed origin with
// 1 rad/s, the body in it with 2, O' = (1, t, 0) in the guide. All x components:
//   T: *v = 1, ov = .v = 0, *v' = ov' = 2, .v' = 3.   True force: -3.
// The printed columns So and S' give other forces for the same motion.
BOOST_AUTO_TEST_CASE(printed_contradicts_the_equation_of_motion) {
  const Truth truth = reference_truth(1);
  const Symbols s = differentiated(truth);
  const auto& [u1, v1] = s.V_rel;
  const auto& [u, v] = s.F;
  const auto moments = [](const Marked& m) {
    return Vector(m.star.moment.x(), m.ring.moment.x(), m.dot.moment.x());
  };
  BOOST_TEST(near(moments(s.T_guide), Vector(1, 0, 0), 1.0, 1));
  BOOST_TEST(near(moments(s.T_rel), Vector(2, 2, 3), 1.0, 1));
  BOOST_TEST(near(moments(s.P_guide), Vector(1, -1, -2), 1.0, 1));
  BOOST_TEST(near(moments(s.P_rel), Vector(2, 0, -1), 1.0, 1));

  const InertiaTensor<Body> particle{{1, {0, 0, 0}, {}}};
  const Relative V_rel{s.V_rel};
  const Guiding F{s.F};
  const auto form_2 = [&](const Vector& dv1, const Vector& dv) {
    return equation_of_motion(particle, V_rel, F,
                              Rate<Body, Relative>{{s.T_rel.star.resultant, dv1}},
                              Rate<Body, Guiding>{{s.T_guide.star.resultant, dv}})
        .total()
        .value.resultant.x();
  };
  const auto form_8 = [&](const Vector& dv1, const Vector& dv) {
    return equation_of_motion(particle, V_rel, F,
                              Rate<Guide, Relative>{{s.T_rel.ring.resultant, dv1}},
                              Rate<Guide, Guiding>{{s.T_guide.ring.resultant, dv}})
        .total()
        .value.resultant.x();
  };
  const auto form_6 = [&](const Vector& dv1, const Vector& dv) {
    return equation_of_motion(particle, V_rel, F,
                              Rate<Inertial, Relative>{{s.T_rel.dot.resultant, dv1}},
                              Rate<Inertial, Guiding>{{s.T_guide.dot.resultant, dv}})
        .total()
        .value.resultant.x();
  };
  const test::HandExampleK K = test::hand_example_K();

  // True: every form, its moments in the sense T. Column S* is the same, with the entries *v' and
  //       *v.
  BOOST_TEST(form_2(s.T_rel.star.moment, s.T_guide.star.moment) == K.force);
  BOOST_TEST(form_8(s.T_rel.ring.moment, s.T_guide.ring.moment) == K.force);
  BOOST_TEST(form_6(s.T_rel.dot.moment, s.T_guide.dot.moment) == K.force);

  // Column So: oV' has ov' and oF has ov; (17a) makes ov' = *v' + [u' v'], (17f) makes ov.
  const Vector ring_v1 = s.T_rel.star.moment + x(u1, v1);
  const Vector ring_v = s.T_guide.star.moment + x(u1, v) + x(v1, u);
  BOOST_TEST(form_8(ring_v1, ring_v) == K.column_So);

  // Column S': .V' has .v' and .F has .v; (17b) makes .v' and (17e) makes .v.
  const Vector dot_v1 = s.T_rel.star.moment + x(u1, v1) - x(u1, v) - x(v1, u);
  const Vector dot_v = s.T_guide.star.moment + x(u, v) + x(u1, v) + x(v1, u);
  BOOST_TEST(form_6(dot_v1, dot_v) == K.column_S_dot);

  // And with the plain derivatives at O'.
  BOOST_TEST(form_6(s.P_rel.dot.moment, s.P_guide.dot.moment) == K.plain);
}

BOOST_AUTO_TEST_SUITE_END()
