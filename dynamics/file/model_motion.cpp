#include <algorithm>
#include <memory>
#include <utility>

#include <dynamics/file/gimbal_motion.hpp>
#include <dynamics/file/model_motion.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/interpolated_motion.hpp>
#include <dynamics/study/nominal_motion.hpp>
#include <dynamics/study/small_motion.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::VectorXd;

namespace {

using Times = std::vector<double>;

/// The accuracy of the integration, for a tolerance of the run.
double integration_accuracy(double tolerance) { return std::clamp(tolerance / 100, 1e-13, 1e-6); }

ModelMotion motion_of(const SmallMotion& small, const VectorXd& start, const Times& times,
                      double accuracy) {
  const SmallSolution solution = small.run(start, times, accuracy);
  return {.states = solution.states(),
          .begin = start,
          .samples = solution.sampler(),
          .stops = solution.stops(),
          .integration_error = solution.error().maxCoeff()};
}

SceneApproximation linear(const SceneFile& scene, const StudySystem& system) {
  const VectorXd start = system.start_of(scene);
  const Steady steady = steady_motion::find_steady(system, scene, start);
  if (!steady.exists()) {
    throw InvalidInput("model 'linear': no steady motion to be linear about: " + steady.reason);
  }
  const auto about = steady_motion::linearized(system, system.begin(), steady.state);
  NominalMotion nominal(system.begin(), about.state, about.rate,
                        steady_motion::tangent_of(system, about.state));
  auto small = std::make_shared<const SmallMotion>(system, std::move(nominal), scene.t_end);
  return {"matrix exponential", [small, accuracy = integration_accuracy(scene.tolerance)](
                                    const VectorXd& from, const Times& times) {
            return motion_of(*small, from, times, accuracy);
          }};
}

SceneApproximation small(const SceneFile& scene, const StudySystem& system) {
  return {
      "exponential collocation",
      [&system, end = scene.t_end, breaks = scene.discontinuities,
       accuracy = integration_accuracy(scene.tolerance)](const VectorXd& from, const Times& times) {
        const SmallMotion motion(system, nominal_motion(system, system.begin(), from), end, breaks);
        return motion_of(motion, from, times, accuracy);
      }};
}

/// The motion of a model that gives states at times alone.
ModelMotion interpolated(const StudySystem& system, const InterpolatedMotion::States& states,
                         const Times& times) {
  ModelMotion result;
  result.states = states(times);
  result.begin = states({system.begin(), times.back()}).front();
  if (result.states.empty()) return result;
  const double end = times[result.states.size() - 1];
  if (!(end > system.begin())) return result;
  const InterpolatedMotion motion(steady_motion::tangent_of(system, result.begin), states,
                                  system.begin(), end);
  result.samples = motion.sampler();
  result.stops = motion.stops();
  return result;
}

SceneApproximation precession(const StudySystem& system) {
  const auto motion = [&system](const VectorXd& from, const Times& times) {
    const auto states = [&](const Times& at) {
      Times since = at;
      for (double& t : since) t -= system.begin();
      std::vector<VectorXd> all = system.technical(from, since);
      for (std::size_t i = 0; i < all.size(); ++i) {
        for (const auto& rotor : system.tree().rotors()) {
          const Eigen::Index rate = system.tree().coordinates() + rotor.link.v;
          all[i][rotor.link.q] = from[rotor.link.q] + since[i] * from[rate];
        }
      }
      return all;
    };
    ModelMotion result = interpolated(system, states, times);
    if (result.states.size() < times.size()) {
      result.message =
          "the motion is no longer slow against the nutations, which the precession equations "
          "leave out";
    }
    return result;
  };
  return {"technical equations, verner98", motion};
}

SceneApproximation gimbals(const SceneFile& scene, const StudySystem& system) {
  const auto gyro = std::make_shared<const GimbalMotion>(scene);
  const auto motion = [&system, gyro](const VectorXd& from, const Times& times) {
    const auto states = [&](const Times& at) {
      Times since = at;
      for (double& t : since) t -= system.begin();
      return gyro->states(from, since);
    };
    return interpolated(system, states, times);
  };
  return {GimbalMotion::method, motion};
}

}  // namespace

SceneApproximation approximation_of(const SceneFile& scene, const StudySystem& system) {
  switch (scene.model) {
    case SceneModel::linear: return linear(scene, system);
    case SceneModel::small: return small(scene, system);
    case SceneModel::precession: return precession(system);
    case SceneModel::foeppl:
    case SceneModel::fuchs_weigand: return gimbals(scene, system);
    case SceneModel::exact: break;
  }
  throw InvalidInput("model 'exact' is no approximation");
}

}  // namespace kreisel
