#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/checkpoint.hpp>
#include <dynamics/step/radau.hpp>

namespace kreisel::detail {

/// A run of radau13.
class RadauRun final : public SteppedRun {
 public:
  RadauRun(const SteppedScene& scene, bool other, const SolveOptions& options,
           const Eigen::VectorXd& start, const Accuracy& accuracy)
      : SteppedRun(scene, options),
        field_(scene.stiff_field(other)),
        steps_(radau_coefficients<7>(), options.begin, start, accuracy, scene.blocks()),
        from_(options.begin) {
    steps_.stop_at(options.discontinuities);
  }

  void step_towards(double end, double output) override {
    take_samples(steps_);
    from_ = steps_.t();
    steps_.step_towards(*field_, end, output);
  }

  /// Advances to the leader's time. Implicit steps forget their errors, so both runs need not take
  /// the same steps.
  void follow(const SteppedRun& leader) override {
    while (t() != leader.t()) step_towards(leader.t(), leader.t());
  }

  /// As RadauIntegrator::try_first_step.
  [[nodiscard]] bool try_first_step(double h, double end, double output) override {
    take_samples(steps_);
    return steps_.try_first_step(*field_, h, end, output);
  }
  void prepare_undo() override { notes_ = steps_.notes(); }
  [[nodiscard]] bool undo_step() override {
    if (!notes_) return false;
    steps_.undo_step(*notes_);
    return true;
  }
  [[nodiscard]] double allowed() const { return steps_.allowed(); }
  [[nodiscard]] double fastest_times_step() const { return steps_.fastest_times_step(); }

  [[nodiscard]] double t() const override { return steps_.t(); }
  [[nodiscard]] std::span<const double> state() const override {
    return {steps_.y().data(), static_cast<std::size_t>(steps_.y().size())};
  }
  [[nodiscard]] double length() const override { return std::abs(steps_.t() - from_); }
  [[nodiscard]] bool covers(double t) const override { return steps_.covers(t); }
  void read(double t, double* y) override {
    const Eigen::VectorXd there = steps_.at(*field_, t);
    std::copy_n(there.data(), there.size(), y);
  }
  void know_sizes(std::span<const double> sizes) override { steps_.set_sizes(sizes); }

  [[nodiscard]] IntegrationStatistics effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.rounding_level(); }

  void pass(Checkpoint& checkpoint) override {
    SteppedRun::pass(checkpoint);
    checkpoint(from_, steps_);
  }

 private:
  std::unique_ptr<StiffField> field_;
  RadauIntegrator steps_;
  std::optional<RadauIntegrator::Notes> notes_ = std::nullopt;  ///< before the last step
  double from_;
};

}  // namespace kreisel::detail
