#pragma once

#include <vector>

#include <dynamics/step/explicit.hpp>

namespace kreisel {

namespace detail {

/// The vector field of a scene as a callable for steppers.
template <class Scene>
struct SceneField {
  const Scene* scene;

  template <class S, class Vector>
  [[nodiscard]] Vector operator()(const S& t, const Vector& y) const {
    return scene->rates(typename Vector::Scalar(t), y);
  }
};

/// The field of a scene that computes in a workspace.
template <class Scene>
requires requires(const Scene& scene) { scene.workspace(); }
struct SceneField<Scene> {
  const Scene* scene;
  decltype(scene->workspace()) workspace = scene->workspace();

  template <class S, class Vector>
  void operator()(const S& t, const Vector& y, Vector& rate) {
    scene->rates(t, y, rate, workspace);
  }

  /// Moves a state onto the conditions of the scene.
  template <class Vector>
  void project(Vector& y) requires requires {
    scene->project(y, workspace);
  }
  { scene->project(y, workspace); }
};

/// The blocks of a scene: a static member of its class or a member of the object.
template <class Scene>
[[nodiscard]] auto blocks_of(const Scene& scene) {
  if constexpr (requires { scene.blocks(); }) {
    return scene.blocks();
  } else {
    return scene.blocks;
  }
}

}  // namespace detail

/// A scene integrated step by step: State in, State out.
///
///   Integrator run(body, 0, start);
///   for (double t = 0.1; t <= 10; t += 0.1) print(t, run.to(t));
///
/// Scene  : has State, Vector, to_vector, from_vector, blocks and rates(t, y), or a workspace() and
///          rates(t, y, result, workspace); is kept by reference
/// Throws : as ExplicitRungeKutta does
template <class Scene, class Tableau = Verner98>
class Integrator {
 public:
  using State = typename Scene::State;

  Integrator(const Scene& scene, double t, const State& state, const Accuracy& accuracy = {})
      : scene_(&scene),
        steps_({&scene}, t, scene.to_vector(state), accuracy, detail::blocks_of(scene)) {}
  Integrator(Scene&&, double, const State&, const Accuracy& = {}) = delete;

  /// The state at the time `end`, before or after the present one.
  State to(double end) { return scene_->from_vector(steps_.advance_to(end)); }

  /// The state at a time on the way to `end`, not before the last requested time. The output does
  /// not change the steps.
  State on_the_way(double time, double end) {
    while (!covers(time)) step_towards(end);
    return at(time);
  }

  /// One step towards `end`, a test whether a time lies within it, and the state there.
  void step_towards(double end) { steps_.step_towards(end); }
  [[nodiscard]] bool covers(double time) const { return steps_.covers(time); }
  [[nodiscard]] State at(double time) { return scene_->from_vector(steps_.at(time)); }

  /// True if the field has proved stiff; see ExplicitRungeKutta::stiff().
  [[nodiscard]] bool stiff() const { return steps_.stiff(); }

  /// Sets the times at which the scene's guide or loads are discontinuous.
  void stop_at(const std::vector<double>& jumps) { steps_.stop_at(jumps); }

  /// Saves or restores the members from which the steps continue.
  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(steps_);
  }

  [[nodiscard]] double t() const { return steps_.t(); }
  [[nodiscard]] State state() const { return scene_->from_vector(steps_.y()); }
  /// The greatest size so far of the block of each component.
  [[nodiscard]] auto sizes() const { return steps_.sizes(); }
  [[nodiscard]] const IntegrationStatistics& effort() const { return steps_.effort(); }
  [[nodiscard]] double rounding_level() const { return steps_.rounding_level(); }

 private:
  const Scene* scene_;
  ExplicitRungeKutta<typename Scene::Vector, detail::SceneField<Scene>, Tableau> steps_;
};

}  // namespace kreisel
