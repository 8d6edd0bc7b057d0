#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <dynamics/ensemble/packed_steps.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>

#include <support/heap.hpp>
#include <support/near.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::near;

namespace {

constexpr int lanes = Pack::lanes;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Rates of random states on a pack, against those of each single lane, relative to the greatest.
template <class Scene>
double rates_differ_by(const Scene& scene) {
  constexpr int n = int(Scene::Vector::RowsAtCompileTime);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in(-1, 1);
  double worst = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const double t = in(random);
    Eigen::Matrix<Pack, n, 1> y;
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < lanes; ++k) y[i].set_lane(k, in(random));
    }
    const Eigen::Matrix<Pack, n, 1> rates = scene.rates(Pack(t), y);
    for (int k = 0; k < lanes; ++k) {
      typename Scene::Vector own;
      for (int i = 0; i < n; ++i) own[i] = y[i].lane(k);
      const typename Scene::Vector alone = scene.rates(t, own);
      for (int i = 0; i < n; ++i) {
        worst = test::worst_of(worst, std::abs(rates[i].lane(k) - alone[i]) / alone.norm());
      }
    }
  }
  return worst;
}

const CardanMoments round_rotor{.rotor = {0.005, 0.005, 0.008},
                                .inner_ring = {0.002, 0.0015, 0.0028},
                                .outer_ring = {0.006, 0.0045, 0.005}};
const CardanMoments rotor_with_blades{.rotor = {0.005, 0.006, 0.008},
                                      .inner_ring = {0.002, 0.0015, 0.0028},
                                      .outer_ring = {0.006, 0.0045, 0.005}};
const InertiaTensor<Body> brick{{2, {0.01, 0.02, 0.05}, {0.04, 0.05, 0.03, 0.001, 0.002, 0.003}}};

/// Oscillators with a frequency and an amplitude for each lane.
struct Oscillators {
  using Vector = Eigen::Matrix<Pack, 2, 1>;

  Pack frequency;

