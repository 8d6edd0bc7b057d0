#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <stop_token>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/ensemble/packed_steps.hpp>
#include <dynamics/ensemble/workers.hpp>
#include <dynamics/random.hpp>
#include <dynamics/solve/adaptive_runs.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/missed.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The members of an ensemble to compute, and the threads to use.
struct Sampling {
  std::size_t count = 0;   ///< of members
  std::size_t first = 0;   ///< the index of the first; a multiple of the lanes of a pack
  std::uint64_t seed = 1;  ///< of the random numbers of all members
  int threads = 0;         ///< 0: as many as the machine runs at once

  /// If true, a finer companion run of each member measures its error. If false, estimates are NaN,
  /// each step is held to a tenth of the tolerance, and the companion runs are saved.
  bool estimates_errors = true;

  /// Called with the completed share, in (0, 1], never by two threads at once; false cancels.
  std::function<bool(double share)> progress = nullptr;
};

/// A member of an ensemble with a scene of its own.
template <class Scene>
struct Member {
  Scene scene;
  typename Scene::State start;
};
template <class Scene>
Member(Scene, typename Scene::State) -> Member<Scene>;

/// The members' motions in the order of their indices, and their total cost.
///
/// A member's status is `failed`, with the reason, if it could not be made or its run stopped. It
/// is `cancelled` if it was not computed to the end. Its effort is that of its pack; invariants are
/// not monitored.
template <class State>
struct Ensemble {
  std::vector<Trajectory<State>> members;
  RunStatus status = RunStatus::complete;  ///< or cancelled
  std::size_t failed = 0;
  double run_time = 0;  ///< s
};

