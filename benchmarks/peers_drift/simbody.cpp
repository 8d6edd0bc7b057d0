// Simbody, by the integrator of its examples at its default accuracy, and at a finer one.

#include <Simbody.h>

#include "engine.hpp"

namespace peers {

namespace {

Engine engine(double accuracy, const std::string& what) {
  const auto run = [accuracy](const Top& top, double end, int count) {
    const auto vector = [](const Triple& v) { return SimTK::Vec3(v[0], v[1], v[2]); };
    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter(system);
    const SimTK::Body::Rigid rigid(
        SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(vector(top.moments))));
    const SimTK::MobilizedBody::Free body(matter.Ground(), rigid);
    SimTK::State state = system.realizeTopology();
    body.setUToFitAngularVelocity(state, vector(top.rate));
    SimTK::RungeKuttaMersonIntegrator integrator(system);
    if (accuracy > 0) integrator.setAccuracy(accuracy);
    SimTK::TimeStepper stepper(system, integrator);
    stepper.initialize(state);
    std::vector<Turning> motion;
    for (int i = 1; i <= count; ++i) {
      stepper.stepTo(end * i / count);
      const SimTK::State& now = integrator.getState();
      system.realize(now, SimTK::Stage::Velocity);
      const SimTK::Quaternion q = body.getBodyRotation(now).convertRotationToQuaternion();
      const SimTK::Vec3 w = body.getBodyAngularVelocity(now);
      motion.push_back({{q[0], q[1], q[2], q[3]}, {w[0], w[1], w[2]}});
    }
    return motion;
  };
  int major = 0;
  int minor = 0;
  int patch = 0;
  SimTK_version_simbody(&major, &minor, &patch);
  return {"Simbody",
          std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(patch),
          "RungeKuttaMerson, " + what, run};
}

}  // namespace

std::vector<Engine> simbody() {
  return {engine(0, "default accuracy"), engine(1e-9, "accuracy 1e-9")};
}

}  // namespace peers
