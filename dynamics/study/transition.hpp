#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <dynamics/step/explicit.hpp>
#include <dynamics/step/jacobian.hpp>

namespace kreisel {

/// Dependence of a motion on its start.
template <int n>
struct Transition {
  Eigen::Matrix<double, n, 1> state;   ///< y(t_end)
  Eigen::Matrix<double, n, n> matrix;  ///< dy(t_end)/dy(t_begin)

  /// Error of each entry of the matrix: its change for steps with a hundred times the error, and
  /// rounding.
  Eigen::Matrix<double, n, n> error;
};

namespace detail {

/// y, followed by the columns of the transition matrix, as one state.
template <int n>
using WithTransition = Eigen::Matrix<double, n*(n + 1), 1>;

template <int n, class Field>
[[nodiscard]] WithTransition<n> integrate(const Field& field, double t_begin,
                                          const Eigen::Matrix<double, n, 1>& y, double t_end,
                                          const Accuracy& accuracy, std::span<const int> blocks) {
  WithTransition<n> start;
  start.template head<n>() = y;
  Eigen::Map<Eigen::Matrix<double, n, n>>(start.data() + n).setIdentity();
  // Every column has the units of the state.
  std::vector<int> all;
  for (int i = 0; i <= n; ++i) all.insert(all.end(), blocks.begin(), blocks.end());
  ExplicitRungeKutta<WithTransition<n>, Field> steps(field, t_begin, start, accuracy, all);
  return steps.advance_to(t_end);
}

/// Field: (t, y) -> the rates of y, and the matrix before X in X'.
template <int n, class Field>
[[nodiscard]] Transition<n> transition_of(const Field& field, double t_begin,
                                          const Eigen::Matrix<double, n, 1>& y, double t_end,
                                          const Accuracy& accuracy, std::span<const int> blocks) {
  using Square = Eigen::Matrix<double, n, n>;
  Accuracy coarse = accuracy;
  coarse.relative = std::min(100 * accuracy.relative, 1e-2);
  const WithTransition<n> fine = integrate<n>(field, t_begin, y, t_end, accuracy, blocks);
  const WithTransition<n> rough = integrate<n>(field, t_begin, y, t_end, coarse, blocks);
  const Square X = Eigen::Map<const Square>(fine.data() + n);
  const Square off = X - Eigen::Map<const Square>(rough.data() + n);
  const double rounding = 16 * std::numeric_limits<double>::epsilon();
  return {fine.template head<n>(), X, off.cwiseAbs() + rounding * X.cwiseAbs()};
}

}  // namespace detail

/// The transition matrix of  x' = A(t) x  from t_begin to t_end:  X' = A X,  X(t_begin) = 1.
///
/// Coefficients : callable (double t) -> Eigen::Matrix<double, n, n>
/// Blocks       : of x, as ExplicitRungeKutta takes them; by default each component for itself
/// Error        : reported entry by entry
/// Cost         : 1.7 integrations of n^2 components
/// Throws       : as ExplicitRungeKutta does
template <int n, class Coefficients>
[[nodiscard]] Transition<n> linear_transition(const Coefficients& A, double t_begin, double t_end,
                                              const Accuracy& accuracy = {},
                                              std::span<const int> blocks = {}) {
  using Square = Eigen::Matrix<double, n, n>;
  const auto field = [&A](double t, const detail::WithTransition<n>& y) {
    detail::WithTransition<n> rate;
    rate.template head<n>().setZero();
    Eigen::Map<Square>(rate.data() + n).noalias() =
        A(t).lazyProduct(Eigen::Map<const Square>(y.data() + n));
    return rate;
  };
  std::array<int, std::size_t(n)> single;
  single.fill(1);
  if (blocks.empty()) blocks = single;
  return detail::transition_of<n>(field, t_begin, Eigen::Matrix<double, n, 1>::Zero(), t_end,
                                  accuracy, blocks);
}

/// The motion of a scene and its transition matrix, from the variational equations
///
///   y' = f(t, y),   X' = (df/dy) X,   X(t_begin) = 1,
///
/// df/dy by dual numbers: exact, no differences. The matrix over one period shows the growth of
/// neighbouring motions of a periodic or steady motion.
///
/// Scene  : has Vector, blocks and rates(t, y), which takes dual numbers too
/// Error  : reported entry by entry
/// Throws : as ExplicitRungeKutta does
template <class Scene, int n = int(Scene::Vector::RowsAtCompileTime)>
[[nodiscard]] Transition<n> transition(const Scene& scene, double t_begin,
                                       const Eigen::Matrix<double, n, 1>& y, double t_end,
                                       const Accuracy& accuracy = {}) {
  using Square = Eigen::Matrix<double, n, n>;
  const auto rates = [&scene](const auto& t, const auto& state) { return scene.rates(t, state); };
  const auto field = [&, jacobian = forward_jacobian<n>(rates)](
                         double t, const detail::WithTransition<n>& y_and_X) {
    const Eigen::Matrix<double, n, 1> state = y_and_X.template head<n>();
    detail::WithTransition<n> rate;
    rate.template head<n>() = scene.rates(t, state);
    Eigen::Map<Square>(rate.data() + n).noalias() =
        jacobian(t, state).of_state.lazyProduct(Eigen::Map<const Square>(y_and_X.data() + n));
    return rate;
  };
  const auto& blocks = scene.blocks;
  return detail::transition_of<n>(field, t_begin, y, t_end, accuracy, blocks);
}

}  // namespace kreisel
