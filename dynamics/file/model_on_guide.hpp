#pragma once

#include <optional>
#include <utility>

#include <dynamics/control/controlled_system.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel {

/// The bodies of a scene on a guide.
template <class M>
[[nodiscard]] BodySystem<M> bodies_on_guide(M guide, const SceneBodies& scene) {
  return {std::move(guide), scene.bodies, scene.gravity, scene.elements, scene.constraints};
}

/// System : BodySystem or ControlledSystem
template <class System>
class ModelOnGuide final : public SceneSolver {
  using State = typename System::State;
  static constexpr bool is_controlled = HasSamples<System>;

 public:
  /// gravitation : as SceneBodies has it
  ModelOnGuide(System system, std::optional<BodyLoad> gravitation)
      : system_(std::move(system)),
        gravitation_(std::move(gravitation)),
        workspace_(system_.workspace()) {}

  [[nodiscard]] Trajectory<JointState> solve(const SolveOptions& options, const JointState& start,
                                             const OnOutput& on_output) const override {
    auto run = kreisel::solve(system_, begin_of(start), options, [&](double t, const State& state) {
      if (!on_output) return OutputAction::proceed;
      return on_output(t, joint_state(state));
    });
    Trajectory<JointState> result{
        std::move(run.times), {}, std::move(run.report), std::move(run.errors)};
    for (const State& state : run.states) result.states.push_back(joint_state(state));
    return result;
  }

  [[nodiscard]] const BodyTree& tree() const override { return system_.tree(); }

  [[nodiscard]] JointReactions reactions(double t, const JointState& state) const override {
    JointReactions result;
    system_.reactions(t, vector(state), result, workspace_);
    return result;
  }

  [[nodiscard]] std::vector<Motor<>> element_forces(double t,
                                                    const JointState& state) const override {
    std::vector<Motor<>> result;
    system_.element_forces(t, vector(state), result, workspace_);
    return result;
  }

  [[nodiscard]] std::vector<Motor<>> constraint_forces(double t,
                                                       const JointState& state) const override {
    std::vector<Motor<>> result;
    for (const auto& reaction : system_.constraint_reactions(t, vector(state), workspace_)) {
      result.push_back(reaction.on_second);
    }
    return result;
  }

  [[nodiscard]] ForceParts<Body> terms(double t, const JointState& state, int body) const override {
    return system_.terms(t, vector(state), body, workspace_);
  }

  [[nodiscard]] Terms equation_terms() const override { return kreisel::terms(system_); }

  [[nodiscard]] std::vector<std::pair<std::string, double>> conserved(
      double t, const JointState& state) const override {
    if constexpr (is_controlled) {
      return {};
    } else {
      return system_.conserved(t, {state.coordinates, state.rates});
    }
  }

  [[nodiscard]] SystemKinematics kinematics(double t, const JointState& state) const override {
    if constexpr (is_controlled) {
      return system_.kinematics(t, vector(state), workspace_);
    } else {
      return kreisel::kinematics(system_, t, vector(state), workspace_,
                                 gravitation_ ? &*gravitation_ : nullptr);
    }
  }

  [[nodiscard]] SystemKinematics kinematics_after_samples(double t,
                                                          const JointState& state) const override {
    if constexpr (is_controlled) {
      return system_.kinematics_after_samples(t, vector(state), workspace_);
    } else {
      return kinematics(t, state);
    }
  }

  [[nodiscard]] int memory() const override {
    if constexpr (is_controlled) {
      return system_.memory();
    } else {
      return 0;
    }
  }

  [[nodiscard]] std::vector<double> sample_times(double begin, double end) const override {
    if constexpr (is_controlled) {
      return system_.sample_times(begin, end);
    } else {
      return {};
    }
  }

  [[nodiscard]] JointState sampled(double t, const JointState& state) const override {
    if constexpr (is_controlled) {
      Eigen::VectorXd y = vector(state);
      system_.sample(t, y);
      return joint_state(system_.from_vector(y));
    } else {
      return state;
    }
  }

  [[nodiscard]] Pose<double> pose(double t, const JointState& state, int body) const override {
    return system_.situation(t, vector(state), body, workspace_).X.value;
  }

 private:
  [[nodiscard]] State begin_of(const JointState& start) const {
    if constexpr (is_controlled) {
      return {start.coordinates, start.rates, start.memory};
    } else {
      return {start.coordinates, start.rates};
    }
  }

  [[nodiscard]] static JointState joint_state(const State& state) {
    if constexpr (is_controlled) {
      return {state.coordinates, state.rates, state.memory};
    } else {
      return {state.coordinates, state.rates};
    }
  }

  [[nodiscard]] Eigen::VectorXd vector(const JointState& state) const {
    return System::to_vector(begin_of(state));
  }

  System system_;
  std::optional<BodyLoad> gravitation_;
  mutable decltype(std::declval<const System&>().workspace()) workspace_;
};

}  // namespace kreisel
