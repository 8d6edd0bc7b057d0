#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include <dynamics/model/closed_form.hpp>
#include <dynamics/processor.hpp>
#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/report.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/scene_runs.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel {

/// Solves a scene to a tolerance of the GLOBAL error, and says how far the result is off.
///
/// Scene  : has State, Vector, blocks, to_vector, from_vector and rates(t, y); with conserved(t,
///          state) its invariants are watched, with a closed_form() it is computed by that, with
///          series() by those, and may_be_stiff() tells then whether it may be stiff
/// Error  : by steps true error / estimate lies in [0.1, 1] in 98 % of 400 runs and never above 1.1
///          (tests/dynamics/solve/solve.cpp); docs/promises.md tells where that ends. Where the
///          tolerance cannot be reached the best is returned and RunReport::tolerance_kept is false
/// Cost   : by steps 2.3 times the integration alone, 3.4 times by gauss16, reported as
///          all_evaluations; 0.3 to 0.8 more to 1e-11 and finer, or to 1e-7 where the first pair of
///          runs does not agree to an eighth of the tolerance; 2.8 to 4.6 times where that errs too
///          much; twice that where so many steps near the last digits are taken that rounding outgrows
///          them. Where the tolerance is missed `automatic` may try another method. Outputs take ten
///          evaluations in each step that has some, by series none
/// Throws : InvalidInput if the options are invalid or the method does not fit the scene. What
///          fails on the way is told by the report, with the trajectory up to there
template <class Scene>
[[nodiscard]] Trajectory<typename Scene::State> solve(const Scene& scene,
                                                      const typename Scene::State& start,
                                                      const SolveOptions& options) {
  detail::KREISEL_SAME_MARCH();
  const detail::SceneRuns<Scene> runs(scene);
  const Eigen::VectorXd y = runs.to_vector(start);
  detail::check(runs, y, options);
  const auto with_states = [&](Trajectory<double> by_components) {
    Trajectory<typename Scene::State> result;
    const auto components = static_cast<std::size_t>(y.size());
    const std::span<const double> all = by_components.states;
    result.states.reserve(by_components.times.size());
    for (std::size_t i = 0; i < by_components.times.size(); ++i) {
      result.states.push_back(runs.from_components(all.subspan(i * components, components)));
    }
    result.times = std::move(by_components.times);
    result.report = std::move(by_components.report);
    result.errors = std::move(by_components.errors);
    return result;
  };
  const bool closed_wanted =
      options.method == Method::closed_form || options.method == Method::automatic;
  if constexpr (requires { closed_form(scene, options.begin, start); }) {
    if (closed_wanted) {
      const auto motion = closed_form(scene, options.begin, start);
      if (motion) {
        const auto at = [&](double t) { return runs.to_vector(motion->at(t)); };
        return with_states(
            detail::solve_closed(runs, y, options, {motion->name, at, motion->error}));
      }
    }
  }
  if (options.method == Method::closed_form) detail::refuse_closed_form();
  return with_states(detail::solve_by_steps(runs, y, options));
}

}  // namespace kreisel
