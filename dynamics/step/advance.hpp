#pragma once

#include <vector>

#include <dynamics/step/explicit.hpp>

namespace kreisel {

/// A scene integrated step by step: State in, State out.
///
///   Advance run(body, 0, start);
///   for (double t = 0.1; t <= 10; t += 0.1) print(t, run.to(t));
///
/// Scene  : has State, to_vector, from_vector, rates(t, y) and blocks; is kept by reference
/// Throws : as ExplicitSteps does
template <class Scene, class Tableau = Verner98>
class Advance {
  struct Field {
    const Scene* scene;

    template <class S, class Vector>
    [[nodiscard]] Vector operator()(const S& t, const Vector& y) const {
      return scene->rates(t, y);
    }
  };

 public:
  using State = typename Scene::State;

  Advance(const Scene& scene, double t, const State& state, const Accuracy& accuracy = {})
      : steps_({&scene}, t, Scene::to_vector(state), accuracy, Scene::blocks) {}
  Advance(Scene&&, double, const State&, const Accuracy& = {}) = delete;

  /// The state at the time `end`, before or after the present one.
  State to(double end) { return Scene::from_vector(steps_.advance_to(end)); }

  /// The state at a time on the way to `end`, not before the last one asked for; the steps go on as
  /// if nobody had asked.
  State on_the_way(double time, double end) {
    while (!steps_.covers(time)) steps_.step_towards(end);
    return Scene::from_vector(steps_.at(time));
  }

  /// Announces times at which the scene's guide or loads jump.
  void stop_at(const std::vector<double>& jumps) { steps_.stop_at(jumps); }

  [[nodiscard]] double t() const { return steps_.t(); }
  [[nodiscard]] State state() const { return Scene::from_vector(steps_.y()); }
  [[nodiscard]] const Effort& effort() const { return steps_.effort(); }

 private:
  ExplicitSteps<typename Scene::Vector, Field, Tableau> steps_;
};

}  // namespace kreisel
