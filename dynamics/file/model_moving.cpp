#include <dynamics/file/model_on_guide.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_moving_model(const SceneFile& scene) {
  const SceneBodies bodies = bodies_in_gravity(scene);
  return std::make_unique<ModelOnGuide<BodySystem<SceneGuide>>>(
      bodies_on_guide(make_guide_of_equations(scene), bodies), bodies.gravitation);
}

}  // namespace kreisel
