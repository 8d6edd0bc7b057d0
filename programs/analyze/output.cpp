#include "output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include <dynamics/file/printable.hpp>

#include "../shared/joint_tables.hpp"
#include "modes_output.hpp"
#include "response_output.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;
using nlohmann::ordered_json;

namespace {

using ::json;
using ::print;
using joint_tables::json;

JointState joints_of(const Result& result, const Eigen::VectorXd& state) {
  return result.system.joints_of(state);
}

/// Sizes from a state and from the reactions in this state.
SceneScale scale_of(const Result& result, const Eigen::VectorXd& state) {
  SceneScale scale = ::scale_of(result.scene, result.system.tree(), {joints_of(result, state)});
  scale.hold(result.system.reactions(result.system.begin(), state));
  return scale;
}

ordered_json joints_json(const Result& result, const Eigen::VectorXd& state,
                         const JointReactions& reactions, const SceneScale& scale) {
  const JointState joints = joints_of(result, state);
  const BodyTree& tree = result.system.tree();
  ordered_json table = ordered_json::object();
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    table[tree.body(i).name] = joint_tables::joint(tree, i, joints, reactions, scale);
  }
  return table;
}

ordered_json reactions_json(const Result& result, const JointReactions& reactions,
                            const SceneScale& scale) {
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < reactions.on_body.size(); ++i) {
    table[result.system.tree().bodies()[i].name] = json(reactions.on_body[i].value, scale);
  }
  return table;
}

ordered_json json(const Steady& steady, const Result& result, const SceneScale& scale = {}) {
  if (!steady.exists()) return {{"found", "none"}, {"reason", steady.reason}};
  const JointReactions reactions = result.system.reactions(result.system.begin(), steady.state);
  return {{"found", steady.kind == Steady::Kind::start ? "start" : "from the start"},
          {"motion", steady.turns ? "steady motion" : "equilibrium"},
          {"distance", steady.distance},
          {"residual", steady.residual},
          {"joints", joints_json(result, steady.state, reactions, scale)},
          {"reactions", reactions_json(result, reactions, scale)}};
}

ordered_json json(const Rest& rest, const Result& result, const SceneScale& scale = {}) {
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

ordered_json json(const FloquetMotion& floquet, const Result& result,
                  const SceneScale& scale = {}) {
  if (!floquet.reason.empty()) return {{"period", floquet.period}, {"reason", floquet.reason}};
  ordered_json multipliers = ordered_json::array();
  for (const Mode& m : floquet.multipliers) {
    multipliers.push_back({{"real", m.root.real()},
                           {"imag", m.root.imag()},
                           {"size", std::abs(m.root)},
                           {"error", m.error}});
  }
  ordered_json modes = ordered_json::array();
  for (const WhirlingMode& mode : result.analysis.floquet_modes) modes.push_back(json(mode, false));
  const auto reactions = result.system.reactions(result.system.begin(), floquet.start);
  return {{"period", floquet.period},
          {"verdict", name(floquet.verdict)},
          {"multipliers", multipliers},
          {"modes", modes},
          {"residual", floquet.residual},
          {"start", joints_json(result, floquet.start, reactions, scale)}};
}

ordered_json json(const PrecessionCheck& check) {
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
    result["greatest_shift"] = json(check.test.greatest_shift);
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
                     {"error", json(bound)},
                     {"nutation", json(nutation)},
                     {"below_0.01_until", valid_until},
                     {"slow", slow}};
  return result;
}

/// The coordinates of all joints with coordinates, in one line.
std::string coordinates_text(const ordered_json& joints) {
  std::string text;
  for (const auto& [body, values] : joints.items()) {
    for (const char* const key : {"coordinate", "attitude", "position"}) {
      if (!values.contains(key)) continue;
      text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", printable(body, 60), key,
                          joint_tables::text(values[key]));
    }
  }
  return text;
}

std::string roots_text(const LinearMotion& linear) {
  std::string text;
  for (const WhirlingMode& mode : linear.modes) {
    text += text.empty() ? "" : ", ";
    const std::complex<double> root = shown_root(mode);
    text += fmt::format("{:.8g}", root.real());
    if (root.imag() > 0) text += fmt::format(" +- {:.8g}i", root.imag());
  }
  return text.empty() ? "none" : text;
}

void print_equilibria(const Result& result) {
  const Analysis& a = result.analysis;
  if (a.starts == 0) return;
  fmt::print("equilibria: {} found from {} start{}\n", a.equilibria.size(), a.starts,
             a.starts == 1 ? "" : "s");
  for (const Rest& rest : a.equilibria) {
    const std::string where =
        coordinates_text(json(rest, result, scale_of(result, rest.equilibrium.state))["joints"]);
    const int neutral = rest.equilibrium.neutral;
    const std::string family = neutral == 0 ? ""
                                            : fmt::format(", one of a family in {} direction{}",
                                                          neutral, neutral == 1 ? "" : "s");
    fmt::print("  {:9} {}{}\n            roots, 1/s, {}: {}\n", name(rest.stability), where, family,
               printable(rest.linear.frame), roots_text(rest.linear));
  }
  fmt::print("\n");
}

