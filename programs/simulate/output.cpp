#include "output.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <dynamics/file/contacts.hpp>
#include <dynamics/file/greatest_terms.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/json/joints.hpp>
#include <dynamics/solve/report.hpp>
#include <motor/error.hpp>

#include "../shared/joint_tables.hpp"

using namespace kreisel;

using nlohmann::ordered_json;

namespace {

const kreisel::RunReport& report(const Result& result) { return result.run.report; }

std::size_t at(int i) { return static_cast<std::size_t>(i); }

int bodies(const Result& result) { return static_cast<int>(result.scene.bodies.size()); }

std::string gravity_name(const kreisel::SceneFile& scene) {
  static constexpr const char* names[] = {
      "",
      "uniform on guide axes",
      "uniform on inertial axes",
      "gravitation of the WGS84 ellipsoid at every body's centre of mass",
      "the effective gravity at the site, its centrifugal part included",
      "gravitation of a point or of a flattened planet at every body's centre of mass",
      "gravitation at every body's centre of mass, less that of the orbit's origin"};
  return names[scene.gravity.index()];
}

/// True if gravity includes the terms of the bodies' size; nothing if its kind has no such terms.
std::optional<bool> size_terms(const kreisel::SceneFile& scene) {
  return std::visit(
      []([[maybe_unused]] const auto& field) -> std::optional<bool> {
        if constexpr (requires { field.gradient; }) return field.gradient;
        return std::nullopt;
      },
      scene.gravity);
}

ordered_json terms_json(const std::vector<TermLine>& terms) {
  ordered_json list = ordered_json::array();
  for (const TermLine& term : terms) list.push_back({{"term", term.name}, {"reason", term.reason}});
  return list;
}

/// The terms that the equation of motion contains, or those that it does not. Gravity is a term of
/// its own, by the kind in the scene: non-uniform gravity enters the equation as a load on each
/// body.
std::vector<TermLine> equation_terms(const Result& result, bool kept) {
  std::vector<TermLine> terms;
  for (const kreisel::Term& term : result.model.equation_terms()) {
    const bool is_told_apart = term.part == "load" && term.name == "gravity";
    if (is_told_apart && result.scene.gravity.index() != 0) continue;
    if (term.kept == kept) terms.push_back({term.part + ": " + term.name, term.why});
  }
  return terms;
}

/// The parts of the error, each at its maximum.
struct ErrorSources {
  double integration = 0;
  double log = 0;
  double model = 0;
};

ErrorSources error_sources(const Result& result) {
  const double model = result.model.model_error();
  return {std::max(0.0, report(result).error_estimate - model), result.log_error.worst, model};
}

double whole_error(const Result& result) {
  return report(result).error_estimate + result.log_error.worst;
}

/// The effect of log errors on the end, for each joint in its own units; no key for a fixed
/// quantity.
ordered_json log_errors(const Result& result) {
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < result.log_error.joints.size(); ++i) {
    const kreisel::LogError::Joint& off = result.log_error.joints[i];
    ordered_json& entry = table[result.scene.bodies[i].name];
    entry = ordered_json::object();
    if (!off.coordinates.empty()) {
      entry["coordinates"] = off.coordinates;
      entry["rates"] = off.rates;
    }
    if (result.reactions) {
      entry["force"] = json_of(off.force);
      entry["torque"] = json_of(off.torque);
    }
  }
  return table;
}

/// The last reading of each sensor, by the names of its parts.
ordered_json final_sensors(const Result& result, const kreisel::SceneScale& scale) {
  auto next = result.readings.begin();
  ordered_json table = ordered_json::object();
  for (const kreisel::SceneSensor& sensor : result.scene.sensors) {
    ordered_json& entry = table[sensor.name];
    for (const kreisel::SensorPart& part : parts(sensor, result.scene.bodies)) {
      ordered_json& list = entry[part.name] = ordered_json::array();
      for (const std::string& unit : part.units) list.push_back(shown(*next++, scale.of(unit)));
    }
  }
  return table;
}

/// The forces of the elements on their second bodies.
ordered_json element_forces(const Result& result, const kreisel::SceneScale& scale) {
  const auto forces =
      result.model.element_forces(result.run.times.back(), result.run.states.back());
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    table[name(result.scene.elements[i])] = json_of(forces[i], scale);
  }
  return table;
}

