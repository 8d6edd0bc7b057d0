#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include <dynamics/ensemble/packed_steps.hpp>
#include <dynamics/solve/comparison_times.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/refinement.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel::detail {

/// Continues until the last step covers t; returns false if a stop was requested.
template <class Run>
[[nodiscard]] bool go_on(Run& run, double t, double end, const std::stop_token& stop) {
  while (!run.covers(t)) {
    if (stop.stop_requested()) return false;
    run.step_towards(end);
  }
  return true;
}

/// The growth of rounding in each member, estimated as by RoundingGrowth of solve().
template <class Scene, class N>
class RoundingGrowthOfMembers {
 public:
  using Values = std::array<double, std::size_t(lanes_of<N>)>;

  RoundingGrowthOfMembers(const Scene& scene, double absolute_scale,
                          PackedIntegrator<Scene, N> unperturbed,
                          PackedIntegrator<Scene, N> perturbed)
      : scene_(scene),
        unperturbed_(std::move(unperturbed)),
        perturbed_(std::move(perturbed)),
        distance_(std::size_t(lanes_of<N>), {scene, absolute_scale}) {}

  /// The growth at t; times must be given in order. 0 if the coarse steps fail or a stop is
  /// requested.
  [[nodiscard]] Values at(double t, double end, const std::stop_token& stop) {
    Values grown{};
    if (gave_up_) return grown;
    try {
      if (!go_on(unperturbed_, t, end, stop) || !go_on(perturbed_, t, end, stop)) return grown;
      const auto a = unperturbed_.at(t);
      const auto b = perturbed_.at(t);
      for (std::size_t k = 0; k < grown.size(); ++k) {
        const double off = distance_[k](scene_.to_vector(a[k]), scene_.to_vector(b[k]));
        gave_up_ = gave_up_ || !std::isfinite(off);
        grown[k] = gave_up_ ? 0 : Levels::rounding_of(off);
      }
    } catch (...) {  // an exception of a load or a guide here does not affect the answer
      gave_up_ = true;
    }
    return grown;
  }

  [[nodiscard]] double evaluations() const {
    return unperturbed_.effort().evaluations + perturbed_.effort().evaluations;
  }

 private:
  const Scene& scene_;
  PackedIntegrator<Scene, N> unperturbed_;
  PackedIntegrator<Scene, N> perturbed_;
  std::vector<ErrorMeasure<Scene>> distance_;
  bool gave_up_ = false;
};

/// The options that the members of a pack share.
struct PackOptions {
  const SolveOptions& options;
  bool estimates_errors;
  const std::stop_token& stop;
};

/// Members side by side through all output times, each with a finer companion run, as PairedRuns
/// does for one scene. Null members fill a pack.
template <class N, class Scene>
class PackedPair {
  static constexpr std::size_t lanes{lanes_of<N>};
  using Integration = PackedIntegrator<Scene, N>;
  using Values = std::array<double, lanes>;

 public:
  using Members = std::array<Trajectory<typename Scene::State>*, lanes>;

  PackedPair(const Scene& scene, const typename Integration::States& starts,
             const PackOptions& with, const Members& members)
      : scene_(scene),
        starts_(starts),
        with_(with),
        options_(with.options),
        members_(members),
        end_(options_.output_times.back()),
        times_(options_, with.estimates_errors),
        refinement_(Refinement::of_lanes(options_, Levels(options_))) {}

  /// Throws : ComputationFailed if one of the members stops; earlier outputs are kept
  void follow() {
    while (true) {
      begin_try();
      if (!compare()) return;  // stopped
      spent_ += spent_in_try();
      const bool accepts = !with_.estimates_errors || refinement_.next(summary()) == Next::accept;
      if (accepts) return finish();
    }
  }

 private:
  struct Beside {
    double end_of_a_step;  ///< so that a short run is not one and the same step in all runs
    Integration steps;
  };

  [[nodiscard]] Integration run(double relative, double digits, double perturbed = 0) const {
    auto from = starts_;
    for (auto& start : from) start = perturbed_by_ulps(scene_, start, digits);
    const Accuracy accuracy{relative, options_.absolute_scale, options_.max_evaluations, perturbed};
    Integration made(scene_, options_.begin, from, accuracy);
    made.stop_at(options_.discontinuities);
    return made;
  }

  void put_beside(double part, double relative, double digits) {
    others_.push_back({options_.begin + part * (end_ - options_.begin), run(relative, digits)});
  }

  void begin_try() {
    refinement_.begin_try();
    const Levels& levels = refinement_.levels();
    const double accuracy = refinement_.accuracy();
    coarse_.emplace(run(accuracy, 0));
    others_.clear();
    growth_.reset();
    distance_.assign(lanes, {scene_, options_.absolute_scale});
    done_ = 0;
    rounds_too_much_ = false;
    too_coarse_ = false;
    worst_ = {};
    for (auto* member : members_) begin_member(member);
    if (!with_.estimates_errors) return;
    put_beside(1.0 / 2, levels.finer(accuracy), refinement_.digits());
    const int more = refinement_.is_last() ? 2 : 0;
    for (int i = 1; i <= more; ++i) {
      const double between = levels.between(accuracy, double(i) / (more + 1));
      put_beside(i == 1 ? 2.0 / 5 : 1.0 / 3, between, -refinement_.digits());
    }
    if (refinement_.looks_for_rounding()) {
      const double cheap = refinement_.cheap_accuracy();
      growth_.emplace(scene_, options_.absolute_scale, run(cheap, 0),
                      run(cheap, 0, rules::perturbed_digits));
    }
  }

