#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

#include <dynamics/ensemble/pack.hpp>
#include <dynamics/step/integrator.hpp>

namespace kreisel {

namespace detail {

/// True if a scene's rates accept packs.
template <class Scene, class N>
inline constexpr bool takes_packs = false;
template <class Scene, class N>
requires(is_pack<N>&& int(Scene::Vector::RowsAtCompileTime) >
         0) inline constexpr bool takes_packs<Scene, N> =
    requires(const Scene& scene, const N& t,
             const Eigen::Matrix<N, int(Scene::Vector::RowsAtCompileTime), 1>& y) {
  scene.rates(t, y);
};

}  // namespace detail

/// As many motions of a scene as N has lanes, integrated with common steps. The member with the
/// greatest relative error sets the step length, so that each member keeps the accuracy of a single
/// run. A failure of one member stops all.
///
/// N      : a pack; or double, for one motion of any scene
/// Cost   : steps allocate no memory
/// Throws : as Integrator; also ComputationFailed if rounding in the field of one member prevents
///          the accuracy, which is tolerated in a single run
template <class Scene, class N = Pack>
class PackedIntegrator {
  static constexpr int components = int(Scene::Vector::RowsAtCompileTime);
  using Vector = Eigen::Matrix<N, components, 1>;

 public:
  using States = std::array<typename Scene::State, std::size_t(N::lanes)>;

  PackedIntegrator(const Scene& scene, double t, const States& states,
                   const Accuracy& accuracy = {})
      : scene_(&scene),
        steps_({&scene}, t, side_by_side(scene, states), accuracy, detail::blocks_of(scene)) {}
  PackedIntegrator(Scene&&, double, const States&, const Accuracy& = {}) = delete;

  /// The states at the time `end`, before or after the present one.
  States to(double end) { return apart(steps_.advance_to(end)); }

  /// One step towards `end`, a test whether a time lies within it, and the states there.
  void step_towards(double end) { steps_.step_towards(end); }
  [[nodiscard]] bool covers(double time) const { return steps_.covers(time); }
  [[nodiscard]] States at(double time) { return apart(steps_.at(time)); }

  /// Sets the times at which the scene's guide or loads are discontinuous.
  void stop_at(const std::vector<double>& jumps) { steps_.stop_at(jumps); }

  /// The greatest size so far of each block of a member's state.
  [[nodiscard]] std::vector<double> sizes(std::size_t k) const {
    const Vector of_components = steps_.sizes();
    std::vector<double> sizes;
    int begin = 0;
    for (const int block : detail::blocks_of(*scene_)) {
      sizes.push_back(of_components[begin].lane(static_cast<int>(k)));
      begin += block;
    }
    return sizes;
  }

  /// The effort of all members together, which share their steps.
  [[nodiscard]] const IntegrationStatistics& effort() const { return steps_.effort(); }
  [[nodiscard]] double rounding_level() const { return steps_.rounding_level(); }

 private:
  [[nodiscard]] static Vector side_by_side(const Scene& scene, const States& states) {
    Vector y;
    for (int k = 0; k < N::lanes; ++k) {
      const typename Scene::Vector own = scene.to_vector(states[std::size_t(k)]);
      for (int i = 0; i < components; ++i) y[i].set_lane(k, own[i]);
    }
    return y;
  }

  [[nodiscard]] States apart(const Vector& y) const {
    States states;
    for (int k = 0; k < N::lanes; ++k) {
      typename Scene::Vector own;
      for (int i = 0; i < components; ++i) own[i] = y[i].lane(k);
      states[std::size_t(k)] = scene_->from_vector(own);
    }
    return states;
  }

  const Scene* scene_;
  ExplicitRungeKutta<Vector, detail::SceneField<Scene>> steps_;
};

template <class Scene>
class PackedIntegrator<Scene, double> {
 public:
  using States = std::array<typename Scene::State, 1>;

  PackedIntegrator(const Scene& scene, double t, const States& states,
                   const Accuracy& accuracy = {})
      : scene_(&scene), steps_(scene, t, states[0], accuracy) {}
  PackedIntegrator(Scene&&, double, const States&, const Accuracy& = {}) = delete;

  States to(double end) { return {steps_.to(end)}; }
  void step_towards(double end) { steps_.step_towards(end); }
  [[nodiscard]] bool covers(double time) const { return steps_.covers(time); }
  [[nodiscard]] States at(double time) { return {steps_.at(time)}; }
  void stop_at(const std::vector<double>& jumps) { steps_.stop_at(jumps); }
  [[nodiscard]] std::vector<double> sizes(std::size_t /*k*/) const {
    const auto of_components = steps_.sizes();
    std::vector<double> sizes;
    int begin = 0;
    for (const int block : detail::blocks_of(*scene_)) {
      sizes.push_back(of_components[begin]);
      begin += block;
    }
    return sizes;
  }
  [[nodiscard]] const IntegrationStatistics& effort() const { return steps_.effort(); }
  [[nodiscard]] double rounding_level() const { return steps_.rounding_level(); }

 private:
  const Scene* scene_;
  Integrator<Scene> steps_;
};

}  // namespace kreisel
