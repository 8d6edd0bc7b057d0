#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <utility>

#include <dynamics/solve/fastest_rate.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

/// Makes H an upper Hessenberg matrix with the same eigenvalues, by elimination with the largest
/// pivots.
///
/// Source : J. H. Wilkinson, C. Reinsch, Linear Algebra, II/13, elmhes
KREISEL_DECLARED void reduce_to_hessenberg(Eigen::MatrixXd& H) {
  const Eigen::Index n = H.rows();
  for (Eigen::Index k = 1; k + 1 < n; ++k) {
    Eigen::Index pivot = k;
    for (Eigen::Index i = k + 1; i < n; ++i) {
      if (std::abs(H(i, k - 1)) > std::abs(H(pivot, k - 1))) pivot = i;
    }
    if (H(pivot, k - 1) == 0) continue;
    for (Eigen::Index j = k - 1; j < n; ++j) std::swap(H(pivot, j), H(k, j));
    for (Eigen::Index i = 0; i < n; ++i) std::swap(H(i, pivot), H(i, k));
    for (Eigen::Index i = k + 1; i < n; ++i) {
      const double part = H(i, k - 1) / H(k, k - 1);
      if (part == 0) continue;
      H(i, k - 1) = 0;
      for (Eigen::Index j = k; j < n; ++j) H(i, j) -= part * H(k, j);
      for (Eigen::Index j = 0; j < n; ++j) H(j, k) += part * H(j, i);
    }
  }
}

/// One of Francis's double QR steps, of the rows and columns from `begin` to `end`, more than two,
/// with both eigenvalues of a matrix of that trace and determinant as shifts.
///
/// Source : G. H. Golub, C. F. Van Loan, Matrix Computations, 7.5.1
KREISEL_DECLARED void francis_step(Eigen::MatrixXd& H, Eigen::Index begin, Eigen::Index end,
                                   double trace, double determinant) {
  // Of the reflections' columns what is not 0: first of (H - a)(H - b), then of H.
  const double h = H(begin, begin);
  std::array<double, 3> column = {
      h * (h - trace) + determinant + H(begin, begin + 1) * H(begin + 1, begin),
      H(begin + 1, begin) * (h + H(begin + 1, begin + 1) - trace),
      H(begin + 1, begin) * H(begin + 2, begin + 1)};
  for (Eigen::Index k = begin; k < end; ++k) {
    const Eigen::Index count = std::min<Eigen::Index>(3, end - k + 1);
    if (k > begin) {
      for (Eigen::Index i = 0; i < 3; ++i) column[std::size_t(i)] = i < count ? H(k + i, k - 1) : 0;
    }
    const double size = std::hypot(column[0], column[1], column[2]);
    if (size == 0) continue;
    // 1 - v v^t / v_0 takes the column to its first axis.
    std::array<double, 3> v = {1 + std::abs(column[0]) / size, column[1] / size, column[2] / size};
    if (column[0] < 0) v = {v[0], -v[1], -v[2]};
    const auto reflect = [&](auto&& entry) {
      double along = 0;
      for (Eigen::Index i = 0; i < count; ++i) along += v[std::size_t(i)] * entry(i);
      along /= v[0];
      for (Eigen::Index i = 0; i < count; ++i) entry(i) -= along * v[std::size_t(i)];
    };
    for (Eigen::Index j = std::max(begin, k - 1); j <= end; ++j) {
      reflect([&](Eigen::Index i) -> double& { return H(k + i, j); });
    }
    for (Eigen::Index j = begin; j <= std::min(end, k + 3); ++j) {
      reflect([&](Eigen::Index i) -> double& { return H(j, k + i); });
    }
  }
}

KREISEL_DEFINED std::complex<double> fastest_rate(const Eigen::MatrixXd& J) {
  if (!J.allFinite()) return 0;
  const double scale = J.isZero(0) ? 1 : J.cwiseAbs().maxCoeff();  // lest anything overflow
  Eigen::MatrixXd H = J / scale;
  reduce_to_hessenberg(H);
  std::complex<double> fastest = 0;
  const auto note = [&fastest](const std::complex<double>& rate) {
    if (std::abs(rate) > std::abs(fastest)) fastest = rate;
  };
  Eigen::Index end = H.rows() - 1;
  for (int steps = 0; end >= 0;) {
    Eigen::Index begin = end;
    while (begin > 0) {
      const double around = std::abs(H(begin, begin)) + std::abs(H(begin - 1, begin - 1));
      const double least = std::numeric_limits<double>::epsilon() * (around == 0 ? 1 : around);
      if (std::abs(H(begin, begin - 1)) <= least) break;
      --begin;
    }
    if (begin == end) {
      note(H(end, end));
      end -= 1;
      steps = 0;
      continue;
    }
    double trace = H(end, end) + H(end - 1, end - 1);
    double determinant = H(end, end) * H(end - 1, end - 1) - H(end, end - 1) * H(end - 1, end);
    if (begin + 1 == end) {
      const double apart = (H(end - 1, end - 1) - H(end, end)) / 2;
      const double square = apart * apart + H(end, end - 1) * H(end - 1, end);
      const double root = std::sqrt(std::abs(square));
      if (square < 0) {
        note({trace / 2, root});
      } else {
        note(trace / 2 + (trace < 0 ? -root : root));
      }
      end -= 2;
      steps = 0;
      continue;
    }
    if (++steps > 100) {
      throw ComputationFailed("the QR iteration for eigenvalues does not converge");
    }
    if (steps % 10 == 0) {  // other shifts, where these go round
      const double size = std::abs(H(end, end - 1)) + std::abs(H(end - 1, end - 2));
      trace = 1.5 * size;
      determinant = size * size;
    }
    francis_step(H, begin, end, trace, determinant);
  }
  return scale * fastest;
}

}  // namespace kreisel::detail
