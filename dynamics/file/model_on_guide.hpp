#pragma once

#include <optional>
#include <utility>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

namespace kreisel {

/// A system as solve() sees it: it hands on every state of which it is asked what is conserved, and
/// stops a run between two outputs.
template <class System>
class WatchedSystem {
  static constexpr bool has_series = requires(const System& system) { system.series(); };

 public:
  using State = typename System::State;
  using Vector = typename System::Vector;

  WatchedSystem(const System& system, const std::function<bool()>& interrupted)
      : system_(system), interrupted_(interrupted) {}

  [[nodiscard]] auto workspace() const { return system_.workspace(); }
  [[nodiscard]] auto blocks() const { return system_.blocks(); }
  [[nodiscard]] static Vector to_vector(const State& state) { return System::to_vector(state); }
  [[nodiscard]] State from_vector(const Vector& y) const { return system_.from_vector(y); }

  void rates(double t, const Vector& y, Vector& result, BodyWorkspace& w) const {
    stop_if_interrupted();
    system_.rates(t, y, result, w);
  }

  [[nodiscard]] bool knows_series() const requires has_series { return system_.knows_series(); }
  [[nodiscard]] auto series() const requires has_series {
    return [this, series = system_.series()](double t, double h, int order,
                                             Eigen::Ref<Eigen::MatrixXd> c) mutable {
      stop_if_interrupted();
      series(t, h, order, c);
    };
  }
  [[nodiscard]] bool may_be_stiff() const { return system_.may_be_stiff(); }

  [[nodiscard]] auto conserved(double t, const State& state) const {
    latest_ = {state.coordinates, state.rates};
    return system_.conserved(t, state);
  }

  [[nodiscard]] const JointState& latest() const { return latest_; }

  [[nodiscard]] const System& system() const { return system_; }

 private:
  void stop_if_interrupted() const {
    if (interrupted_()) throw ComputationFailed("interrupted");
  }

  const System& system_;
  const std::function<bool()>& interrupted_;
  mutable JointState latest_;
};

/// That of the system, where it may have one.
template <class System>
[[nodiscard]] auto closed_form(const WatchedSystem<System>& watched, double begin,
                               const typename System::State& start)
    -> decltype(closed_form(watched.system(), begin, start)) {
  return closed_form(watched.system(), begin, start);
}

template <class M>
class ModelOnGuide final : public SceneSolver {
  using System = BodySystem<M>;
  using State = typename System::State;

 public:
  ModelOnGuide(M guide, SceneBodies scene)
      : system_(std::move(guide), std::move(scene.bodies), scene.gravity),
        gravitation_(std::move(scene.gravitation)),
        workspace_(system_.workspace()) {}

  [[nodiscard]] Trajectory<JointState> solve(
      const SolveOptions& options, const JointState& start, const Listener& listener,
      const std::function<bool()>& interrupted) const override {
    const WatchedSystem<System> watched(system_, interrupted);
    SolveOptions watched_options = options;
    watched_options.progress = [&](double t) { return listener(t, watched.latest()); };
    auto run = kreisel::solve(watched, State{start.coordinates, start.rates}, watched_options);
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
