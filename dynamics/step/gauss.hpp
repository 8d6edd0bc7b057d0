#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include <dynamics/step/explicit.hpp>
#include <dynamics/step/shared.hpp>
#include <dynamics/step/stop.hpp>

namespace kreisel {

/// Coefficients of Gauss collocation in s stages, order 2 s.
///
/// With x = 2 c - 1 at the nodes c, the zeros of Legendre's P_s, and P_-1 = -1,
///
///   b_i = 1/((1 - x_i^2) P_s'(x_i)^2),
///   a_ij/b_j = 1/2 sum_{k<s} P_k(x_j) (P_k+1(x_i) - P_k-1(x_i)).
///
/// Source : Hairer, Noersett, Wanner, Solving ODEs I, II.7; the second is the integral of
///          l_j = b_j sum_k (2k+1) P_k(x_j) P_k
/// Error  : <= 8 * 2^-64                                  (tests/dynamics/step/gauss.cpp)
template <int s>
struct GaussCoefficients {
  using Row = std::array<DoubleDouble, static_cast<std::size_t>(s)>;

  Row node{};
  Row weight{};

  /// a_ij/b_j. The condition a_ij/b_j + a_ji/b_i = 1 keeps quadratic invariants, whatever the
  /// digits. To round again, round the elements below the diagonal and compute the others from the
  /// sum.
  std::array<Row, s> ratio{};

  /// b_i l_j(1 + c_i)/b_j: extrapolates to the stages of the next step.
  std::array<Row, s> ahead{};

  GaussCoefficients() {
    std::array<std::array<DoubleDouble, s + 1>, s> P{};
    std::array<std::array<DoubleDouble, s + 1>, s> P_next{};
    for (std::size_t i = 0; i < s; ++i) {
      const DoubleDouble x = legendre_zero(i);
      P[i] = legendre(x);
      P_next[i] = legendre(x + 2);
      node[i] = (1 + x) / 2;
      const DoubleDouble slope = s * P[i][s - 1];  // (1 - x^2) P_s'
      weight[i] = (1 - x * x) / (slope * slope);
    }
    for (std::size_t i = 0; i < s; ++i) {
      for (std::size_t j = 0; j < s; ++j) {
        ratio[i][j] = (P[i][1] + 1) / 2;
        ahead[i][j] = 1;
        for (std::size_t k = 1; k < s; ++k) {
          // P_s vanishes here, and its rounding residue would only disturb the sum.
          const DoubleDouble upper = k + 1 < s ? P[i][k + 1] : 0;
          ratio[i][j] += P[j][k] * (upper - P[i][k - 1]) / 2;
          ahead[i][j] += static_cast<double>(2 * k + 1) * P[j][k] * P_next[i][k];
        }
        ahead[i][j] *= weight[i];
      }
    }
  }

 private:
  /// P_0 to P_s.
  [[nodiscard]] static std::array<DoubleDouble, s + 1> legendre(DoubleDouble x) {
    std::array<DoubleDouble, s + 1> P{1, x};
    for (std::size_t k = 1; k < s; ++k) {
      const auto n = static_cast<double>(k);
      P[k + 1] = ((2 * n + 1) * x * P[k] - n * P[k - 1]) / (n + 1);
    }
    return P;
  }

  /// In ascending order, by Newton's method from Tricomi's cosine.
  [[nodiscard]] static DoubleDouble legendre_zero(std::size_t i) {
    const double shifted = static_cast<double>(i) + 0.75;
    DoubleDouble x = -std::cos(std::numbers::pi * shifted / (s + 0.5));
    for (int iteration = 0; iteration < 8; ++iteration) {
      const auto P = legendre(x);
      x -= P[s] * (1 - x * x) / (s * (P[s - 1] - x * P[s]));
    }
    return x;
  }
};

/// Gauss collocation of  y' = field(t, y)  with fixed steps, for runs of 1e4 and more periods.
///
///   Y_i = y + sum_j (a_ij/b_j) Z_j,   Z_i = h b_i field(t + c_i h, Y_i),   y <- y + sum_i Z_i
///
/// is symmetric and symplectic. Rounding must not destroy that: energy would drift with time
/// instead of a random walk. Therefore the ratios a_ij/b_j are rounded to numbers that still fulfil
/// a_ij/b_j + a_ji/b_i = 1 exactly, and h b_i has 106 bits. The stages are iterated until rounding,
/// not a tolerance, stops them. State and time are summed with compensation. The first guess is the
/// continued collocation polynomial of the last step. Each stage uses the newest values of the
/// others, which saves iterations and, as measured, reduces the drift.
///
/// Source : Hairer, McLachlan, Razakarivony, Achieving Brouwer's law with implicit Runge-Kutta
///          methods, BIT 48 (2008) 231; the ratios: Antonana, Makazaga, Murua, Numerical Algorithms
///          76 (2017) 861
/// Field  : as ExplicitRungeKutta takes it; smooth, not stiff
/// Vector : as ExplicitRungeKutta; steps allocate memory if its size is dynamic
/// Blocks : as ExplicitRungeKutta; their sizes, at least `absolute_scale`, are the reference for
///          rounding of the stages and for rounding_level()
/// Error  : pendulum of 0.1 rad, 6 to 12 steps a period, RMS of 6: after 1e4 periods energy 2e-14
///          relative, phase 1.5e-12 rad; after 1e5, 7e-14 and 2e-11: as sqrt(t) and t
/// Cost   : 10 to 14 iterations of `stages` evaluations a step
/// Limits : coefficients and steps have 64 bits, in wider scalars too
/// Throws : InvalidInput for an invalid step or start; ComputationFailed naming the time at which
///          the stages do not converge: the last accepted time and state stay readable
template <class Vector, class Field, int stages = 8>
class GaussIRK {
 public:
  using Scalar = typename Vector::Scalar;

