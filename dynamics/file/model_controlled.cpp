#include <dynamics/file/model_on_guide.hpp>
#include <dynamics/guide/resting.hpp>

namespace kreisel {

namespace {

template <class M>
std::unique_ptr<SceneSolver> controlled_on(M guide, const SceneFile& scene) {
  const SceneBodies bodies = bodies_in_gravity(scene);
  ControlledSystem<M> system(bodies_on_guide(std::move(guide), bodies), scene.controllers,
                             bodies.gravitation);
  return std::make_unique<ModelOnGuide<ControlledSystem<M>>>(std::move(system), bodies.gravitation);
}

}  // namespace

std::unique_ptr<SceneSolver> make_controlled_model(const SceneFile& scene) {
  if (scene.rests()) return controlled_on(RestingFrame<>{}, scene);
  return controlled_on(make_guide_of_equations(scene), scene);
}

}  // namespace kreisel
