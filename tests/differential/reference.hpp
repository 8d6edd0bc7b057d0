#pragma once

#include <vector>

#include "scene.hpp"

/// An integrator of scenes that shares no code with dynamics/. Every body has position, attitude
/// and velocities of its own. Joints are conditions with Lagrange multipliers. Steps are those of
/// Gragg's extrapolation in long double.

namespace differential {

/// Coordinates, then rates, of one body after the other, in the order of docs/scene_files.md; a
/// quaternion as x, y, z, w. Locked joints are included.
using JointValues = std::vector<double>;

/// Numbers in JointValues that share unit and size: 4 for an attitude, else the number of
/// coordinates.
[[nodiscard]] std::vector<int> blocks(const Scene& scene);

/// Numbers in a sensor's readings that belong together, in the order of the file's columns.
[[nodiscard]] std::vector<int> parts_of(const Scene& scene, const Sensor& sensor);

/// Reference sizes for the drift of invariants.
struct Sizes {
  long double energy = 0;
  long double momentum = 0;
};

/// The motion at the requested times, as far as the budget allows.
struct ReferenceMotion {
  std::vector<double> times;
  std::vector<JointValues> states;
  /// The same with halved steps and a start perturbed in its last digits.
  std::vector<JointValues> others;
  bool complete = false;
  Sizes sizes = {};  ///< greatest sizes so far
};

/// The values of all joints at the start.
[[nodiscard]] JointValues start_values(const Scene& scene);

/// The force of each body's parent on it at the start: three numbers of force, three of torque. The
/// torque is about the body's origin, all on body axes.
[[nodiscard]] std::vector<double> start_reactions(const Scene& scene);

/// Readings of sensors at the start, in the order of Tree::readings(); NaN for unknown numbers.
[[nodiscard]] std::vector<double> start_readings(const Scene& scene);

/// The pose of a body in the guide: attitude and position of its origin.
struct StartPose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector x = Vector::Zero();
};

[[nodiscard]] std::vector<StartPose> start_poses(const Scene& scene);

/// The values of all joints at the start, with the nearest rates that fulfil the constraints.
[[nodiscard]] JointValues fulfilled_values(const Scene& scene);

/// True if some motion in the joints moves no inertia at the start. Constraints do not count, as a
/// tree must be able to move without them.
[[nodiscard]] bool has_idle_motion(const Scene& scene);

/// The singular values of all conditions at the start, in decreasing order, with a 0 for each
/// condition that follows from others.
[[nodiscard]] Eigen::VectorXd condition_values(const Scene& scene);

/// True if the last element of a scene has a force at the start, with room to move.
[[nodiscard]] bool last_element_works(const Scene& scene);

/// `work` is the approximate limit of floating point operations.
[[nodiscard]] ReferenceMotion integrate(const Scene& scene, const std::vector<double>& times,
                                        double work);

}  // namespace differential
