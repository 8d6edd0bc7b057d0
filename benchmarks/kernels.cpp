// The cost of one operation of the motor calculus by kreisel, by hand, in matrices of Eigen and by
// the installed libraries. One factorisation of the stiff integrator is measured too. A contender
// with other results is not timed.

#include <Eigen/LU>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <dynamics/step/factors.hpp>

#include "kernels/contender.hpp"

namespace {

/// The greatest difference, relative to the greatest number.
double difference(const std::vector<double>& found, const std::vector<double>& expected) {
  if (found.size() != expected.size()) return HUGE_VAL;
  double off = 0;
  double size = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    off = std::max(off, std::abs(found[k] - expected[k]));
    size = std::max(size, std::abs(expected[k]));
    if (std::isnan(found[k])) return HUGE_VAL;
  }
  return off / size;
}

/// Returns true if all contenders have the same results.
bool register_kernels() {
  bool good = true;
  const std::vector<kernels::Contender> all = kernels::contenders();
  std::map<std::string, const kernels::Contender*> first;
  for (const kernels::Contender& c : all) {
    const kernels::Contender& expected = *first.try_emplace(c.operation, &c).first->second;
    double off = 0;
    for (std::size_t i = 0; i < kernels::inputs; ++i) {
      off = std::max(off, difference(c.answer(i), expected.answer(i)));
    }
    const std::string name = c.operation + ": " + c.name;
    if (!(off <= 1e-13)) {
      std::fprintf(stderr, "kernels: %s differs by %.1e\n", name.c_str(), off);
      good = false;
      continue;
    }
    benchmark::RegisterBenchmark(name.c_str(), [run = c.run](benchmark::State& state) {
      while (state.KeepRunningBatch(kernels::inputs)) run(kernels::inputs);
    });
  }
  return good;
}

void factors(benchmark::State& state) {
  const auto n = static_cast<Eigen::Index>(state.range(0));
  const Eigen::MatrixXcd A = Eigen::MatrixXcd::Random(n, n);
  const Eigen::VectorXcd b = Eigen::VectorXcd::Random(n);
  kreisel::LuFactors<std::complex<double>> lu;
  Eigen::VectorXcd x;
  for (auto _ : state) {
    lu.matrix = A;
    lu.compute();
    x = b;
    lu.solve(x);
    benchmark::DoNotOptimize(x);
  }
}

void factors_by_eigen(benchmark::State& state) {
  const auto n = static_cast<Eigen::Index>(state.range(0));
  const Eigen::MatrixXcd A = Eigen::MatrixXcd::Random(n, n);
  const Eigen::VectorXcd b = Eigen::VectorXcd::Random(n);
  Eigen::PartialPivLU<Eigen::MatrixXcd> lu;
  Eigen::VectorXcd x;
  for (auto _ : state) {
    lu.compute(A);
    x = lu.solve(b);
    benchmark::DoNotOptimize(x);
  }
}

BENCHMARK(factors)->Arg(6)->Arg(13)->Arg(50)->Arg(200);
BENCHMARK(factors_by_eigen)->Arg(6)->Arg(13)->Arg(50)->Arg(200);

}  // namespace

int main(int argc, char** argv) {
  const bool good = register_kernels();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
