// DART.

#include <Eigen/Geometry>

#include <dart/config.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>

#include "engine.hpp"

namespace peers {

namespace {

std::vector<Turning> run(const Top& top, double end, int count) {
  const auto vector = [](const Triple& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const dart::dynamics::SkeletonPtr skeleton = dart::dynamics::Skeleton::create("top");
  dart::dynamics::BodyNode::Properties properties;
  properties.mInertia = dart::dynamics::Inertia(1, Eigen::Vector3d::Zero(),
                                                vector(top.moments).asDiagonal().toDenseMatrix());
  const auto [joint, body] = skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>(
      nullptr, dart::dynamics::FreeJoint::Properties(), properties);
  const dart::simulation::WorldPtr world = dart::simulation::World::create();
  world->setGravity(Eigen::Vector3d::Zero());
  world->addSkeleton(skeleton);
  joint->setAngularVelocity(vector(top.rate));
  const dart::dynamics::BodyNode* const turning = body;
  return equal_steps(
      end, count, world->getTimeStep(), [&] { world->step(); },
      [&] {
        const Eigen::Quaterniond q(turning->getWorldTransform().linear());
        const Eigen::Vector3d w = turning->getAngularVelocity();
        return Turning{{q.w(), q.x(), q.y(), q.z()}, {w.x(), w.y(), w.z()}};
      });
}

}  // namespace

std::vector<Engine> dart() { return {{"DART", DART_VERSION, "default, 1/1000 s", run}}; }

}  // namespace peers
