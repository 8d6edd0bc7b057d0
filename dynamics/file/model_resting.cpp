#include <dynamics/file/model_on_guide.hpp>
#include <dynamics/guide/resting.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_resting_model(const SceneFile& scene) {
  const SceneBodies bodies = bodies_in_gravity(scene);
  return std::make_unique<ModelOnGuide<BodySystem<RestingFrame<>>>>(
      bodies_on_guide(RestingFrame<>{}, bodies), bodies.gravitation);
}

}  // namespace kreisel
