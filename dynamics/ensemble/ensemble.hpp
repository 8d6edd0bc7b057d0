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

#include <dynamics/ensemble/packed_pair.hpp>
#include <dynamics/ensemble/packed_steps.hpp>
#include <dynamics/ensemble/workers.hpp>
#include <dynamics/random.hpp>
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
        PackedPair<N, std::remove_cvref_t<decltype(scene)>>(
            scene, starts, {options, sampling.estimates_errors, stop}, made)
            .follow();
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
          PackedPair<double, std::remove_cvref_t<decltype(scene)>>(
              scene, starts, {options, sampling.estimates_errors, stop}, std::array{made[k]})
              .follow();
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