namespace detail {

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
        grown[k] = gave_up_ ? 0 : AdaptiveRuns::rounding_of(off);
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

/// Integrates members side by side through all output times, each with a finer companion run, as
/// solve() does for one scene. Null members fill a pack.
///
/// Throws : ComputationFailed if one of the members stops; earlier outputs are kept
template <class N, class Scene>
void follow(const Scene& scene, const typename PackedIntegrator<Scene, N>::States& starts,
            const SolveOptions& options, bool estimates_errors, const std::stop_token& stop,
            const std::array<Trajectory<typename Scene::State>*, lanes_of<N>>& members) {
  const AdaptiveRuns runs(options);
  const double end = options.output_times.back();
  struct Beside {
    double end_of_a_step;  ///< so that a short run is not one and the same step in all runs
    PackedIntegrator<Scene, N> steps;
  };
  double setting = runs.first();
  Missed<double> missed{setting};
  std::array<double, std::size_t(lanes_of<N>)> grown_to{};  // by rounding, in any run
  CheapSteps cheap;                                         // that estimate the growth
  double spent = 0;
  while (true) {
    const bool last_try = !estimates_errors || runs.last(setting);
    const auto run = [&](double relative, double digits, double perturbed = 0) {
      auto from = starts;
      for (auto& start : from) start = perturbed_by_ulps(scene, start, digits);
      const Accuracy accuracy{relative, options.absolute_scale, options.max_evaluations, perturbed};
      PackedIntegrator<Scene, N> made(scene, options.begin, from, accuracy);
      made.stop_at(options.discontinuities);
      return made;
    };
    auto coarse = run(setting, 0);
    std::vector<Beside> others;
    const auto put_beside = [&](double part, double relative, double digits) {
      others.push_back({options.begin + part * (end - options.begin), run(relative, digits)});
    };
    if (estimates_errors) put_beside(1.0 / 2, runs.finer(setting), digits_off(options));
    if (estimates_errors && last_try) {
      // If only rounding is left, two runs may agree by chance.
      put_beside(2.0 / 5, runs.between(setting, 1.0 / 3), -digits_off(options));
      put_beside(1.0 / 3, runs.between(setting, 2.0 / 3), -digits_off(options));
    }
    std::optional<RoundingGrowthOfMembers<Scene, N>> rounding;
    if (estimates_errors && runs.can_look_for_rounding(setting, missed.error > 0)) {
      const double accuracy = cheap.beside(runs, setting);
      rounding.emplace(scene, options.absolute_scale, run(accuracy, 0),
                       run(accuracy, 0, AdaptiveRuns::shaken_digits));
    }
    std::vector<ErrorMeasure<Scene>> distance(members.size(), {scene, options.absolute_scale});
    for (auto* member : members) {
      if (!member) continue;
      *member = {};
      member->report.method = name(Method::verner98);
      member->report.tolerance = options.tolerance;
      member->report.status = RunStatus::cancelled;
      if (!estimates_errors) {
        member->report.error_estimate = std::numeric_limits<double>::quiet_NaN();
      }
    }
    double worst = 0;
    double grown_most = 0;
    bool rounds_too_much = false;
    bool too_coarse = false;
    std::size_t output = 0;
    for (const double t : options.output_times) {
      if (!go_on(coarse, t, end, stop)) return;
      const auto states = coarse.at(t);
      std::array<double, std::size_t(lanes_of<N>)> off{};
      for (auto& [end_of_a_step, steps] : others) {
        const bool before = (t < end_of_a_step) == (end > options.begin);
        if (!go_on(steps, t, before ? end_of_a_step : end, stop)) return;
        const auto beside = steps.at(t);
        for (std::size_t k = 0; k < members.size(); ++k) {
          if (!members[k]) continue;
          const auto y = scene.to_vector(states[k]);
          off[k] = max_or_nan(off[k], distance[k](y, scene.to_vector(beside[k])));
        }
      }
      if (rounding) {
        const auto grown = rounding->at(t, end, stop);
        for (std::size_t k = 0; k < grown.size(); ++k) {
          if (members[k]) grown_to[k] = max_or_nan(grown_to[k], grown[k]);
        }
      }
      grown_most = *std::max_element(grown_to.begin(), grown_to.end());
      rounds_too_much = runs.may_round_too_much(grown_most);
      for (std::size_t k = 0; estimates_errors && k < members.size(); ++k) {
        if (!members[k]) continue;
        const double grown_rounding = max_or_nan(coarse.rounding_level(), grown_to[k]);
        double& estimate = members[k]->report.error_estimate;
        estimate =
            max_or_nan(estimate, error_of_pair(off[k], runs.finer_by(setting), runs.rounding(),
                                               coarse.effort().steps, grown_rounding));
        worst = max_or_nan(worst, estimate);
      }
      missed.note(output, worst);
      too_coarse = !last_try && (worst > options.tolerance || rounds_too_much);
      if (too_coarse) break;
      ++output;
      for (std::size_t k = 0; k < members.size(); ++k) {
        if (!members[k]) continue;
        members[k]->times.push_back(t);
        members[k]->states.push_back(states[k]);
      }
    }
    spent += coarse.effort().evaluations;
    for (const Beside& other : others) spent += other.steps.effort().evaluations;
    if (rounding) spent += rounding->evaluations();
    if (rounds_too_much && !last_try && cheap.refine(grown_most, setting)) {
      grown_to = {};
      continue;
    }
    if (too_coarse) {
      const bool stays = rounds_too_much || missed.stays(runs, setting);
      if (missed.error == 0) missed = {setting, output, worst};
      setting = stays ? runs.finest() : runs.tightened(setting, options.tolerance / (3 * worst));
      continue;
    }
    for (auto* member : members) {
      if (!member) continue;
      RunReport& report = member->report;
      report.status = RunStatus::complete;
      report.effort = coarse.effort();
      report.all_evaluations = spent;
      report.tolerance_kept = report.error_estimate <= options.tolerance;
    }
    return;
  }
}

/// The members of a group, all of one scene.
template <class Scene, class N>
class GroupOfOneScene {
 public:
  using State = typename Scene::State;

  explicit GroupOfOneScene(const Scene& scene) : scene_(scene) {}

  void put(std::size_t k, const State& start) { starts_[k] = start; }
  void copy(std::size_t from, std::size_t to) { starts_[to] = starts_[from]; }

  template <class Follow>
  [[nodiscard]] bool together(const Follow& follow) const {
    if constexpr (takes_packs<Scene, N>) follow(scene_, starts_);
    return takes_packs<Scene, N>;
  }
  template <class Follow>
  void alone(std::size_t k, const Follow& follow) const {
    follow(scene_, std::array{starts_[k]});
  }

