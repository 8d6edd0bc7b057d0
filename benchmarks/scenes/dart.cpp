// DART. O(n); a moving base is a joint whose actuator prescribes the acceleration.

#include <Eigen/Geometry>

#include <algorithm>
#include <dart/config.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

#include "peer.hpp"

namespace scenes {

namespace {

Eigen::Vector3d vector(const Triple& v) { return {v[0], v[1], v[2]}; }

class Dart final : public Peer {
 public:
  explicit Dart(const Chain& chain)
      : n_(static_cast<Eigen::Index>(chain.links.size())),
        skeleton_(dart::dynamics::Skeleton::create("chain")) {
    dart::dynamics::BodyNode* parent = nullptr;
    if (chain.moves()) parent = add(parent, base_joint(chain).link);
    for (const Link& link : chain.links) parent = add(parent, link);
    skeleton_->setGravity(vector(chain.gravity));
    const auto all = static_cast<Eigen::Index>(skeleton_->getNumDofs());
    q_ = v_ = dv_ = Eigen::VectorXd::Zero(all);
    if (chain.moves()) {
      skeleton_->getJoint(0)->setActuatorType(dart::dynamics::Joint::ACCELERATION);
      skeleton_->getJoint(0)->setCommand(0, 0);
      v_[0] = base_joint(chain).rate;
    }
  }

  void forward(const double* q, const double* v, double* dv) override {
    take(q, v);
    skeleton_->computeForwardDynamics();
    Eigen::Map<Eigen::VectorXd>(dv, n_) = skeleton_->getAccelerations().tail(n_);
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) override {
    take(q, v);
    std::copy_n(dv, n_, dv_.data() + (dv_.size() - n_));
    skeleton_->setAccelerations(dv_);
    skeleton_->computeInverseDynamics();
    Eigen::Map<Eigen::VectorXd>(force, n_) = skeleton_->getForces().tail(n_);
  }

 private:
  dart::dynamics::BodyNode* add(dart::dynamics::BodyNode* parent, const Link& link) {
    const std::string number = std::to_string(skeleton_->getNumBodyNodes());
    dart::dynamics::RevoluteJoint::Properties joint;
    joint.mName = number;
    joint.mAxis = vector(link.axis);
    joint.mT_ParentBodyToJoint.translation() = vector(link.position);
    dart::dynamics::BodyNode::Properties body;
    body.mName = number;
    body.mInertia = dart::dynamics::Inertia(link.mass, vector(link.centre),
                                            vector(link.moments).asDiagonal().toDenseMatrix());
    return skeleton_->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(parent, joint, body)
        .second;
  }

  void take(const double* q, const double* v) {
    std::copy_n(q, n_, q_.data() + (q_.size() - n_));
    std::copy_n(v, n_, v_.data() + (v_.size() - n_));
    skeleton_->setPositions(q_);
    skeleton_->setVelocities(v_);
  }

  Eigen::Index n_;
  dart::dynamics::SkeletonPtr skeleton_;
  Eigen::VectorXd q_, v_, dv_;
};

}  // namespace

Library dart() {
  return {
      "DART",
      DART_VERSION,
      "computeForwardDynamics",
      "computeInverseDynamics",
      "Joint::ACCELERATION",
      [](const Chain& chain) -> std::unique_ptr<Peer> { return std::make_unique<Dart>(chain); }};
}

}  // namespace scenes
