#include "model.hpp"

std::unique_ptr<Model> make_model(const kreisel::SceneFile& scene) {
  return scene.rests() ? make_resting_model(scene) : make_moving_model(scene);
}

JointState start_of(const kreisel::SceneFile& scene) {
  std::vector<double> coordinates;
  std::vector<double> rates;
  for (const kreisel::JointStart& joint : scene.start) {
    coordinates.insert(coordinates.end(), joint.coordinates.begin(), joint.coordinates.end());
    rates.insert(rates.end(), joint.rates.begin(), joint.rates.end());
  }
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  return {vector(coordinates), vector(rates)};
}
