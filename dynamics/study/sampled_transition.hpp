#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/linearize.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The linear equations of a system with sampled controllers, from just after a sample to the same
/// moment a period later:  eta(t + period) = matrix eta(t).
///
/// Roots s of the loop follow from its eigenvalues z = exp(s period). With constraints the rows and
/// columns of the independent components count (FreeDirections).
struct SampledTransition {
  double period = 0;
  Eigen::MatrixXd matrix = {};
};

namespace detail {

/// The shortest common multiple of periods, up to 1000 times the longest; nothing if there is none.
[[nodiscard]] inline std::optional<double> common_multiple(const std::vector<double>& periods) {
  const double longest = *std::max_element(periods.begin(), periods.end());
  for (int n = 1; n <= 1000; ++n) {
    const double all = n * longest;
    const bool fits = std::all_of(periods.begin(), periods.end(), [all](double period) {
      const double ratio = all / period;
      return std::abs(ratio - std::round(ratio)) < 1e-9 * ratio;
    });
    if (fits) return all;
  }
  return std::nullopt;
}

/// Throws : InvalidInput if the periods have no common multiple
[[nodiscard]] inline double common_period(const std::vector<double>& periods) {
  if (const auto all = common_multiple(periods)) return *all;
  throw InvalidInput(
      "the periods of the controllers have no common multiple up to 1000 times the "
      "longest: the linear equations of the loop are not periodic");
}

/// The time from which all controllers are sampled, t or later, and their common period.
struct SamplePeriod {
  double first = 0;
  double period = 0;
};

template <class System>
[[nodiscard]] SamplePeriod sample_period(const System& system, double t) {
  std::vector<double> periods;
  double first = t;
  for (const auto& loop : system.loops()) {
    if (!loop.is_sampled()) continue;
    periods.push_back(loop.controller().period);
    first = std::max(first, loop.controller().first);
  }
  return {first, common_period(periods)};
}

/// The derivatives along eta of the move that the samples at t make. With constraints eta is
/// N eta_I, and the columns of dependent components are 0.
template <class System>
[[nodiscard]] Eigen::MatrixXd sample_matrix(const System& system, double t,
                                            const Eigen::VectorXd& y, const Tangent& tangent,
                                            const FreeDirections& free) {
  constexpr int at_once = directions<System>;
  using Number = Duals<at_once>;
  Eigen::MatrixXd E = tangent.basis(y);
  if (free.bound()) E *= free.N;
  Eigen::MatrixXd along(y.size(), E.cols());
  for (Eigen::Index begin = 0; begin < E.cols(); begin += at_once) {
    const Eigen::Index count = std::min<Eigen::Index>(at_once, E.cols() - begin);
    Eigen::Matrix<Number, Eigen::Dynamic, 1> state(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      state[i] = Number(y[i]);
      for (Eigen::Index k = 0; k < count; ++k) state[i].derivatives()[k] = E(i, begin + k);
    }
    system.sample(Number(t), state);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      for (Eigen::Index k = 0; k < count; ++k) along(i, begin + k) = state[i].derivatives()[k];
    }
  }
  const Eigen::MatrixXd moves = tangent.inverse(y) * along;
  return free.bound() ? with_columns(moves, free.independent, tangent.dimension()) : moves;
}

}  // namespace detail

/// The transition about a state in which steady_rates() are 0. Between samples it is the exponential
/// of the exact linear equations; samples contribute their exact derivatives.
///
/// Error  : of the exponentials, 1e-14 of the matrix for each sample time of the period
/// Throws : InvalidInput if the periods have no common multiple, or as rates() does
template <class System>
[[nodiscard]] SampledTransition sampled_transition(const System& system, double t,
                                                   const Eigen::VectorXd& y) {
  const Tangent tangent = detail::tangent_of(system, y.size(), {});
  const auto [first, period] = detail::sample_period(system, t);
  SampledTransition result;
  result.period = period;
  const detail::Reduced linear = detail::reduced(system, t, y, tangent, detail::InTime::no);
  const Eigen::MatrixXd& A = linear.A;
  result.matrix = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  double now = first;
  for (const double next : system.sample_times(first, first + result.period)) {
    result.matrix = detail::exponential(A * (next - now)) * result.matrix;
    result.matrix = detail::sample_matrix(system, next, y, tangent, linear.free) * result.matrix;
    now = next;
  }
  const double left = first + result.period - now;
  if (left > 0) result.matrix = detail::exponential(A * left) * result.matrix;
  return result;
}

}  // namespace kreisel
