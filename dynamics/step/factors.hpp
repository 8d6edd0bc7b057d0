#pragma once

#include <Eigen/Core>

#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace kreisel::detail {

/// Sizes and products of real and complex numbers without the care for infinities that the standard
/// takes with complex ones: what is not finite stays so.
[[nodiscard]] inline double size(double a) { return std::abs(a); }
[[nodiscard]] inline double size(const std::complex<double>& a) {
  return std::abs(a.real()) + std::abs(a.imag());
}
[[nodiscard]] inline double times(double a, double b) { return a * b; }
[[nodiscard]] inline std::complex<double> times(const std::complex<double>& a,
                                                const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// The factors L U of a square matrix whose rows are exchanged for the largest pivots, for systems
/// of the few components that a scene has.
///
/// Plain loops: at six complex components they take half the time of Eigen's factors of a size
/// known at run time, at 200 no more (benchmarks/kernels.cpp), and they hardly cost in compiling.
template <class Number>
class Factors {
 public:
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

  /// The matrix to be factorised, until compute() puts its factors there.
  Matrix matrix;

  /// A singular matrix gives solutions that are not finite.
  void compute() {
    const Eigen::Index n = matrix.rows();
    exchanges_.resize(static_cast<std::size_t>(n));
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::Index pivot = k;
      for (Eigen::Index i = k + 1; i < n; ++i) {
        if (size(matrix(i, k)) > size(matrix(pivot, k))) pivot = i;
      }
      exchanges_[static_cast<std::size_t>(k)] = pivot;
      if (pivot != k) matrix.row(k).swap(matrix.row(pivot));
      matrix(k, k) = Number(1) / matrix(k, k);
      for (Eigen::Index i = k + 1; i < n; ++i) matrix(i, k) = times(matrix(i, k), matrix(k, k));
      for (Eigen::Index j = k + 1; j < n; ++j) subtract(k + 1, n, k, matrix(k, j), &matrix(0, j));
    }
  }

  /// Puts the solution in place of the right-hand side.
  void solve(Vector& x) const {
    const Eigen::Index n = matrix.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      std::swap(x[k], x[exchanges_[static_cast<std::size_t>(k)]]);
    }
    for (Eigen::Index k = 0; k < n; ++k) subtract(k + 1, n, k, x[k], x.data());
    for (Eigen::Index k = n - 1; k >= 0; --k) {
      x[k] = times(x[k], matrix(k, k));
      subtract(0, k, k, x[k], x.data());
    }
  }

 private:
  /// Takes `factor` times the rows begin ... end of column k from those of a column.
  void subtract(Eigen::Index begin, Eigen::Index end, Eigen::Index k, Number factor,
                Number* column) const {
    const Number* const from = &matrix(0, k);
    for (Eigen::Index i = begin; i < end; ++i) column[i] -= times(from[i], factor);
  }

  std::vector<Eigen::Index> exchanges_;
};

}  // namespace kreisel::detail
