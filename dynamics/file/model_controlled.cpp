#include <dynamics/file/model_on_guide.hpp>

namespace kreisel {

/// For all guides, also for one at rest: a second type would only spare its evaluation.
std::unique_ptr<SceneSolver> make_controlled_model(const SceneFile& scene) {
  const SceneBodies bodies = bodies_in_gravity(scene);
  ControlledSystem<SceneGuide> system(bodies_on_guide(make_guide_of_equations(scene), bodies),
                                      scene.controllers, bodies.gravitation);
  return std::make_unique<ModelOnGuide<ControlledSystem<SceneGuide>>>(std::move(system),
                                                                      bodies.gravitation);
}

}  // namespace kreisel