  static constexpr int order = 2 * stages;

  GaussIRK(Field field, const Scalar& t, const Vector& y, double step,
           std::span<const int> blocks = {}, double absolute_scale = 0)
      : field_(std::move(field)),
        step_(step),
        time_{t, Scalar(0)},
        state_{y, Vector::Zero(y.size())},
        stage_(Stages::Zero(y.size(), stages)),
        block_sizes_(blocks.begin(), blocks.end()),
        sizes_(blocks, Scalar(absolute_scale), y) {
    detail::require_step(step);
    if (!std::isfinite(static_cast<double>(t)))
      detail::refuse_steps("the start time is not finite");
    if (!detail::finite(y)) detail::refuse_steps("the state at the start is not finite");
    if (blocks.empty()) block_sizes_ = {int(y.size())};
    const GaussCoefficients<stages>& exact = coefficients();
    for (int i = 0; i < stages; ++i) {
      ratio_(i, i) = Scalar(0.5);
      for (int j = 0; j < i; ++j) {
        ratio_(j, i) = static_cast<Scalar>(exact.ratio[std::size_t(i)][std::size_t(j)]);
        ratio_(i, j) = Scalar(1) - ratio_(j, i);
      }
      for (int j = 0; j < stages; ++j) {
        ahead_(j, i) = static_cast<Scalar>(exact.ahead[std::size_t(i)][std::size_t(j)]);
      }
    }
  }

  [[nodiscard]] const Scalar& t() const { return time_.value; }
  [[nodiscard]] const Vector& y() const { return state_.value; }
  [[nodiscard]] const IntegrationStatistics& effort() const { return effort_; }

  /// The greatest size of each block so far.
  [[nodiscard]] std::vector<Scalar> sizes() const { return sizes_.sizes(); }

  /// Error of the state due to rounding of its rates, relative to size; sampled at intervals.
  [[nodiscard]] Scalar rounding_level() const {
    // Each stage rounds independently: sqrt(sum b^2) of half a last digit.
    return Scalar(0.2) * sizes_.wander(squares_);
  }

  /// Limit of the evaluations, after which the integration gives up.
  void give_up_after(double evaluations) { max_evaluations_ = evaluations; }

  /// advance_to() throws StopRequested before its next step once this token requests a stop.
  void stop_by(std::stop_token stop) { stop_ = std::move(stop); }

  /// Upper limit of the step length from here on.
  void take_steps_of(double step) {
    detail::require_step(step);
    step_ = step;
  }

  /// Integrates to `end` exactly, in equal steps no longer than the limit, forwards or backwards.
  const Vector& advance_to(const Scalar& end) {
    const detail::EqualSteps steps(time_, end, step_);
    if (end == t()) return y();
    take_length(steps.length);
    double done = 0;
    while (done < steps.count) {
      detail::stop_if_requested(stop_);
      if (effort_.evaluations > max_evaluations_) {
        detail::stop_without_evaluations(t(), max_evaluations_);
      }
      if (steps_taken_ % 16 == 0) note_rounding();
      solve_stages();
      state_.add(stage_.rowwise().sum());
      if constexpr (requires { field_.project(state_.value); }) field_.project(state_.value);
      time_.add(h_);
      squares_ += h_ * h_;
      sizes_.note(y());
      steps_taken_ += 1;
      effort_.steps += 1;
      done += 1;
    }
    time_ = {end, Scalar(0)};
    return y();
  }

