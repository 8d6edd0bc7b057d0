#include "joint_tables.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/file/printable.hpp>
#include <dynamics/tree/joint/list.hpp>

using namespace kreisel;

using nlohmann::ordered_json;

namespace joint_tables {

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
  ordered_json values{
      {"attitude",
       {shown(a.w(), scale.angle), shown(a.x(), scale.angle), shown(a.y(), scale.angle),
        shown(a.z(), scale.angle)}},
      {"angular_velocity", json(shown(Eigen::Vector3d(state.rates.segment<3>(v)), scale.turning))}};
  if (q_count == 7) {
    values["position"] = json(shown(place(tree, body, state), scale.length));
    values["velocity"] = json(shown(Eigen::Vector3d(state.rates.segment<3>(v + 3)), scale.speed));
  }
  return values;
}

}  // namespace

std::string text(const ordered_json& numbers) {
  if (numbers.is_number()) return fmt::format("{:.15g}", numbers.get<double>());
  std::string all;
  for (const auto& x : numbers) {
    all += fmt::format("{}{:.15g}", all.empty() ? "" : ", ", x.get<double>());
  }
  return "(" + all + ")";
}

ordered_json json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

ordered_json json(double x) { return std::isfinite(x) ? ordered_json(x) : ordered_json(); }

ordered_json json(const kreisel::Motor<>& force, const kreisel::SceneScale& scale) {
  return {{"force", json(shown(force.resultant, scale.force))},
          {"torque", json(shown(force.moment, scale.torque))}};
}

ordered_json joint(const kreisel::BodyTree& tree, int body, const kreisel::JointState& state,
                   const kreisel::JointReactions& reactions, const kreisel::SceneScale& scale) {
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

void print(const char* title, const ordered_json& table) {
  fmt::print("\n{}\n", title);
  for (const auto& [name, values] : table.items()) {
    const std::string body = kreisel::printable(name, 60);
    for (const auto& [quantity, numbers] : values.items()) {
      if (numbers.is_object()) {
        for (const auto& [part, vector] : numbers.items()) {
          fmt::print("  {:20} {:17} {}\n", body, fmt::format("{} {}", quantity, part),
                     text(vector));
        }
      } else {
        fmt::print("  {:20} {:17} {}\n", body, quantity, text(numbers));
      }
    }
  }
}

}  // namespace joint_tables
