#include <Eigen/Geometry>

#include <cmath>
#include <limits>

#include <dynamics/tree/cardan_chain.hpp>

namespace kreisel {

namespace {

/// Rounding that adding, rotating and normalizing a few numbers may leave.
constexpr double slack = 64 * std::numeric_limits<double>::epsilon();

std::string of_body(const BodyDescription& body, const char* why) {
  return "body '" + body.name + "' " + why;
}

/// Empty if each body is on a revolute joint of the one before, where the axes meet.
std::string joint_mistake(const std::vector<BodyDescription>& bodies) {
  if (bodies.size() != 3) return "here are not three bodies";
  for (std::size_t i = 0; i < 3; ++i) {
    const BodyDescription& body = bodies[i];
    if (body.joint.kind != JointKind::revolute) return of_body(body, "is on no revolute joint");
    if (body.parent != (i == 0 ? "guide" : bodies[i - 1].name)) {
      return of_body(body, "is not held by the body before it");
    }
    if (i > 0 && !body.joint.position.isZero(0)) {
      return of_body(body, "has its joint elsewhere than where the axes meet");
    }
  }
  return {};
}

Inertia<> rotated(const Inertia<>& T, const Matrix3<double>& R) {
  return {T.mass, R * T.first_moment, T.tensor.rotated(R)};
}

}  // namespace

std::variant<CardanChain, std::string> cardan_chain(const std::vector<BodyDescription>& bodies) {
  if (std::string mistake = joint_mistake(bodies); !mistake.empty()) return mistake;
  CardanChain chain;
  std::array<Matrix3<double>, 3> attitudes;  // of the bodies at zero angles
  Matrix3<double> parent = Matrix3<double>::Identity();
  for (int i = 0; i < 3; ++i) {
    const Joint& joint = bodies[std::size_t(i)].joint;
    chain.axes.col(i) = parent * joint.axis.normalized();
    parent *= joint.orientation.normalized().toRotationMatrix();
    attitudes[std::size_t(i)] = parent;
  }
  const Vector3<double> across = chain.axes.col(0).cross(chain.axes.col(1));
  chain.sign = across.dot(chain.axes.col(2)) < 0 ? -1 : 1;
  if ((across - chain.sign * chain.axes.col(2)).norm() > slack) {
    return "these axes are not at right angles";
  }
  chain.axes.col(2) = across;
  chain.point = bodies[0].joint.position;
  const auto inertia = [&](std::size_t i) {
    return rotated(bodies[i].inertia.value, chain.axes.transpose() * attitudes[i]);
  };
  chain.outer_ring = inertia(0);
  chain.inner_ring = inertia(1);
  chain.rotor = inertia(2);
  return chain;
}

bool is_principal(const Inertia<>& inertia) {
  const Symmetric3<>& t = inertia.tensor;
  return std::hypot(t.xy, t.xz, t.yz) <= slack * (t.xx + t.yy + t.zz);
}

bool is_centred(const Inertia<>& inertia) {
  const double trace = inertia.tensor.xx + inertia.tensor.yy + inertia.tensor.zz;
  return inertia.first_moment.norm() <= slack * std::sqrt(inertia.mass * trace);
}

}  // namespace kreisel
