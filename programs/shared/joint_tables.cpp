#include "joint_tables.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include <dynamics/file/printable.hpp>

using namespace kreisel;

using kreisel::JointKind;
using nlohmann::ordered_json;

namespace joint_tables {

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
  const auto [q, q_count, v, v_count] = tree.place(body);
  const auto pair = [](const Eigen::VectorXd& x, int begin, double size) {
    return ordered_json{shown(x[begin], size), shown(x[begin + 1], size)};
  };
  const JointKind kind = tree.body(body).joint.kind;
  const bool slides = kind == JointKind::prismatic;
  switch (kind) {
    case JointKind::fixed: return ordered_json::object();
    case JointKind::universal:
      return {{"coordinate", pair(state.coordinates, q, scale.angle)},
              {"rate", pair(state.rates, v, scale.turning)}};
    case JointKind::spherical:
    case JointKind::free: break;
    default:
      return {{"coordinate", shown(state.coordinates[q], slides ? scale.length : scale.angle)},
              {"rate", shown(state.rates[v], slides ? scale.speed : scale.turning)},
              {"drive_torque", shown(drive_torque(tree, body, reactions), scale.torque)}};
  }
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
