#pragma once

#include <string>
#include <vector>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_file.hpp>

namespace kreisel {

/// A rolling contact that pulls its body onto the plane. A real one would lift off.
struct PullingContact {
  std::string constraint;
  double t;      ///< of the first output at which it pulls
  double force;  ///< along the plane's normal, below 0, in N
};

/// The rolling contacts that pull at an output of a run.
[[nodiscard]] std::vector<PullingContact> pulling_contacts(const SceneFile& scene,
                                                           const SceneSolver& model,
                                                           const Trajectory<JointState>& run);

}  // namespace kreisel
