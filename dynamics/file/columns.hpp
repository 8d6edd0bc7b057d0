#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scale.hpp>
#include <dynamics/tree/joint/type.hpp>

namespace kreisel {

/// The quantities of a joint in the order of the columns: coordinates, then rates.
std::vector<JointQuantity> joint_quantities(JointKind kind);

/// Names of the components of a joint's reaction.
inline constexpr std::array reaction_quantities{"force x",  "force y",  "force z",     "torque x",
                                                "torque y", "torque z", "drive torque"};

/// Names of the components of the force of an element or a constraint.
inline constexpr std::array element_quantities{"force x",  "force y",  "force z",
                                               "torque x", "torque y", "torque z"};

/// The columns of a trajectory: t, coordinates and rates of every joint, and on request its
/// reaction and the torque of its drive. Attitudes (w, x, y, z) and positions are relative to the
/// parent.
std::vector<std::string> columns(const std::vector<BodyDescription>& bodies, bool reactions);
inline std::vector<std::string> columns(const BodyTree& tree, bool reactions) {
  return columns(tree.bodies(), reactions);
}

/// The columns of forces and torques of elements and of constraints.
std::vector<std::string> columns(const std::vector<Element>& elements);
std::vector<std::string> columns(const std::vector<Constraint>& constraints);

/// The forces that the rows of a run contain besides the joints' coordinates and rates.
struct RowForces {
  bool reactions = false;
  bool elements = false;
  bool constraints = false;
};

/// The columns of a scene's run: joints, the memory of controllers, reactions, elements and
/// constraints if they are requested, and sensors.
[[nodiscard]] std::vector<std::string> columns(const SceneFile& scene);

/// True if a word is a column's name or its group: the part of the name before a dot or a blank.
[[nodiscard]] bool names_column(std::string_view word, std::string_view column);

/// The indices of the columns that the words name, in the order of the words, after the time's
/// index.
[[nodiscard]] std::vector<std::size_t> chosen_columns(const std::vector<std::string>& columns,
                                                      const std::vector<std::string>& words);

/// The numbers of a row, in the order of the columns.
std::vector<double> row(const SceneSolver& model, double t, const JointState& state,
                        const RowForces& forces);

/// Appends coordinates and rates of a body's joint, in the order of the columns.
void append_joint(const BodyTree& tree, int body, const JointState& state,
                  std::vector<double>& values);

/// The row as pictures show it, with reactions or without. Numbers that are rounding relative to the
/// scale are 0. The memory of controllers has no scale.
std::vector<double> shown_row(const SceneSolver& model, std::vector<double> values,
                              const SceneScale& scale);

/// The state in a row.
JointState state_of(const SceneSolver& model, const std::vector<double>& row);

}  // namespace kreisel
