#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/checkpoint.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/shared.hpp>
#include <dynamics/step/taylor.hpp>

namespace kreisel::detail {

/// The eigenvalue of greatest modulus of the Jacobian; 0 if the Jacobian is not finite, because a
/// failed stiffness check must not end the run.
[[nodiscard]] inline std::complex<double> dominant_eigenvalue(const SteppedScene& scene, bool other,
                                                              double t, const Eigen::VectorXd& y) {
  Eigen::MatrixXd J(y.size(), y.size());
  scene.stiff_field(other)->jacobian(t, y, J);
  std::complex<double> fastest = 0;
  if (y.size() == 0 || !finite(J)) return fastest;
  for (const std::complex<double>& rate : eigenvalues(J)) {
    if (std::abs(rate) > std::abs(fastest)) fastest = rate;
  }
  return fastest;
}

/// A run of radau13.
class RadauRun final : public SteppedRun {
 public:
  RadauRun(const SteppedScene& scene, bool other, const SolveOptions& options,
           const Eigen::VectorXd& start, const Accuracy& accuracy)
      : SteppedRun(scene.blocks(), options),
        field_(scene.stiff_field(other)),
        steps_(radau_coefficients<7>(), options.begin, start, accuracy, scene.blocks()),
        from_(options.begin) {
    steps_.stop_at(options.discontinuities);
  }

  void step_towards(double end, double output) override {
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
    return steps_.try_first_step(*field_, h, end, output);
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
  double from_;
};

/// A run by verner98 or taylor that changes to radau13 and back where that takes fewer evaluations.
/// It changes to verner98 where the series of taylor fails or allows only short steps.
///
/// A field is stiff where stability limits explicit steps, although the motion is damped away. A
/// trial decides: one step of radau13, ten times as long, must be accepted. It is rejected while an
/// oscillation that radau13 would damp exceeds the accuracy.
class SwitchingRun final : public SteppedRun {
 public:
  SwitchingRun(const SteppedScene& scene, bool other, const SolveOptions& options, Method first,
               const Eigen::VectorXd& start, const Accuracy& accuracy)
      : SteppedRun(scene.blocks(), options),
        scene_(scene),
        other_(other),
        accuracy_(accuracy),
        first_(first),
        explicit_(first),
        method_(first),
        // Beyond 200 components factorisations would dominate the cost.
        looks_((first == Method::verner98 || scene.may_be_stiff()) && start.size() <= 200) {
    here_.begin = options.begin;
    here_.discontinuities = options.discontinuities;
    here_.absolute_scale = options.absolute_scale;
    run_ = run_by(first, start);
  }

  void step_towards(double end, double output) override {
    choose_method(end, output);
    if (run_->covers(output)) return;  // by the trial step
    try {
      run_->step_towards(end, output);
    } catch (const SeriesFailed&) {
      change_to(Method::verner98);
      run_->step_towards(end, output);
    }
  }

  void follow(const SteppedRun& other) override {
    const auto& leader = static_cast<const SwitchingRun&>(other);
    if (leader.method_ != method_) change_to(leader.method_);
    run_->follow(*leader.run_);
  }

  [[nodiscard]] double t() const override { return run_->t(); }
  [[nodiscard]] std::span<const double> state() const override { return run_->state(); }
  [[nodiscard]] double length() const override { return run_->length(); }
  [[nodiscard]] bool covers(double t) const override { return run_->covers(t); }
  void read(double t, double* y) override { run_->read(t, y); }
  void know_sizes(std::span<const double> sizes) override { run_->know_sizes(sizes); }

  [[nodiscard]] IntegrationStatistics effort() const override {
    return sum(finished_, run_->effort());
  }
  /// The noise of the last method: a stiff, damped motion forgets the noise of explicit steps.
  [[nodiscard]] double noise() const override { return run_->noise(); }
  [[nodiscard]] std::optional<Method> changed_to() const override {
    if (changes_.empty()) return std::nullopt;
    return method_;
  }

  [[nodiscard]] std::string changes() const override {
    std::ostringstream text;
    text.precision(6);
    Method before = first_;
    for (const Change& change : changes_) {
      text << name(before) << " to t = " << change.t << " s, then ";
      before = change.to;
    }
    if (!changes_.empty()) text << name(before);
    return text.str();
  }

  void pass(Checkpoint& checkpoint) override {
    std::size_t count = changes_.size();
    checkpoint(count);
    constexpr std::size_t most_changes = 1000000;
    if (count > most_changes) refuse_task("the checkpoint is not of this run");
    changes_.resize(count);
    for (Change& change : changes_) {
      auto to = static_cast<double>(change.to);
      checkpoint(change.t, to);
      const bool known = to == static_cast<double>(Method::verner98) ||
                         to == static_cast<double>(Method::radau13) ||
                         to == static_cast<double>(first_);
      if (!known) refuse_task("the checkpoint is not of this run");
      change.to = static_cast<Method>(static_cast<int>(to));
      if (change.to != Method::radau13) explicit_ = change.to;
    }
    const Method now = changes_.empty() ? first_ : changes_.back().to;
    if (now != method_) run_ = run_by(now, vector_of<Eigen::VectorXd>(run_->state()));
    method_ = now;
    SteppedRun::pass(checkpoint);
    checkpoint(finished_, next_look_, needless_);
    run_->pass(checkpoint);
  }

 private:
  struct Change {
    double t = 0;
    Method to = Method::verner98;
  };

