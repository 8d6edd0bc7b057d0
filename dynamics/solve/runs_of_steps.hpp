#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/taylor.hpp>

/// Integrators as runs.

namespace kreisel::detail {

template <class Vector>
void write(double* y, const Vector& from) {
  std::copy_n(from.data(), from.size(), y);
}

/// The notes of steps that can be undone; of others nothing.
template <class Steps>
[[nodiscard]] auto notes_of(const Steps& steps) {
  if constexpr (requires { steps.notes(); }) {
    return steps.notes();
  } else {
    return std::monostate();
  }
}

/// A run by ExplicitRungeKutta or TaylorSteps.
template <class Steps>
class RunOfSteps final : public SteppedRun {
 public:
  RunOfSteps(const SteppedScene& scene, const SolveOptions& options, Steps steps)
      : SteppedRun(scene, options), steps_(std::move(steps)) {}

  void step_towards(double end, double /*output*/) override {
    take_samples(steps_);
    from_ = steps_.t();
    steps_.step_towards(end);
  }

  void cross(double end, double output) override {
    if constexpr (requires { steps_.cross_to(end); }) {
      take_samples(steps_);
      from_ = steps_.t();
      steps_.cross_to(end);
    } else {
      step_towards(end, output);
    }
  }

  [[nodiscard]] bool try_first_step(double h, double end, double output) override {
    if constexpr (requires { steps_.try_first_step(h, end); }) {
      take_samples(steps_);
      from_ = steps_.t();
      return steps_.try_first_step(h, end);
    } else {  // the length of a series' step is not given
      step_towards(end, output);
      return length() >= std::min(h, std::abs(end - from_));
    }
  }

  void prepare_undo() override {
    if constexpr (can_undo) notes_ = steps_.notes();
  }
  [[nodiscard]] bool undo_step() override {
    if constexpr (can_undo) {
      if (!notes_) return false;
      steps_.undo_step(*notes_);
      return true;
    } else {
      return false;
    }
  }

  [[nodiscard]] bool is_short_for_little() const override {
    if constexpr (requires { steps_.is_short_for_little(); }) {
      return steps_.is_short_for_little();
    } else {
      return false;
    }
  }

  void follow(const SteppedRun& leader) override {
    take_samples(steps_);
    from_ = steps_.t();
    steps_.follow(static_cast<const RunOfSteps&>(leader).steps_);
  }

  [[nodiscard]] double t() const override { return steps_.t(); }
  [[nodiscard]] std::span<const double> state() const override {
    return {steps_.y().data(), static_cast<std::size_t>(steps_.y().size())};
  }
  [[nodiscard]] double length() const override { return std::abs(steps_.t() - from_); }
  [[nodiscard]] bool covers(double t) const override { return steps_.covers(t); }
  void read(double t, double* y) override { write(y, steps_.at(t)); }
  void know_sizes(std::span<const double> sizes) override { steps_.set_sizes(sizes); }
  [[nodiscard]] IntegrationStatistics effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.rounding_level(); }

  void pass(Checkpoint& checkpoint) override {
    SteppedRun::pass(checkpoint);
    checkpoint(from_, steps_);
  }

 private:
  static constexpr bool can_undo = requires(const Steps& steps) { steps.notes(); };
  using Notes = decltype(notes_of(std::declval<const Steps&>()));

  Steps steps_;
  double from_ = 0;                            ///< start of the last step
  std::optional<Notes> notes_ = std::nullopt;  ///< before that step
};

template <class Steps>
class RunOfGaussIRK final : public Run {
 public:
  RunOfGaussIRK(const EqualLength& length, Steps steps)
      : length_(length), steps_(std::move(steps)) {}

  void on_the_way(double t, double /*end*/, double* y) override {
    length_.advance(steps_, t);
    sizes_ = steps_.sizes();
    write(y, steps_.y());
  }

  [[nodiscard]] std::span<const double> sizes() const override { return sizes_; }

  [[nodiscard]] IntegrationStatistics effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.rounding_level(); }
  void pass(Checkpoint& checkpoint) override { checkpoint(steps_); }

 private:
  EqualLength length_;
  Steps steps_;
  std::vector<double> sizes_;
};

/// A run of a scene's field by ExplicitRungeKutta; its states have the type Vector.
template <class Vector, class Field>
[[nodiscard]] std::unique_ptr<SteppedRun> run_explicit_steps(const SteppedScene& scene, Field field,
                                                             const SolveOptions& options,
                                                             const Eigen::VectorXd& start,
                                                             const Accuracy& accuracy) {
  using Steps = ExplicitRungeKutta<Vector, Field>;
  Steps steps(std::move(field), options.begin, vector_of<Vector>(start), accuracy, scene.blocks());
  steps.stop_at(options.discontinuities);
  return std::make_unique<RunOfSteps<Steps>>(scene, options, std::move(steps));
}

template <class Vector, class Field>
[[nodiscard]] std::unique_ptr<Run> run_gauss_steps(const SteppedScene& scene, Field field,
                                                   const SolveOptions& options,
                                                   const Eigen::VectorXd& start,
                                                   const EqualLength& length) {
  using Steps = GaussIRK<Vector, Field>;
  Steps steps(std::move(field), options.begin, vector_of<Vector>(start), length.longest,
              scene.blocks(), options.absolute_scale);
  steps.give_up_after(options.max_evaluations);
  steps.stop_by(options.stop);
  return std::make_unique<RunOfGaussIRK<Steps>>(length, std::move(steps));
}

template <class Vector, class Series>
[[nodiscard]] std::unique_ptr<SteppedRun> run_taylor_steps(const SteppedScene& scene, Series series,
                                                           const SolveOptions& options,
                                                           const Eigen::VectorXd& start,
                                                           const Accuracy& accuracy) {
  using Steps = TaylorSteps<Vector, Series>;
  Steps steps(std::move(series), options.begin, vector_of<Vector>(start), accuracy, scene.blocks());
  steps.stop_at(options.discontinuities);
  return std::make_unique<RunOfSteps<Steps>>(scene, options, std::move(steps));
}

}  // namespace kreisel::detail
