#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>

#include <dynamics/guide/series.hpp>
#include <dynamics/tree/workspace.hpp>
#include <motor/api.hpp>

namespace kreisel::detail {

/// True if the motion of a tree has a computable Taylor series. Its loads are then AnalyticLoads and
/// its prescribed accelerations analytic functions of time. It has no constraints, no elements except
/// couplings, and no free joint between two bodies.
KREISEL_API [[nodiscard]] bool knows_series(const BodyTree& tree, bool guide_rests);

/// The Taylor series of the motion of a tree, for TaylorSteps.
/// Formulas: dynamics/tree/series_recurrences.hpp.
///
/// Source : recurrences for products: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///          Differential Equations I, I.8
/// Cost   : linear in the number of bodies; an order takes half an evaluation of the field for one
///          link, up to 1.2 in a long chain (benchmarks/body_system.cpp)
/// Throws : as the field does
class KREISEL_API TreeSeries {
 public:
  static constexpr int most_order = most_series_order;

  /// High orders cost hardly more than low ones, and each step also evaluates the field.
  static constexpr double relative_order = 1.15;

  /// The vector field; leaves the joints eliminated in the workspace.
  using Field = std::function<void(double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate,
                                   BodyWorkspace& w)>;
  /// The series of u and g' at the guide's origin.
  using Felt = std::function<GuideSeries(double t, double h, int order)>;

  /// The rotation from guide axes to inertial axes.
  using Attitude = std::function<Matrix3<double>(double t)>;

  /// The tree must outlive this object.
  TreeSeries(const BodyTree& tree, bool guide_rests, Field field, Felt felt, Attitude attitude);
  TreeSeries(const TreeSeries& other);
  TreeSeries(TreeSeries&& other) noexcept;
  TreeSeries& operator=(const TreeSeries& other);
  TreeSeries& operator=(TreeSeries&& other) noexcept;
  ~TreeSeries();

  /// Fills the columns 1 to `order` of c with the coefficients of the state in powers of
  /// (time - t)/h, for the motion whose state at t is column 0.
  void operator()(double t, double h, int order, Eigen::Ref<Eigen::MatrixXd> c);

 private:
  class Recurrences;

  std::unique_ptr<Recurrences> recurrences_;
};

}  // namespace kreisel::detail