  [[nodiscard]] static IntegrationStatistics sum(const IntegrationStatistics& a,
                                                 const IntegrationStatistics& b) {
    return {a.steps + b.steps, a.rejected + b.rejected, a.evaluations + b.evaluations,
            a.jacobians + b.jacobians};
  }

  /// A run that begins at the present time.
  [[nodiscard]] std::unique_ptr<SteppedRun> run_by(Method method, const Eigen::VectorXd& y) const {
    Accuracy accuracy = accuracy_;
    accuracy.max_evaluations = std::max(1.0, accuracy_.max_evaluations - finished_.evaluations);
    if (method == Method::taylor) return scene_.taylor_run(here_, y, accuracy, other_);
    if (method == Method::verner98) return scene_.explicit_run(here_, y, accuracy, other_);
    return radau_run(y, accuracy);
  }

  [[nodiscard]] std::unique_ptr<RadauRun> radau_run(const Eigen::VectorXd& y,
                                                    Accuracy accuracy) const {
    // The finest pair of explicit runs corresponds to the finest pair of implicit runs.
    constexpr double finest = 4e-16;
    const bool beyond = accuracy.relative < (first_ == Method::taylor ? 1e-18 : 1e-16);
    accuracy.relative = beyond ? 1e-16 : std::max(accuracy.relative, finest);
    return std::make_unique<RadauRun>(scene_, other_, here_, y, accuracy);
  }

  [[nodiscard]] Eigen::VectorXd present() {
    here_.begin = run_->t();
    const std::span<const double> y = run_->state();
    return Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
  }

  void change_to(Method method) {
    const Eigen::VectorXd y = present();
    auto run = run_by(method, y);
    run->know_sizes(sizes());
    adopt(method, std::move(run), run_->t());
  }

  void adopt(Method method, std::unique_ptr<SteppedRun> run, double t) {
    finished_ = sum(finished_, run_->effort());
    changes_.push_back({t, method});
    method_ = method;
    if (method != Method::radau13) explicit_ = method;
    run_ = std::move(run);
    needless_ = 0;
    next_look_ = first_look;
  }

  void choose_method(double end, double output) {
    if (method_ != Method::radau13) {
      if (run_->effort().steps < next_look_) return;
      if (run_->is_short_for_little() && try_verner98(end, output)) return;
      next_look_ *= looks_ && try_radau(end, output) ? 1.25 : 2;
      return;
    }
    // Explicit steps can be as long as such short implicit steps.
    const auto& radau = static_cast<const RadauRun&>(*run_);
    needless_ = radau.fastest_times_step() < 1 ? needless_ + 1 : 0;
    if (needless_ >= 50) change_to(explicit_);
  }

  /// Changes from taylor to verner98 if steps three times as long are accepted. In a fast rotation
  /// of a body that is symmetric but for rounding, series amplify rounding; stages do not.
  [[nodiscard]] bool try_verner98(double end, double output) {
    const Eigen::VectorXd y = present();
    auto trial = run_by(Method::verner98, y);
    trial->know_sizes(sizes());
    const double from = run_->t();
    const bool pays = trial->try_first_step(3 * run_->length(), end, output);
    if (pays) {
      adopt(Method::verner98, std::move(trial), from);
    } else {
      finished_ = sum(finished_, trial->effort());
    }
    return pays;
  }

  /// Changes to radau13 if that pays; else true if it may pay later.
  [[nodiscard]] bool try_radau(double end, double output) {
    const Eigen::VectorXd y = present();
    const std::complex<double> fastest = dominant_eigenvalue(scene_, other_, run_->t(), y);
    const double speed = std::abs(fastest);
    constexpr double soon = 1e-3;  // of the time left
    const bool dies_soon =
        fastest.real() < -0.5 * speed && speed * std::abs(end - run_->t()) > 1 / soon;
    if (dies_soon) {
      change_to(Method::radau13);
      return true;
    }
    // A series of order 20 follows an oscillation in steps of 2 radians. Explicit steps are shorter
    // for a motion forced through a well-damped mode. Implicit steps may damp a mode that dies
    // before the next output; this costs no more from twice the length on.
    const double angle = speed * run_->length();
    if (angle < 0.2) return false;
    auto trial = radau_run(y, accuracy_);
    const double remains = std::exp(fastest.real() * std::abs(output - run_->t()));
    const bool dies = remains * trial->allowed() < accuracy_.relative;
    const bool well_damped = fastest.real() < -0.2 * speed;
    if (angle < 1.5 && !well_damped && !dies) return false;
    trial->know_sizes(sizes());
    const double from = run_->t();
    if (trial->try_first_step((dies ? 2 : 10) * run_->length(), end, output)) {
      adopt(Method::radau13, std::move(trial), from);
    } else {
      finished_ = sum(finished_, trial->effort());
    }
    return fastest.real() < 0 && angle >= 1.5;
  }

  static constexpr double first_look = 16;  // steps

  const SteppedScene& scene_;
  bool other_;
  Accuracy accuracy_;
  Method first_;
  Method explicit_;  ///< the last one before radau13
  Method method_;
  bool looks_;
  SolveOptions here_;  ///< begins at the state from which the last method began
  std::unique_ptr<SteppedRun> run_;
  std::vector<Change> changes_;
  IntegrationStatistics finished_;  ///< of the methods before
  double next_look_ = first_look;
  int needless_ = 0;  ///< consecutive steps of radau13 that could have been explicit
};

}  // namespace kreisel::detail
