#pragma once

#include <optional>
#include <utility>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel {

template <class M>
class ModelOnGuide final : public SceneSolver {
  using System = BodySystem<M>;
  using State = typename System::State;

 public:
  ModelOnGuide(M guide, SceneBodies scene)
      : system_(std::move(guide), std::move(scene.bodies), scene.gravity, std::move(scene.elements),
                scene.constraints),
        gravitation_(std::move(scene.gravitation)),
        workspace_(system_.workspace()) {}

  [[nodiscard]] Trajectory<JointState> solve(const SolveOptions& options, const JointState& start,
                                             const OnOutput& on_output) const override {
    const State begin{start.coordinates, start.rates};
    auto run = kreisel::solve(system_, begin, options, [&](double t, const State& state) {
      if (!on_output) return OutputAction::proceed;
      return on_output(t, {state.coordinates, state.rates});
    });
    Trajectory<JointState> result{
        std::move(run.times), {}, std::move(run.report), std::move(run.errors)};
    for (State& state : run.states) {
      result.states.push_back({std::move(state.coordinates), std::move(state.rates)});
    }
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
    std::vector<std::pair<std::string, double>> result;
    for (const auto& [name, value] : system_.conserved(t, {state.coordinates, state.rates})) {
      result.emplace_back(name, value);
    }
    return result;
  }

  [[nodiscard]] SystemKinematics kinematics(double t, const JointState& state) const override {
    return kreisel::kinematics(system_, t, vector(state), workspace_,
                               gravitation_ ? &*gravitation_ : nullptr);
  }

  [[nodiscard]] Pose<double> pose(double t, const JointState& state, int body) const override {
    return system_.situation(t, vector(state), body, workspace_).X.value;
  }

 private:
  [[nodiscard]] static Eigen::VectorXd vector(const JointState& state) {
    return System::to_vector({state.coordinates, state.rates});
  }

  System system_;
  std::optional<BodyLoad> gravitation_;
  mutable BodyWorkspace workspace_;
};

}  // namespace kreisel
