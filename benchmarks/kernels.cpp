// What one operation of the motor calculus costs, beside the same operation on
// bare arrays or in the representation that was not chosen.

#include <Eigen/LU>
#include <benchmark/benchmark.h>

#include <array>
#include <complex>
#include <random>

#include <dynamics/inertia.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/step/factors.hpp>
#include <motor/displacement.hpp>
#include <motor/frame.hpp>
#include <motor/motor.hpp>

using namespace kreisel;

namespace {

constexpr std::size_t count = 64;  // fits the first-level cache; enough that nothing is a constant

struct Inputs {
  std::array<Motor<double>, count> a;
  std::array<Motor<double>, count> b;
  std::array<Inertia<double>, count> inertia;
  std::array<Pose<double>, count> pose;
  std::array<Eigen::Quaterniond, count> quaternion;

  Inputs() {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto vector = [&] {
      const double x = normal(random);
      const double y = normal(random);
      const double z = normal(random);
      return Vector3<double>(x, y, z);
    };
    for (std::size_t i = 0; i < count; ++i) {
      a[i] = {vector(), vector()};
      b[i] = {vector(), vector()};
      inertia[i] = Pose<double>{Matrix3<double>::Identity(), vector()} *
                   Inertia<double>{2, Vector3<double>::Zero(), {1, 2, 2.5, 0.1, 0.2, 0.3}};
      pose[i] = exp(a[i]);
      quaternion[i] = kreisel::quaternion(pose[i].rotation);
    }
  }
};

const Inputs& inputs() {
  static const Inputs values;
  return values;
}

template <class Operation>
void run(benchmark::State& state, const Operation& operation) {
  const Inputs& in = inputs();
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      auto result = operation(in, i);
      benchmark::DoNotOptimize(result);
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(count));
}

/// [A B] on twelve bare numbers: the floor.
std::array<double, 6> bare_cross(const double* a, const double* b) {
  return {a[1] * b[2] - a[2] * b[1],
          a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0],
          a[1] * b[5] - a[2] * b[4] + a[4] * b[2] - a[5] * b[1],
          a[2] * b[3] - a[0] * b[5] + a[5] * b[0] - a[3] * b[2],
          a[0] * b[4] - a[1] * b[3] + a[3] * b[1] - a[4] * b[0]};
}

using V = Velocity<Body, Guide, Body>;
using F = Velocity<Guide, Inertial, Body>;

}  // namespace

#define KERNEL(name, ...) \
  BENCHMARK_CAPTURE(run, name, [](const Inputs& in, std::size_t i) { return __VA_ARGS__; })

KERNEL(motor_product, cross(in.a[i], in.b[i]));
KERNEL(motor_product_bare, bare_cross(in.a[i].resultant.data(), in.b[i].resultant.data()));
KERNEL(inertia_times_motor, in.inertia[i] * in.a[i]);
KERNEL(motor_tensor_times_motor_36, in.inertia[i].motor_tensor() * in.a[i]);
KERNEL(displace_motor_by_matrix, in.pose[i] * in.a[i]);
KERNEL(displace_motor_by_quaternion, [&] {
  const Vector3<double> r = in.quaternion[i] * in.a[i].resultant;
  return Motor<double>{r, in.quaternion[i] * in.a[i].moment + in.pose[i].translation.cross(r)};
}());
KERNEL(displace_inertia, in.pose[i] * in.inertia[i]);
KERNEL(compose_by_matrix, in.pose[i] * in.pose[(i + 1) % count]);
KERNEL(compose_by_quaternion, [&] {
  const std::size_t j = (i + 1) % count;
  return std::pair(
      in.quaternion[i] * in.quaternion[j],
      Vector3<double>(in.quaternion[i] * in.pose[j].translation + in.pose[i].translation));
}());
KERNEL(momentum_bias, cross(in.a[i], in.inertia[i] * in.a[i]));
KERNEL(exponential, exp(in.a[i]));
KERNEL(logarithm, log(in.pose[i]));
KERNEL(equation_of_motion_form_2,
       equation_of_motion(InertiaTensor<Body>{in.inertia[i]}, V{in.a[i]}, F{in.b[i]},
                          Rate<Body, V>{in.b[i]}, Rate<Body, F>{in.a[i]}));
KERNEL(equation_of_motion_form_5,
       equation_of_motion(InertiaTensor<Body>{in.inertia[i]}, V{in.a[i]}, F{in.b[i]},
                          Rate<Body, V>{in.b[i]}, Rate<Guide, F>{in.a[i]}));
KERNEL(relative_acceleration,
       relative_acceleration<Body>(InertiaTensor<Body>{in.inertia[i]}, Force<Body>{in.b[i]},
                                   V{in.a[i]}, F{in.b[i]}, Rate<Guide, F>{in.a[i]}));

// --- Factors of small systems, as the stiff integrator takes them --------------------------------

void factors(benchmark::State& state) {
  const auto n = static_cast<Eigen::Index>(state.range(0));
  const Eigen::MatrixXcd A = Eigen::MatrixXcd::Random(n, n);
  const Eigen::VectorXcd b = Eigen::VectorXcd::Random(n);
  detail::Factors<std::complex<double>> lu;
  Eigen::VectorXcd x;
  for (auto _ : state) {
    lu.matrix = A;
    lu.compute();
    x = b;
    lu.solve(x);
    benchmark::DoNotOptimize(x);
  }
}
BENCHMARK(factors)->Arg(6)->Arg(13)->Arg(50)->Arg(200);

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
BENCHMARK(factors_by_eigen)->Arg(6)->Arg(13)->Arg(50)->Arg(200);

BENCHMARK_MAIN();
