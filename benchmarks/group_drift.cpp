// The drift of a rotation off the group and off the truth over many steps: 1e9 equal rotations of
// 2.7e-3 rad by three policies. Usage: group_drift [steps]

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <motor/attitude.hpp>
#include <motor/displacement.hpp>

using namespace kreisel;
using Digits50 = boost::multiprecision::cpp_bin_float_50;

namespace {

const Vector3<double> turn(0.001, -0.002, 0.0015);

/// The angle between the attitude R and the attitude after n exact rotations.
double error(const Matrix3<Digits50>& R, double n) {
  const Vector3<Digits50> w = turn.cast<Digits50>() * Digits50(n);
  const Matrix3<Digits50> exact = exp(Motor<Digits50>{w, {}}).rotation;
  const Pose<Digits50> off{exact.transpose() * R};
  return static_cast<double>(log(off).resultant.norm());
}

template <class Step>
void measure(const char* name, double n, const Step& step) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  const auto begin = std::chrono::steady_clock::now();
  for (double i = 0; i < n; ++i) q = step(q);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const Pose<Digits50> X = Pose<Digits50>::from(q.cast<Digits50>());
  std::printf("| %-34s | %9.1e | %9.1e | %6.1f |\n", name, std::abs(q.norm() - 1),
              error(X.rotation, n), 1e9 * time.count() / n);
}

}  // namespace

int main(int argc, char** argv) {
  const double n = argc > 1 ? std::atof(argv[1]) : 1e9;
  if (!(n >= 1 && n <= 1e12)) {
    std::fprintf(stderr, "group_drift: steps = %s lies outside [1, 1e12]\n", argv[1]);
    return 2;
  }
  std::printf(
      "%.0e turns\n\n| policy | norm error | attitude error, rad | ns/turn "
      "|\n|---|---|---|---|\n",
      n);
  measure("rotated()", n, [](const auto& q) { return rotated(q, turn); });
  measure("rotated(), norm set to 1 each turn", n,
          [](const auto& q) { return rotated(q, turn).normalized(); });
  const Eigen::Quaterniond once = rotated(Eigen::Quaterniond::Identity(), turn);
  measure("product with the rounded exponential", n, [&](const auto& q) { return q * once; });
}
