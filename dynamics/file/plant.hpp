#pragma once

#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/study/linear_plant.hpp>

/// Names of inputs and outputs of the linear plant of a scene.

namespace kreisel {

/// The input with a name:
///
///   joint.BODY, joint.BODY.2              the force of a joint along its rate, its second rate
///   load.BODY.force.x, load.BODY.torque.z at the body's origin, on its axes
///   CONTROLLER.reference                  or CONTROLLER.reference.2
///   guide.roll, guide.pitch, guide.yaw    small rotations about the guide's x, y and z axis
///   guide.angular_velocity.x              and y, z: the same, by their rates
///   guide.origin_acceleration.x           and y, z
///
/// Throws : InvalidInput with the known names
[[nodiscard]] PlantInput plant_input(const SceneFile& scene, const std::string& name);

/// The output with a name: a column of a joint, a sensor or a controller.
///
/// Throws : InvalidInput with the known names
[[nodiscard]] PlantOutput plant_output(const SceneFile& scene, const std::string& name);

/// Joint forces, loads on bodies that have loads, references and motions of the guide; all outputs
/// that can be read.
[[nodiscard]] std::vector<PlantInput> plant_inputs(const SceneFile& scene);
[[nodiscard]] std::vector<PlantOutput> plant_outputs(const SceneFile& scene);

}  // namespace kreisel