  Vector operator()(double /*t*/, const Vector& y) const {
    return {frequency * y[1], -frequency * y[0]};
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(packs)

BOOST_AUTO_TEST_CASE(sines_have_nearly_full_precision) {
  using exact = long double;
  const auto off = [](double found, exact truth) {
    return static_cast<double>(std::abs(found - truth));
  };
  std::mt19937 random(2);
  double worst = 0;
  for (const double range : {1.0, 1e3, 1e9}) {
    std::uniform_real_distribution<double> in(-range, range);
    for (int i = 0; i < 20000; ++i) {
      Pack x;
      for (int k = 0; k < lanes; ++k) x.set_lane(k, in(random));
      const Pack s = sin(x), c = cos(x);
      for (int k = 0; k < lanes; ++k) {
        worst = test::worst_of(worst, off(s.lane(k), std::sin(exact(x.lane(k)))));
        worst = test::worst_of(worst, off(c.lane(k), std::cos(exact(x.lane(k)))));
      }
    }
  }
  BOOST_TEST(worst <= 1.2 * eps / 2);
}

BOOST_AUTO_TEST_CASE(sines_exist_for_all_finite_numbers) {
  Pack x(0.5);
  x.set_lane(0, 1e300);
  BOOST_TEST(sin(x).lane(0) == std::sin(1e300));
  BOOST_TEST(cos(x).lane(0) == std::cos(1e300));
  BOOST_TEST(std::abs(sin(x).lane(lanes - 1) - std::sin(0.5)) <= eps);
  x.set_lane(0, std::nan(""));
  BOOST_TEST(std::isnan(sin(x).lane(0)));
  BOOST_TEST(std::isnan(cos(x).lane(0)));
}

BOOST_AUTO_TEST_CASE(select_and_compare_lane_by_lane) {
  Pack x;
  for (int k = 0; k < lanes; ++k) x.set_lane(k, k);
  BOOST_TEST(any(x <= Pack(0)));
  BOOST_TEST(!all(x <= Pack(0)));
  BOOST_TEST(all(x >= Pack(0)));
  BOOST_TEST(!any(x < Pack(0)));
  BOOST_TEST(greatest_lane(x) == lanes - 1);
  x.set_lane(0, std::nan(""));
  BOOST_TEST(std::isnan(greatest_lane(x)));
  const Pack y = select(x > Pack(0), Pack(1), Pack(-1));
  BOOST_TEST(y.lane(0) == -1);
  BOOST_TEST(y.lane(lanes - 1) == 1);
}

// Fused multiplications and the order of sums, which the compiler may choose, cause a few u.
BOOST_AUTO_TEST_CASE(move_scenes_like_doubles) {
  BOOST_TEST(rates_differ_by(EulerTop({0.002, 0.0025, 0.003}, {0.01, 0, 0.05}, {0, 0, 1})) <
             32 * eps);
  BOOST_TEST(rates_differ_by(CardanGyro(round_rotor, {}, RestingFrame<>{})) < 256 * eps);
  BOOST_TEST(rates_differ_by(CardanGyro(rotor_with_blades, {}, RestingFrame<>{})) < 256 * eps);
  const auto moving = [](double t) {
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = {t, 0.2, 0.3};
    motion.dV.value.resultant = {1, 0, 0};
    return motion;
  };
  BOOST_TEST(rates_differ_by(CardanGyro(rotor_with_blades, {}, moving)) < 256 * eps);
  BOOST_TEST(rates_differ_by(FixedPointBody(brick, {0, 0, 0.1}, moving,
                                            UniformGravity<Guide>{{0, 0, -9.81}},
                                            ViscousDrag<>{0.1, 0})) < 256 * eps);
  BOOST_TEST(rates_differ_by(FreeBody(brick, moving, UniformGravity<Guide>{{0, 0, -9.81}})) <
             256 * eps);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(members_that_share_their_steps)

// A small fast oscillator beside a large slow one. Measured relative to the other's size, its error
// might be 1e6 times as large. Each has (error in a step) * (steps) of its own.
BOOST_AUTO_TEST_CASE(each_keep_the_relative_accuracy) {
  constexpr double accuracy = 1e-10;
  Oscillators field{1};
  field.frequency.set_lane(lanes - 1, 10);
  Oscillators::Vector start(1, 0);
  start[0].set_lane(lanes - 1, 1e-6);
  ExplicitRungeKutta steps(field, 0.0, start, {accuracy, 0});
  const double end = 20;
  const auto y = steps.advance_to(end);
  for (int k = 0; k < lanes; ++k) {
    const double amplitude = start[0].lane(k);
    const double x = amplitude * std::cos(field.frequency.lane(k) * end);
    BOOST_TEST(std::abs(y[0].lane(k) - x) <= accuracy * steps.effort().steps * amplitude);
  }
  // The pack takes about as many steps as the fast one alone.
  ExplicitRungeKutta alone(
      [](double, const Eigen::Vector2d& v) { return Eigen::Vector2d(10 * v[1], -10 * v[0]); }, 0.0,
      Eigen::Vector2d(1e-6, 0), {accuracy, 0});
  alone.advance_to(end);
  BOOST_TEST(steps.effort().steps >= alone.effort().steps);
  BOOST_TEST(steps.effort().steps <= 1.1 * alone.effort().steps);
}

BOOST_AUTO_TEST_CASE(agree_with_single_runs) {
  const EulerTop top({0.002, 0.002, 0.003}, {0, 0, 0.05});
  PackedIntegrator<EulerTop>::States starts;
  for (int k = 0; k < lanes; ++k) starts[std::size_t(k)].angular_velocity = {0.3 + k, 0.1, 100};
  const Accuracy accuracy{1e-13};
  PackedIntegrator run(top, 0.0, starts, accuracy);
  const auto half = [&] {
    while (!run.covers(0.5)) run.step_towards(1);
    return run.at(0.5);
  }();
  const auto end = run.to(1);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    Integrator alone(top, 0, starts[k], accuracy);
    const auto differ = [](const EulerTop::State& a, const EulerTop::State& b) {
      return (EulerTop::to_vector(a) - EulerTop::to_vector(b)).norm() / 100;
    };
    // 50 turns of 2 pi in steps of 1e-13.
    BOOST_TEST(differ(alone.to(0.5), half[k]) < 1e-11);
    BOOST_TEST(differ(alone.to(1), end[k]) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(allocate_no_memory_in_steps) {
  const EulerTop top({0.002, 0.002, 0.003}, {0, 0, 0.05});
  PackedIntegrator<EulerTop>::States starts;
  starts.fill({.angular_velocity = {1, 0, 100}});
  PackedIntegrator run(top, 0.0, starts);
  BOOST_TEST(test::heap::requests_of([&] { run.to(1); }) == 0U);
}

// Gimbal lock of massless rings in one lane.
BOOST_AUTO_TEST_CASE(stop_together) {
  const CardanGyro gyro({.rotor = {0.005, 0.005, 0.008}}, {}, RestingFrame<>{});
  PackedIntegrator<std::remove_const_t<decltype(gyro)>>::States starts;
  starts.fill({.phi_rate = 1});
  starts.back().beta = std::acos(0.0);
  PackedIntegrator run(gyro, 0.0, starts);
  BOOST_CHECK_EXCEPTION(run.to(1), ComputationFailed, [](const ComputationFailed& error) {
    return std::string(error.what()).find("gimbal lock") != std::string::npos;
  });
}

BOOST_AUTO_TEST_SUITE_END()
