#include <Eigen/Eigenvalues>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cstdio>
#include <type_traits>

#include <dynamics/law/relative.hpp>
#include <dynamics/law/vector_form.hpp>

#include <support/body.hpp>
#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/reference.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::cast;
using test::Digits50;
using test::inertia;
using test::MovingBody;
using test::near;
using test::same;
using test::Terms;
using test::terms;
using test::Typed;
namespace data = boost::unit_test::data;

static_assert(sizeof(ForceParts<Body>) == 18 * sizeof(double));

namespace {

/// Calls check(form, dV_rel, dF) for each of the nine pairs of observers.
template <class S, class Check>
void for_each_form(const Typed<S>& b, const Check& check) {
  check("*V' *F (2)", b.dV_rel.body, b.dF.body);
  check("*V' oF (5)", b.dV_rel.body, b.dF.guide);
  check("*V' .F", b.dV_rel.body, b.dF.inertial);
  check("oV' *F", b.dV_rel.guide, b.dF.body);
  check("oV' oF (8)", b.dV_rel.guide, b.dF.guide);
  check("oV' .F", b.dV_rel.guide, b.dF.inertial);
  check(".V' *F", b.dV_rel.inertial, b.dF.body);
  check(".V' oF", b.dV_rel.inertial, b.dF.guide);
  check(".V' .F (6)", b.dV_rel.inertial, b.dF.inertial);
}

/// The rate of the same name in another scalar.
template <class Observer, class Motor1, class S>
const auto& by(const S& rates) {
  if constexpr (std::is_same_v<Observer, Body>) return rates.body;
  if constexpr (std::is_same_v<Observer, Guide>) return rates.guide;
  if constexpr (std::is_same_v<Observer, Inertial>) return rates.inertial;
}

/// The sizes of all terms of the form with these observers.
template <class OfV, class OfF>
ForceParts<Body, Terms> sizes(const Typed<Terms>& t) {
  return equation_of_motion(t.T, t.V_rel, t.F, by<OfV, Terms>(t.dV_rel), by<OfF, Terms>(t.dF));
}

double relative_error(const Motor<>& x, const Motor<>& y) {
  const auto half = [](const Vector3<double>& a, const Vector3<double>& b) {
    return b.norm() == 0 ? 0.0 : (a - b).norm() / b.norm();
  };
  return test::worst_of(half(x.resultant, y.resultant), half(x.moment, y.moment));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_nine_forms)

// The requirement is 1e-14 of the terms; 16u is 1.8e-15.
BOOST_AUTO_TEST_CASE(give_the_reference_forces) {
  for (const test::ReferenceCase& c : test::reference_cases()) {
    const MovingBody body = test::moving_body(c);
    // All data from the file, none from the kinematics of these tests.
    Typed<double> b;
    b.T = InertiaTensor<Body>::about_origin(static_cast<double>(c.mass), cast<double>(c.r_s),
                                            cast<double>(c.Theta_O));
    b.V_rel = {cast<double>(c.V_rel)};
    b.F = {cast<double>(c.F)};
    b.dV_rel = {{cast<double>(c.dV_rel.body)},
                {cast<double>(c.dV_rel.guide)},
                {cast<double>(c.dV_rel.inertial)}};
    b.dF = {{cast<double>(c.dF.body)}, {cast<double>(c.dF.guide)}, {cast<double>(c.dF.inertial)}};
    const Motor<> force = cast<double>(c.force);
    std::printf("case %s, relative error of the result\n", c.name.c_str());
    for_each_form(b, [&]<class OfV, class DV, class OfF, class DF>(
                         const char* name, const Rate<OfV, DV>& dV_rel, const Rate<OfF, DF>& dF) {
      const auto parts = equation_of_motion(b.T, b.V_rel, b.F, dV_rel, dF);
      static_assert(std::is_same_v<decltype(parts), const ForceParts<Body>>);
      const auto scale = sizes<OfV, OfF>(body.terms()).total();
      std::printf("  %-12s %.1e\n", name, relative_error(parts.total().value, force));
      BOOST_TEST_CONTEXT(name) {
        BOOST_TEST(near(parts.total().value, force, scale.value, 16));
        BOOST_TEST(relative_error(parts.total().value, force) <= 1e-14);
      }
    });
  }
}

// Point masses on prescribed motions, their accelerations in the inertial frame in 50 digits.
BOOST_DATA_TEST_CASE(give_the_newtonian_force, data::xrange(300u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<Terms> t = body.terms();
  const Typed<double> b = body.numbers();
  for_each_form(b, [&]<class OfV, class DV, class OfF, class DF>(
                       const char* name, const Rate<OfV, DV>& dV_rel, const Rate<OfF, DF>& dF) {
    const auto parts = equation_of_motion(b.T, b.V_rel, b.F, dV_rel, dF);
    BOOST_TEST_CONTEXT(name) {
      BOOST_TEST(near(parts.total().value, body.force(), sizes<OfV, OfF>(t).total().value, 20));
    }
  });
}

// The observers are tags: any three frames are allowed, and the axes may be any frame's.
struct Earth {};
struct Ship {};
struct Gyro {};

BOOST_DATA_TEST_CASE(hold_for_any_frames_on_any_axes, data::xrange(100u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Pose<> X = cast<double>(body.truth.X_GB);
  const InertiaTensor<Ship> T{X * b.T.value};
  const Velocity<Gyro, Ship, Ship> V_rel{X * b.V_rel.value};
  const Velocity<Ship, Earth, Ship> F{X * b.F.value};
  const Rate<Gyro, Velocity<Gyro, Ship, Ship>> dV_rel{X * b.dV_rel.body.value};
  const Rate<Ship, Velocity<Ship, Earth, Ship>> dF{X * b.dF.guide.value};
  const auto there = equation_of_motion(T, V_rel, F, dV_rel, dF);
  static_assert(std::is_same_v<decltype(there), const ForceParts<Ship>>);
  const auto here = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide);

  const Typed<Terms> t = body.terms();
  const Pose<Terms> x = terms(X);
  const auto scale = equation_of_motion(InertiaTensor<Body, Terms>{x * t.T.value},
                                        Typed<Terms>::Relative{x * t.V_rel.value},
                                        Typed<Terms>::Guiding{x * t.F.value},
                                        Rate<Body, Typed<Terms>::Relative>{x * t.dV_rel.body.value},
                                        Rate<Guide, Typed<Terms>::Guiding>{x * t.dF.guide.value});
  const auto own = sizes<Body, Guide>(t);
  BOOST_TEST(near(there.relative.value, X * here.relative.value,
                  scale.relative.value + x * own.relative.value, 32));
  BOOST_TEST(
      near(there.guide.value, X * here.guide.value, scale.guide.value + x * own.guide.value, 32));
  BOOST_TEST(near(there.coriolis.value, X * here.coriolis.value,
                  scale.coriolis.value + x * own.coriolis.value, 32));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_parts)

// Anchor: a particle of 2 kg at (3, 0, 0) of a guide that turns with 1 rad/s about z, moving in it
//         with 5 along x, together with O'. Guide: -2 x 3 inwards; Coriolis: 2 x 2 x 5 along y.
BOOST_AUTO_TEST_CASE(by_hand) {
  const InertiaTensor<Body> T{{2, {0, 0, 0}, {}}};
  const Velocity<Body, Guide, Body> V_rel{{{0, 0, 0}, {5, 0, 0}}};
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 1}, {0, 3, 0}}};
  const Rate<Body, Velocity<Body, Guide, Body>> dV_rel{};
  const Rate<Guide, Velocity<Guide, Inertial, Body>> dF{};
  const auto parts = equation_of_motion(T, V_rel, F, dV_rel, dF);
  BOOST_TEST(same(parts.relative.value, Motor<>{}));
  BOOST_TEST(same(parts.guide.value, Motor<>{{-6, 0, 0}, {0, 0, 0}}));
  BOOST_TEST(same(parts.coriolis.value, Motor<>{{0, 20, 0}, {0, 0, 0}}));
  BOOST_TEST(same(parts.total().value, Motor<>{{-6, 20, 0}, {0, 0, 0}}));
}

