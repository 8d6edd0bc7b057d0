#include <boost/test/unit_test.hpp>

#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/guide/analytic.hpp>
#include <dynamics/guide/any_guide.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/attitude.hpp>

using namespace kreisel;

namespace {

struct Roll {
  template <class T>
  Pose<T> operator()(const T& t) const {
    using std::sin;
    const T roll = 0.2 * sin(0.9 * t);
    return {YawPitchRoll<T>{T(0.1), T(0), roll}.rotation(),
            Vector3<T>(T(5 * t), T(0), T(sin(0.4 * t)))};
  }
};

std::vector<BodyDescription> two_rods() {
  const auto rod = InertiaTensor<Body>::about_centre(
      2, {0, 0, -0.5}, Matrix3<double>(Vector3<double>(0.2, 0.2, 0.01).asDiagonal()));
  return {{.name = "upper", .joint = {JointKind::universal, {1, 0, 0}, {0, 1, 0}}, .inertia = rod},
          {.name = "lower",
           .parent = "upper",
           .joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = {0, 0, -1}},
           .inertia = rod}};
}

UniformGravity<Inertial> weight_of(double g) { return {{0, 0, -g}}; }

template <class M>
void hold_systems(const M& guide) {
  const BodySystem<M> bare(guide, two_rods(), weight_of(9.81));
  const BodySystem<AnyGuide> any(guide, two_rods(), weight_of(9.81));
  const Eigen::VectorXd y = (Eigen::VectorXd(6) << 0.1, -0.2, 0.3, 1, -2, 0.5).finished();
  BodyWorkspace w = bare.workspace();
  JointReactions expected, found;
  for (const double t : {-1.0, 0.0, 0.7, 30.0}) {
    BOOST_TEST((any.rates(t, y) == bare.rates(t, y)));
    bare.reactions(t, y, expected, w);
    any.reactions(t, y, found, w);
    for (std::size_t i = 0; i < expected.on_body.size(); ++i) {
      BOOST_TEST((found.on_body[i].value.resultant == expected.on_body[i].value.resultant));
      BOOST_TEST((found.on_body[i].value.moment == expected.on_body[i].value.moment));
    }
  }
  const SolveOptions options{.t_end = 2, .output_step = 0.5, .tolerance = 1e-9};
  const auto a = solve(bare, bare.from_vector(y), options);
  const auto b = solve(any, any.from_vector(y), options);
  BOOST_TEST(a.report.method == b.report.method);
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    BOOST_TEST((a.states[i].coordinates == b.states[i].coordinates));
    BOOST_TEST((a.states[i].rates == b.states[i].rates));
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(any_guide)

BOOST_AUTO_TEST_CASE(systems_give_the_same_numbers) {
  hold_systems(posed(Roll{}));
  hold_systems(analytic(Roll{}));
  hold_systems([roll = posed(Roll{})](double t) { return roll(2 * t); });
}

// A tree has its series by the type of a steady guide; of any guide by its own series alone.
BOOST_AUTO_TEST_CASE(steady_guides_give_the_same_rates) {
  const RotatingFrame<> turntable{.angular_velocity = {0.1, -0.2, 0.3}};
  const BodySystem<RotatingFrame<>> bare(turntable, two_rods(), weight_of(9.81));
  const BodySystem<AnyGuide> any(turntable, two_rods(), weight_of(9.81));
  const Eigen::VectorXd y = (Eigen::VectorXd(6) << 0.1, -0.2, 0.3, 1, -2, 0.5).finished();
  BOOST_TEST((any.rates(0.7, y) == bare.rates(0.7, y)));
  BOOST_TEST(!any.knows_series());
}

BOOST_AUTO_TEST_CASE(is_a_value_that_can_be_replaced) {
  struct Vehicle {
    AnyGuide guide = RestingFrame<>{};
  };
  Vehicle vehicle;
  const Vehicle before = vehicle;
  vehicle.guide = posed(Roll{});
  BOOST_TEST(before.guide(1).V.value.resultant.isZero(0));
  BOOST_TEST((vehicle.guide(1).V.value.resultant == posed(Roll{})(1).V.value.resultant));
  const Vehicle after = vehicle;
  vehicle = before;
  BOOST_TEST(vehicle.guide(1).V.value.resultant.isZero(0));
  BOOST_TEST(!after.guide(1).V.value.resultant.isZero(0));
  BOOST_TEST(!after.guide.knows_series());
  BOOST_TEST(AnyGuide(analytic(Roll{})).knows_series());
}

BOOST_AUTO_TEST_CASE(wraps_no_wrapper) {
  const AnyGuide inner = analytic(Roll{});
  const AnyGuide outer(inner);
  BOOST_TEST(outer.knows_series());
  BOOST_TEST((outer(1).dV.value.moment == inner(1).dV.value.moment));
}

// Scenes that have series by the type of their guide: automatic has to do without them.
BOOST_AUTO_TEST_CASE(scenes_do_without_series_there_are_not) {
  const auto body_on = [](const auto& guide) {
    const auto rod = InertiaTensor<Body>::about_origin(
        2, {0, 0, -0.5}, Matrix3<double>(Vector3<double>(0.7, 0.7, 0.01).asDiagonal()));
    return FixedPointBody(rod, {0, 0, 0}, guide, weight_of(9.81));
  };
  const SolveOptions options{.t_end = 1};
  for (const AnyGuide& guide : {AnyGuide(posed(Roll{})), AnyGuide(analytic(Roll{}))}) {
    const auto run = solve(body_on(guide), {}, options);
    BOOST_TEST((run.report.status == RunStatus::complete), run.report.message);
    BOOST_TEST(run.report.method == (guide.knows_series() ? "taylor" : "verner98"));
  }
  BOOST_CHECK_THROW((void)AnyGuide(posed(Roll{})).series(0, 1, 1, {}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
