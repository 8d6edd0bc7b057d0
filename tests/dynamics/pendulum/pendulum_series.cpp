#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <string>

#include <dynamics/model/structure.hpp>
#include <dynamics/pendulum/physical_pendulum.hpp>
#include <dynamics/solve/solve.hpp>

#include <support/series.hpp>

using namespace kreisel;
using test::hold_samples;

namespace {

const PendulumBody<> rod{.mass = 1, .arm = 0.5, .theta_b = 1, .theta_c = 1};
const PendulumBody<> crooked{.mass = 2,
                             .arm = 0.3,
                             .theta_a = 0.7,
                             .theta_b = 1,
                             .theta_c = 0.9,
                             .phi_a = 0.05,
                             .phi_b = -0.04,
                             .phi_c = 0.06};

/// The guide turns, accelerates its rotation, and has gravity at an angle.
const PendulumGuide<> in_a_turn{.angular_velocity = {0.4, -0.9, 0.5},
                                .angular_acceleration = {0.3, 0.2, -0.6},
                                .effective_gravity = {9, 2, -1}};

PendulumGuide<> with_a_gradient() {
  PendulumGuide<> guide = in_a_turn;
  guide.gravity_gradient = Eigen::Matrix3d{{0.5, 0.1, -0.2}, {0.1, -0.3, 0.15}, {-0.2, 0.15, -0.2}};
  return guide;
}

template <class Scene>
concept KnowsSeries = requires(const Scene& scene) {
  scene.series();
};

}  // namespace

BOOST_AUTO_TEST_SUITE(pendulum_series)

BOOST_AUTO_TEST_CASE(agrees_with_its_field) {
  hold_samples("at rest", PhysicalPendulum(crooked, RestingPendulumGuide<>{9.81}));
  hold_samples("in a turn", PhysicalPendulum(crooked, in_a_turn));
  hold_samples("with a gradient", PhysicalPendulum(crooked, with_a_gradient()));
  hold_samples("on principal axes",
               PhysicalPendulum(rod, in_a_turn, NoDamping{}, Without<ProductsOfInertia>{}));
}

BOOST_AUTO_TEST_CASE(is_unavailable_with_damping_or_changes) {
  const auto turning = [](double /*t*/) { return in_a_turn; };
  const auto brake = [](const auto& rate) { return 0.1 * rate; };
  static_assert(KnowsSeries<PhysicalPendulum<PendulumGuide<>>>);
  static_assert(!KnowsSeries<decltype(PhysicalPendulum(rod, turning))>);
  static_assert(!KnowsSeries<decltype(PhysicalPendulum(rod, in_a_turn, brake))>);
}

// In an accelerating frame nothing is conserved and no closed form is known. Compared with Verner's
// steps, which use the field.
BOOST_AUTO_TEST_CASE(moves_the_pendulum_on_a_turning_guide) {
  const PhysicalPendulum pendulum(crooked, in_a_turn);
  const auto by = [&](Method method) {
    return solve(pendulum, {.angle = 0.5, .rate = 2},
                 {.output_times = {1, 30}, .tolerance = 1e-12, .method = method});
  };
  const auto run = by(Method::automatic);
  const auto other = by(Method::verner98);
  BOOST_TEST(run.report.method == "taylor");
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(other.report.tolerance_kept);
  BOOST_TEST(run.report.all_evaluations < other.report.all_evaluations);
  for (std::size_t i = 0; i < 2; ++i) {
    BOOST_TEST(std::abs(run.states[i].angle - other.states[i].angle) <=
               2e-12 * std::abs(run.states[i].angle));
    BOOST_TEST(std::abs(run.states[i].rate - other.states[i].rate) <=
               2e-12 * std::abs(run.states[i].rate));
  }
}

BOOST_AUTO_TEST_SUITE_END()
