#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <dynamics/solve/run.hpp>
#include <dynamics/solve/task.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/taylor.hpp>

/// Integrators as runs, and how they are set out.

namespace kreisel::detail {

template <class Vector>
void write(double* y, const Vector& from) {
  std::copy_n(from.data(), from.size(), y);
}

template <class Steps>
class RunOfExplicitSteps final : public ExplicitRun {
 public:
  RunOfExplicitSteps(const SteppedScene& scene, bool other, bool looks, Steps steps)
      : ExplicitRun(scene, other), looks_(looks), steps_(std::move(steps)) {}

  void on_the_way(double t, double end, double* y) override {
    while (!steps_.covers(t)) {
      steps_.step_towards(end);
      if (looks_ && looks_now(end, y)) return;
    }
    write(y, steps_.at(t));
  }

  double step_towards(double end) override {
    steps_.step_towards(end);
    return steps_.t();
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(looks_, steps_); }

 private:
  /// Looked at once, or where it seems to be stability that keeps the steps short.
  [[nodiscard]] bool looks_now(double end, double* y) {
    const bool looks_early = steps_.effort().steps == 50;
    if (!looks_early && !steps_.stiff()) return false;
    write(y, steps_.y());
    const auto components = static_cast<std::size_t>(steps_.y().size());
    const bool stiff = proves_stiff(steps_.t(), {y, components}, end, steps_.stiff(), 0);
    looks_ = !stiff && looks_early;
    return stiff;
  }

  bool looks_;
  Steps steps_;
};

template <class Steps>
class RunOfTaylorSteps final : public LookingRun {
 public:
  RunOfTaylorSteps(const SteppedScene& scene, bool other, bool looks, Steps steps)
      : LookingRun(scene, other), looks_(looks), steps_(std::move(steps)) {}

  void on_the_way(double t, double end, double* y) override {
    while (!steps_.covers(t)) {
      steps_.step_towards(end);
      if (!looks_ || steps_.effort().steps < next_look_) continue;
      next_look_ *= 2;
      write(y, steps_.y());
      const auto components = static_cast<std::size_t>(steps_.y().size());
      if (proves_stiff(steps_.t(), {y, components}, end, false, steps_.length())) return;
    }
    write(y, steps_.at(t));
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(next_look_, steps_); }

 private:
  bool looks_;
  double next_look_ = 50;
  Steps steps_;
};

template <class Steps>
class RunOfGaussSteps final : public Run {
 public:
  RunOfGaussSteps(const EqualLength& length, Steps steps)
      : length_(length), steps_(std::move(steps)) {}

  void on_the_way(double t, double /*end*/, double* y) override {
    length_.advance(steps_, t);
    write(y, steps_.y());
  }

  [[nodiscard]] const Effort& effort() const override { return steps_.effort(); }
  [[nodiscard]] double noise() const override { return steps_.noise(); }
  void pass(Bookmark& bookmark) override { bookmark(steps_); }

 private:
  EqualLength length_;
  Steps steps_;
};

/// Whether radau13 may take over, so that it makes sense to look whether a field is stiff; not where
/// its factorisations would outweigh everything.
[[nodiscard]] inline bool may_give_way(const Task& task, const Eigen::VectorXd& start) {
  return task.method == Method::automatic && start.size() <= 200;
}

/// Of a scene's field, that of the other one where `other` says so; states are of the kind Vector.
template <class Vector, class Field>
[[nodiscard]] std::unique_ptr<ExplicitRun> run_explicit_steps(const SteppedScene& scene, bool other,
                                                              Field field, const Task& task,
                                                              const Eigen::VectorXd& start,
                                                              const Accuracy& accuracy) {
  using Steps = ExplicitSteps<Vector, Field>;
  const bool looks = may_give_way(task, start);
  Steps steps(std::move(field), task.begin, vector_of<Vector>(start), accuracy, scene.blocks());
  steps.stop_at(task.jumps);
  return std::make_unique<RunOfExplicitSteps<Steps>>(scene, other, looks, std::move(steps));
}

template <class Vector, class Field>
[[nodiscard]] std::unique_ptr<Run> run_gauss_steps(const SteppedScene& scene, Field field,
                                                   const Task& task, const Eigen::VectorXd& start,
                                                   const EqualLength& length) {
  using Steps = GaussSteps<Vector, Field>;
  Steps steps(std::move(field), task.begin, vector_of<Vector>(start), length.longest,
              scene.blocks(), task.smallest);
  steps.give_up_after(task.most_evaluations);
  return std::make_unique<RunOfGaussSteps<Steps>>(length, std::move(steps));
}

template <class Vector, class Series>
[[nodiscard]] std::unique_ptr<Run> run_taylor_steps(const SteppedScene& scene, bool other,
                                                    bool may_be_stiff, Series series,
                                                    const Task& task, const Eigen::VectorXd& start,
                                                    const Accuracy& accuracy) {
  using Steps = TaylorSteps<Vector, Series>;
  const bool looks = may_be_stiff && may_give_way(task, start);
  Steps steps(std::move(series), task.begin, vector_of<Vector>(start), accuracy, scene.blocks());
  steps.stop_at(task.jumps);
  return std::make_unique<RunOfTaylorSteps<Steps>>(scene, other, looks, std::move(steps));
}

}  // namespace kreisel::detail
