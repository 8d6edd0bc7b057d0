#include "output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/file/printable.hpp>

#include "../shared/joint_tables.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;

using kreisel::GyroscopicMode;
using nlohmann::ordered_json;

namespace {

using joint_tables::json;

const char* const verdicts[] = {"stable", "marginal", "unstable"};

const char* name(Verdict verdict) { return verdicts[static_cast<int>(verdict)]; }

/// The root for display: parts that are no larger than its error are 0.
std::complex<double> shown(const kreisel::Mode& mode) {
  const auto part = [&mode](double x) { return std::abs(x) > mode.error ? x : 0; };
  return {part(mode.root.real()), part(mode.root.imag())};
}

double damping_ratio(const std::complex<double>& root) {
  return root.real() != 0 ? -root.real() / std::abs(root) : 0;
}

/// The direction of the coordinate or rate with the greatest amplitude.
std::string mostly(const GyroscopicMode& mode, const std::vector<std::string>& names, int rates) {
  Eigen::Index most = 0;
  if (mode.shape.head(rates).cwiseAbs().maxCoeff(&most) == 0) {
    mode.shape.cwiseAbs().maxCoeff(&most);
  }
  return names[static_cast<std::size_t>(most)];
}

kreisel::JointState joints_of(const Result& result, const Eigen::VectorXd& state) {
  return result.system.joints_of(state);
}

/// Sizes from a state and from the reactions in this state.
kreisel::SceneScale scale_of(const Result& result, const Eigen::VectorXd& state) {
  kreisel::SceneScale scale =
      ::scale_of(result.scene, result.system.tree(), {joints_of(result, state)});
  scale.hold(result.system.reactions(result.system.begin(), state));
  return scale;
}

ordered_json joints_json(const Result& result, const Eigen::VectorXd& state,
                         const kreisel::JointReactions& reactions,
                         const kreisel::SceneScale& scale) {
  const kreisel::JointState joints = joints_of(result, state);
  const kreisel::BodyTree& tree = result.system.tree();
  ordered_json table = ordered_json::object();
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    table[tree.body(i).name] = joint_tables::joint(tree, i, joints, reactions, scale);
  }
  return table;
}

ordered_json reactions_json(const Result& result, const kreisel::JointReactions& reactions,
                            const kreisel::SceneScale& scale) {
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < reactions.on_body.size(); ++i) {
    table[result.system.tree().bodies()[i].name] = json(reactions.on_body[i].value, scale);
  }
  return table;
}

ordered_json json(const GyroscopicMode& mode, bool has_rotors) {
  const double w = mode.root.imag();
  ordered_json result{{"growth_rate", mode.root.real()},
                      {"frequency", w},
                      {"frequency_hz", w / (2 * std::numbers::pi)},
                      {"damping_ratio", damping_ratio(mode.root)},
                      {"error", mode.error}};
  if (*kind(mode, has_rotors) != '\0') {
    result["kind"] = kind(mode, has_rotors);
    result["spin_growth"] = mode.spin_growth;
  }
  return result;
}

ordered_json json(const Steady& steady, const Result& result,
                  const kreisel::SceneScale& scale = {}) {
  if (!steady.exists()) return {{"found", "none"}, {"reason", steady.reason}};
  const kreisel::JointReactions reactions =
      result.system.reactions(result.system.begin(), steady.state);
  return {{"found", steady.kind == Steady::Kind::start ? "start" : "from the start"},
          {"motion", steady.turns ? "steady motion" : "equilibrium"},
          {"distance", steady.distance},
          {"residual", steady.residual},
          {"joints", joints_json(result, steady.state, reactions, scale)},
          {"reactions", reactions_json(result, reactions, scale)}};
}

ordered_json roots_json(const Linear& linear) {
  ordered_json roots = ordered_json::array();
  for (const GyroscopicMode& mode : linear.modes) {
    roots.push_back(json(mode, linear.has_rotors));
    roots.back()["mostly"] = mostly(mode, linear.names, linear.rates);
  }
  return roots;
}

ordered_json json(const Linear& linear) {
  ordered_json result = {{"verdict", name(linear.verdict)},
                         {"frame", linear.frame},
                         {"roots", roots_json(linear)},
                         {"left_out", linear.left_out}};
  if (!linear.dependent.empty()) result["dependent"] = linear.dependent;
  if (linear.sample_period > 0) {
    result["sample_period"] = linear.sample_period;
    result["dead_beats"] = linear.dead_beats;
  }
  return result;
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) {
    all += all.empty() ? "" : ", ";
    all += name;
  }
  return all;
}

