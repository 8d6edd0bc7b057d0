#pragma once

#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/processor.hpp>
#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/scene_runs.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel {

/// A function that solve() calls at every output: on_output(t, state). It returns an OutputAction or
/// nothing; without a result the run proceeds.
template <class F, class State>
concept OutputFunction = std::invocable<F&, double, const State&> &&
    (std::same_as<std::invoke_result_t<F&, double, const State&>, OutputAction> ||
     std::is_void_v<std::invoke_result_t<F&, double, const State&>>);

namespace detail {

/// A run with the scene's states, made of a run by components.
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> with_states(const SceneRuns<Scene>& runs,
                                                            std::size_t components,
                                                            Trajectory<double> by_components) {
  Trajectory<typename Scene::State> result;
  const std::span<const double> all = by_components.states;
  result.states.reserve(by_components.times.size());
  for (std::size_t i = 0; i < by_components.times.size(); ++i) {
    result.states.push_back(runs.from_components(all.subspan(i * components, components)));
  }
  result.times = std::move(by_components.times);
  result.report = std::move(by_components.report);
  result.errors = std::move(by_components.errors);
  return result;
}

/// solve() with on_output as a function of components.
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve_watched(const SceneRuns<Scene>& runs,
                                                              const Scene& scene,
                                                              const typename Scene::State& start,
                                                              const SolveOptions& given,
                                                              const OnComponents& on_output) {
  KREISEL_SAME_MARCH();
  const SolveOptions options = with_output_times(given);
  const Eigen::VectorXd y = runs.to_vector(start);
  const auto components = static_cast<std::size_t>(y.size());
  check(runs, y, options);
  const bool closed_wanted =
      options.method == Method::closed_form || options.method == Method::automatic;
  if constexpr (requires { closed_form(scene, options.begin, start); }) {
    if (closed_wanted) {
      const auto motion = closed_form(scene, options.begin, start);
      if (motion) {
        const auto at = [&](double t) { return runs.to_vector(motion->at(t)); };
        return with_states(
            runs, components,
            solve_closed(runs, y, options, {motion->name, at, motion->error}, on_output));
      }
    }
  }
  if (options.method == Method::closed_form) refuse_closed_form();
  return with_states(runs, components, solve_by_steps(runs, y, options, on_output));
}

}  // namespace detail

/// Solves a scene to a tolerance of the GLOBAL error, and reports the error of the result.
///
/// Scene  : has State, Vector, blocks, to_vector, from_vector and rates(t, y). Optional:
///          conserved(t, state), whose drift is reported; the methods closed_form() and series();
///          and may_be_stiff() (see model/scene.hpp)
/// Error  : by steps true error / estimate lies in [0.1, 1] in 98 % of 400 runs and never above 1.1
///          (tests/dynamics/solve/solve.cpp); docs/promises.md states the limits. If the tolerance
///          cannot be reached, the best result is returned and RunReport::tolerance_kept is false
/// Cost   : by steps 2.3 times the integration alone, 3.4 times by gauss16, reported as
///          all_evaluations. 0.3 to 0.8 more at 1e-11 and finer, or at 1e-7 if the first pair of
///          runs does not agree to an eighth of the tolerance. 2.8 to 4.6 times if that pair has
///          too great an error; twice that if rounding in many steps exceeds the last digits. If
///          the tolerance is missed, `automatic` may try another method. Outputs cost ten
///          evaluations in each step that has some, by series none
/// Throws : InvalidInput if the options are invalid or the method does not fit the scene. A failure
///          during the run is reported, with the trajectory up to there
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve(const Scene& scene,
                                                      const typename Scene::State& start,
                                                      const SolveOptions& options) {
  return detail::solve_watched(detail::SceneRuns<Scene>(scene), scene, start, options, nullptr);
}

/// Solves a scene and calls on_output with each state at an output time; on_output may end the run.
///
///   const auto run = solve(top, start, {.t_end = 60, .output_step = 0.1},
///                          [](double t, const EulerTop::State& state) {
///     return state.attitude.z() > 0.5 ? OutputAction::stop : OutputAction::proceed;
///   });
///
/// If a time does not follow the one before, the run has begun again, with shorter steps or another
/// method. Earlier states are then void: the result contains the states of the last begin.
///
/// Throws : as solve() without on_output, and the exceptions of on_output
template <class Scene, OutputFunction<typename Scene::State> OnOutput>
[[nodiscard]] Trajectory<typename Scene::State> solve(const Scene& scene,
                                                      const typename Scene::State& start,
                                                      const SolveOptions& options,
                                                      OnOutput&& on_output) {
  const detail::SceneRuns<Scene> runs(scene);
  return detail::solve_watched(
      runs, scene, start, options, [&](double t, std::span<const double> components) {
        const typename Scene::State state = runs.from_components(components);
        if constexpr (std::is_void_v<decltype(on_output(t, state))>) {
          on_output(t, state);
          return OutputAction::proceed;
        } else {
          return on_output(t, state);
        }
      });
}

}  // namespace kreisel
