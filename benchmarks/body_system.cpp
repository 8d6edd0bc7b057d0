// Chains of 1 to 4096 revolute bodies, by BodySystem and by hand. The code by hand has articulated
// bodies and Newton-Euler on body axes for such chains alone, as in textbooks.

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/tree/body_system.hpp>

#include "scenes/chains.hpp"
#include "scenes/hand_written.hpp"

using namespace kreisel;

namespace {

scenes::Chain chain(int n) { return scenes::random_chain(static_cast<std::size_t>(n)); }

struct Start {
  Eigen::VectorXd y;
  Eigen::VectorXd dv;

  explicit Start(int n) : y(2 * n), dv(n) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (double& x : y) x = uniform(random);
    for (double& x : dv) x = uniform(random);
  }
};

using HandWritten = scenes::HandWrittenChain<false>;

template <class M>
struct System {
  BodySystem<M> system;
  BodyWorkspace w;
  Start start;
  Eigen::VectorXd result;

  System(const M& guide, int n)
      : system(guide, described(chain(n)), UniformGravity<Guide>{scenes::vector(chain(n).gravity)}),
        w(system.workspace()),
        start(n) {}
};

RestingFrame<> resting() { return {}; }
RotatingFrame<> moving() {
  return {.angular_velocity = {0.5, 0.25, 1}, .origin_acceleration = {1, 2, 3}};
}

template <auto guide>
void forward(benchmark::State& state) {
  System<decltype(guide())> s(guide(), static_cast<int>(state.range(0)));
  for (auto _ : state) {
    s.start.y[0] += 1e-3;
    s.system.accelerations(0.5, s.start.y, {}, s.result, s.w);
    benchmark::DoNotOptimize(s.result.data());
  }
}

template <auto guide>
void inverse(benchmark::State& state) {
  System<decltype(guide())> s(guide(), static_cast<int>(state.range(0)));
  for (auto _ : state) {
    s.start.y[0] += 1e-3;
    s.system.joint_forces(0.5, s.start.y, s.start.dv, s.result, s.w);
    benchmark::DoNotOptimize(s.result.data());
  }
}

/// The series to order 20, as in solve() at 1e-10.
void series(benchmark::State& state) {
  System<RestingFrame<>> s(resting(), static_cast<int>(state.range(0)));
  auto series = s.system.series();
  Eigen::MatrixXd c(s.start.y.size(), 21);
  c.col(0) = s.start.y;
  for (auto _ : state) {
    c(0, 0) += 1e-3;
    series(0.5, 0.1, 20, c);
    benchmark::DoNotOptimize(c.data());
  }
}

void forward_by_hand(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  HandWritten hand(chain(n));
  Start start(n);
  Eigen::VectorXd result(n);
  for (auto _ : state) {
    start.y[0] += 1e-3;
    hand.forward(start.y.data(), start.y.data() + n, result.data());
    benchmark::DoNotOptimize(result.data());
  }
}

void inverse_by_hand(benchmark::State& state) {
  const auto n = static_cast<int>(state.range(0));
  HandWritten hand(chain(n));
  Start start(n);
  Eigen::VectorXd result(n);
  for (auto _ : state) {
    start.y[0] += 1e-3;
    hand.inverse(start.y.data(), start.y.data() + n, start.dv.data(), result.data());
    benchmark::DoNotOptimize(result.data());
  }
}

/// Refuses to time two computations with different results.
bool both_agree() {
  const int n = 16;
  System<RestingFrame<>> s(resting(), n);
  HandWritten hand(chain(n));
  Eigen::VectorXd by_hand(n);
  const double* q = s.start.y.data();
  s.system.accelerations(0, s.start.y, {}, s.result, s.w);
  hand.forward(q, q + n, by_hand.data());
  const double forward_off = (s.result - by_hand).norm() / by_hand.norm();
  s.system.joint_forces(0, s.start.y, s.start.dv, s.result, s.w);
  hand.inverse(q, q + n, s.start.dv.data(), by_hand.data());
  const double inverse_off = (s.result - by_hand).norm() / by_hand.norm();
  if (forward_off < 1e-11 && inverse_off < 1e-12) return true;
  std::fprintf(stderr,
               "body_system: library and hand-written loop differ by %.1e forward, %.1e "
               "inverse\n",
               forward_off, inverse_off);
  return false;
}

void lengths(benchmark::internal::Benchmark* benchmark) {
  for (const int n : {1, 4, 16, 64, 256, 1024, 4096}) benchmark->Arg(n);
}

}  // namespace

BENCHMARK(forward_by_hand)->Apply(lengths);
BENCHMARK_TEMPLATE(forward, resting)->Apply(lengths);
BENCHMARK_TEMPLATE(forward, moving)->Apply(lengths);
BENCHMARK(series)->Apply(lengths);
BENCHMARK(inverse_by_hand)->Apply(lengths);
BENCHMARK_TEMPLATE(inverse, resting)->Apply(lengths);
BENCHMARK_TEMPLATE(inverse, moving)->Apply(lengths);

int main(int argc, char** argv) {
  if (!both_agree()) return EXIT_FAILURE;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
