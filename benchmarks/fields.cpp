// The cost of a right-hand side against the least code by hand for the same scene: doubles, no
// frames, no unneeded terms. The library's forms are those of a user who declares only the scene;
// benchmarks/pruning.cpp has forms with declarations.

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>

#include "hand_written_fields.hpp"

using namespace kreisel;

namespace {

using by_hand::Gyro;
using by_hand::Top;
using by_hand::V3;

// --- A top with a fixed point ---------------------------------------------------------------------

const V3 top_moments(0.25, 0.27, 0.06);
const V3 top_weight(0.3, -0.2, 4);

// --- Pendulums on the earth ----------------------------------------------------------------------

const V3 earth(-5.15630e-5, 0, 5.15630e-5);  // rad/s, x south, z up
constexpr double gravity = 9.81;
constexpr double arm = 0.45;
const V3 ball_moments(0.25, 0.25, 0.01);

const PendulumBody<> rod = PendulumBody<>::from_reduced_length(0.5);
const PendulumGuide<> meridian{{3e-5, 6e-5, 0}, V3::Zero(), {9.81, 0.01, 0}, {}};

by_hand::PlanePendulum plane_by_hand() {
  const PendulumCoefficients<> c = coefficients(rod, meridian);
  return {c.e() / rod.theta_c, c.f / rod.theta_c, c.h / rod.theta_c, 2 * c.k / rod.theta_c};
}

// --- The Cardan gyro -----------------------------------------------------------------------------

const CardanMoments moments{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4e-4}};
const by_hand::CardanGyro gyro_hand{5e-4, 8e-4, 2e-4, 3e-4, 2.5e-4, 4e-4,
                                    0,    0.5,  1e-3, 1e3,  2,      {0.3, -0.2, 0.1}};
constexpr double outer_stiffness = 0.5, outer_damping = 1e-3, inner_stiffness = 1e3,
                 inner_damping = 2;
const V3 base(0.3, -0.2, 0.1);

// --- Both, timed and compared --------------------------------------------------------------------

constexpr std::size_t count = 64;  // inputs in turn, so that none is a constant

template <class Vector>
std::array<Vector, count> inputs(const Vector& y) {
  std::array<Vector, count> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / count;
    all[i] = y;
    all[i][y.size() - 2] *= 1 + 0.1 * part;
    all[i][y.size() - 1] *= 1 - 0.1 * part;
  }
  return all;
}

const Top top_state = (Top() << 0.1, -0.5, 0.7, 0.5, 0.3, -2, 5).finished();
const Gyro gyro_state = (Gyro() << 0.02, 0.001, 3, 0.5, 0.01, 500).finished();
const Eigen::Vector2d plane_state(0.1, 0.3);

template <class Vector, class Field>
void time(benchmark::State& state, const Vector& start, const Field& field) {
  const auto all = inputs(start);
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      Vector result = field(all[i]);
      benchmark::DoNotOptimize(result);
    }
  }
}

bool good = true;

/// Registers a field of the library and the same by hand; refuses to time two with different
/// results.
template <class Vector, class Field, class ByHand>
void pair(const std::string& name, const Vector& start, const Field& field, const ByHand& by_hand) {
  const Vector y = inputs(start)[7];
  const Vector f = field(y);
  const double off = (f - by_hand(y)).cwiseAbs().maxCoeff() / f.cwiseAbs().maxCoeff();
  if (!(off < 1e-13)) {
    std::fprintf(stderr, "fields: %s and the one by hand differ by %.1e\n", name.c_str(), off);
    good = false;
  }
  benchmark::RegisterBenchmark((name + "/library").c_str(),
                               [start, field](benchmark::State& s) { time(s, start, field); });
  benchmark::RegisterBenchmark((name + "/by_hand").c_str(),
                               [start, by_hand](benchmark::State& s) { time(s, start, by_hand); });
}

}  // namespace

int main(int argc, char** argv) {
  const EulerTop free(top_moments);
  const EulerTop heavy(top_moments, top_weight);
  const by_hand::PrincipalTop hand{top_moments, top_weight};
  const by_hand::BallPendulum ball_hand{ball_moments, earth, arm * gravity};
  const by_hand::CardanGyro hand_gyro = gyro_hand;
  const auto body = InertiaTensor<Body>::about_origin(1, {0, 0, -arm},
                                                      Matrix3<double>(ball_moments.asDiagonal()));
  const RotatingFrame<> ground{earth};
  const UniformGravity<Guide> down{{0, 0, -gravity}};
  const FixedPointBody ball(body, V3::Zero(), ground, down);
  const FixedPointBody hanging(body, V3::Zero(), ground, down, Without<ProductsOfInertia>{},
                               Without<FirstMoment, Axis::x, Axis::y>{},
                               Without<ApparentGravity, Axis::x, Axis::y>{},
                               Without<GuideRate, Axis::y>{});
  const PendulumField plane(rod, meridian);
  const CardanBearings bearings{{outer_stiffness, outer_damping}, {inner_stiffness, inner_damping}};
  const CardanGyro gyro(moments, bearings, RestingFrame<>{});
  const CardanGyro gyro_on_base(moments, bearings, RotatingFrame<>{base});

  pair(
      "free top", top_state, [=](const Top& y) { return free.rates(0, y); },
      [=](const Top& y) { return hand.rates<false>(y); });
  pair(
      "heavy top", top_state, [=](const Top& y) { return heavy.rates(0, y); },
      [=](const Top& y) { return hand.rates<true>(y); });
  pair(
      "plane pendulum on the earth", plane_state,
      [=](const Eigen::Vector2d& y) { return plane(0.0, y); }, plane_by_hand());
  pair(
      "ball pendulum on the earth, its zeros stated", top_state,
      [=](const Top& y) { return hanging.rates(0, y); },
      [=](const Top& y) { return ball_hand.rates(y); });
  pair(
      "ball pendulum on the earth, nothing stated", top_state,
      [=](const Top& y) { return ball.rates(0, y); },
      [=](const Top& y) { return ball_hand.rates(y); });
  pair(
      "Cardan gyro", gyro_state, [=](const Gyro& y) { return gyro.rates(0, y); },
      [=](const Gyro& y) { return hand_gyro.at_rest<false>(y); });
  pair(
      "Cardan gyro on a base that turns", gyro_state,
      [=](const Gyro& y) { return gyro_on_base.rates(0, y); },
      [=](const Gyro& y) { return hand_gyro.on_base<false>(y); });
  if (!good) return EXIT_FAILURE;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