/// The forces of the constraints on their second bodies.
ordered_json constraint_forces(const Result& result, const kreisel::SceneScale& scale) {
  const auto forces =
      result.model.constraint_forces(result.run.times.back(), result.run.states.back());
  ordered_json table = ordered_json::object();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    table[result.scene.constraints[i].name] = json_of(forces[i], scale);
  }
  return table;
}

ordered_json final_state(const Result& result, const kreisel::SceneScale& scale = {}) {
  const double t = result.run.times.back();
  const kreisel::JointState& state = result.run.states.back();
  const kreisel::JointReactions reactions = result.model.reactions(t, state);
  ordered_json joints = ordered_json::object();
  ordered_json carried = ordered_json::object();
  ordered_json parts = ordered_json::object();
  for (int i = 0; i < bodies(result); ++i) {
    const std::string& name = result.scene.bodies[at(i)].name;
    joints[name] = joint_json(result.model.tree(), i, state, reactions, scale);
    carried[name] = json_of(reactions.on_body[at(i)].value, scale);
    if (!result.terms) continue;
    const auto terms = result.model.terms(t, state, i);
    parts[name] = {{"relative", json_of(terms.relative.value, scale)},
                   {"guide", json_of(terms.guide.value, scale)},
                   {"coriolis", json_of(terms.coriolis.value, scale)}};
  }
  ordered_json final{{"t", t}, {"joints", joints}};
  if (result.reactions) final["reactions"] = carried;
  if (result.scene.element_forces) final["elements"] = element_forces(result, scale);
  if (result.scene.constraint_forces) final["constraints"] = constraint_forces(result, scale);
  if (result.terms) final["terms"] = parts;
  if (!result.scene.sensors.empty()) final["sensors"] = final_sensors(result, scale);
  if (!result.log_error.joints.empty()) final["error_of_log"] = log_errors(result);
  return final;
}

/// The greatest terms of each kind in the joints of frames; null without rotors. Numbers below
/// `rounding` times the greatest of all are 0.
ordered_json terms_by_kind(const Result& result, double rounding) {
  const auto terms = kreisel::greatest_terms(result.scene, result.model, result.run);
  if (!terms) return nullptr;
  using Terms = kreisel::FrameTerms;
  static constexpr std::pair<const char*, Eigen::VectorXd Terms::*> kinds[] = {
      {"inertia", &Terms::inertia},
      {"gyroscopic", &Terms::gyroscopic},
      {"restraint", &Terms::restraint},
      {"guide_change", &Terms::guide_change},
      {"guide_inertia", &Terms::guide_inertia},
      {"guide_gyroscopic", &Terms::guide_gyroscopic},
      {"left_out", &Terms::left_out}};
  double greatest = 0;
  for (const auto& [name, kind] : kinds) {
    greatest = std::max(greatest, (*terms.*kind).lpNorm<Eigen::Infinity>());
  }
  ordered_json table = ordered_json::object();
  for (const auto& link : result.model.tree().links()) {
    using Kind = kreisel::detail::LinkKind;
    const int several = link.kind == Kind::spherical ? 3 : link.kind == Kind::free ? 6 : 0;
    const int count = link.has_one_rate() ? 1 : several;
    for (const auto& [name, kind] : kinds) {
      for (int i = 0; i < count; ++i) {
        const double size = (*terms.*kind)[link.v + i];
        const std::string& joint = result.scene.bodies[at(link.body)].name;
        table[joint][name].push_back(json_of(size < rounding * greatest ? 0 : size));
      }
    }
  }
  return table;
}

void print_terms(const char* title, const std::vector<TermLine>& terms) {
  fmt::print("\n{}\n", title);
  for (const TermLine& term : terms) fmt::print("  {:56} {}\n", term.name, term.reason);
}

}  // namespace

kreisel::SceneScale scale_of(const Result& result) {
  kreisel::SceneScale scale = scale_of(result.scene, result.model.tree(), result.run.states);
  for (const std::size_t i : {std::size_t(0), result.run.states.size() - 1}) {
    scale.hold(result.model.reactions(result.run.times[i], result.run.states[i]));
  }
  return scale;
}

std::vector<TermLine> terms_kept(const Result& result) {
  std::vector<TermLine> terms = equation_terms(result, true);
  if (result.scene.gravity.index() != 0) terms.push_back({"gravity", gravity_name(result.scene)});
  return terms;
}

