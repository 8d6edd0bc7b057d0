#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/solve/error_rules.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/checkpoint.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/stop.hpp>
#include <motor/api.hpp>

/// The interface between solve() and the integrators of a scene. States are arrays of components,
/// so that running and comparing integrations is compiled once for all scenes. solve() reads states
/// at outputs, never at steps.

namespace kreisel::detail {

/// An integration of a scene in progress.
class Run {
 public:
  virtual ~Run() = default;

  /// Writes the state at t to y. Times must be given in order; steps lead to `end`.
  virtual void on_the_way(double t, double end, double* y) = 0;

  /// The greatest size of each block at the start and at every step before the last time read;
  /// empty if the run keeps no sizes.
  [[nodiscard]] virtual std::span<const double> sizes() const { return {}; }

  [[nodiscard]] virtual IntegrationStatistics effort() const = 0;

  /// The effect of rounding in the field so far, if the run estimates it; else 0.
  [[nodiscard]] virtual double noise() const { return 0; }

  /// The changes of the method, as "taylor to t = 0.5 s, then radau13"; empty if there was none.
  [[nodiscard]] virtual std::string changes() const { return {}; }

  /// The method of the last step, if the method has changed.
  [[nodiscard]] virtual std::optional<Method> changed_to() const { return std::nullopt; }

  /// Passes all numbers from which the run continues; none if it cannot.
  virtual void pass(Checkpoint& checkpoint) = 0;
};

class SteppedScene;

/// An integration with steps of its own length. States within the last step can be read.
///
/// States are those before the samples at their time, which are taken at the begin of the next step.
/// A run begins with a state after the samples at its begin.
class SteppedRun : public Run {
 public:
  inline SteppedRun(const SteppedScene& scene, const SolveOptions& options);

  void on_the_way(double t, double end, double* y) override {
    while (!covers(t)) {
      stop_if_requested(stop_);
      note_sizes();
      step(end, t);
    }
    read(t, y);
  }

  /// Takes one step towards `end`, not beyond a corner; `output` is the next time at which the state
  /// is read.
  void step(double end, double output) {
    if (has_corners_) {
      step_to_corner(end, output);
    } else {
      step_towards(end, output);
    }
  }

  /// The same, whatever the corners are.
  virtual void step_towards(double end, double output) = 0;

  /// Takes a very short step to `end` across a corner, whatever its error.
  virtual void cross(double end, double output) { step_towards(end, output); }

  [[nodiscard]] virtual double t() const = 0;
  [[nodiscard]] virtual std::span<const double> state() const = 0;

  /// The length of the last step.
  [[nodiscard]] virtual double length() const = 0;

  /// True if t lies within the last step.
  [[nodiscard]] virtual bool covers(double t) const = 0;

  /// Writes the state at a time within the last step.
  virtual void read(double t, double* y) = 0;

  /// Tries a first step of length h at least, or to `end` if that is nearer. False if no such step
  /// is accepted: the run is then of no more use.
  [[nodiscard]] virtual bool try_first_step(double /*h*/, double /*end*/, double /*output*/) {
    return false;
  }

  /// Prepares for undo_step() after the next step.
  virtual void prepare_undo() {}
  /// Undoes the last step. False, with no effect, if the run cannot.
  [[nodiscard]] virtual bool undo_step() { return false; }

  /// As TaylorSteps::is_short_for_little().
  [[nodiscard]] virtual bool is_short_for_little() const { return false; }

  /// Repeats the last step of another run of the same kind, whatever its error in this run.
  virtual void follow(const SteppedRun& leader) = 0;

  /// Takes over the sizes of blocks before this run began; errors are relative to them.
  virtual void know_sizes(std::span<const double> sizes) = 0;

  /// Sets the length of the steps across corners, as a part of the steps before them.
  void cross_corners_by(double part) { corner_width_ = part; }

  /// The state with the samples at its time taken.
  [[nodiscard]] inline Eigen::VectorXd sampled_state() const;

  [[nodiscard]] std::span<const double> sizes() const override { return sizes_; }

  void pass(Checkpoint& checkpoint) override { checkpoint(sizes_, sampled_at_, uncut_); }

 protected:
  /// Takes the samples at the present time, once, before a step. States of fixed size have none.
  template <class Steps>
  void take_samples(Steps& steps) {
    if constexpr (std::is_same_v<decltype(steps.y()), const Eigen::VectorXd&>) {
      if (!has_samples_ || t() == sampled_at_) return;
      steps.jump_to(sampled_state());
      sampled_at_ = t();
    }
  }

 private:
  /// A corner within the last step. An unsure one is a time at which a function comes too near to 0
  /// for the length of the step.
  struct CornerTime {
    double t;
    bool is_sure;
  };

  /// Times nearer to a corner at t cannot be told from it.
  [[nodiscard]] double width_of_corner(double t) const;

  /// Crosses a corner that is nearer than its width, but not a jump or `end`.
  void cross_corner(double ahead, double end, double output);
  /// Takes a step that ends before the first corner on its way, or crosses the corner at its begin.
  KREISEL_API void step_to_corner(double end, double output);
  /// first, y : the corners and the state at the begin of the step
  [[nodiscard]] std::optional<CornerTime> first_corner(const std::vector<Corner>& first,
                                                       double from, const Eigen::VectorXd& y) const;
  /// The corners at the end of a step from `from`, before a jump there.
  [[nodiscard]] std::vector<Corner> corners_after(double from) const;

