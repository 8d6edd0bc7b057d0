#include "joints.hpp"

#include <cmath>
#include <vector>

#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

using nlohmann::ordered_json;

namespace {

/// The numbers of these quantities in the state from index `at` on, one after another.
ordered_json listed(const std::vector<JointQuantity>& quantities, const Eigen::VectorXd& state,
                    int at, const SceneScale& scale) {
  ordered_json list = ordered_json::array();
  for (const JointQuantity& quantity : quantities) {
    const double size = scale.of(quantity.unit);
    for (int k = 0; k < quantity.count(); ++k, ++at) list.push_back(shown(state[at], size));
  }
  return list;
}

/// A joint with an attitude.
ordered_json ball(const BodyTree& tree, int body, const JointState& state,
                  const SceneScale& scale) {
  const auto [q, q_count, v, v_count] = tree.place(body);
  const Eigen::Quaterniond a = attitude(tree, body, state);
  ordered_json values{{"attitude",
                       {shown(a.w(), scale.angle), shown(a.x(), scale.angle),
                        shown(a.y(), scale.angle), shown(a.z(), scale.angle)}},
                      {"angular_velocity",
                       json_of(shown(Eigen::Vector3d(state.rates.segment<3>(v)), scale.turning))}};
  if (q_count == 7) {
    values["position"] = json_of(shown(place(tree, body, state), scale.length));
    values["velocity"] =
        json_of(shown(Eigen::Vector3d(state.rates.segment<3>(v + 3)), scale.speed));
  }
  return values;
}

}  // namespace

ordered_json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ordered_json json_of(double x) { return std::isfinite(x) ? ordered_json(x) : ordered_json(); }

ordered_json json_of(const Motor<>& force, const SceneScale& scale) {
  return {{"force", json_of(shown(force.resultant, scale.force))},
          {"torque", json_of(shown(force.moment, scale.torque))}};
}

ordered_json joint_json(const BodyTree& tree, int body, const JointState& state,
                        const JointReactions& reactions, const SceneScale& scale) {
  const JointPlace place = tree.place(body);
  const JointType& type = joint_type(tree.body(body).joint.kind);
  if (type.coordinates.empty()) return ordered_json::object();
  if (type.has_attitude()) return ball(tree, body, state, scale);
  const ordered_json coordinates = listed(type.coordinates, state.coordinates, place.q, scale);
  const ordered_json rates = listed(type.rates, state.rates, place.v, scale);
  if (coordinates.size() > 1) return {{"coordinate", coordinates}, {"rate", rates}};
  const double torque = shown(drive_torque(tree, body, reactions), scale.torque);
  return {{"coordinate", coordinates[0]},
          {"rate", rates[0]},
          {"drive_torque", torque},
          {"drive_power", torque * state.rates[place.v]}};
}

}  // namespace kreisel