std::vector<TermLine> terms_dropped(const Result& result) {
  const kreisel::SceneFile& scene = result.scene;
  std::vector<TermLine> terms = equation_terms(result, false);
  if (scene.model == kreisel::SceneModel::linear) {
    terms.push_back(
        {"what is not linear", "in the departure from the steady motion next to the start"});
  }
  if (scene.model == kreisel::SceneModel::small) {
    terms.push_back({"what is not linear", "in the departure from the position of the start"});
  }
  if (scene.model == kreisel::SceneModel::precession) {
    terms.push_back(
        {"nutations",
         "accelerations across the gyroscopic moments, and terms of second order in the "
         "velocities"});
  }
  if (scene.model == kreisel::SceneModel::foeppl ||
      scene.model == kreisel::SceneModel::fuchs_weigand) {
    terms.push_back({"products of the rings' angles and rates", "small against those themselves"});
    terms.push_back({"changes of the rotor's speed", "of second order in the rings' angles"});
  }
  if (scene.gravity.index() == 3) {
    terms.push_back({"gravity gradient over a body", "gravitation is taken at the centre of mass"});
  }
  if (const auto sized = size_terms(scene)) {
    terms.push_back({"gravity's change over a body",
                     *sized
                         ? "beyond second order in its size: at most 2.07 mu M3/r^4 of torque and "
                           "4 mu M3/r^5 of force, M3 the integral of |x|^3 dm"
                         : "gradient = true adds it"});
  }
  if (scene.gravity.index() == 4) {
    terms.push_back({"gravity gradient", "the gravity at the site is the same for all bodies"});
  }
  if (scene.follows_log()) {
    terms.push_back(
        {"motion faster than the table's samples", "a spline runs through the samples"});
  }
  return terms;
}

namespace {

/// Facts of the run that a user would not expect.
std::vector<std::string> warnings(const Result& result) {
  std::vector<std::string> all;
  for (const auto& [name, redundant, conditions] : result.scene.redundant_constraints) {
    all.push_back(fmt::format("constraint '{}': {} of its {} conditions follow from others", name,
                              redundant, conditions));
  }
  const auto note_log = [&all](const std::filesystem::path& file, const auto& log) {
    if (log.late == 0) return;
    all.push_back(fmt::format(
        "log '{}': its time stamps are coarse; all may be late or early by {:.3g} s, which the "
        "error of the log contains",
        file.filename().string(), log.late));
  };
  for (const auto& link : result.scene.guide) {
    std::visit(
        [&](const auto& one) {
          if constexpr (requires { one.log; }) note_log(one.file, one.log);
        },
        link);
  }
  for (const kreisel::SceneSignalLog& one : result.scene.signal_logs) note_log(one.file, one.log);
  for (const auto& [name, t, force] :
       kreisel::pulling_contacts(result.scene, result.model, result.run)) {
    all.push_back(fmt::format(
        "constraint '{}': at t = {:.9g} s its contact pulls with {:.4g} N; a real one lifts off",
        name, t, -force));
  }
  return all;
}

ordered_json summary(const Result& result) {
  const kreisel::RunReport& r = report(result);
  ordered_json invariants = ordered_json::array();
  for (const auto& [name, start, largest] : r.invariants) {
    invariants.push_back(
        {{"name", name}, {"start", json_of(start)}, {"largest_drift", json_of(largest)}});
  }
  const ErrorSources parts = error_sources(result);
  ordered_json error{{"integration", json_of(parts.integration)},
                     {"truncation", json_of(r.error_parts.truncation)},
                     {"rounding", json_of(r.error_parts.rounding)},
                     {"log", json_of(parts.log)},
                     {"model", json_of(parts.model)}};
  if (const auto distance = result.model.model_distance()) error["distance"] = json_of(*distance);
  const auto whole = [](double count) { return static_cast<long long>(count); };
  ordered_json all = {{"title", result.scene.title},
                      {"method", r.method},
                      {"method_changes", r.changes},
                      {"model", name(result.scene.model)},
                      {"steps", whole(r.effort.steps)},
                      {"rejected", whole(r.effort.rejected)},
                      {"evaluations", whole(r.effort.evaluations)},
                      {"all_evaluations", whole(r.all_evaluations)},
                      {"run_time_s", r.run_time},
                      {"tolerance", r.tolerance},
                      {"error_estimate", json_of(whole_error(result))},
                      {"error", error},
                      {"tolerance_kept", r.tolerance_kept},
                      {"invariants", invariants},
                      {"warnings", warnings(result)},
                      {"terms_kept", terms_json(terms_kept(result))},
                      {"terms_dropped", terms_json(terms_dropped(result))},
                      {"final", final_state(result)}};
  if (!result.terms) return all;
  const ordered_json kinds = terms_by_kind(result, 0);
  if (!kinds.is_null()) all["terms_by_kind"] = kinds;
  return all;
}

/// The keys of the first number that is not finite (null in JSON); nothing if all are finite.
std::optional<std::string> path_to_null(const ordered_json& value) {
  if (value.is_null()) return "";
  if (value.is_number_float() && !std::isfinite(value.get<double>())) return "";
  if (!value.is_structured()) return std::nullopt;
  for (const auto& [key, part] : value.items()) {
    if (const auto path = path_to_null(part)) return path->empty() ? key : key + ", " + *path;
  }
  return std::nullopt;
}

}  // namespace

