#include <dynamics/sensor/kinematics.hpp>
#include <dynamics/tree/passes.hpp>
#include <dynamics/tree/rotor_forces.hpp>

namespace kreisel::detail {

SystemKinematics kinematics(const BodyTree& tree, const Surroundings& now, const Eigen::VectorXd& y,
                            const BodyLoad* gravitation, BodyWorkspace& w) {
  SystemKinematics result{
      now.t, now.guide, now.guide, {field(now.gravity, now.guide), gravitation}};
  reactions(tree, now, y, result.reactions, w);
  const double* const v = y.data() + tree.coordinates();
  const double* const dv = w.acceleration.data();
  result.rates.resize(y.size());
  set_coordinate_rates(tree, y.data(), v, result.rates.data());
  result.rates.tail(tree.rates()) = w.acceleration;
  set_motions(tree, LinkMotion<>{}, v, dv, w);
  set_places(tree, v, w);
  set_rotor_places(tree, y.data(), v, w);
  set_rotor_motions(tree, v, dv, w);
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const std::size_t link = tree.link(i);
    const auto& [x, V] = w.place[link];
    const LinkMotion<>& motion = w.motion[link];
    result.bodies.push_back({w.pose[link].R, x, V.resultant, V.moment, motion.dw, motion.a});
  }
  return result;
}

}  // namespace kreisel::detail
