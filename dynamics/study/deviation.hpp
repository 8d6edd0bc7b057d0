#pragma once

#include <algorithm>

#include <dynamics/step/integrator.hpp>

namespace kreisel {

/// The greatest deviation, component by component, of an approximate motion from the exact one with
/// the same start. Both run side by side from t_begin to t_end and are compared at `samples` times.
///
/// Scene  : a scene for Integrator that also has exact(), exact_state(State) and
///          approximated(exact state)
/// Units  : those of the scene's state
/// Error  : that of the steps: their accuracy must be finer than the deviation
/// Throws : as Integrator
template <class Scene>
[[nodiscard]] typename Scene::Vector greatest_deviation(const Scene& scene,
                                                        const typename Scene::State& start,
                                                        double t_begin, double t_end,
                                                        int samples = 200,
                                                        const Accuracy& accuracy = {}) {
  const auto exact = scene.exact();
  Integrator approximate(scene, t_begin, start, accuracy);
  Integrator true_run(exact, t_begin, scene.exact_state(start), accuracy);
  typename Scene::Vector most = Scene::Vector::Zero();
  for (int i = 1; i <= samples; ++i) {
    const double t = t_begin + (t_end - t_begin) * i / samples;
    const auto a = scene.to_vector(approximate.to(t));
    const auto b = scene.to_vector(scene.approximated(true_run.to(t)));
    most = most.cwiseMax((a - b).cwiseAbs());
  }
  return most;
}

}  // namespace kreisel