  void begin_member(Trajectory<typename Scene::State>* member) const {
    if (!member) return;
    *member = {};
    member->report.method = name(Method::verner98);
    member->report.tolerance = options_.tolerance;
    member->report.status = RunStatus::cancelled;
    if (!with_.estimates_errors) {
      member->report.error_estimate = std::numeric_limits<double>::quiet_NaN();
    }
  }

  /// Compares the runs at all times, as far as the try goes; false if a stop was requested.
  [[nodiscard]] bool compare() {
    for (; done_ < times_.size(); ++done_) {
      const double t = times_[done_];
      if (!go_on(*coarse_, t, end_, with_.stop)) return false;
      const auto states = coarse_->at(t);
      if (with_.estimates_errors) {
        if (!note_errors(t, states)) return false;
        if (too_coarse_) return true;
      }
      if (!times_.is_output(done_)) continue;
      for (std::size_t k = 0; k < lanes; ++k) {
        if (!members_[k]) continue;
        members_[k]->times.push_back(t);
        members_[k]->states.push_back(states[k]);
      }
    }
    return true;
  }

  [[nodiscard]] bool note_errors(double t, const typename Integration::States& states) {
    Values off{};
    for (std::size_t k = 0; k < lanes; ++k) distance_[k].note_sizes(coarse_->sizes(k));
    for (auto& [end_of_a_step, steps] : others_) {
      const bool before = (t < end_of_a_step) == (end_ > options_.begin);
      if (!go_on(steps, t, before ? end_of_a_step : end_, with_.stop)) return false;
      const auto beside = steps.at(t);
      for (std::size_t k = 0; k < lanes; ++k) {
        if (!members_[k]) continue;
        const auto y = scene_.to_vector(states[k]);
        off[k] = max_or_nan(off[k], distance_[k](y, scene_.to_vector(beside[k])));
      }
    }
    note_estimates(t, off, growth_ ? growth_->at(t, end_, with_.stop) : Values{});
    return true;
  }

  void note_estimates(double t, const Values& off, const Values& grown) {
    const Levels& levels = refinement_.levels();
    for (std::size_t k = 0; k < lanes; ++k) {
      if (!members_[k]) continue;
      refinement_.note_growth(grown[k]);
      const double noise = max_or_nan(coarse_->rounding_level(), grown[k]);
      const ErrorParts error = error_of_pair(off[k], levels.finer_by(refinement_.accuracy()),
                                             levels.rounding(), coarse_->effort().steps, noise);
      members_[k]->report.raise(error);
      if (times_.is_output(done_)) members_[k]->errors.push_back(error.sum());
      if (!(error.sum() <= worst_.sum())) worst_ = error;
    }
    rounds_too_much_ = levels.may_round_too_much(refinement_.grown_to());
    refinement_.note(done_, worst_.sum());
    expected_ = forecast(options_, t, worst_.sum());
    too_coarse_ = refinement_.is_too_coarse(worst_.sum(), expected_, rounds_too_much_);
  }

  [[nodiscard]] TryResult summary() const {
    return {.complete = true,
            .too_coarse = too_coarse_,
            .is_implicit = false,
            .knows_growth = growth_.has_value(),
            .rounds_too_much = rounds_too_much_,
            .error = worst_.sum(),
            .error_parts = worst_,
            .expected = expected_,
            .steps = coarse_->effort().steps,
            .output = done_};
  }

  [[nodiscard]] double spent_in_try() const {
    double sum = coarse_->effort().evaluations;
    for (const Beside& other : others_) sum += other.steps.effort().evaluations;
    return growth_ ? sum + growth_->evaluations() : sum;
  }

  void finish() const {
    for (std::size_t k = 0; k < lanes; ++k) {
      if (!members_[k]) continue;
      RunReport& report = members_[k]->report;
      report.status = RunStatus::complete;
      report.sizes = coarse_->sizes(k);
      report.effort = coarse_->effort();
      report.all_evaluations = spent_;
      report.tolerance_kept = report.error_estimate <= options_.tolerance;
    }
  }

  const Scene& scene_;
  typename Integration::States starts_;
  PackOptions with_;
  const SolveOptions& options_;
  Members members_;
  double end_;
  ComparisonTimes times_;
  Refinement refinement_;
  std::optional<Integration> coarse_;
  std::vector<Beside> others_;
  std::optional<RoundingGrowthOfMembers<Scene, N>> growth_;
  std::vector<ErrorMeasure<Scene>> distance_;  ///< of the lanes
  std::size_t done_ = 0;
  ErrorParts worst_;  ///< of all members
  double expected_ = 0;
  double spent_ = 0;
  bool rounds_too_much_ = false;
  bool too_coarse_ = false;
};

}  // namespace kreisel::detail