 private:
  const Scene& scene_;
  std::array<State, std::size_t(lanes_of<N>)> starts_;
};

/// True if scenes of this type can be combined into a scene of packs.
template <class Scene, class N>
inline constexpr bool lies_side_by_side = false;
template <class Scene, class N>
requires is_pack<N>
inline constexpr bool lies_side_by_side<Scene, N> =
    requires(const std::array<const Scene*, std::size_t(N::lanes)>& scenes) {
  Scene::template side_by_side<N>(scenes);
};

/// The members of a group, each of a scene of its own.
template <class Scene, class N>
class GroupOfScenes {
 public:
  using State = typename Scene::State;

  void put(std::size_t k, Member<Scene> member) { members_[k].emplace(std::move(member)); }
  void copy(std::size_t from, std::size_t to) { members_[to] = members_[from]; }

  template <class Follow>
  [[nodiscard]] bool together(const Follow& follow) const {
    if constexpr (lies_side_by_side<Scene, N>) {
      std::array<const Scene*, std::size_t(lanes_of<N>)> scenes;
      std::array<State, std::size_t(lanes_of<N>)> starts;
      for (std::size_t k = 0; k < members_.size(); ++k) {
        scenes[k] = &members_[k]->scene;
        starts[k] = members_[k]->start;
      }
      const auto packed = Scene::template side_by_side<N>(scenes);
      if (packed) follow(*packed, starts);
      return packed.has_value();
    } else {
      return false;
    }
  }
  template <class Follow>
  void alone(std::size_t k, const Follow& follow) const {
    follow(members_[k]->scene, std::array{members_[k]->start});
  }

