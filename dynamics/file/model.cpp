#include <dynamics/file/approximation.hpp>
#include <dynamics/file/model.hpp>

namespace kreisel {

std::unique_ptr<SceneSolver> make_model(const SceneFile& scene) {
  auto exact = scene.rests() ? make_resting_model(scene) : make_moving_model(scene);
  return make_approximation(scene, std::move(exact));
}

}  // namespace kreisel
