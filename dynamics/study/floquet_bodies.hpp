#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <sstream>
#include <vector>

#include <dynamics/step/explicit.hpp>
#include <dynamics/study/equilibrium.hpp>

namespace kreisel {

/// Dependence of a motion on its start, in the directions eta in which its state can move
/// (study/tangent.hpp).
struct TangentTransition {
  Eigen::VectorXd state;  ///< y(t_end)
  /// d eta(t_end) / d eta(t_begin); with constraints of the independent components at t_begin, and
  /// 0 in the columns of the others.
  Eigen::MatrixXd matrix;

  /// Error of each entry of the matrix: its change for steps with a hundred times the error.
  Eigen::MatrixXd error;
};

namespace detail {

/// y, followed by the columns of the transition matrix.
template <class Scene>
[[nodiscard]] Eigen::VectorXd with_tangents(const Scene& scene, double t_begin,
                                            const Eigen::VectorXd& y, double t_end,
                                            const Accuracy& accuracy) {
  const Tangent tangent = tangent_of(scene, y.size(), {});
  const Eigen::Index n = y.size(), d = tangent.dimension();
  const auto field = [&, n, d](double t, const Eigen::VectorXd& z, Eigen::VectorXd& rate) {
    const Eigen::VectorXd now = z.head(n);
    const Reduced at = reduced(scene, t, now, tangent, InTime::no);
    rate.head(n) = at.f;
    Eigen::Map<Eigen::MatrixXd>(rate.data() + n, d, d).noalias() =
        at.A * Eigen::Map<const Eigen::MatrixXd>(z.data() + n, d, d);
  };
  const std::vector<int> of_state = scene.blocks();
  std::vector<int> of_column;
  for (int begin = 0; const int size : of_state) {
    const auto& balls = tangent.quaternions();
    const bool ball = std::find(balls.begin(), balls.end(), begin) != balls.end();
    of_column.push_back(ball ? size - 1 : size);
    begin += size;
  }
  std::vector<int> blocks = of_state;
  for (Eigen::Index j = 0; j < d; ++j) {
    blocks.insert(blocks.end(), of_column.begin(), of_column.end());
  }
  Eigen::VectorXd start(n + d * d);
  start.head(n) = y;
  Eigen::Map<Eigen::MatrixXd>(start.data() + n, d, d) =
      free_directions(scene, y, tangent.basis(y)).unit_moves(tangent.dimension());
  ExplicitRungeKutta steps(field, t_begin, start, accuracy, blocks);
  return steps.advance_to(t_end);
}

}  // namespace detail

/// The motion of a scene with a state of dynamic size, and its transition matrix. The latter
/// follows from the variational equations X' = A(t) X, X(t_begin) = 1, with A of linearize().
///
/// Scene  : Differentiable, with a tree() or quaternions(), and blocks()
/// Error  : reported entry by entry
/// Throws : as ExplicitRungeKutta and the scene's rates()
template <class Scene>
[[nodiscard]] TangentTransition tangent_transition(const Scene& scene, double t_begin,
                                                   const Eigen::VectorXd& y, double t_end,
                                                   const Accuracy& accuracy = {.relative = 1e-12}) {
  Accuracy coarse = accuracy;
  coarse.relative = std::min(100 * accuracy.relative, 1e-2);
  const Eigen::VectorXd fine = detail::with_tangents(scene, t_begin, y, t_end, accuracy);
  const Eigen::VectorXd rough = detail::with_tangents(scene, t_begin, y, t_end, coarse);
  const Eigen::Index d = detail::tangent_of(scene, y.size(), {}).dimension();
  const auto matrix = [&y, d](const Eigen::VectorXd& z) {
    return Eigen::MatrixXd(Eigen::Map<const Eigen::MatrixXd>(z.data() + y.size(), d, d));
  };
  return {fine.head(y.size()), matrix(fine), (matrix(fine) - matrix(rough)).cwiseAbs()};
}

/// A motion that repeats after a period, except running angles.
struct PeriodicMotion {
  Eigen::VectorXd start;
  TangentTransition period;  ///< its multipliers are the growth factors of neighbouring motions
  double residual = 0;       ///< of the return, greatest component
  int iterations = 0;
};

/// Shooting: Newton's method on y(t + period) = y(t) with the transition matrix as its Jacobian. If
/// equations or unknowns are redundant, the shortest step is taken.
///
/// search   : `held` and `running` as find_equilibrium() has them; running components may advance
/// Error    : residual, as large as the steps' own error
/// Throws   : as tangent_transition(); ComputationFailed with the residual if no motion of this
///          period is near
template <class Scene>
[[nodiscard]] PeriodicMotion periodic_motion(const Scene& scene, double t, double period,
                                             const Eigen::VectorXd& guess,
                                             const EquilibriumOptions& search = {},
                                             const Accuracy& accuracy = {.relative = 1e-12}) {
  const Tangent tangent = detail::tangent_of(scene, guess.size(), {});
  const std::vector<int> wanted = detail::others(tangent.dimension(), search.running);
  PeriodicMotion motion;
  motion.start = detail::on_constraints(scene, guess);
  for (; motion.iterations < search.most_iterations; ++motion.iterations) {
    motion.period = tangent_transition(scene, t, motion.start, t + period, accuracy);
    const Eigen::VectorXd away =
        tangent.inverse(motion.start) * (motion.period.state - motion.start);
    const Eigen::VectorXd off = away(wanted);
    motion.residual = off.lpNorm<Eigen::Infinity>();
    const double size = 1 + motion.start.lpNorm<Eigen::Infinity>();
    if (motion.residual <= 1e3 * accuracy.relative * size) return motion;
    const FreeDirections free =
        detail::free_directions(scene, motion.start, tangent.basis(motion.start));
    const std::vector<int> unknown =
        detail::others(tangent.dimension(), detail::appended(search.held, free.dependent));
    const Eigen::MatrixXd change = motion.period.matrix - free.unit_moves(tangent.dimension());
    // The matrix has the error of its steps, which exceeds rounding.
    const detail::NewtonStep newton(change(wanted, unknown), off, 1e-9);
    motion.start =
        detail::moved(scene, tangent, motion.start,
                      free.complete(detail::scattered(tangent.dimension(), unknown, newton.step)));
  }
  std::ostringstream text;
  text.precision(10);
  text << "periodic motion: none of the period " << period << " s reached in " << motion.iterations
       << " steps; the distance from its start is " << motion.residual;
  throw ComputationFailed(text.str());
}

}  // namespace kreisel