void require_finite(const Result& result) {
  for (std::size_t i = 0; i < result.run.states.size(); ++i) {
    const kreisel::JointState& state = result.run.states[i];
    if (state.coordinates.allFinite() && state.rates.allFinite()) continue;
    throw kreisel::ComputationFailed(
        fmt::format("the state at t = {:.9g} s is not finite", result.run.times[i]));
  }
  if (const auto path = path_to_null(summary(result))) {
    throw kreisel::ComputationFailed("a number of the report is not finite: " + *path);
  }
}

void print_json(const Result& result) { fmt::print("{}\n", summary(result).dump(2)); }

void print_summary(const Result& result) {
  const kreisel::RunReport& r = report(result);
  if (!result.scene.title.empty()) {
    fmt::print("{}\n\n", kreisel::printable(result.scene.title));
  }
  fmt::print("method    {}, model {}\n", r.changes.empty() ? r.method : r.changes,
             name(result.scene.model));
  fmt::print(
      "steps     {:.0f}, {:.0f} rejected, {:.0f} evaluations ({:.0f} with those for the "
      "estimate), {:.3g} s\n",
      r.effort.steps, r.effort.rejected, r.effort.evaluations, r.all_evaluations, r.run_time);
  const bool logged = !result.log_error.joints.empty();
  const ErrorSources parts = error_sources(result);
  fmt::print("error     {:.1e} estimated, {:.1e} asked for{}{}\n", whole_error(result), r.tolerance,
             logged ? " of the integration" : "", r.tolerance_kept ? "" : ": NOT REACHED");
  if (logged) {
    fmt::print("          error_of_integration {:.1e}\n          error_of_log {:.1e}\n",
               parts.integration, parts.log);
  }
  if (const auto distance = result.model.model_distance()) {
    fmt::print("          error_of_model {:.1e} at most, {:.1e} by comparison\n", parts.model,
               *distance);
  }
  for (const auto& [name, start, largest] : r.invariants) {
    fmt::print("constant  {} = {:.15g}, off by up to {:.1e}\n", kreisel::printable(name, 120),
               start, largest);
  }
  const ordered_json final = final_state(result, scale_of(result));
  joint_tables::print(fmt::format("joints at t = {:.15g} s", final["t"].get<double>()).c_str(),
                      final["joints"]);
  if (final.contains("sensors")) joint_tables::print("sensors, SI", final["sensors"]);
  if (result.reactions) joint_tables::print("reactions, N and N m", final["reactions"]);
  if (final.contains("elements")) {
    joint_tables::print("elements on their second bodies, N and N m", final["elements"]);
  }
  if (final.contains("constraints")) {
    joint_tables::print("constraints on their second bodies, N and N m", final["constraints"]);
  }
  for (const std::string& warning : warnings(result)) {
    fmt::print("\nwarning: {}\n", kreisel::printable(warning));
  }
  if (result.terms) {
    joint_tables::print("terms of the law, N and N m", final["terms"]);
    const ordered_json kinds = terms_by_kind(result, 1e-12);
    if (!kinds.is_null()) {
      joint_tables::print("greatest terms of frames with rotors, N and N m", kinds);
    }
  }
  if (logged) {
    joint_tables::print("error of the log at the end, SI", final["error_of_log"]);
  }
  print_terms("terms kept", terms_kept(result));
  print_terms("terms dropped", terms_dropped(result));
}
