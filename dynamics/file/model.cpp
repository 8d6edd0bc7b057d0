#include <variant>

#include <dynamics/file/approximation.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_system.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

/// Throws : InvalidInput naming the body if a field's centre is at its centre of mass at the start
void check_field(const SceneFile& scene, const SceneSolver& model) {
  const auto* const planet = std::get_if<OblateGravitation<>>(&scene.gravity);
  if (planet == nullptr) return;
  const auto guide = make_guide(scene)(scene.t_begin).X;
  const JointState start = start_of(scene);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const BodyDescription& body = scene.bodies[static_cast<std::size_t>(i)];
    const Inertia<>& T = body.inertia.value;
    if (!(T.mass > 0)) continue;
    const Pose<double> X = model.pose(scene.t_begin, start, i);
    const Vector3<double> place =
        guide.point(X.rotation * (T.first_moment / T.mass) + X.translation);
    if (place != planet->centre) continue;
    throw InvalidInput("gravity.centre: the centre of mass of body '" + body.name +
                       "' is at the centre of the field at the start; move one of them");
  }
}

}  // namespace

std::unique_ptr<SceneSolver> make_model(const SceneFile& scene) {
  auto exact = !scene.controllers.empty() ? make_controlled_model(scene)
               : scene.rests()            ? make_resting_model(scene)
                                          : make_moving_model(scene);
  check_field(scene, *exact);
  return make_approximation(scene, std::move(exact));
}

SolveOptions options_of(const SceneFile& scene) {
  SolveOptions options;
  options.begin = scene.t_begin;
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
  return make_model(scene)->solve(options_of(scene), start_of(scene));
}

}  // namespace kreisel