 private:
  std::array<std::optional<Member<Scene>>, std::size_t(lanes_of<N>)> members_;
};

template <class State>
void fail(Trajectory<State>& member, const std::exception& error) {
  member.report.status = RunStatus::failed;
  member.report.message = error.what();
}

/// Members of an ensemble from `index` on: at most one for each lane of N.
template <class N, class Group, class Make>
void run_group(Group group, const Make& make, std::size_t index, const SolveOptions& options,
               const Sampling& sampling, const std::stop_token& stop,
               std::span<Trajectory<typename Group::State>> members) {
  using State = typename Group::State;
  constexpr std::size_t lanes{lanes_of<N>};
  const auto begin = std::chrono::steady_clock::now();
  std::array<Trajectory<State>*, lanes> made{};
  for (std::size_t k = 0; k < members.size(); ++k) {
    try {
      MemberRandom random(sampling.seed, index + k);
      group.put(k, make(index + k, random));
      made[k] = &members[k];
    } catch (const std::exception& error) {
      fail(members[k], error);
    }
  }
  const auto* first = std::find_if(made.begin(), made.end(), [](auto* m) { return m != nullptr; });
  if (first == made.end()) return;
  for (std::size_t k = 0; k < lanes; ++k) {
    if (!made[k]) group.copy(static_cast<std::size_t>(first - made.begin()), k);
  }
  const auto all_together = [&] {
    try {
      return group.together([&](const auto& scene, const auto& starts) {
        follow<N>(scene, starts, options, sampling.estimates_errors, stop, made);
      });
    } catch (const std::exception&) {
      return false;  // a single rerun reports the reason
    }
  };
  if (!all_together()) {
    for (std::size_t k = 0; k < lanes; ++k) {
      if (!made[k]) continue;
      try {
        group.alone(k, [&](const auto& scene, const auto& starts) {
          follow<double>(scene, starts, options, sampling.estimates_errors, stop,
                         std::array{made[k]});
        });
      } catch (const std::exception& error) {
        fail(*made[k], error);
      }
    }
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  for (auto& member : members) {
    member.report.run_time = taken.count() / static_cast<double>(members.size());
  }
}

inline void check(const Sampling& sampling, const SolveOptions& options, int lanes) {
  check(options);
  if (options.method != Method::automatic && options.method != Method::verner98) {
    refuse_task("options.method = ", name(options.method), ": an ensemble needs verner98");
  }
  if (sampling.threads < 0)
    refuse_task("sampling.threads = ", sampling.threads, " must be 0 or above");
  if (sampling.first % static_cast<std::size_t>(lanes) != 0) {
    refuse_task("sampling.first = ", sampling.first, " must be a multiple of ", lanes);
  }
}

template <class N, class Group, class Make>
[[nodiscard]] Ensemble<typename Group::State> run_ensemble(const Group& group, const Make& make,
                                                           const SolveOptions& given,
                                                           const Sampling& sampling) {
  constexpr std::size_t lanes{lanes_of<N>};
  const SolveOptions options = with_output_times(given);
  check(sampling, options, lanes_of<N>);
  const auto begin = std::chrono::steady_clock::now();
  Ensemble<typename Group::State> result;
  result.members.resize(sampling.count);
  for (auto& member : result.members) member.report.status = RunStatus::cancelled;
  const bool all_done = parallel_for(
      (sampling.count + lanes - 1) / lanes, {sampling.threads, sampling.progress, options.stop},
      [&](std::size_t i, const std::stop_token& stop) {
        const std::size_t from = i * lanes;
        const std::size_t count = std::min(lanes, sampling.count - from);
        run_group<N>(group, make, sampling.first + from, options, sampling, stop,
                     std::span(result.members).subspan(from, count));
      });
  if (!all_done) result.status = RunStatus::cancelled;
  for (const auto& member : result.members) {
    if (member.report.status == RunStatus::failed) ++result.failed;
  }
  result.run_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace detail

/// Many motions of one scene (Monte Carlo), with starts drawn at random or made from the index.
///
///   const auto result = ensemble(top, {.count = 10000}, [](std::size_t, MemberRandom& random) {
///     return EulerTop::State{.angular_velocity = {random.normal(0, 0.01), 0, 100}};
///   }, {.output_times = {60}});
///
/// Members run side by side, one for each lane of a pack, if the scene's rates accept packs.
/// Members with the same index / lanes share a pack. Results are therefore equal to the last bit
/// for any number of threads and any division into ranges of indices. Another width of packs
/// changes the results within the tolerance. If one member stops its pack, the members run again
/// one by one, so that each fails only for a reason of its own.
///
/// Steps are explicit (ExplicitRungeKutta): stiff members take many steps and fail at
/// options.max_evaluations.
///
/// N      : the pack; or double, for members one by one
/// make   : callable (index, MemberRandom&) -> State, from several threads at once; its exception
///          makes the member fail
/// Error  : of each member within options.tolerance, estimated as in solve()
/// Throws : InvalidInput if the options or the sampling are invalid; exceptions of sampling.progress
template <class N = Pack, class Scene, class Make>
[[nodiscard]] Ensemble<typename Scene::State> ensemble(const Scene& scene, const Sampling& sampling,
                                                       const Make& make,
                                                       const SolveOptions& options) {
  using Taken = std::conditional_t<detail::takes_packs<Scene, N>, N, double>;
  return detail::run_ensemble<Taken>(detail::GroupOfOneScene<Scene, Taken>(scene), make, options,
                                     sampling);
}

/// The same with a scene for each member, for example with other moments of inertia or other loads.
///
/// Scenes share packs if their type allows it. EulerTop does. CardanGyro does in a frame at rest
/// with a free or regulated rotor. All gyros of a pack must then be symmetric, or none, with the
/// same friction of the rotor. Other scenes run one by one.
///
/// make   : callable (index, MemberRandom&) -> Member<Scene>
template <class N = Pack, class Make>
[[nodiscard]] auto ensemble(const Sampling& sampling, const Make& make,
                            const SolveOptions& options) {
  using Made = std::invoke_result_t<const Make&, std::size_t, MemberRandom&>;
  using Scene = decltype(Made::scene);
  using Taken = std::conditional_t<detail::lies_side_by_side<Scene, N>, N, double>;
  return detail::run_ensemble<Taken>(detail::GroupOfScenes<Scene, Taken>(), make, options,
                                     sampling);
}

}  // namespace kreisel
