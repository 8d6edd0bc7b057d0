#include <dynamics/file/model_on_guide.hpp>
#include <dynamics/guide/resting.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_resting_model(const SceneFile& scene) {
  return std::make_unique<ModelOnGuide<RestingFrame<>>>(RestingFrame<>{}, bodies_in_gravity(scene));
}

}  // namespace kreisel
