#pragma once

#include <vector>

#include "scene.hpp"

/// An integrator of scenes that shares no code with dynamics/: every body has place, attitude and
/// velocities of its own, joints are conditions with Lagrange multipliers, and steps are those of
/// Gragg's extrapolation in long double.

namespace differential {

/// Coordinates, then rates, of one body after the other, as docs/scene_files.md counts them; a
/// quaternion as x, y, z, w. Of a joint that is held they are there too.
using JointValues = std::vector<double>;

/// Numbers in JointValues that share unit and size: 4 an attitude, else so many numbers.
[[nodiscard]] std::vector<int> blocks(const Scene& scene);

/// What drifts of invariants are measured by.
struct Sizes {
  long double energy = 0;
  long double momentum = 0;
};

/// The motion at the times asked for, as far as the budget went.
struct ReferenceMotion {
  std::vector<double> times;
  std::vector<JointValues> states;
  /// The same with halved steps, from a start that is off by its last digits.
  std::vector<JointValues> others;
  bool complete = false;
  Sizes sizes = {};  ///< the greatest on the way
};

/// The force of each body's parent on it at the start: three numbers of force and three of torque about
/// the body's origin, on body axes.
[[nodiscard]] std::vector<double> start_reactions(const Scene& scene);

/// `work` is about the number of floating point operations that may be spent.
[[nodiscard]] ReferenceMotion integrate(const Scene& scene, const std::vector<double>& times,
                                        double work);

}  // namespace differential
