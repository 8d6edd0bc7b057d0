#include <string>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

namespace {

/// The quantities of a joint in the order of the columns: coordinates, then rates.
std::vector<JointQuantity> quantities(const BodyDescription& body) {
  const JointType& type = joint_type(body.joint.kind);
  std::vector<JointQuantity> all = type.coordinates;
  all.insert(all.end(), type.rates.begin(), type.rates.end());
  return all;
}

int count(const BodyTree& tree) { return static_cast<int>(tree.bodies().size()); }

bool has_attitude(const BodyTree& tree, int body) {
  return joint_type(tree.body(body).joint.kind).has_attitude();
}

}  // namespace

std::vector<std::string> columns(const BodyTree& tree, bool reactions) {
  std::vector<std::string> names{"t"};
  for (const auto& body : tree.bodies()) {
    for (const JointQuantity& quantity : quantities(body)) {
      for (const std::string& column : quantity.columns) names.push_back(body.name + "." + column);
    }
  }
  if (!reactions) return names;
  for (const auto& body : tree.bodies()) {
    for (const char* const part :
         {"force x", "force y", "force z", "torque x", "torque y", "torque z", "drive torque"}) {
      names.push_back(body.name + "." + part);
    }
  }
  return names;
}

std::vector<double> row(const SceneSolver& model, double t, const JointState& state,
                        bool reactions) {
  const BodyTree& tree = model.tree();
  std::vector<double> values{t};
  const auto append = [&values](const auto& vector) {
    values.insert(values.end(), vector.data(), vector.data() + vector.size());
  };
  for (int i = 0; i < count(tree); ++i) {
    const auto [q, q_count, v, v_count] = tree.place(i);
    if (has_attitude(tree, i)) {
      const Eigen::Quaterniond a = attitude(tree, i, state);
      append(Eigen::Vector4d(a.w(), a.x(), a.y(), a.z()));
      if (q_count == 7) append(place(tree, i, state));
    } else {
      append(state.coordinates.segment(q, q_count).eval());
    }
    append(state.rates.segment(v, v_count).eval());
  }
  if (!reactions) return values;
  const JointReactions carried = model.reactions(t, state);
  for (int i = 0; i < count(tree); ++i) {
    const auto& [force, torque] = carried.on_body[static_cast<std::size_t>(i)].value;
    append(force);
    append(torque);
    values.push_back(drive_torque(tree, i, carried));
  }
  return values;
}

std::vector<double> shown_row(const BodyTree& tree, std::vector<double> values,
                              const SceneScale& scale) {
  std::size_t at = 1;
  const auto show = [&](const std::string& unit, int count) {
    const double size = scale.of(unit);
    for (int k = 0; k < count; ++k, ++at) values[at] = shown(values[at], size);
  };
  for (const auto& body : tree.bodies()) {
    for (const JointQuantity& quantity : quantities(body)) show(quantity.unit, quantity.count());
  }
  while (at < values.size()) {
    show("N", 3);
    show("N m", 4);
  }
  return values;
}

JointState state_of(const BodyTree& tree, const std::vector<double>& row) {
  JointState state{Eigen::VectorXd(tree.coordinates()), Eigen::VectorXd(tree.rates())};
  const double* next = row.data() + 1;
  for (int i = 0; i < count(tree); ++i) {
    const auto [q, q_count, v, v_count] = tree.place(i);
    if (has_attitude(tree, i)) {
      const Joint& joint = tree.body(i).joint;
      const Eigen::Quaterniond a(next[0], next[1], next[2], next[3]);
      state.coordinates.segment<4>(q) = (joint.orientation.conjugate() * a).coeffs();
      if (q_count == 7) {
        state.coordinates.segment<3>(q + 4) =
            Eigen::Map<const Eigen::Vector3d>(next + 4) - joint.position;
      }
    } else {
      std::copy_n(next, q_count, state.coordinates.data() + q);
    }
    next += q_count;
    std::copy_n(next, v_count, state.rates.data() + v);
    next += v_count;
  }
  return state;
}

}  // namespace kreisel
