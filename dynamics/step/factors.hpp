#pragma once

#include <Eigen/Core>

#include <cmath>
#include <complex>
#include <utility>
#include <vector>

namespace kreisel {

namespace detail {

/// Sizes and products of real and complex numbers, without the standard's special treatment of
/// infinite complex numbers. Values that are not finite stay not finite.
[[nodiscard]] inline double size(double a) { return std::abs(a); }
[[nodiscard]] inline double size(const std::complex<double>& a) {
  return std::abs(a.real()) + std::abs(a.imag());
}
[[nodiscard]] inline double times(double a, double b) { return a * b; }
[[nodiscard]] inline std::complex<double> times(const std::complex<double>& a,
                                                const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

}  // namespace detail

/// LU factorisation of a square matrix with row pivoting, for systems as small as a scene's state.
///
/// Plain loops. With six complex components they take half the time of Eigen's factors of dynamic
/// size, with 200 the same time (benchmarks/kernels.cpp). They compile fast.
template <class Number>
class LuFactors {
 public:
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Number, Eigen::Dynamic, 1>;

  /// The matrix to be factorised; compute() overwrites it with its factors.
  Matrix matrix;

  /// A singular matrix leads to solutions that are not finite.
  void compute() {
    const Eigen::Index n = matrix.rows();
    exchanges_.resize(static_cast<std::size_t>(n));
    for (Eigen::Index k = 0; k < n; ++k) {
      Eigen::Index pivot = k;
      for (Eigen::Index i = k + 1; i < n; ++i) {
        if (detail::size(matrix(i, k)) > detail::size(matrix(pivot, k))) pivot = i;
      }
      exchanges_[static_cast<std::size_t>(k)] = pivot;
      if (pivot != k) matrix.row(k).swap(matrix.row(pivot));
      matrix(k, k) = Number(1) / matrix(k, k);
      for (Eigen::Index i = k + 1; i < n; ++i)
        matrix(i, k) = detail::times(matrix(i, k), matrix(k, k));
      for (Eigen::Index j = k + 1; j < n; ++j) subtract(k + 1, n, k, matrix(k, j), &matrix(0, j));
    }
  }

  /// Overwrites the right-hand side with the solution.
  void solve(Vector& x) const {
    const Eigen::Index n = matrix.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
      std::swap(x[k], x[exchanges_[static_cast<std::size_t>(k)]]);
    }
    for (Eigen::Index k = 0; k < n; ++k) subtract(k + 1, n, k, x[k], x.data());
    for (Eigen::Index k = n - 1; k >= 0; --k) {
      x[k] = detail::times(x[k], matrix(k, k));
      subtract(0, k, k, x[k], x.data());
    }
  }

 private:
  /// Subtracts `factor` times the rows begin ... end of column k from those of a column.
  void subtract(Eigen::Index begin, Eigen::Index end, Eigen::Index k, Number factor,
                Number* column) const {
    const Number* const from = &matrix(0, k);
    for (Eigen::Index i = begin; i < end; ++i) column[i] -= detail::times(from[i], factor);
  }

  std::vector<Eigen::Index> exchanges_;
};

}  // namespace kreisel
