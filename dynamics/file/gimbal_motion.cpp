#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <dynamics/file/gimbal_motion.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::Matrix3d, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// Rounding that adding, rotating and normalizing a few numbers may leave.
constexpr double slack = 64 * std::numeric_limits<double>::epsilon();

class Refusal {
 public:
  explicit Refusal(bool symmetric) : model_(symmetric ? "foeppl" : "fuchs-weigand") {}

  [[noreturn]] void operator()(const std::string& why) const {
    throw InvalidInput("model '" + model_ + "' is of a gyro in two rings on a guide at rest; " +
                       why);
  }
  [[noreturn]] void operator()(const BodyDescription& body, const std::string& why) const {
    (*this)("body '" + body.name + "' " + why);
  }

 private:
  std::string model_;
};

/// Checks for a chain of joints whose axes meet in one point, with springs and friction alone.
void check_joints(const SceneFile& scene, const Refusal& refuse) {
  if (!scene.rests()) refuse("this guide moves");
  if (scene.bodies.size() != 3) refuse("here are not three bodies");
  if (!scene.elements.empty()) refuse("here are elements between bodies");
  for (std::size_t i = 0; i < 3; ++i) {
    const BodyDescription& body = scene.bodies[i];
    const bool rotor = i == 2;
    if (body.joint.kind != JointKind::revolute) refuse(body, "is on no revolute joint");
    if (body.parent != (i == 0 ? "guide" : scene.bodies[i - 1].name)) {
      refuse(body, "is not held by the body before it");
    }
    if (i > 0 && !body.joint.position.isZero(0)) {
      refuse(body, "has its joint elsewhere than where the axes meet");
    }
    const Inertia<double>& T = body.inertia.value;
    if (T.first_moment.norm() > slack * std::sqrt(T.mass * T.tensor.matrix().trace())) {
      refuse(body, "has its centre of mass elsewhere than where the axes meet");
    }
    if (body.rule == JointRule::held) refuse(body, "is locked");
    if (!rotor && body.rule != JointRule::forces) refuse(body, "has a drive");
    if (!rotor && body.rotor) refuse(body, "is a rotor that carries another");
    if (!body.loads.empty()) refuse(body, "has a load");
    const bool regulated =
        body.rule == JointRule::driven || (body.rotor && body.rotor->mode == RotorMode::regulated);
    if (body.rotor && body.rotor->torque != 0) refuse(body, "is a rotor that a torque speeds up");
    for (const JointForce& force : body.forces) {
      if (!rotor && force.rest != 0) refuse(body, "has a spring that is not slack at 0");
      if (!regulated && force.constant != 0) refuse(body, "has a constant force");
      if (force.in_time) refuse(body, "has a force that changes with time");
      if (rotor && !regulated && (force.stiffness != 0 || force.damping != 0)) {
        refuse(body, "is a rotor that spring or friction slows down");
      }
    }
  }
}

/// Moments about three axes: outer ring, inner ring and, perpendicular to both, rotor.
Vector3d principal(const BodyDescription& body, const Matrix3d& axes, const Refusal& refuse) {
  const Matrix3d tensor = axes.transpose() * body.inertia.value.tensor.matrix() * axes;
  Vector3d moments = tensor.diagonal();
  if ((tensor - Matrix3d(moments.asDiagonal())).norm() > slack * moments.sum()) {
    refuse(body, "has products of inertia about the three axes");
  }
  return moments;
}

CardanBearing bearing(const BodyDescription& ring) {
  if (ring.forces.empty()) return {};
  return {ring.forces.front().stiffness, ring.forces.front().damping};
}

template <class Gyro>
std::vector<VectorXd> ring_oscillation(const Gyro& gyro, double t_begin, const VectorXd& start,
                                       const std::vector<double>& times) {
  Integrator run(gyro, t_begin, {start[0], start[1], start[3], start[4]}, {.relative = 1e-13});
  std::vector<VectorXd> result;
  for (const double t : times) {
    const auto ring = run.on_the_way(t_begin + t, t_begin + times.back());
    VectorXd y = start;
    y << ring.alpha, ring.beta, start[2] + t * start[5], ring.alpha_rate, ring.beta_rate, start[5];
    result.push_back(y);
  }
  return result;
}

/// The model's equations with the numbers of this scene.
std::variant<FoepplGyro<>, UnsymmetricRotor<>> gyro_of(const SceneFile& scene) {
  const bool symmetric = scene.model == SceneModel::foeppl;
  const Refusal refuse(symmetric);
  check_joints(scene, refuse);
  // All on guide axes, at zero angles.
  Matrix3d axes;
  std::array<Matrix3d, 3> turned;
  Matrix3d parent = Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    const Joint& joint = scene.bodies[std::size_t(i)].joint;
    axes.col(i) = parent * joint.axis.normalized();
    parent *= joint.orientation.normalized().toRotationMatrix();
    turned[std::size_t(i)] = parent;
  }
  // The equations count the spin about outer x inner axis.
  const Vector3d across = axes.col(0).cross(axes.col(1));
  const double sign = across.dot(axes.col(2)) < 0 ? -1 : 1;
  if ((across - sign * axes.col(2)).norm() > slack) refuse("these axes are not at right angles");
  axes.col(2) = across;
  const auto moments = [&](std::size_t i) {
    return principal(scene.bodies[i], turned[i].transpose() * axes, refuse);
  };
  CardanMoments all{moments(2), moments(1), moments(0)};
  const CardanBearings bearings{bearing(scene.bodies[0]), bearing(scene.bodies[1])};
  const double speed = sign * scene.start[2].rates.front();
  if (!symmetric) return UnsymmetricRotor<>(all, bearings, speed);
  Vector3d& rotor = all.rotor;
  if (std::abs(rotor.x() - rotor.y()) > slack * rotor.sum()) {
    refuse(scene.bodies[2], "is not symmetric about its axis; 'fuchs-weigand' takes it");
  }
  rotor.x() = rotor.y() = (rotor.x() + rotor.y()) / 2;
  return FoepplGyro<>(all, bearings, speed);
}

}  // namespace

GimbalMotion::GimbalMotion(const SceneFile& scene) : gyro_(gyro_of(scene)) {}

std::vector<VectorXd> GimbalMotion::states(const VectorXd& start,
                                           const std::vector<double>& times) const {
  // The coefficients of the unsymmetric rotor belong to one that starts at the angle 0.
  const bool periodic = std::holds_alternative<UnsymmetricRotor<>>(gyro_);
  const double begin = periodic ? start[2] / start[5] : 0;
  return std::visit([&](const auto& gyro) { return ring_oscillation(gyro, begin, start, times); },
                    gyro_);
}

}  // namespace kreisel
