#include <dynamics/file/approximation.hpp>
#include <dynamics/file/model.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_model(const SceneFile& scene) {
  auto exact = scene.rests() ? make_resting_model(scene) : make_moving_model(scene);
  return make_approximation(scene, std::move(exact));
}

SolveOptions options_of(const SceneFile& scene) {
  SolveOptions options;
  options.output_times = scene.output_times;
  if (options.output_times.empty() || options.output_times.back() < scene.t_end) {
    options.output_times.push_back(scene.t_end);
  }
  options.discontinuities = scene.discontinuities;
  options.tolerance = scene.tolerance;
  options.method = scene.method;
  return options;
}

Trajectory<JointState> run_scene(const SceneFile& scene) {
  return make_model(scene)->solve(
      options_of(scene), start_of(scene), [](double, const JointState&) { return true; },
      [] { return false; });
}

}  // namespace kreisel
