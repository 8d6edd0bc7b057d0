#include "model_on_guide.hpp"

std::unique_ptr<Model> make_moving_model(const kreisel::SceneFile& scene) {
  return std::make_unique<ModelOnGuide<kreisel::SceneGuide>>(kreisel::make_guide(scene),
                                                             kreisel::bodies_in_gravity(scene));
}