// Relative: the force in an inertial guide, the guide's rate of T V'.
BOOST_DATA_TEST_CASE(relative_part_does_not_depend_on_the_guide, data::xrange(100u), seed) {
  const MovingBody body = test::moving_body(seed);
  const Typed<double> b = body.numbers();
  const Typed<Terms> t = body.terms();
  const Motor<> expected = cast<double>(body.truth.J.T.guide);
  const auto form_5 = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide);
  const auto form_8 = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.guide, b.dF.guide);
  BOOST_TEST(near(form_5.relative.value, expected, sizes<Body, Guide>(t).relative.value, 16));
  BOOST_TEST(near(form_8.relative.value, expected, sizes<Guide, Guide>(t).relative.value, 16));
}

// Guide, in form (5): the force on a body at rest in the guide.
BOOST_DATA_TEST_CASE(guide_part_is_the_force_of_a_body_at_rest, data::xrange(100u), seed) {
  test::Sample sample(seed);
  const std::vector<test::PointMass> masses = sample.solid_masses();
  const test::Motion guide = test::motion(sample);
  const test::Motion relative = test::motion(sample);
  const MovingBody body{masses, test::truth(guide, relative, Digits50(0), masses),
                        inertia<Digits50>(masses)};
  const test::Truth rest = test::truth(guide, relative.still(0), Digits50(0), masses);
  const Typed<double> b = body.numbers();
  const auto scale = sizes<Body, Guide>(body.terms());
  for_each_form(b, [&]<class OfV, class DV, class OfF, class DF>(
                       const char* name, const Rate<OfV, DV>& dV_rel, const Rate<OfF, DF>& dF) {
    if constexpr (std::is_same_v<OfF, Guide>) {
      const auto parts = equation_of_motion(b.T, b.V_rel, b.F, dV_rel, dF);
      BOOST_TEST_CONTEXT(name) {
        BOOST_TEST(near(parts.guide.value, cast<double>(rest.force), scale.guide.value, 16));
      }
    }
  });
}

