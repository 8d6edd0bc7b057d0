// Bullet, in the single precision of Debian's package. Steps of 1/240 s, the default of its Python
// module; the gyroscopic torque is implicit on body axes, the default of the library.

#include <btBulletDynamicsCommon.h>

#include "engine.hpp"

namespace peers {

namespace {

std::vector<Turning> run(const Top& top, double end, int count) {
  constexpr double length = 1.0 / 240;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, 0));
  btSphereShape shape(btScalar(0.1));
  const auto vector = [](const Triple& v) {
    return btVector3(btScalar(v[0]), btScalar(v[1]), btScalar(v[2]));
  };
  btRigidBody body(
      btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &shape, vector(top.moments)));
  body.setAngularVelocity(vector(top.rate));
  body.setActivationState(DISABLE_DEACTIVATION);
  world.addRigidBody(&body);
  auto motion = equal_steps(
      end, count, length, [&] { world.stepSimulation(btScalar(length), 0, btScalar(length)); },
      [&] {
        const btQuaternion q = body.getOrientation();
        const btVector3& w = body.getAngularVelocity();
        return Turning{{q.w(), q.x(), q.y(), q.z()}, {w.x(), w.y(), w.z()}};
      });
  world.removeRigidBody(&body);
  return motion;
}

}  // namespace

std::vector<Engine> bullet() {
  constexpr int version = BT_BULLET_VERSION;
  return {{"Bullet", std::to_string(version / 100) + '.' + std::to_string(version % 100),
           "default, 1/240 s, single precision", run}};
}

}  // namespace peers
