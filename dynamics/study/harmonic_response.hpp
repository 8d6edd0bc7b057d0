#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/study/linear_plant.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The linear equations about a motion with the period T = 2 pi/W:
///
///   eta' = A(t) eta + sum_j B_j(t) d^p u/dt^p,   y = C(t) eta + sum_j D_j(t) d^p u/dt^p
///
/// An input u = e^(i w t) causes outputs with the frequencies w + k W, k = 0, +-1, ..:
///
///   y = sum_k H_k(w) e^(i (w + k W) t)
///
/// With eta = sum_l X_l e^(i (w + l W) t) and the Fourier coefficients A_k, .. of the matrices,
///
///   i (w + l W) X_l - sum_m A_(l-m) X_m = B_l,   H_l = sum_m C_(l-m) X_m + D_l
///
/// for |l| <= K: Hill's method, or harmonic balance. The coefficients are sums over samples at 4 K
/// equal parts of the period. Smooth coefficients make the error fall exponentially with K.
///
/// Source : G. W. Hill, Acta Mathematica 8 (1886) 1; N. M. Wereley and S. R. Hall (1990)
/// Units  : those of the state, the inputs and the outputs, SI and radian
class PeriodicPlant {
 public:
  /// samples : the plants about the motion at equal parts of the period, from t = 0 of the input's
  ///           phase on; their number is a multiple of 4
  ///
  /// Throws  : InvalidInput if the samples do not fit together, or have sampled controllers
  KREISEL_API PeriodicPlant(double period, const std::vector<LinearPlant>& samples);

  /// H_k for k = -harmonics .. harmonics: a matrix each, with a row for each output and a column
  /// for each input.
  ///
  /// Throws : InvalidInput for w <= 0 or more than K harmonics; ComputationFailed at an undamped
  ///          resonance
  KREISEL_API [[nodiscard]] std::vector<Eigen::MatrixXcd> response(double w, int harmonics) const;

 private:
  /// A Fourier coefficient for each k = -2 K .. 2 K.
  using Coefficients = std::vector<Eigen::MatrixXcd>;

  [[nodiscard]] const Eigen::MatrixXcd& at(const Coefficients& of, int k) const {
    const int middle = 2 * most_;
    return *(of.begin() + middle + k);
  }

  /// The part of an input's column in all harmonics |l| <= K: one above the other.
  [[nodiscard]] Eigen::MatrixXcd stacked(const std::vector<Coefficients>& columns, double w) const;

  double period_;
  int most_;  ///< K
  Eigen::Index inputs_;
  std::vector<LinearPlant::Column> columns_;  ///< without matrices
  Coefficients states_;                       ///< of A
  Coefficients outputs_;                      ///< of C
  std::vector<Coefficients> forces_;          ///< for each column
  std::vector<Coefficients> direct_;
};

}  // namespace kreisel
