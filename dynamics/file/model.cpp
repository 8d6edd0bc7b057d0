#include "model.hpp"

#include "approximation.hpp"

std::unique_ptr<Model> make_model(const kreisel::SceneFile& scene) {
  auto exact = scene.rests() ? make_resting_model(scene) : make_moving_model(scene);
  return make_approximation(scene, std::move(exact));
}
