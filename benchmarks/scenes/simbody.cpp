// Simbody. O(n); a moving base is a mobilizer with a prescribed Motion.

#include <Simbody.h>
#include <algorithm>

#include "peer.hpp"

namespace scenes {

namespace {

SimTK::Vec3 vector(const Triple& v) { return {v[0], v[1], v[2]}; }

std::string version() {
  int major = 0;
  int minor = 0;
  int patch = 0;
  SimTK_version_simbody(&major, &minor, &patch);
  return std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(patch);
}

class Simbody final : public Peer {
 public:
  explicit Simbody(const Chain& chain)
      : n_(static_cast<int>(chain.links.size())),
        first_(chain.moves() ? 1 : 0),
        matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, vector(chain.gravity)) {
    SimTK::MobilizedBody parent = matter_.Ground();
    if (chain.moves()) {
      const BaseJoint base = base_joint(chain);
      parent = add(parent, base.link);
      SimTK::Motion::Steady(parent, base.rate);
    }
    for (const Link& link : chain.links) parent = add(parent, link);
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    if (chain.moves()) state_.updU()[0] = base_joint(chain).rate;
    dv_.resize(first_ + n_);
    dv_ = 0;
  }

  void forward(const double* q, const double* v, double* dv) override {
    take(q, v);
    system_.realize(state_, SimTK::Stage::Acceleration);
    const SimTK::Vector& result = state_.getUDot();
    for (int i = 0; i < n_; ++i) dv[i] = result[first_ + i];
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) override {
    take(q, v);
    for (int i = 0; i < n_; ++i) dv_[first_ + i] = dv[i];
    system_.realize(state_, SimTK::Stage::Velocity);
    matter_.calcResidualForceIgnoringConstraints(state_, SimTK::Vector(),
                                                 gravity_.getBodyForces(state_), dv_, force_);
    for (int i = 0; i < n_; ++i) force[i] = force_[first_ + i];
  }

 private:
  static SimTK::MobilizedBody add(SimTK::MobilizedBody& parent, const Link& link) {
    const auto& [A, B, C] = link.moments;
    const SimTK::Rotation rotated(SimTK::UnitVec3(vector(link.axis)), SimTK::ZAxis);
    const SimTK::Inertia about_origin =
        SimTK::Inertia(A, B, C).shiftFromMassCenter(vector(link.centre), link.mass);
    const SimTK::Body::Rigid body(
        SimTK::MassProperties(link.mass, vector(link.centre), about_origin));
    return SimTK::MobilizedBody::Pin(parent, SimTK::Transform(turned, vector(link.position)), body,
                                     SimTK::Transform(turned));
  }

  void take(const double* q, const double* v) {
    SimTK::Vector& all_q = state_.updQ();
    SimTK::Vector& all_v = state_.updU();
    for (int i = 0; i < n_; ++i) all_q[first_ + i] = q[i];
    for (int i = 0; i < n_; ++i) all_v[first_ + i] = v[i];
  }

  int n_;
  int first_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::Gravity gravity_;
  SimTK::State state_;
  SimTK::Vector dv_, force_;
};

}  // namespace

Library simbody() {
  return {
      "Simbody",
      version(),
      "realize(Acceleration)",
      "calcResidualForceIgnoringConstraints",
      "Motion::Steady",
      [](const Chain& chain) -> std::unique_ptr<Peer> { return std::make_unique<Simbody>(chain); }};
}

}  // namespace scenes
