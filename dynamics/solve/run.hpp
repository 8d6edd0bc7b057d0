#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <dynamics/compiled.hpp>
#include <dynamics/scene/closed_form.hpp>
#include <dynamics/scene/euler_top.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/task.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/bookmark.hpp>
#include <dynamics/step/radau.hpp>

/// Scenes and their integrators as solve() sees them: by the components of states, so that what runs
/// them and holds one against the other is the same for all, and compiled once. It asks at outputs,
/// never at steps.

namespace kreisel::detail {

/// An integration of a scene that is on its way.
class Run {
 public:
  virtual ~Run() = default;

  /// Writes the state at t to y; times are asked for in turn, steps lead to `end`. Where the field
  /// proves stiff, the state at an earlier time.
  virtual void on_the_way(double t, double end, double* y) = 0;

  [[nodiscard]] virtual const Effort& effort() const = 0;

  /// What rounding in the field has made by now, where the run knows that; else 0.
  [[nodiscard]] virtual double noise() const { return 0; }

  [[nodiscard]] virtual bool stiff() const { return false; }

  /// What it goes on from; nothing, where it cannot.
  virtual void pass(Bookmark& bookmark) = 0;
};

class SteppedScene;

/// Of steps for which a field may prove stiff.
class LookingRun : public Run {
 public:
  LookingRun(const SteppedScene& scene, bool other) : scene_(scene), other_(other) {}

  [[nodiscard]] bool stiff() const override { return stiff_; }

 protected:
  /// Looks at what is fastest in the field at t.
  ///
  /// length : of a step, by which it may be told that stability keeps steps short; 0 where
  ///          short_steps says it
  KREISEL_DECLARED [[nodiscard]] bool proves_stiff(double t, std::span<const double> y, double end,
                                                   bool short_steps, double length);

 private:
  const SteppedScene& scene_;
  bool other_;
  bool stiff_ = false;
};

/// Of explicit steps.
class ExplicitRun : public LookingRun {
 public:
  using LookingRun::LookingRun;

  /// One step towards `end`; the time reached.
  virtual double step_towards(double end) = 0;
};

/// The length of equal steps, all of which end at the output times.
struct EqualLength {
  double longest;

  /// Of the run beside which this one goes on, with at least one step more between any two outputs:
  /// else the two would be the same, and tell nothing of their error.
  double beside = std::numeric_limits<double>::infinity();

  template <class Bookmark>
  void pass(Bookmark& bookmark) {
    bookmark(longest, beside);
  }

  [[nodiscard]] double over(double interval) const {
    return std::min(longest, interval / (std::ceil(interval / beside) + 1));
  }

  template <class Steps>
  void advance(Steps& steps, double t) const {
    if (t == steps.t()) return;
    steps.take_steps_of(over(std::abs(t - steps.t())));
    steps.advance_to(t);
  }
};

/// A scene with the runs that there are of it.
///
/// other : of the scene that runs are held against, off by the last digits of parameters of which so
///         little makes much, where there is one
class SteppedScene {
 public:
  virtual ~SteppedScene() = default;

  [[nodiscard]] virtual std::vector<int> blocks() const = 0;
  [[nodiscard]] virtual bool has_other() const = 0;
  [[nodiscard]] virtual bool knows_series() const = 0;

  /// The scene itself, if it is a top: some have a method of their own.
  [[nodiscard]] virtual const EulerTop* top() const = 0;

  /// Keeps the largest drift of what the scene says is conserved.
  virtual void note_invariants(double t, std::span<const double> y,
                               std::vector<InvariantDrift>& drifts) const = 0;

  [[nodiscard]] virtual std::unique_ptr<StiffField> stiff_field(bool other) const = 0;

  [[nodiscard]] virtual std::unique_ptr<ExplicitRun> explicit_run(const Task& task,
                                                                  const Eigen::VectorXd& start,
                                                                  const Accuracy& accuracy,
                                                                  bool other) const = 0;
  [[nodiscard]] virtual std::unique_ptr<Run> taylor_run(const Task& task,
                                                        const Eigen::VectorXd& start,
                                                        const Accuracy& accuracy,
                                                        bool other) const = 0;
  [[nodiscard]] virtual std::unique_ptr<Run> gauss_run(const Task& task,
                                                       const Eigen::VectorXd& start,
                                                       const EqualLength& length,
                                                       bool other) const = 0;
};

/// Throws what is wrong with a task for this scene and this start.
KREISEL_DECLARED void check(const SteppedScene& scene, const Eigen::VectorXd& start,
                            const Task& task);

/// The motion of a scene by steps; its states are their components, one after another.
KREISEL_DECLARED [[nodiscard]] Trajectory<double> solve_by_steps(const SteppedScene& scene,
                                                                 const Eigen::VectorXd& start,
                                                                 const Task& task);

/// The same by the closed form.
KREISEL_DECLARED [[nodiscard]] Trajectory<double> solve_closed(
    const SteppedScene& scene, const Eigen::VectorXd& start, const Task& task,
    const ClosedForm<Eigen::VectorXd>& motion);

KREISEL_DECLARED [[noreturn]] void refuse_closed_form();

}  // namespace kreisel::detail