  void note_sizes() {
    const std::span<const double> y = state();
    const Eigen::Map<const Eigen::VectorXd> components(y.data(),
                                                       static_cast<Eigen::Index>(y.size()));
    int begin = 0;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      sizes_[i] = std::max(sizes_[i], norm(components, begin, blocks_[i]));
      begin += blocks_[i];
    }
  }

  const SteppedScene& scene_;
  bool has_samples_;
  bool has_corners_;
  double uncut_ = 0;  ///< length of the last step that no corner cut
  double corner_width_ = rules::corner_width;
  double sampled_at_;          ///< time of the last samples, or the begin
  std::vector<double> jumps_;  ///< of a scene with corners
  std::vector<int> blocks_;
  std::vector<double> sizes_;
  std::stop_token stop_;
};

/// The length of equal steps. A step ends at every output time.
struct EqualLength {
  double longest;

  /// The step length of the coarser run of a pair. This run takes at least one step more between
  /// two outputs: equal runs would give no error estimate.
  double beside = std::numeric_limits<double>::infinity();

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(longest, beside);
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

/// A scene and its runs.
///
/// other : true for the comparison scene, if there is one: a copy whose sensitive parameters are
///         perturbed by their last digits
class SteppedScene {
 public:
  virtual ~SteppedScene() = default;

  [[nodiscard]] virtual std::vector<int> blocks() const = 0;
  [[nodiscard]] virtual bool has_other() const = 0;
  [[nodiscard]] virtual bool knows_series() const = 0;

  /// True if parts of the state jump at samples.
  [[nodiscard]] virtual bool has_samples() const = 0;

  /// The times of samples in (begin, end], in order.
  [[nodiscard]] virtual std::vector<double> sample_times(double begin, double end) const = 0;

  /// The state after the samples at t; the same if there are none.
  [[nodiscard]] virtual Eigen::VectorXd sampled(double t, const Eigen::VectorXd& y) const = 0;

  /// The functions whose changes of sign are corners of the field.
  [[nodiscard]] virtual bool has_corners() const = 0;
  [[nodiscard]] virtual std::vector<Corner> corners(double t, std::span<const double> y) const = 0;
  [[nodiscard]] virtual double corner_frequency() const = 0;

  /// True if a part of the scene may make it stiff, or if the scene does not declare this.
  [[nodiscard]] virtual bool may_be_stiff() const = 0;

  /// The scene itself, if it is a top: some have a method of their own.
  [[nodiscard]] virtual const EulerTop* top() const = 0;

  /// Records the largest drift of each conserved quantity of the scene.
  virtual void note_invariants(double t, std::span<const double> y,
                               std::vector<InvariantDrift>& drifts) const = 0;

  [[nodiscard]] virtual std::unique_ptr<StiffField> stiff_field(bool other) const = 0;

  /// Runs begin with `start` at options.begin.
  [[nodiscard]] virtual std::unique_ptr<SteppedRun> explicit_run(const SolveOptions& options,
                                                                 const Eigen::VectorXd& start,
                                                                 const Accuracy& accuracy,
                                                                 bool other) const = 0;
  [[nodiscard]] virtual std::unique_ptr<SteppedRun> taylor_run(const SolveOptions& options,
                                                               const Eigen::VectorXd& start,
                                                               const Accuracy& accuracy,
                                                               bool other) const = 0;
  [[nodiscard]] virtual std::unique_ptr<Run> gauss_run(const SolveOptions& options,
                                                       const Eigen::VectorXd& start,
                                                       const EqualLength& length,
                                                       bool other) const = 0;
};

inline SteppedRun::SteppedRun(const SteppedScene& scene, const SolveOptions& options)
    : scene_(scene),
      has_samples_(scene.has_samples()),
      has_corners_(scene.has_corners()),
      sampled_at_(options.begin),
      jumps_(has_corners_ ? sorted(options.discontinuities) : std::vector<double>()),
      blocks_(scene.blocks()),
      sizes_(blocks_.size(), options.absolute_scale),
      stop_(options.stop) {}

inline Eigen::VectorXd SteppedRun::sampled_state() const {
  const Eigen::VectorXd y = vector_of<Eigen::VectorXd>(state());
  return has_samples_ && t() != sampled_at_ ? scene_.sampled(t(), y) : y;
}

/// Throws : InvalidInput if the options do not fit this scene and this start
KREISEL_API void check(const SteppedScene& scene, const Eigen::VectorXd& start,
                       const SolveOptions& options);

/// The function that solve() calls at outputs, on components; may be empty.
using OnComponents = std::function<OutputAction(double t, std::span<const double> state)>;

/// The motion of a scene, by steps. Its states are stored as their components, one after another.
KREISEL_API [[nodiscard]] Trajectory<double> solve_by_steps(const SteppedScene& scene,
                                                            const Eigen::VectorXd& start,
                                                            const SolveOptions& options,
                                                            const OnComponents& on_output);

/// The motion of a scene, by its closed form, stored as by solve_by_steps().
KREISEL_API [[nodiscard]] Trajectory<double> solve_closed(const SteppedScene& scene,
                                                          const Eigen::VectorXd& start,
                                                          const SolveOptions& options,
                                                          const ClosedForm<Eigen::VectorXd>& motion,
                                                          const OnComponents& on_output);

KREISEL_API [[noreturn]] void refuse_closed_form();

}  // namespace kreisel::detail
