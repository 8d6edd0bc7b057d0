#include <array>

#include <dynamics/file/columns.hpp>

namespace kreisel {

namespace {

/// Names of coordinates and rates of a joint.
std::vector<const char*> quantities(JointKind kind) {
  switch (kind) {
    case JointKind::fixed: return {};
    case JointKind::revolute: return {"angle", "rate"};
    case JointKind::prismatic: return {"displacement", "rate"};
    case JointKind::universal: return {"angle 1", "angle 2", "rate 1", "rate 2"};
    case JointKind::spherical: return {"qw", "qx", "qy", "qz", "wx", "wy", "wz"};
    case JointKind::free:
      return {"qw", "qx", "qy", "qz", "x", "y", "z", "wx", "wy", "wz", "vx", "vy", "vz"};
  }
  return {};
}

std::vector<const char*> units(JointKind kind) {
  switch (kind) {
    case JointKind::fixed: return {};
    case JointKind::revolute: return {"rad", "rad/s"};
    case JointKind::prismatic: return {"m", "m/s"};
    case JointKind::universal: return {"rad", "rad", "rad/s", "rad/s"};
    case JointKind::spherical: return {"1", "1", "1", "1", "rad/s", "rad/s", "rad/s"};
    case JointKind::free:
      return {"1", "1", "1", "1", "m", "m", "m", "rad/s", "rad/s", "rad/s", "m/s", "m/s", "m/s"};
  }
  return {};
}

int count(const BodyTree& tree) { return static_cast<int>(tree.bodies().size()); }

bool turns_freely(const BodyTree& tree, int body) { return tree.place(body).q_count >= 4; }

}  // namespace

std::vector<std::string> columns(const BodyTree& tree, bool reactions) {
  std::vector<std::string> names{"t"};
  for (const auto& body : tree.bodies()) {
    for (const char* const quantity : quantities(body.joint.kind)) {
      names.push_back(body.name + "." + quantity);
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
    if (turns_freely(tree, i)) {
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
  const auto show = [&](const auto& list) {
    for (const char* const unit : list) {
      values[at] = shown(values[at], scale.of(unit));
      ++at;
    }
  };
  for (const auto& body : tree.bodies()) show(units(body.joint.kind));
  while (at < values.size()) {
    show(std::array<const char*, 7>{"N", "N", "N", "N m", "N m", "N m", "N m"});
  }
  return values;
}

JointState state_of(const BodyTree& tree, const std::vector<double>& row) {
  JointState state{Eigen::VectorXd(tree.coordinates()), Eigen::VectorXd(tree.rates())};
  const double* next = row.data() + 1;
  for (int i = 0; i < count(tree); ++i) {
    const auto [q, q_count, v, v_count] = tree.place(i);
    if (turns_freely(tree, i)) {
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