void print(const Steady& steady, const Result& result) {
  if (!steady.exists()) {
    fmt::print("no equilibrium and no steady motion: {}\n", printable(steady.reason));
    return;
  }
  const char* const what = steady.turns ? "steady motion" : "equilibrium";
  if (steady.kind == Steady::Kind::start) {
    fmt::print("{}: the start of the file\n", what);
  } else {
    fmt::print("{}: not the start of the file but the one next to it, up to {:.3g} away\n", what,
               steady.distance);
  }
  const ordered_json table = json(steady, result, scale_of(result, steady.state));
  joint_tables::print("joints there", table["joints"]);
  joint_tables::print("reactions there, N and N m, on the body, its axes", table["reactions"]);
}

void print(const FloquetMotion& floquet, const Result& result) {
  fmt::print("\nFloquet, period {:.9g} s: ", floquet.period);
  if (!floquet.reason.empty()) {
    fmt::print("none, {}\n", floquet.reason);
    return;
  }
  fmt::print("{}\n  {:>20} {:>20} {:>14} {:>10}\n", name(floquet.verdict), "multiplier", "", "size",
             "error");
  for (const Mode& m : floquet.multipliers) {
    const std::complex<double> root = shown_root(m);
    fmt::print("  {:20.12g} {:+20.12g} {:14.9g} {:10.1e}\n", root.real(), root.imag(),
               std::abs(m.root), m.error);
  }
  print(result.analysis.floquet_modes, floquet, result.system.tree().rates());
  const std::string title =
      fmt::format("the motion that repeats itself, at t = {:.9g}", result.system.begin());
  joint_tables::print(title.c_str(),
                      json(floquet, result, scale_of(result, floquet.start))["start"]);
}

void print(const PrecessionCheck& check, double t_end) {
  fmt::print("\nprecession equations: ");
  if (!check.beyond.empty()) {
    fmt::print("none, {}\n", check.beyond);
    return;
  }
  if (!check.not_tested.empty()) {
    fmt::print("not tested, {}\n", check.not_tested);
  } else {
    fmt::print("{}{}\n  G has rank {} of {}; slow roots are off by up to {:.2g} of their size\n",
               check.test.admissible ? "admissible" : "not admissible: ", check.test.reason,
               check.rank, check.velocities, check.test.greatest_shift);
    for (const auto& [technical, exact] : check.test.slow) {
      if (technical.imag() < 0) continue;
      const double size = std::abs(exact);
      fmt::print("  slow root {:.8g} {:+.8g}i, exact {:.8g} {:+.8g}i\n",
                 ::shown(technical.real(), size), ::shown(technical.imag(), size),
                 ::shown(exact.real(), size), ::shown(exact.imag(), size));
    }
  }
  if (!check.no_motion.empty()) {
    fmt::print("  no bound: {}\n", check.no_motion);
    return;
  }
  const auto& [end, bound, nutation, valid_until, slow] = check.motion;
  fmt::print(
      "  from the file's start off by at most {:.2g} in {:.6g} s, nutation {:.2g}, {} of {} "
      "accelerations kept\n",
      bound, end, nutation, check.kept, check.velocities);
  if (!slow) {
    fmt::print("  broken off there, before t_end = {:.6g} s: the motion is not slow\n", t_end);
  } else if (valid_until < end) {
    fmt::print("  below 0.01 until {:.6g} s\n", valid_until);
  }
}

}  // namespace

ordered_json to_json(const Result& result) {
  const Analysis& a = result.analysis;
  ordered_json equilibria = ordered_json::array();
  for (const Rest& rest : a.equilibria) equilibria.push_back(json(rest, result));
  ordered_json all{{"title", result.scene.title},
                   {"equilibria", equilibria},
                   {"equilibrium_starts", a.starts},
                   {"steady", json(a.steady, result)}};
  if (a.linear) all["linear"] = json(*a.linear);
  if (a.campbell) all["campbell"] = json(*a.campbell);
  if (a.floquet) all["floquet"] = json(*a.floquet, result);
  if (a.response) all["response"] = json(*a.response);
  all["precession"] = json(a.precession);
  all["notes"] = a.notes;
  return all;
}

void print_summary(const Result& result) {
  const Analysis& a = result.analysis;
  if (!result.scene.title.empty()) {
    fmt::print("{}\n\n", printable(result.scene.title));
  }
  print_equilibria(result);
  print(a.steady, result);
  if (a.linear) print(*a.linear);
  if (a.campbell) print(*a.campbell);
  if (a.floquet) print(*a.floquet, result);
  if (a.response) print(*a.response);
  print(a.precession, result.scene.t_end);
  for (const std::string& note : a.notes) fmt::print("\nnote: {}\n", note);
}
