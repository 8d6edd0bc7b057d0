#include "analysis.hpp"

#include <cmath>

#include "joints.hpp"
#include "modes.hpp"

namespace kreisel {

using namespace scene_analysis;
using nlohmann::ordered_json;

namespace {

JointState joints_of(const AnalysisResult& result, const Eigen::VectorXd& state) {
  return result.system.joints_of(state);
}

ordered_json joints_json(const AnalysisResult& result, const Eigen::VectorXd& state,
                         const JointReactions& reactions, const SceneScale& scale) {
  const JointState joints = joints_of(result, state);
  const BodyTree& tree = result.system.tree();
  ordered_json table = ordered_json::object();
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    table[tree.body(i).name] = joint_json(tree, i, joints, reactions, scale);
  }
  return table;
}

ordered_json reactions_json(const AnalysisResult& result, const JointReactions& reactions,
                            const SceneScale& scale) {
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < reactions.on_body.size(); ++i) {
    table[result.system.tree().bodies()[i].name] = json_of(reactions.on_body[i].value, scale);
  }
  return table;
}

ordered_json precession_json(const PrecessionCheck& check) {
  if (!check.beyond.empty()) return {{"reason", check.beyond}};
  ordered_json result{{"velocities", check.velocities}};
  if (check.not_tested.empty()) {
    ordered_json slow = ordered_json::array();
    for (const auto& root : check.test.slow) {
      slow.push_back({{"technical", {root.technical.real(), root.technical.imag()}},
                      {"exact", {root.exact.real(), root.exact.imag()}}});
    }
    result["admissible"] = check.test.admissible;
    if (!check.test.admissible) result["why_not"] = check.test.reason;
    result["rank"] = check.rank;
    result["greatest_shift"] = json_of(check.test.greatest_shift);
    result["slow_roots"] = slow;
  } else {
    result["not_tested"] = check.not_tested;
  }
  if (!check.no_motion.empty()) {
    result["no_bound"] = check.no_motion;
    return result;
  }
  const auto& [end, bound, nutation, valid_until, slow] = check.motion;
  result["kept_accelerations"] = check.kept;
  result["bound"] = {{"t", end},
                     {"error", json_of(bound)},
                     {"nutation", json_of(nutation)},
                     {"below_0.01_until", valid_until},
                     {"slow", slow}};
  return result;
}

}  // namespace

SceneScale scale_of(const AnalysisResult& result, const Eigen::VectorXd& state) {
  SceneScale scale =
      kreisel::scale_of(result.scene, result.system.tree(), {joints_of(result, state)});
  scale.hold(result.system.reactions(result.system.begin(), state));
  return scale;
}

ordered_json json_of(const Steady& steady, const AnalysisResult& result, const SceneScale& scale) {
  if (!steady.exists()) return {{"found", "none"}, {"reason", steady.reason}};
  const JointReactions reactions = result.system.reactions(result.system.begin(), steady.state);
  return {{"found", steady.kind == Steady::Kind::start ? "start" : "from the start"},
          {"motion", steady.turns ? "steady motion" : "equilibrium"},
          {"distance", steady.distance},
          {"residual", steady.residual},
          {"joints", joints_json(result, steady.state, reactions, scale)},
          {"reactions", reactions_json(result, reactions, scale)}};
}

ordered_json json_of(const Rest& rest, const AnalysisResult& result, const SceneScale& scale) {
  const Eigen::VectorXd& state = rest.equilibrium.state;
  return {{"stability", name(rest.stability)},
          {"distance", rest.distance},
          {"residual", rest.equilibrium.residual},
          {"neutral", rest.equilibrium.neutral},
          {"joints", joints_json(result, state,
                                 result.system.reactions(result.system.begin(), state), scale)},
          {"frame", rest.linear.frame},
          {"roots", roots_json(rest.linear)}};
}

ordered_json json_of(const FloquetMotion& floquet, const AnalysisResult& result,
                     const SceneScale& scale) {
  if (!floquet.reason.empty()) return {{"period", floquet.period}, {"reason", floquet.reason}};
  ordered_json multipliers = ordered_json::array();
  for (const Mode& m : floquet.multipliers) {
    multipliers.push_back({{"real", m.root.real()},
                           {"imag", m.root.imag()},
                           {"size", std::abs(m.root)},
                           {"error", m.error}});
  }
  ordered_json modes = ordered_json::array();
  for (const WhirlingMode& mode : result.analysis.floquet_modes)
    modes.push_back(json_of(mode, false));
  const auto reactions = result.system.reactions(result.system.begin(), floquet.start);
  return {{"period", floquet.period},
          {"verdict", name(floquet.verdict)},
          {"multipliers", multipliers},
          {"modes", modes},
          {"residual", floquet.residual},
          {"start", joints_json(result, floquet.start, reactions, scale)}};
}

ordered_json to_json(const AnalysisResult& result) {
  const Analysis& a = result.analysis;
  ordered_json equilibria = ordered_json::array();
  for (const Rest& rest : a.equilibria) equilibria.push_back(json_of(rest, result));
  ordered_json all{{"title", result.scene.title},
                   {"equilibria", equilibria},
                   {"equilibrium_starts", a.starts},
                   {"steady", json_of(a.steady, result)}};
  if (a.linear) all["linear"] = json_of(*a.linear);
  if (a.campbell) all["campbell"] = json_of(*a.campbell);
  if (a.floquet) all["floquet"] = json_of(*a.floquet, result);
  if (a.response) all["response"] = json_of(*a.response);
  all["precession"] = precession_json(a.precession);
  all["notes"] = a.notes;
  return all;
}

}  // namespace kreisel
