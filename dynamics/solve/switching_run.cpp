#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/solve/switching_run.hpp>
#include <dynamics/step/shared.hpp>
#include <dynamics/step/taylor.hpp>
#include <dynamics/step/verner.hpp>

namespace kreisel::detail {

namespace {

[[nodiscard]] IntegrationStatistics sum(const IntegrationStatistics& a,
                                        const IntegrationStatistics& b) {
  return {a.steps + b.steps, a.rejected + b.rejected, a.evaluations + b.evaluations,
          a.jacobians + b.jacobians};
}

}  // namespace

std::complex<double> dominant_eigenvalue(const SteppedScene& scene, bool other, double t,
                                         const Eigen::VectorXd& y) {
  Eigen::MatrixXd J(y.size(), y.size());
  scene.stiff_field(other)->jacobian(t, y, J);
  std::complex<double> fastest = 0;
  if (y.size() == 0 || !finite(J)) return fastest;
  for (const std::complex<double>& rate : eigenvalues(J)) {
    if (std::abs(rate) > std::abs(fastest)) fastest = rate;
  }
  return fastest;
}

SwitchingRun::SwitchingRun(const SteppedScene& scene, bool other, const SolveOptions& options,
                           Method first, const Eigen::VectorXd& start, const Accuracy& accuracy)
    : SteppedRun(scene, options),
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

void SwitchingRun::step_towards(double end, double output) {
  choose_method(end, output);
  if (run_->covers(output)) return;  // by the trial step
  try {
    run_->step_towards(end, output);
  } catch (const SeriesFailed&) {
    change_to(Method::verner98);
    run_->step_towards(end, output);
  }
}

void SwitchingRun::follow(const SteppedRun& other) {
  const auto& leader = static_cast<const SwitchingRun&>(other);
  if (leader.method_ != method_) change_to(leader.method_);
  run_->follow(*leader.run_);
}

IntegrationStatistics SwitchingRun::effort() const { return sum(finished_, run_->effort()); }

std::optional<Method> SwitchingRun::changed_to() const {
  if (changes_.empty()) return std::nullopt;
  return method_;
}

std::string SwitchingRun::changes() const {
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

void SwitchingRun::pass_changes(Checkpoint& checkpoint) {
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
}

void SwitchingRun::pass(Checkpoint& checkpoint) {
  pass_changes(checkpoint);
  const Method now = changes_.empty() ? first_ : changes_.back().to;
  if (now != method_) run_ = run_by(now, vector_of<Eigen::VectorXd>(run_->state()));
  method_ = now;
  SteppedRun::pass(checkpoint);
  checkpoint(finished_, next_look_, needless_);
  run_->pass(checkpoint);
}

std::unique_ptr<SteppedRun> SwitchingRun::run_by(Method method, const Eigen::VectorXd& y) const {
  Accuracy accuracy = accuracy_;
  accuracy.max_evaluations = std::max(1.0, accuracy_.max_evaluations - finished_.evaluations);
  if (method == Method::taylor) return scene_.taylor_run(here_, y, accuracy, other_);
  if (method == Method::verner98) return scene_.explicit_run(here_, y, accuracy, other_);
  return radau_run(y, accuracy);
}

std::unique_ptr<RadauRun> SwitchingRun::radau_run(const Eigen::VectorXd& y,
                                                  Accuracy accuracy) const {
  // The finest pair of explicit runs corresponds to the finest pair of implicit runs.
  const bool beyond = accuracy.relative < traits_of(first_).finest;
  constexpr double finer_of_last_pair = 1e-16;
  accuracy.relative =
      beyond ? finer_of_last_pair : std::max(accuracy.relative, rules::finest_radau13);
  return std::make_unique<RadauRun>(scene_, other_, here_, y, accuracy);
}

Eigen::VectorXd SwitchingRun::present() {
  here_.begin = run_->t();
  return run_->sampled_state();
}

void SwitchingRun::change_to(Method method) {
  const Eigen::VectorXd y = present();
  auto run = run_by(method, y);
  run->know_sizes(sizes());
  adopt(method, std::move(run), run_->t());
}

void SwitchingRun::adopt(Method method, std::unique_ptr<SteppedRun> run, double t) {
  finished_ = sum(finished_, run_->effort());
  changes_.push_back({t, method});
  method_ = method;
  if (method != Method::radau13) explicit_ = method;
  run_ = std::move(run);
  needless_ = 0;
  next_look_ = method == Method::radau13 ? first_look_back : first_look;
}

void SwitchingRun::choose_method(double end, double output) {
  if (method_ != Method::radau13) {
    if (run_->effort().steps < next_look_) return;
    if (run_->is_short_for_little() && try_verner98(end, output)) return;
    next_look_ *= looks_ && try_radau(end, output) ? 1.25 : 2;
    return;
  }
  // Explicit steps of this length are stable, and cost less.
  constexpr double stable_series = 6;  // of order 20
  const double stable = explicit_ == Method::taylor ? stable_series : 0.8 * Verner98::stable;
  const auto& radau = static_cast<const RadauRun&>(*run_);
  needless_ = radau.fastest_times_step() < stable ? needless_ + 1 : 0;
  if (needless_ < next_look_) return;
  if (!try_run(explicit_, run_by(explicit_, present()), run_->length(), end, output)) {
    next_look_ *= 2;
  }
}

/// Changes to a method if its run, which begins here, accepts a first step of this length.
bool SwitchingRun::try_run(Method method, std::unique_ptr<SteppedRun> trial, double length,
                           double end, double output) {
  trial->know_sizes(sizes());
  const double from = run_->t();
  const auto accepts = [&] {
    try {
      return trial->try_first_step(length, end, output);
    } catch (const SeriesFailed&) {
      return false;
    }
  };
  const bool accepted = accepts();
  if (accepted) {
    adopt(method, std::move(trial), from);
  } else {
    finished_ = sum(finished_, trial->effort());
  }
  return accepted;
}

/// True after a change back from radau13.
bool SwitchingRun::was_implicit() const {
  return std::any_of(changes_.begin(), changes_.end(),
                     [](const Change& change) { return change.to == Method::radau13; });
}

/// Changes from taylor to verner98 if steps three times as long are stable and accepted. In a fast
/// rotation of a body that is symmetric but for rounding, series amplify rounding; stages do not. In
/// a damped motion near its rest a single long step says nothing: the next ones diverge.
bool SwitchingRun::try_verner98(double end, double output) {
  const Eigen::VectorXd y = present();
  const double speed = std::abs(dominant_eigenvalue(scene_, other_, run_->t(), y));
  if (speed * 3 * run_->length() > Verner98::stable) return false;
  return try_run(Method::verner98, run_by(Method::verner98, y), 3 * run_->length(), end, output);
}

/// Changes to radau13 if that pays; else true if it may pay later.
bool SwitchingRun::try_radau(double end, double output) {
  const Eigen::VectorXd y = present();
  const std::complex<double> fastest = dominant_eigenvalue(scene_, other_, run_->t(), y);
  const double speed = std::abs(fastest);
  constexpr double soon = 1e-3;  // of the time left
  const bool dies_soon =
      fastest.real() < -0.5 * speed && speed * std::abs(end - run_->t()) > 1 / soon;
  if (dies_soon && !was_implicit()) {
    change_to(Method::radau13);
    return true;
  }
  // A series of order 20 follows an oscillation in steps of 2 radians. Explicit steps are shorter
  // for a motion forced through a well-damped mode. Implicit steps may damp a mode that dies before
  // the next output; this costs no more from twice the length on.
  const double angle = speed * run_->length();
  if (angle < 0.2) return false;
  auto trial = radau_run(y, accuracy_);
  const double remains = std::exp(fastest.real() * std::abs(output - run_->t()));
  const bool dies = remains * trial->allowed() < accuracy_.relative;
  const bool well_damped = fastest.real() < -0.2 * speed;
  if (angle < 1.5 && !well_damped && !dies) return false;
  if (try_run(Method::radau13, std::move(trial), (dies ? 2 : 10) * run_->length(), end, output)) {
    return true;
  }
  return fastest.real() < 0 && angle >= 1.5;
}

}  // namespace kreisel::detail
