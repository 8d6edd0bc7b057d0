#include <cstddef>

#include <dynamics/tree/joint/cylindrical.hpp>
#include <dynamics/tree/joint/fixed.hpp>
#include <dynamics/tree/joint/free.hpp>
#include <dynamics/tree/joint/list.hpp>
#include <dynamics/tree/joint/planar.hpp>
#include <dynamics/tree/joint/prismatic.hpp>
#include <dynamics/tree/joint/revolute.hpp>
#include <dynamics/tree/joint/screw.hpp>
#include <dynamics/tree/joint/spherical.hpp>
#include <dynamics/tree/joint/universal.hpp>

namespace kreisel {

const std::vector<JointType>& joint_types() {
  static const std::vector<JointType> types = {
      detail::fixed_joint(),       detail::revolute_joint(),  detail::prismatic_joint(),
      detail::universal_joint(),   detail::spherical_joint(), detail::free_joint(),
      detail::cylindrical_joint(), detail::planar_joint(),    detail::screw_joint()};
  return types;
}

const JointType& joint_type(JointKind kind) {
  return joint_types().at(static_cast<std::size_t>(kind));
}

}  // namespace kreisel
