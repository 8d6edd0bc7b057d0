#include <dynamics/guide/resting.hpp>

#include "model_on_guide.hpp"

std::unique_ptr<Model> make_resting_model(const kreisel::SceneFile& scene) {
  return std::make_unique<ModelOnGuide<kreisel::RestingFrame<>>>(kreisel::RestingFrame<>{},
                                                                 kreisel::bodies_in_gravity(scene));
}
