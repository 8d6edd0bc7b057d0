#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

std::vector<JointQuantity> joint_quantities(JointKind kind) {
  const JointType& type = joint_type(kind);
  std::vector<JointQuantity> all = type.coordinates;
  all.insert(all.end(), type.rates.begin(), type.rates.end());
  return all;
}

namespace {

int count(const BodyTree& tree) { return static_cast<int>(tree.bodies().size()); }

bool has_attitude(const BodyTree& tree, int body) {
  return joint_type(tree.body(body).joint.kind).has_attitude();
}

}  // namespace

std::vector<std::string> columns(const std::vector<BodyDescription>& bodies, bool reactions) {
  std::vector<std::string> names{"t"};
  for (const auto& body : bodies) {
    for (const JointQuantity& quantity : joint_quantities(body.joint.kind)) {
      for (const std::string& column : quantity.columns) names.push_back(body.name + "." + column);
    }
  }
  if (!reactions) return names;
  for (const auto& body : bodies) {
    for (const char* const part : reaction_quantities) names.push_back(body.name + "." + part);
  }
  return names;
}

namespace {

void append_force_columns(const std::string& name, std::vector<std::string>& names) {
  for (const char* const part : element_quantities) names.push_back(name + "." + part);
}

}  // namespace

std::vector<std::string> columns(const std::vector<Element>& elements) {
  std::vector<std::string> names;
  for (const Element& element : elements) append_force_columns(name(element), names);
  return names;
}

std::vector<std::string> columns(const std::vector<Constraint>& constraints) {
  std::vector<std::string> names;
  for (const Constraint& constraint : constraints) append_force_columns(constraint.name, names);
  return names;
}

std::vector<std::string> columns(const SceneFile& scene) {
  std::vector<std::string> names = columns(scene.bodies, scene.reactions);
  std::vector<std::string> memory;
  for (const std::string& name : scene.memory_names) memory.push_back("memory." + name);
  const auto joints = static_cast<std::ptrdiff_t>(columns(scene.bodies, false).size());
  names.insert(names.begin() + joints, memory.begin(), memory.end());
  if (scene.element_forces) {
    const std::vector<std::string> own = columns(scene.elements);
    names.insert(names.end(), own.begin(), own.end());
  }
  if (scene.constraint_forces) {
    const std::vector<std::string> own = columns(scene.constraints);
    names.insert(names.end(), own.begin(), own.end());
  }
  for (const SceneSensor& sensor : scene.sensors) {
    const std::vector<std::string> own = columns(sensor, scene.bodies);
    names.insert(names.end(), own.begin(), own.end());
  }
  return names;
}

bool names_column(std::string_view word, std::string_view column) {
  if (!column.starts_with(word)) return false;
  return column.size() == word.size() || column[word.size()] == '.' || column[word.size()] == ' ';
}

std::vector<std::size_t> chosen_columns(const std::vector<std::string>& columns,
                                        const std::vector<std::string>& words) {
  std::vector<std::size_t> chosen{0};
  for (const std::string& word : words) {
    for (std::size_t i = 1; i < columns.size(); ++i) {
      const bool is_new = std::find(chosen.begin(), chosen.end(), i) == chosen.end();
      if (is_new && names_column(word, columns[i])) chosen.push_back(i);
    }
  }
  return chosen;
}

void append_joint(const BodyTree& tree, int body, const JointState& state,
                  std::vector<double>& values) {
  const auto append = [&values](const auto& vector) {
    values.insert(values.end(), vector.data(), vector.data() + vector.size());
  };
  const auto [q, q_count, v, v_count] = tree.place(body);
  if (has_attitude(tree, body)) {
    const Eigen::Quaterniond a = attitude(tree, body, state);
    append(Eigen::Vector4d(a.w(), a.x(), a.y(), a.z()));
    if (q_count == 7) append(place(tree, body, state));
  } else {
    append(state.coordinates.segment(q, q_count).eval());
  }
  append(state.rates.segment(v, v_count).eval());
}

std::vector<double> row(const SceneSolver& model, double t, const JointState& state,
                        const RowForces& forces) {
  const BodyTree& tree = model.tree();
  std::vector<double> values{t};
  const auto append = [&values](const auto& vector) {
    values.insert(values.end(), vector.data(), vector.data() + vector.size());
  };
  for (int i = 0; i < count(tree); ++i) append_joint(tree, i, state, values);
  append(state.memory);
  if (forces.reactions) {
    const JointReactions carried = model.reactions(t, state);
    for (int i = 0; i < count(tree); ++i) {
      const auto& [force, torque] = carried.on_body[static_cast<std::size_t>(i)].value;
      append(force);
      append(torque);
      values.push_back(drive_torque(tree, i, carried));
    }
  }
  const auto append_all = [&append](const std::vector<Motor<>>& all) {
    for (const auto& [force, torque] : all) {
      append(force);
      append(torque);
    }
  };
  if (forces.elements) append_all(model.element_forces(t, state));
  if (forces.constraints) append_all(model.constraint_forces(t, state));
  return values;
}

std::vector<double> shown_row(const SceneSolver& model, std::vector<double> values,
                              const SceneScale& scale) {
  std::size_t at = 1;
  const auto show = [&](const std::string& unit, int count) {
    const double size = scale.of(unit);
    for (int k = 0; k < count; ++k, ++at) values[at] = shown(values[at], size);
  };
  for (const auto& body : model.tree().bodies()) {
    for (const JointQuantity& quantity : joint_quantities(body.joint.kind)) {
      show(quantity.unit, quantity.count());
    }
  }
  at += static_cast<std::size_t>(model.memory());
  while (at < values.size()) {
    show("N", 3);
    show("N m", 4);
  }
  return values;
}

JointState state_of(const SceneSolver& model, const std::vector<double>& row) {
  const BodyTree& tree = model.tree();
  JointState state{Eigen::VectorXd(tree.coordinates()), Eigen::VectorXd(tree.rates()),
                   Eigen::VectorXd(model.memory())};
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
  std::copy_n(next, state.memory.size(), state.memory.data());
  return state;
}

}  // namespace kreisel
