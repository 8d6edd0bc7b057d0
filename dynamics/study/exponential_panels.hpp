#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// Gauss nodes of a panel.
inline constexpr int panel_nodes = 12;

/// Solutions of  x' = A x + g(t)  on panels of the time axis, for any A h: fast oscillations and
/// stiff decay need no short panels.
///
///   x(s) = e^(A s) x(0) + sum_k W_k(s) g_k,   W_k(s) = int_0^s e^(A(s - r)) P_k(2 r/h - 1) dr
///
/// g is a polynomial through its values at the Gauss nodes of the panel; g_k are its coefficients in
/// Legendre polynomials P_k. If g depends on x as well, repeated solutions with g at the nodes
/// converge to the collocation method of Gauss with exact integrals of A.
///
/// Units  : those of x and the time
/// Error  : rounding, 1e-16 |A| h of x, |A| after balancing
/// Cost   : 156 n^2 products for each panel. The matrices of a length h are computed once, by
///          doubling from a length with |A| s < 1/2
class ExponentialPanels {
 public:
  using Fractions = Eigen::Matrix<double, panel_nodes, 1>;

  KREISEL_API explicit ExponentialPanels(const Eigen::MatrixXd& A);

  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return matrix_; }

  /// The nodes of a panel, as fractions of its length in (0, 1).
  [[nodiscard]] KREISEL_API static const Fractions& fractions();

  /// The coefficients g_k of the polynomial through values at the nodes, as columns.
  [[nodiscard]] KREISEL_API static Eigen::MatrixXd coefficients(const Eigen::MatrixXd& values);

  /// The coefficients of the same polynomial on the part [from, to] of its panel, as fractions.
  [[nodiscard]] KREISEL_API static Eigen::MatrixXd on_part(const Eigen::MatrixXd& coefficients,
                                                           double from, double to);

  /// The polynomial at the nodes and, in the last column, at the end of its panel.
  [[nodiscard]] KREISEL_API static Eigen::MatrixXd values(const Eigen::MatrixXd& coefficients);

  /// The coefficients of its derivative by the fraction of the panel.
  [[nodiscard]] KREISEL_API static Eigen::MatrixXd derivative(const Eigen::MatrixXd& coefficients);

  /// x at the nodes and, in the last column, at the end of a panel of length h.
  [[nodiscard]] KREISEL_API Eigen::MatrixXd solution(double h, const Eigen::VectorXd& start,
                                                     const Eigen::MatrixXd& coefficients) const;

  /// The effect on x, at the nodes and the end, of the error of the polynomial: an estimate for each
  /// component. It extrapolates the last two coefficients by their ratio to the two before, and is
  /// too great where the panel resolves g.
  [[nodiscard]] KREISEL_API Eigen::VectorXd truncation(double h,
                                                       const Eigen::MatrixXd& coefficients) const;

 private:
  struct Propagator {
    Eigen::MatrixXd of_start;  ///< rows for each node and the end
    Eigen::MatrixXd of_force;  ///< columns for each coefficient
  };

  /// The greatest contribution of the coefficients k and k + 1 to x at a node or at the end.
  [[nodiscard]] Eigen::VectorXd contribution(const Propagator& of,
                                             const Eigen::MatrixXd& coefficients, int k) const;

  [[nodiscard]] const Propagator& propagator(double h) const;

  Eigen::MatrixXd matrix_;
  Eigen::VectorXd balance_;   ///< A = D B D^-1, D diagonal
  Eigen::MatrixXd balanced_;  ///< B
  mutable std::map<double, Propagator> known_ = {};
};

/// The panels of a run: the intervals between stops, each divided into 2^level equal parts. The
/// level follows the error of the parts.
class PanelSequence {
 public:
  /// stops : in order, after begin; the last is the end of the run
  KREISEL_API PanelSequence(double begin, std::vector<double> stops);

  [[nodiscard]] bool done() const { return interval_ == stops_.size(); }
  [[nodiscard]] KREISEL_API double begin() const;
  [[nodiscard]] KREISEL_API double length() const;

  /// Halves the present panel.
  ///
  /// Throws : ComputationFailed, with the time, if rounding would make it empty
  KREISEL_API void halve();

  /// Goes on to the next panel, which may be longer. True if it begins at a stop.
  KREISEL_API bool advance(bool longer);

 private:
  [[nodiscard]] double interval_length() const;

  double begin_;  ///< of the interval
  std::vector<double> stops_;
  std::size_t interval_ = 0;
  int level_ = 0;
  long long part_ = 0;
};

}  // namespace kreisel
