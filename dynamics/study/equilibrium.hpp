#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/linearize.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The parts of the state that are no unknowns of the search. Positions count in eta, where each
/// quaternion has three angles (study/tangent.hpp).
struct EquilibriumOptions {
  std::vector<int> held = {};     ///< keep their value from the guess: a given speed
  std::vector<int> running = {};  ///< may have a rate: cyclic angles of a steady motion
  std::vector<int> quaternions = {};
  int most_iterations = 60;
};

/// A state in which nothing changes, except running angles.
template <class Vector>
struct EquilibriumResult {
  Vector state;
  double residual = 0;  ///< of the rates, greatest component
  double step = 0;      ///< the last Newton step, greatest component: the error
  int iterations = 0;
  int neutral = 0;  ///< directions in which the equilibrium is not isolated
};

namespace detail {

/// The positions below `dimension` that are not left out.
///
/// Throws : InvalidInput for a position outside [0, dimension)
[[nodiscard]] inline std::vector<int> others(int dimension, const std::vector<int>& left_out) {
  std::vector<bool> kept(static_cast<std::size_t>(dimension), true);
  for (const int i : left_out) {
    if (i < 0 || i >= dimension) {
      std::ostringstream text;
      text << "equilibrium: component " << i << " must be in [0, " << dimension << ')';
      throw InvalidInput(text.str());
    }
    kept[static_cast<std::size_t>(i)] = false;
  }
  std::vector<int> positions;
  for (int i = 0; i < dimension; ++i) {
    if (kept[static_cast<std::size_t>(i)]) positions.push_back(i);
  }
  return positions;
}

[[nodiscard]] inline std::vector<int> appended(std::vector<int> a, const std::vector<int>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// x at the positions, 0 elsewhere. A loop: g++ 12 warns about freed memory in Eigen's indexed
/// assignment.
[[nodiscard]] inline Eigen::VectorXd scattered(int dimension, const std::vector<int>& positions,
                                               const Eigen::VectorXd& x) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(dimension);
  for (Eigen::Index i = 0; i < x.size(); ++i) result[positions[static_cast<std::size_t>(i)]] = x[i];
  return result;
}

/// Newton's step for f + A step = 0: the shortest least-squares solution.
struct NewtonStep {
  Eigen::VectorXd step;
  int rank = 0;  ///< of A

  /// threshold : a pivot counts as 0 below this part of the greatest, times their number
  NewtonStep(const Eigen::MatrixXd& A, const Eigen::VectorXd& f,
             double threshold = std::numeric_limits<double>::epsilon())
      : step(Eigen::VectorXd::Zero(A.cols())) {
    if (A.size() == 0) return;
    const auto pivots = static_cast<double>(std::min(A.rows(), A.cols()));
    const ShortestSolution solution = shortest_solution(A, f, threshold * pivots);
    rank = solution.rank;
    step = -solution.x;
  }

  /// True if the remaining rate is explained by rounding. A falling body has no equilibrium,
  /// although none of its coordinates causes the fall.
  [[nodiscard]] bool suffices(const Eigen::MatrixXd& A, const Eigen::VectorXd& f,
                              double size) const {
    const Eigen::ArrayXd rounding = 1e-10 * (1 + size * A.cwiseAbs().rowwise().sum().array());
    return ((f + A * step).array().abs() <= rounding).all();
  }
};

/// As moved(); nothing if no state near there fulfils the constraints.
template <class Scene>
[[nodiscard]] std::optional<typename Scene::Vector> moved_or_none(const Scene& scene,
                                                                  const Tangent& tangent,
                                                                  const typename Scene::Vector& y,
                                                                  const Eigen::VectorXd& eta) {
  try {
    return moved(scene, tangent, y, eta);
  } catch (const ComputationFailed&) {
    return std::nullopt;
  }
}

}  // namespace detail

/// Newton's method with the exact Jacobian; steps that lead uphill are halved. If equations or
/// unknowns are redundant, the shortest step is taken: it leads to the equilibrium nearest to the
/// guess. States of a constrained system are moved onto its constraints.
///
/// Scene  : Differentiable
/// Error  : quadratic convergence down to rounding, `step`; linear where the Jacobian is singular
///          at the equilibrium only
/// Throws : InvalidInput for invalid positions; ComputationFailed with residual and state if the
///          steps reach no equilibrium, for example if a body falls freely
template <class Scene>
[[nodiscard]] EquilibriumResult<typename Scene::Vector> find_equilibrium(
    const Scene& scene, double t, const typename Scene::Vector& guess,
    const EquilibriumOptions& search = {}) {
  const Tangent tangent = detail::tangent_of(scene, guess.size(), search.quaternions);
  const std::vector<int> wanted = detail::others(tangent.dimension(), search.running);
  const auto rates = [&](const typename Scene::Vector& y) {
    const Eigen::VectorXd f = scene.rates(t, y);
    return Eigen::VectorXd((tangent.inverse(y) * f)(wanted));
  };
  const auto greatest = [](const Eigen::VectorXd& v) { return v.lpNorm<Eigen::Infinity>(); };

  EquilibriumResult<typename Scene::Vector> result;
  result.state = detail::on_constraints(scene, guess);
  Eigen::VectorXd f = rates(result.state);
  for (; result.iterations < search.most_iterations; ++result.iterations) {
    const typename Scene::Vector& y = result.state;
    const detail::Reduced r = detail::reduced(scene, t, y, tangent, detail::InTime::no);
    const std::vector<int> unknown =
        detail::others(tangent.dimension(), detail::appended(search.held, r.free.dependent));
    const Eigen::MatrixXd A = r.A(wanted, unknown);
    const detail::NewtonStep newton(A, f);
    const bool suffices = newton.suffices(A, f, 1 + greatest(y));
    result.neutral = static_cast<int>(A.cols()) - newton.rank;
    const Eigen::VectorXd eta =
        r.free.complete(detail::scattered(tangent.dimension(), unknown, newton.step));
    double share = 1;
    bool falls = false;
    for (; share > 1e-4 && !falls; share /= 2) {
      const auto next = detail::moved_or_none(scene, tangent, y, Eigen::VectorXd(share * eta));
      if (!next) continue;
      const Eigen::VectorXd f_next = rates(*next);
      falls = f_next.norm() < f.norm();
      if (!falls) continue;
      result.state = *next;
      f = f_next;
    }
    result.residual = greatest(f);
    result.step = greatest(newton.step);
    const double size = 1 + greatest(result.state);
    const bool is_small = result.step <= 4 * std::numeric_limits<double>::epsilon() * size;
    if (result.residual == 0 || (suffices && is_small)) return result;
    if (!falls) {
      // Rounding ends the search if nothing else is left of the step.
      if (suffices && result.step <= 1e-9 * size) return result;
      break;
    }
  }
  std::ostringstream text;
  text.precision(10);
  text << "equilibrium: none reached in " << result.iterations << " steps; a rate of "
       << greatest(f) << " is left at y = [" << result.state.transpose() << "]";
  throw ComputationFailed(text.str());
}

}  // namespace kreisel
