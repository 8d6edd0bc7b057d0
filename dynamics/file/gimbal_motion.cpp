#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <string>
#include <variant>

#include <dynamics/file/gimbal_motion.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/cardan_chain.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::Matrix3d, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// Rounding that adding, rotating and normalizing a few numbers may leave.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

class Refusal {
 public:
  explicit Refusal(bool symmetric) : model_(symmetric ? "foeppl" : "fuchs-weigand") {}

  [[noreturn]] void operator()(const std::string& why) const {
    throw InvalidInput("model '" + model_ + "' is of a gyro in two rings; " + why);
  }
  [[noreturn]] void operator()(const BodyDescription& body, const std::string& why) const {
    (*this)("body '" + body.name + "' " + why);
  }

 private:
  std::string model_;
};

/// True if the speed of a rotor is prescribed.
bool is_regulated(const BodyDescription& body) {
  return body.rule == JointRule::driven || (body.rotor && body.rotor->mode == RotorMode::regulated);
}

/// Checks that springs and friction alone act in the joints of the rings.
void check_forces(const SceneFile& scene, const Refusal& refuse) {
  if (!scene.elements.empty()) refuse("here are elements between bodies");
  for (std::size_t i = 0; i < 3; ++i) {
    const BodyDescription& body = scene.bodies[i];
    const bool rotor = i == 2;
    if (body.rule == JointRule::held) refuse(body, "is locked");
    if (!rotor && body.rule != JointRule::forces) refuse(body, "has a drive");
    if (!rotor && body.rotor) refuse(body, "is a rotor that carries another");
    if (!body.loads.empty()) refuse(body, "has a load");
    const bool regulated = is_regulated(body);
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

/// True for a rotor whose centre of mass lies on its axis, which is a principal axis.
bool is_balanced(Inertia<> rotor) {
  rotor.first_moment.z() = 0;
  rotor.tensor.xy = 0;
  return is_principal(rotor) && is_centred(rotor);
}

Vector3d moments(const Inertia<>& body) { return {body.tensor.xx, body.tensor.yy, body.tensor.zz}; }

/// The guide and its uniform gravity, on gimbal axes.
AnyGuide on_gimbal_axes(const AnyGuide& guide, const Matrix3d& axes) {
  return AnyGuide([guide, axes](double t) {
    FrameMotion<Guide, Inertial> now = guide(t);
    now.X.value.rotation *= axes;
    for (Motor<>* motor : {&now.V.value, &now.dV.value}) {
      motor->resultant = axes.transpose() * motor->resultant;
      motor->moment = axes.transpose() * motor->moment;
    }
    return now;
  });
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

/// The scene's gyro with centres of mass anywhere, on its guide.
///
/// chain : its rotor is turned so that its angle is speed times time
GimbalMotion::Pendulous pendulous(const SceneFile& scene, CardanChain chain,
                                  const CardanBearings& bearings, double speed) {
  const SceneBodies bodies = bodies_in_gravity(scene);
  UniformGravity<Guide> on_guide;
  UniformGravity<Inertial> inertial;
  if (const auto* field = std::get_if<UniformGravity<Guide>>(&bodies.gravity)) {
    on_guide.g = chain.axes.transpose() * field->g;
  }
  if (const auto* field = std::get_if<UniformGravity<Inertial>>(&bodies.gravity)) inertial = *field;
  const double ahead = chain.sign * scene.start[2].coordinates.front() - speed * scene.t_begin;
  const Matrix3d turned(Eigen::AngleAxisd(ahead, Vector3d::UnitZ()));
  chain.rotor = {chain.rotor.mass, turned * chain.rotor.first_moment,
                 chain.rotor.tensor.rotated(turned)};
  return {{chain.rotor, chain.inner_ring, chain.outer_ring, chain.axes.transpose() * chain.point},
          bearings,
          speed,
          on_gimbal_axes(make_guide(scene), chain.axes),
          on_guide,
          inertial};
}

/// Refuses what PendulousOscillations do not contain.
void check_pendulous(const SceneFile& scene, const CardanChain& chain, bool symmetric,
                     const Refusal& refuse) {
  const BodyDescription& rotor = scene.bodies[2];
  if (bodies_in_gravity(scene).gravitation) refuse("this gravity is not uniform");
  if (symmetric && !is_balanced(chain.rotor)) {
    refuse(rotor, "is not balanced; 'fuchs-weigand' takes it");
  }
  if (is_regulated(rotor)) return;
  if (!scene.rests())
    refuse(rotor, "is free, and this guide changes its speed; regulate the speed");
  if (!is_balanced(chain.rotor)) {
    refuse(rotor, "is free, and unbalance changes its speed; regulate the speed");
  }
}

/// The model's equations with the numbers of this scene.
GimbalMotion::Gyro gyro_of(const SceneFile& scene) {
  const bool symmetric = scene.model == SceneModel::foeppl;
  const Refusal refuse(symmetric);
  const auto found = cardan_chain(scene.bodies);
  if (const auto* reason = std::get_if<std::string>(&found)) refuse(*reason);
  CardanChain chain = std::get<CardanChain>(found);
  check_forces(scene, refuse);
  const CardanBearings bearings{bearing(scene.bodies[0]), bearing(scene.bodies[1])};
  const double speed = chain.sign * scene.start[2].rates.front();
  Symmetric3<>& rotor = chain.rotor.tensor;
  if (symmetric) {
    if (std::abs(rotor.xx - rotor.yy) > rounding * (rotor.xx + rotor.yy + rotor.zz)) {
      refuse(scene.bodies[2], "is not symmetric about its axis; 'fuchs-weigand' takes it");
    }
    rotor.xx = rotor.yy = (rotor.xx + rotor.yy) / 2;
  }
  const auto is_plain = [](const Inertia<>& body) {
    return is_principal(body) && is_centred(body);
  };
  if (!scene.rests() || !is_plain(chain.outer_ring) || !is_plain(chain.inner_ring) ||
      !is_plain(chain.rotor)) {
    check_pendulous(scene, chain, symmetric, refuse);
    return pendulous(scene, chain, bearings, speed);
  }
  const CardanMoments all{moments(chain.rotor), moments(chain.inner_ring),
                          moments(chain.outer_ring)};
  if (symmetric) return FoepplGyro<>(all, bearings, speed);
  return UnsymmetricRotor<>(all, bearings, speed);
}

}  // namespace

GimbalMotion::GimbalMotion(const SceneFile& scene) : gyro_(gyro_of(scene)), begin_(scene.t_begin) {}

std::vector<VectorXd> GimbalMotion::states(const VectorXd& start,
                                           const std::vector<double>& times) const {
  // The coefficients of the unsymmetric rotor belong to one that starts at the angle 0.
  const double begin = std::holds_alternative<UnsymmetricRotor<>>(gyro_) ? start[2] / start[5]
                       : std::holds_alternative<Pendulous>(gyro_)        ? begin_
                                                                         : 0;
  return std::visit([&](const auto& gyro) { return ring_oscillation(gyro, begin, start, times); },
                    gyro_);
}

}  // namespace kreisel