ordered_json json(const Rest& rest, const Result& result, const kreisel::SceneScale& scale = {}) {
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

ordered_json json(const Campbell& campbell) {
  ordered_json curves = ordered_json::array();
  for (const Curve& curve : campbell.curves) {
    ordered_json modes = ordered_json::array();
    for (const auto& mode : curve) {
      modes.push_back(mode ? json(*mode, campbell.has_rotors) : ordered_json());
    }
    curves.push_back(modes);
  }
  return {{"body", campbell.body}, {"speeds", campbell.speeds}, {"curves", curves}};
}

ordered_json json(const Floquet& floquet, const Result& result,
                  const kreisel::SceneScale& scale = {}) {
  if (!floquet.reason.empty()) return {{"period", floquet.period}, {"reason", floquet.reason}};
  ordered_json multipliers = ordered_json::array();
  for (const kreisel::Mode& m : floquet.multipliers) {
    multipliers.push_back({{"real", m.root.real()},
                           {"imag", m.root.imag()},
                           {"size", std::abs(m.root)},
                           {"error", m.error}});
  }
  const auto reactions = result.system.reactions(result.system.begin(), floquet.start);
  return {{"period", floquet.period},
          {"verdict", name(floquet.verdict)},
          {"multipliers", multipliers},
          {"residual", floquet.residual},
          {"start", joints_json(result, floquet.start, reactions, scale)}};
}

ordered_json json(const kreisel::PrecessionCheck& check) {
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
      text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", kreisel::printable(body, 60), key,
                          joint_tables::text(values[key]));
    }
  }
  return text;
}

std::string roots_text(const Linear& linear) {
  std::string text;
  for (const GyroscopicMode& mode : linear.modes) {
    text += text.empty() ? "" : ", ";
    const std::complex<double> root = shown(mode);
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
               kreisel::printable(rest.linear.frame), roots_text(rest.linear));
  }
  fmt::print("\n");
}

void print(const Steady& steady, const Result& result) {
  if (!steady.exists()) {
    fmt::print("no equilibrium and no steady motion: {}\n", kreisel::printable(steady.reason));
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

void print(const Linear& linear) {
  fmt::print("\nlinear equations there: {}\n", name(linear.verdict));
  if (!linear.modes.empty()) fmt::print("  roots as seen {}\n", kreisel::printable(linear.frame));
  if (!linear.modes.empty()) {
    fmt::print("  {:>16} {:>18} {:>14} {:>12}  {:12} {}\n", "growth, 1/s", "frequency, rad/s", "Hz",
               "damping", "kind", "mostly");
  }
  for (const GyroscopicMode& mode : linear.modes) {
    const std::complex<double> root = shown(mode);
    fmt::print("  {:16.8g} {:18.10g} {:14.6g} {:12.4g}  {:12} {}\n", root.real(), root.imag(),
               root.imag() / (2 * std::numbers::pi), damping_ratio(root),
               kind(mode, linear.has_rotors), mostly(mode, linear.names, linear.rates));
  }
  if (linear.sample_period > 0) {
    fmt::print(
        "  of the sampled loop, from its transition over {:.9g} s; roots that die within it: {}\n",
        linear.sample_period, linear.dead_beats);
  }
  if (!linear.left_out.empty()) {
    fmt::print("  without roots, given or such that nothing depends on it: {}\n",
               joined(linear.left_out));
  }
  if (!linear.dependent.empty()) {
    fmt::print("  follow from the others by constraints: {}\n", joined(linear.dependent));
  }
}

void print(const Campbell& campbell) {
  fmt::print("\nfrequencies, rad/s, over the speed of {}, rad/s; * grows\n", campbell.body);
  for (std::size_t i = 0; i < campbell.speeds.size(); ++i) {
    fmt::print("  {:12.6g}", campbell.speeds[i]);
    for (const Curve& curve : campbell.curves) {
      const bool grows = curve[i] && curve[i]->root.real() > curve[i]->error;
      fmt::print(" {:>14}{}", curve[i] ? fmt::format("{:.8g}", shown(*curve[i]).imag()) : "-",
                 grows ? '*' : ' ');
    }
    fmt::print("\n");
  }
}

void print(const Floquet& floquet, const Result& result) {
  fmt::print("\nFloquet, period {:.9g} s: ", floquet.period);
  if (!floquet.reason.empty()) {
    fmt::print("none, {}\n", floquet.reason);
    return;
  }
  fmt::print("{}\n  {:>20} {:>20} {:>14} {:>10}\n", name(floquet.verdict), "multiplier", "", "size",
             "error");
  for (const kreisel::Mode& m : floquet.multipliers) {
    const std::complex<double> root = shown(m);
    fmt::print("  {:20.12g} {:+20.12g} {:14.9g} {:10.1e}\n", root.real(), root.imag(),
               std::abs(m.root), m.error);
  }
  const std::string title =
      fmt::format("the motion that repeats itself, at t = {:.9g}", result.system.begin());
  joint_tables::print(title.c_str(),
                      json(floquet, result, scale_of(result, floquet.start))["start"]);
}

void print(const kreisel::PrecessionCheck& check, double t_end) {
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

/// The phase in degrees, in (-180, 180].
double degrees(const std::complex<double>& value) {
  return std::arg(value) * 180 / std::numbers::pi;
}

ordered_json json(const Response& response) {
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    rows.push_back({{"frequency", response.frequencies[i]},
                    {"amplitude", std::abs(response.values[i])},
                    {"phase", std::arg(response.values[i])}});
  }
  ordered_json result{{"input", response.input.name},
                      {"input_unit", response.input.unit},
                      {"output", response.output.name},
                      {"output_unit", response.output.unit},
                      {"first_harmonic", response.is_first_harmonic},
                      {"rows", rows}};
  if (response.bandwidth) result["bandwidth"] = *response.bandwidth;
  if (response.margins) {
    const auto crossing = [](const auto& found, const char* name) {
      if (!found) return ordered_json();
      return ordered_json{{"frequency", found->frequency}, {name, found->margin}};
    };
    result["phase_margin"] = crossing(response.margins->phase, "angle");
    result["gain_margin"] = crossing(response.margins->gain, "factor");
  }
  return result;
}

void print(const Response& response) {
  fmt::print("\nresponse of {}, {}, to {}, {}{}\n", kreisel::printable(response.output.name),
             response.output.unit, kreisel::printable(response.input.name),
             response.input.unit.empty() ? "reference" : response.input.unit,
             response.is_first_harmonic ? "; first harmonic" : "");
  fmt::print("  {:>16} {:>14} {:>16} {:>12}\n", "frequency, rad/s", "Hz", "amplitude",
             "phase, deg");
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    const double w = response.frequencies[i];
    fmt::print("  {:16.10g} {:14.6g} {:16.10g} {:12.6g}\n", w, w / (2 * std::numbers::pi),
               std::abs(response.values[i]), degrees(response.values[i]));
  }
  if (response.bandwidth) fmt::print("  bandwidth (-3 dB): {:.10g} rad/s\n", *response.bandwidth);
  if (!response.margins) return;
  const auto& [phase, gain] = *response.margins;
  fmt::print("  the loop, opened at this joint force{}:\n",
             response.is_first_harmonic ? ", by the first harmonic" : "");
  if (phase) {
    fmt::print("    phase margin {:.8g} deg at {:.10g} rad/s\n",
               phase->margin * 180 / std::numbers::pi, phase->frequency);
  } else {
    fmt::print("    no phase margin: its gain does not cross 1 in this range\n");
  }
  if (gain) {
    fmt::print("    gain margin {:.8g} at {:.10g} rad/s\n", gain->margin, gain->frequency);
  } else {
    fmt::print("    no gain margin: its phase does not cross -180 deg in this range\n");
  }
}

}  // namespace

