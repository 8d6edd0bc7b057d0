#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <vector>

#include <dynamics/study/tangent_rates.hpp>

namespace kreisel {

/// A motion at the nodes of a panel (study/exponential_panels.hpp) and at its end.
struct MotionSamples {
  std::vector<Eigen::VectorXd> states;
  std::vector<Eigen::VectorXd> rates;  ///< on the tangents at the states
};

/// The samples of a motion on the panel from t to t + h. Panels are asked for in order, a panel
/// perhaps again with a smaller h.
using MotionSampler = std::function<MotionSamples(double t, double h)>;

/// The rate of a state on its tangent, by the exact equations.
using TangentField = std::function<Eigen::VectorXd(double t, const Eigen::VectorXd& y)>;

/// The field of a scene, which must outlive it. It may keep scratch memory: each thread needs its
/// own.
template <class Scene>
[[nodiscard]] TangentField tangent_field(const Scene& scene, const Tangent& tangent) {
  if constexpr (requires { scene.field(); }) {
    return [rates = scene.field(), tangent, rate = Eigen::VectorXd()](
               double t, const Eigen::VectorXd& y) mutable {
      rates(t, y, rate);
      return tangent_rate(tangent, y, rate);
    };
  } else if constexpr (requires { scene.workspace(); }) {
    using Workspace = decltype(scene.workspace());
    return [&scene, tangent, w = std::make_shared<Workspace>(scene.workspace()),
            rate = Eigen::VectorXd()](double t, const Eigen::VectorXd& y) mutable {
      scene.rates(t, y, rate, *w);
      return tangent_rate(tangent, y, rate);
    };
  } else {
    return [&scene, tangent](double t, const Eigen::VectorXd& y) {
      return tangent_rate(tangent, y, scene.rates(t, typename Scene::Vector(y)));
    };
  }
}

}  // namespace kreisel
