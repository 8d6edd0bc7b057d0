#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/solve/run.hpp>
#include <dynamics/step/checkpoint.hpp>

namespace kreisel::detail {

/// A run with its outputs so far, which can be read again.
class RunSoFar {
 public:
  /// stops_at : as RunRequest::stops_at
  RunSoFar(std::unique_ptr<Run> run, Eigen::Index components, double stops_at)
      : run_(std::move(run)),
        components_(static_cast<std::size_t>(components)),
        stops_at_(stops_at) {}

  /// The state at the i-th output, valid until the next call. Outputs must be read in order, each
  /// time from the first one on.
  [[nodiscard]] std::span<const double> at_output(std::size_t i, double t, double end) {
    if (i == first_ + known_) run_->on_the_way(t, end, next_state());
    return {states_.data() + (i - first_) * components_, components_};
  }

  /// True if the run has its outputs from the first one on; false if a checkpoint began it.
  [[nodiscard]] bool knows_all() const { return first_ == 0; }

  /// Replaces this run by another, which takes over its cost.
  void replace_by(RunSoFar other) {
    other.spent_before_ = spent();
    *this = std::move(other);
  }

  [[nodiscard]] double stops_at() const { return stops_at_; }

  /// The number of evaluations so far.
  [[nodiscard]] double spent() const { return std::max(spent_before_, effort().evaluations); }

  [[nodiscard]] IntegrationStatistics effort() const { return run_->effort(); }
  [[nodiscard]] double noise() const { return run_->noise(); }
  [[nodiscard]] std::span<const double> sizes() const { return run_->sizes(); }
  [[nodiscard]] std::string changes() const { return run_->changes(); }
  [[nodiscard]] std::optional<Method> changed_to() const { return run_->changed_to(); }

  /// Passes all numbers from which the run continues after the first `done` outputs.
  void pass(std::size_t done, Checkpoint& checkpoint) {
    if (known_ == 0) first_ = done;
    run_->pass(checkpoint);
    checkpoint(spent_before_);
    std::size_t ahead = first_ + known_ - done;
    checkpoint(ahead);
    for (std::size_t i = done; i < done + ahead; ++i) {
      double* const y =
          i == first_ + known_ ? next_state() : states_.data() + (i - first_) * components_;
      for (std::size_t k = 0; k < components_; ++k) checkpoint(y[k]);
    }
  }

 private:
  [[nodiscard]] double* next_state() {
    known_ += 1;
    states_.resize(known_ * components_);
    return states_.data() + (known_ - 1) * components_;
  }

  std::unique_ptr<Run> run_;
  std::size_t components_;
  double stops_at_;
  std::size_t first_ = 0;       ///< output that is kept
  std::size_t known_ = 0;       ///< number of outputs kept
  std::vector<double> states_;  ///< one after another
  double spent_before_ = 0;     ///< a lower bound of spent()
};

}  // namespace kreisel::detail
