#include <dynamics/file/model_on_guide.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_moving_model(const SceneFile& scene) {
  return std::make_unique<ModelOnGuide<SceneGuide>>(make_guide_of_equations(scene),
                                                    bodies_in_gravity(scene));
}

}  // namespace kreisel
