#include <dynamics/study/frame_terms.hpp>

namespace kreisel {

using Eigen::VectorXd;

namespace {

bool is_rotor(const BodyDescription& body) {
  const bool driven = body.rule == JointRule::driven && !body.acceleration;
  return body.rotor.has_value() || (driven && body.joint.kind == JointKind::revolute);
}

/// The bodies without everything but their inertia and their joints.
std::vector<BodyDescription> bare(std::vector<BodyDescription> bodies) {
  for (BodyDescription& body : bodies) {
    body.forces.clear();
    body.loads.clear();
    body.rotor.reset();
    body.acceleration = {};
    if (body.rule == JointRule::driven) body.rule = JointRule::forces;
  }
  return bodies;
}

}  // namespace

FrameTermsOf::FrameTermsOf(const std::vector<BodyDescription>& bodies)
    : bodies_(bare(bodies)),
      system_(Turning{}, bodies_),
      of_frames_(VectorXd::Ones(tree().rates())) {
  for (const auto& link : tree().links()) {
    if (!link.has_one_rate() || !is_rotor(bodies[std::size_t(link.body)])) continue;
    of_frames_[link.v] = 0;
    has_rotors_ = true;
  }
}

VectorXd FrameTermsOf::forces(const FrameTurning<double>& guide, const VectorXd& coordinates,
                              const VectorXd& rates, const VectorXd& accelerations) const {
  const BodySystem<Turning> system(Turning{guide}, bodies_);
  BodyWorkspace w = system.workspace();
  VectorXd y(coordinates.size() + rates.size());
  y << coordinates, rates;
  VectorXd result;
  system.joint_forces(0, y, accelerations, result, w);
  return result;
}

FrameTerms FrameTermsOf::operator()(const FrameTurning<double>& guide, const VectorXd& coordinates,
                                    const VectorXd& rates, const VectorXd& accelerations) const {
  const VectorXd none = VectorXd::Zero(rates.size());
  const VectorXd normal = system_.rest().coordinates;
  const VectorXd frames = rates.cwiseProduct(of_frames_);
  const VectorXd spins = rates - frames;
  const FrameTurning<double> rests;
  const FrameTurning<double> turns{guide.u, Vector3<double>::Zero()};
  const FrameTurning<double> gathers{Vector3<double>::Zero(), guide.du};
  // The forces are quadratic in all velocities: what two of them do together, less what each does.
  const auto guide_and_spin = [&](const VectorXd& q) -> VectorXd {
    return forces(turns, q, spins, none) - forces(turns, q, none, none) -
           forces(rests, q, spins, none);
  };
  FrameTerms terms;
  terms.inertia = forces(rests, normal, none, accelerations.cwiseProduct(of_frames_));
  terms.gyroscopic = forces(rests, normal, rates, none) - forces(rests, normal, frames, none) -
                     forces(rests, normal, spins, none);
  terms.guide_gyroscopic = guide_and_spin(normal);
  terms.restraint = guide_and_spin(coordinates) - terms.guide_gyroscopic;
  terms.guide_inertia = forces(gathers, normal, none, none);
  terms.guide_change = forces(gathers, coordinates, none, none) - terms.guide_inertia;
  terms.left_out = forces(guide, coordinates, rates, accelerations) - terms.inertia -
                   terms.gyroscopic - terms.guide_gyroscopic - terms.restraint -
                   terms.guide_inertia - terms.guide_change;
  return terms;
}

}  // namespace kreisel
