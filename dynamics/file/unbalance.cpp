#include <Eigen/Geometry>
#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include <dynamics/file/scene_sweep.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/file/unbalance.hpp>
#include <dynamics/study/whirl.hpp>
#include <dynamics/tree/joint/planar.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

/// The forces along both directions across a rotor's axis, as inputs on its carrier.
std::vector<PlantInput> forces_across(const BodyTree& tree, int body) {
  const BodyDescription& rotor = tree.body(body);
  if (rotor.parent == "guide") {
    throw InvalidInput("unbalance: rotor '" + rotor.name +
                       "' is fixed to the guide, which no force moves; give it a carrier");
  }
  const int carrier = tree.index(rotor.parent);
  const Vector3<double> axis = rotor.joint.axis.normalized();
  const Inertia<double>& T = rotor.inertia.value;
  if (!(T.mass > 0)) throw InvalidInput("unbalance: rotor '" + rotor.name + "' has no mass");
  const Vector3<double> c = rotor.joint.orientation.normalized() * (T.first_moment / T.mass);
  const Vector3<double> at = rotor.joint.position + axis * axis.dot(c);
  std::vector<PlantInput> inputs;
  const auto [first, second] =
      detail::plane_directions({.kind = JointKind::planar, .axis = rotor.joint.axis});
  for (const Vector3<double>& e : {first, second}) {
    const Actuator force{"", "N", Actuator::BodyForce{carrier, {e, at.cross(e)}}};
    inputs.push_back({force.name, force.unit, force});
  }
  return inputs;
}

/// Throws : InvalidInput if the carrier of the body turns
void check_carrier(const BodyTree& tree, int body, const Eigen::VectorXd& state) {
  for (const SpinningBody& spinning : spinning_bodies(tree, state)) {
    if (spinning.body != body || std::abs(spinning.carrier) < 1e-9) continue;
    throw InvalidInput("unbalance: the carrier of '" + tree.body(body).name +
                       "' turns; describe the rotor as the last body that turns");
  }
}

}  // namespace

UnbalanceResponse unbalance_response(const StudySystem& system, const SceneFile& scene,
                                     const std::string& body, const PlantOutput& output,
                                     const std::vector<double>& speeds,
                                     const Eigen::VectorXd& guess) {
  const Eigen::Index speed = speed_of(system, body);
  const int index = system.tree().index(body);
  const std::vector<PlantInput> inputs = forces_across(system.tree(), index);
  UnbalanceResponse response{speeds, {}};
  Eigen::VectorXd y = guess;
  for (const double W : speeds) {
    y[speed] = W;
    const Steady steady = steady_motion::find_steady(system, y, scene.duration());
    if (!steady.exists()) {
      throw ComputationFailed(
          fmt::format("unbalance: no steady motion at {:.9g} rad/s: {}", W, steady.reason));
    }
    y = steady.state;
    check_carrier(system.tree(), index, y);
    const Eigen::MatrixXcd H = system.plant(system.begin(), y, inputs, {output}).response(W);
    response.values.push_back(W * W * (H(0, 0) - std::complex<double>(0, 1) * H(0, 1)));
  }
  return response;
}

}  // namespace kreisel