const char* kind(const GyroscopicMode& mode, bool has_rotors) {
  static constexpr const char* kinds[] = {"nutation", "precession", "oscillation"};
  const bool oscillates = mode.root.imag() > mode.error;
  return has_rotors && oscillates ? kinds[static_cast<int>(mode.kind())] : "";
}

void write_response(const Result& result, const std::filesystem::path& path) {
  kreisel::AtomicFile file(path);
  const Response& response = *result.analysis.response;
  std::string text = "frequency,amplitude,phase\n";
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    text += fmt::format("{:.17g},{:.17g},{:.17g}\n", response.frequencies[i],
                        std::abs(response.values[i]), std::arg(response.values[i]));
  }
  file.stream() << text;
  file.commit();
}

ordered_json state_space_json(const Result& result) {
  const Steady& steady = result.analysis.steady;
  if (!steady.exists()) {
    throw kreisel::ComputationFailed("--state-space: no steady motion: " + steady.reason);
  }
  const kreisel::LinearPlant plant =
      result.system.plant(steady.state, plant_inputs(result.scene), plant_outputs(result.scene));
  const kreisel::StateSpace matrices = state_space(plant);
  const auto rows = [](const Eigen::MatrixXd& M) {
    ordered_json all = ordered_json::array();
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      const Eigen::VectorXd row = M.row(i);
      all.push_back(std::vector<double>(row.begin(), row.end()));
    }
    return all;
  };
  const auto named = [](const auto& all) {
    ordered_json list = ordered_json::array();
    for (const auto& one : all) list.push_back({{"name", one.name}, {"unit", one.unit}});
    return list;
  };
  ordered_json inputs = ordered_json::array();
  for (const auto& input : matrices.inputs) {
    inputs.push_back({{"name", input.name}, {"unit", input.unit}, {"derivative", input.power}});
  }
  return {{"title", result.scene.title},
          {"frame", result.analysis.linear ? result.analysis.linear->frame : ""},
          {"dt", plant.period},
          {"states", plant.names},
          {"inputs", inputs},
          {"outputs", named(plant.outputs)},
          {"A", rows(matrices.A)},
          {"B", rows(matrices.B)},
          {"C", rows(plant.C)},
          {"D", rows(matrices.D)}};
}

void write_state_space(const Result& result, const std::filesystem::path& path) {
  kreisel::AtomicFile file(path);
  file.stream() << state_space_json(result).dump(1) << '\n';
  file.commit();
}

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
    fmt::print("{}\n\n", kreisel::printable(result.scene.title));
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