  /// Saves or restores the members from which the steps continue.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(step_, h_, time_, state_, stage_, continues_, sizes_, squares_, steps_taken_,
               effort_);
  }

 private:
  using Stages = Eigen::Matrix<Scalar, Vector::RowsAtCompileTime, stages>;
  using Square = Eigen::Matrix<Scalar, stages, stages>;

  /// A step has failed if the stages have not converged after this many iterations.
  static constexpr int most_iterations = 100;

  [[nodiscard]] static const GaussCoefficients<stages>& coefficients() {
    static const GaussCoefficients<stages> exact;
    return exact;
  }

  [[nodiscard]] Vector evaluate(const Scalar& t, const Vector& y) {
    effort_.evaluations += 1;
    return detail::rate_of(field_, t, y);
  }

  void take_length(DoubleDouble length) {
    const auto h = static_cast<Scalar>(length);
    for (std::size_t i = 0; i < stages; ++i) {
      const DoubleDouble exact = length * coefficients().weight[i];
      weight_[i] = static_cast<Scalar>(exact);
      weight_rest_[i] = static_cast<Scalar>(exact - DoubleDouble(weight_[i]));
      node_[i] = static_cast<Scalar>(length * coefficients().node[i]);
    }
    // The old stages are a guess only for steps of nearly the same length.
    if (!(std::abs(h - h_) < Scalar(0.1) * std::abs(h_))) continues_ = false;
    h_ = h;
  }

  /// Z of the step from here.
  void solve_stages() {
    guess_stages();
    Vector least = Vector::Constant(y().size(), std::numeric_limits<Scalar>::max());
    int stalled = 0;
    for (int iteration = 1; iteration <= most_iterations; ++iteration) {
      Vector change = Vector::Zero(y().size());
      for (int i = 0; i < stages; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Vector sum = stage_.lazyProduct(ratio_.col(i));
        alignas(detail::Vec4d) alignas(Vector) const Vector point = y() + (sum + state_.rest);
        alignas(detail::Vec4d) alignas(Vector) const Vector f =
            evaluate(t() + (node_[at] + time_.rest), point);
        const Vector z = weight_[at] * f + weight_rest_[at] * f;
        change = change.cwiseMax((z - stage_.col(i)).cwiseAbs());
        stage_.col(i) = z;  // the next stages use the new value already
      }
      if (!detail::finite(stage_)) break;
      // Changes that no longer halve are rounding. A slow start must not be taken for rounding.
      const bool shrinks = (change.array() < least.array() / Scalar(2)).any();
      stalled = shrinks ? 0 : stalled + 1;
      if (!shrinks && at_rest(change, stalled)) {
        continues_ = true;
        return;
      }
      least = least.cwiseMin(change);
    }
    continues_ = false;
    detail::stop_integration(t(),
                             "the stages do not converge: the field is not finite, or steps of ",
                             std::abs(h_), " s are too long for it");
  }

  void note_rounding() {
    Vector moved = y();
    detail::move_last_digits(moved, 1);
    const Vector off = evaluate(t(), moved) - evaluate(t(), y());
    if (!detail::finite(off)) return;
    sizes_.note_rounding(off, squares_);
    squares_ = Scalar(0);
  }

  void guess_stages() {
    if (continues_) {
      const Stages last = stage_;
      for (int i = 0; i < stages; ++i) stage_.col(i) = last.lazyProduct(ahead_.col(i));
      return;
    }
    const Vector f = evaluate(t(), y());
    for (int i = 0; i < stages; ++i) stage_.col(i) = weight_[static_cast<std::size_t>(i)] * f;
  }

  /// True if no block changes by more than rounding, of its present size or of its greatest size so
  /// far. The latter matters for a motion that has died out, whose parts cancel. Where forces cancel,
  /// rounding of the field is greater: changes that have stalled for many iterations are its effect.
  [[nodiscard]] bool at_rest(const Vector& change, int stalled) const {
    constexpr int many = 16;
    constexpr Scalar rounding_of_forces = Scalar(1e-10);
    const Scalar rounding =
        stalled < many ? 64 * std::numeric_limits<Scalar>::epsilon() : rounding_of_forces;
    Vector greatest(y().size());
    sizes_.put(greatest);
    int begin = 0;
    for (const int components : block_sizes_) {
      Scalar changed(0);
      Scalar size(0);
      Scalar known(0);
      for (int i = begin; i < begin + components; ++i) {
        known = greatest[i];
        changed = std::max(changed, change[i]);
        size = std::max(size, Scalar(std::abs(y()[i]) + stage_.row(i).cwiseAbs().sum()));
      }
      if (!(changed <= std::max(Scalar(1e-10) * size, rounding * known))) return false;
      begin += components;
    }
    return true;
  }

  Field field_;
  double step_;
  Scalar h_ = Scalar(0);
  detail::Compensated<Scalar> time_;
  detail::Compensated<Vector> state_;
  Square ratio_;  ///< transposed, as is the next: column j holds what stage j takes of the others
  Square ahead_;
  std::array<Scalar, stages> weight_ = {};  ///< h b
  std::array<Scalar, stages> weight_rest_ = {};
  std::array<Scalar, stages> node_ = {};  ///< h c
  Stages stage_;                          ///< Z
  bool continues_ = false;                ///< true if Z is that of the step before
  std::vector<int> block_sizes_;
  detail::BlockSizes<Vector> sizes_;
  Scalar squares_{0};         ///< of step lengths, since the last rounding sample
  unsigned steps_taken_ = 0;  ///< modulo its range
  double max_evaluations_ = std::numeric_limits<double>::infinity();
  std::stop_token stop_;
  IntegrationStatistics effort_;
};

}  // namespace kreisel
