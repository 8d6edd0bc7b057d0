// ODE. It recommends no step; 1/100 s is the most frequent one in its own demonstrations.

#include <memory>
#include <ode/ode.h>

#include "engine.hpp"

namespace peers {

namespace {

std::vector<Turning> run(const Top& top, double end, int count) {
  constexpr double length = 0.01;
  dInitODE2(0);
  const std::unique_ptr<dxWorld, void (*)(dxWorld*)> world(dWorldCreate(), &dWorldDestroy);
  const dBodyID body = dBodyCreate(world.get());
  dMass mass;
  const auto& [A, B, C] = top.moments;
  dMassSetParameters(&mass, 1, 0, 0, 0, A, B, C, 0, 0, 0);
  dBodySetMass(body, &mass);
  dBodySetAngularVel(body, top.rate[0], top.rate[1], top.rate[2]);
  return equal_steps(
      end, count, length, [&] { dWorldStep(world.get(), length); },
      [&] {
        const dReal* q = dBodyGetQuaternion(body);
        const dReal* w = dBodyGetAngularVel(body);
        return Turning{{q[0], q[1], q[2], q[3]}, {w[0], w[1], w[2]}};
      });
}

}  // namespace

std::vector<Engine> ode() { return {{"ODE", dODE_VERSION, "dWorldStep, 1/100 s", run}}; }

}  // namespace peers
