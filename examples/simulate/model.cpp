#include "model.hpp"

std::unique_ptr<Model> make_model(const kreisel::SceneFile& scene) {
  return scene.rests() ? make_resting_model(scene) : make_moving_model(scene);
}