BOOST_DATA_TEST_CASE(guide_part_does_not_depend_on_the_body, data::xrange(20u), seed) {
  const Typed<double> b = test::moving_body(seed).numbers();
  const Typed<double> other = test::moving_body(seed + 1000).numbers();
  const auto one = equation_of_motion(b.T, b.V_rel, b.F, b.dV_rel.body, b.dF.guide);
  const auto two = equation_of_motion(b.T, other.V_rel, b.F, other.dV_rel.body, b.dF.guide);
  BOOST_TEST(same(one.guide.value, two.guide.value));
}

BOOST_DATA_TEST_CASE(coriolis_part_vanishes_if_either_rests, data::xrange(20u), seed) {
  const Typed<double> b = test::moving_body(seed).numbers();
  const auto in_rest =
      equation_of_motion(b.T, Velocity<Body, Guide, Body>{}, b.F, b.dV_rel.body, b.dF.guide);
  const auto in_still = equation_of_motion(b.T, b.V_rel, Velocity<Guide, Inertial, Body>{},
                                           b.dV_rel.body, b.dF.guide);
  BOOST_TEST(in_rest.coriolis.value.resultant.norm() == 0);
  BOOST_TEST(in_rest.coriolis.value.moment.norm() == 0);
  BOOST_TEST(in_still.coriolis.value.resultant.norm() == 0);
  BOOST_TEST(in_still.coriolis.value.moment.norm() == 0);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(the_relative_acceleration)

template <class Observer, class OfF, class DF>
void check_acceleration(const MovingBody& body, const Rate<OfF, DF>& dF) {
  const Typed<double> b = body.numbers();
  const Force<Body> P{body.force()};
  const auto dV = relative_acceleration<Observer>(b.T, P, b.V_rel, b.F, dF);
  static_assert(std::is_same_v<decltype(dV), const Rate<Observer, Velocity<Body, Guide, Body>>>);

  // The error of the force, through the inverse of the inertia: see solve() in inertia.cpp.
  const auto scale = sizes<Observer, OfF>(body.terms()).total().value;
  const Inertia<>& T = b.T.value;
  const Vector3<double> r = T.first_moment / T.mass;
  const Matrix3<double> about_centre =
      (T.tensor - offset_product(r, Vector3<double>(T.first_moment / 2))).matrix();
  const double least = about_centre.selfadjointView<Eigen::Lower>().eigenvalues()[0];
  const Vector3<Terms> torque = scale.moment + terms(r).cross(scale.resultant);
  double size = 0;
  double push = 0;
  for (int i = 0; i < 3; ++i) {
    size = std::max(size, torque[i].size);
    push = std::max(push, scale.resultant[i].size);
  }
  const double angular = T.tensor.matrix().norm() / least * size / least;
  const Motor<> exact = cast<double>(body.truth.V_rel.T.by<Observer>());
  BOOST_TEST(near(dV.value.resultant, exact.resultant, angular, 24));
  BOOST_TEST(near(dV.value.moment, exact.moment, angular * r.norm() + push / T.mass, 24));
}

BOOST_DATA_TEST_CASE(agrees_with_the_motion_for_all_observers, data::xrange(200u), seed) {
  const MovingBody body = test::moving_body(seed);
  const auto& dF = body.numbers().dF;
  check_acceleration<Body>(body, dF.body);
  check_acceleration<Body>(body, dF.guide);
  check_acceleration<Body>(body, dF.inertial);
  check_acceleration<Guide>(body, dF.body);
  check_acceleration<Guide>(body, dF.guide);
  check_acceleration<Guide>(body, dF.inertial);
  check_acceleration<Inertial>(body, dF.body);
  check_acceleration<Inertial>(body, dF.guide);
  check_acceleration<Inertial>(body, dF.inertial);
}

// Anchor: without force in a guide that turns with 1 rad/s about z, a particle at rest at (3, 0, 0)
//         accelerates outwards with 3.
BOOST_AUTO_TEST_CASE(by_hand) {
  const InertiaTensor<Body> T{{2, {0, 0, 0}, {1, 1, 1, 0, 0, 0}}};
  const Velocity<Guide, Inertial, Body> F{{{0, 0, 1}, {0, 3, 0}}};
  const Rate<Guide, Velocity<Guide, Inertial, Body>> dF{};
  const auto dV =
      relative_acceleration<Body>(T, Force<Body>{}, Velocity<Body, Guide, Body>{}, F, dF);
  BOOST_TEST(same(dV.value, Motor<>{{0, 0, 0}, {3, 0, 0}}));
}

BOOST_AUTO_TEST_CASE(refuses_a_point_body) {
  const InertiaTensor<Body> point{{2, {0, 0, 0}, {}}};
  const Rate<Guide, Velocity<Guide, Inertial, Body>> dF{};
  BOOST_CHECK_THROW(
      (void)relative_acceleration<Body>(point, Force<Body>{}, Velocity<Body, Guide, Body>{},
                                        Velocity<Guide, Inertial, Body>{}, dF),
      ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
