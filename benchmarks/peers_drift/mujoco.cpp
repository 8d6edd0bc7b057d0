// MuJoCo, by its default steps and by Runge-Kutta steps.

#include <algorithm>
#include <array>
#include <memory>
#include <mujoco/mujoco.h>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../scenes/mujoco_model.hpp"
#include "engine.hpp"

namespace peers {

namespace {

Engine engine(const std::string& integrator, const std::string& name) {
  const auto run = [integrator](const Top& top, double end, int count) {
    const auto& [A, B, C] = top.moments;
    std::ostringstream xml;
    xml.precision(17);
    xml << "<mujoco><option gravity=\"0 0 0\" integrator=\"" << integrator
        << "\"/><worldbody><body><freejoint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"" << A
        << ' ' << B << ' ' << C << "\"/></body></worldbody></mujoco>";
    const std::unique_ptr<mjModel, void (*)(mjModel*)> model(scenes::load(xml.str()),
                                                             mj_deleteModel);
    const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
    // A free joint has three numbers of the position first, then the rate on body axes.
    std::copy(top.rate.begin(), top.rate.end(), data->qvel + 3);
    return equal_steps(
        end, count, model->opt.timestep, [&] { mj_step(model.get(), data.get()); },
        [&] {
          const mjtNum* q = data->qpos + 3;
          std::array<double, 3> w{};
          mju_rotVecQuat(w.data(), data->qvel + 3, q);
          return Turning{{q[0], q[1], q[2], q[3]}, w};
        });
  };
  return {"MuJoCo", mj_versionString(), name + ", 1/500 s", run};
}

}  // namespace

std::vector<Engine> mujoco() { return {engine("Euler", "Euler, default"), engine("RK4", "RK4")}; }

}  // namespace peers
