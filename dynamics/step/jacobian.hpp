#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <dynamics/step/shared.hpp>

namespace kreisel {

/// The derivatives of a vector field of n components.
template <int n>
struct Jacobian {
  Eigen::Matrix<double, n, n> of_state;  ///< df_i/dy_j
  Eigen::Matrix<double, n, 1> of_time;   ///< df_i/dt
};

/// Placeholder for the Jacobian of methods that need none.
struct NoJacobian {};

/// (t, y) -> Jacobian of a field that is a template on the number type, by forward differentiation.
/// The result is exact and costs one evaluation of the field in dual numbers.
///
///   const auto jacobian = forward_jacobian<2>([](const auto& t, const auto& y) { ... });
///
/// Field  : callable (S t, Eigen::Matrix<S, n, 1> y) -> Eigen::Matrix<S, n, 1> for S = double and
///          dual numbers
/// Error  : that of the field's own formula
/// Cost   : one evaluation in numbers of n + 2 parts
template <int n, class Field>
[[nodiscard]] auto forward_jacobian(Field field) {
  return [field = std::move(field)](double t, const Eigen::Matrix<double, n, 1>& y) {
    using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, n + 1, 1>>;
    Eigen::Matrix<Dual, n, 1> state;
    for (int i = 0; i < n; ++i) state[i] = Dual(y[i], n + 1, i);
    const Eigen::Matrix<Dual, n, 1> f = field(Dual(t, n + 1, n), state);
    Jacobian<n> jacobian;
    for (int i = 0; i < n; ++i) {
      jacobian.of_state.row(i) = f[i].derivatives().template head<n>().transpose();
      jacobian.of_time[i] = f[i].derivatives()[n];
    }
    return jacobian;
  };
}

/// (t, y) -> Jacobian of any field, by differences, for fields that do not accept dual numbers.
///
/// Field  : as ExplicitRungeKutta takes it; n may be Eigen::Dynamic
/// Error  : of of_state some 1e-8 of each column: good enough for the iterations of RadauSteps.
///          of_time stays 0
/// Cost   : one evaluation and one for each component
template <int n, class Field>
[[nodiscard]] auto difference_jacobian(Field field) {
  using Vector = Eigen::Matrix<double, n, 1>;
  return [field = std::move(field)](double t, const Vector& y) {
    Field own = field;  // the field may write into a workspace
    const double little = std::sqrt(std::numeric_limits<double>::epsilon());
    const double size = std::max(y.template lpNorm<Eigen::Infinity>(), 1e-3);
    const Vector f = detail::rate_of(own, t, y);
    Jacobian<n> jacobian{{y.size(), y.size()}, Vector::Zero(y.size())};
    for (int j = 0; j < int(y.size()); ++j) {
      Vector moved = y;
      moved[j] += little * std::max(std::abs(y[j]), 1e-3 * size);
      jacobian.of_state.col(j) = (detail::rate_of(own, t, moved) - f) / (moved[j] - y[j]);
    }
    return jacobian;
  };
}

}  // namespace kreisel
