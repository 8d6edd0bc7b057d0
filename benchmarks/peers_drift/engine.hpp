#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

/// The common interface of all engines. It contains no type of any engine and none of ours, so that
/// their headers never meet.
namespace peers {

using Triple = std::array<double, 3>;

/// A body of 1 kg that turns about its centre of mass at rest, without force and torque. Its axes
/// are the inertial ones at the start.
struct Top {
  Triple moments;  ///< of inertia, along the body's axes
  Triple rate;     ///< at the start
};

struct Turning {
  std::array<double, 4> attitude;  ///< w, x, y, z: takes components on body axes to inertial ones
  Triple rate;                     ///< on inertial axes
};

struct Engine {
  std::string name;
  std::string version;
  std::string how;  ///< its integrator and step, with default settings

  /// The motion at `count` times, the last of which is `end`; whole numbers of steps apart.
  std::function<std::vector<Turning>(const Top&, double end, int count)> run;
};

[[gnu::visibility("default")]] std::vector<Engine> bullet();
[[gnu::visibility("default")]] std::vector<Engine> dart();
[[gnu::visibility("default")]] std::vector<Engine> mujoco();
[[gnu::visibility("default")]] std::vector<Engine> ode();
[[gnu::visibility("default")]] std::vector<Engine> simbody();

/// An engine with equal steps: step() makes one, now() returns the motion.
template <class Step, class Now>
std::vector<Turning> equal_steps(double end, int count, double length, const Step& step,
                                 const Now& now) {
  const long between = static_cast<long>(end / count / length + 0.5);
  std::vector<Turning> motion;
  for (int i = 0; i < count; ++i) {
    for (long k = 0; k < between; ++k) step();
    motion.push_back(now());
  }
  return motion;
}

}  // namespace peers
