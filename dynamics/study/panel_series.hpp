#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// A function of time as polynomials on panels, in Legendre polynomials through the Gauss nodes
/// (study/exponential_panels.hpp). Panels are as long as the function allows, one for a constant.
///
/// Error : the estimated truncation is below `relative` times the greatest value of a component,
///         or below its rounding; more on panels shorter than 1e-6 of the time, at kinks and jumps
/// Cost  : 12 evaluations for each panel, and as many for each one that is too long
class PanelSeries {
 public:
  using Function = std::function<Eigen::VectorXd(double t)>;

  /// breaks   : times at which the function jumps, in order
  /// rounding : of the function; the greatest change at times that differ by rounding is added
  /// Throws   : ComputationFailed, with the time, if no panel is short enough
  KREISEL_API PanelSeries(const Function& function, double begin, double end,
                          const std::vector<double>& breaks, Eigen::VectorXd rounding,
                          double relative);

  /// The values at the nodes of the part [t, t + h] of a panel, as columns.
  [[nodiscard]] KREISEL_API Eigen::MatrixXd at_nodes(double t, double h) const;

  /// The error of the values, for each component: of the polynomials, and rounding.
  [[nodiscard]] const Eigen::VectorXd& error() const { return error_; }

  /// The ends of all panels.
  [[nodiscard]] KREISEL_API std::vector<double> stops() const;

 private:
  struct Panel {
    double begin;
    double length;
    Eigen::MatrixXd coefficients;
  };

  std::vector<Panel> panels_;
  Eigen::VectorXd error_;
};

}  // namespace kreisel
