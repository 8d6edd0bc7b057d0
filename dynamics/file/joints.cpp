#include <variant>
#include <vector>

#include <dynamics/file/joints.hpp>

namespace kreisel {

std::vector<std::filesystem::path> files_read(const std::filesystem::path& scene_file,
                                              const SceneFile& scene) {
  std::vector<std::filesystem::path> files = scene.log_files();
  files.insert(files.begin(), scene_file);
  return files;
}

JointState start_of(const SceneFile& scene) {
  std::vector<double> coordinates;
  std::vector<double> rates;
  for (const JointStart& joint : scene.start) {
    coordinates.insert(coordinates.end(), joint.coordinates.begin(), joint.coordinates.end());
    rates.insert(rates.end(), joint.rates.begin(), joint.rates.end());
  }
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  return {vector(coordinates), vector(rates), vector(scene.memory_start)};
}

Eigen::Quaterniond attitude(const BodyTree& tree, int body, const JointState& state) {
  const double* const q = state.coordinates.data() + tree.place(body).q;
  return (tree.body(body).joint.orientation * Eigen::Quaterniond(q[3], q[0], q[1], q[2]))
      .normalized();
}

Eigen::Vector3d place(const BodyTree& tree, int body, const JointState& state) {
  return tree.body(body).joint.position + state.coordinates.segment<3>(tree.place(body).q + 4);
}

double drive_torque(const BodyTree& tree, int body, const JointReactions& reactions) {
  const BodyDescription& b = tree.body(body);
  const bool regulated = b.rotor && b.rotor->mode == RotorMode::regulated;
  const bool driven = b.rule == JointRule::driven || regulated;
  return driven ? reactions.drive[tree.place(body).v] : 0;
}

}  // namespace kreisel
