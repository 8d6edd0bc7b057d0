#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/log_error.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>
#include <motor/error.hpp>

#include "interruptible.hpp"
#include "scene.hpp"

using namespace kreisel;

namespace {

/// Makes groups of consecutive columns.
class Groups {
 public:
  explicit Groups(std::size_t begin) : at_(begin) {}

  void add(const std::string& kind, const std::string& name, const std::string& part,
           std::size_t count) {
    if (count > 0) list_.push_back({kind, name, part, at_, count});
    at_ += count;
  }
  void add_force(const std::string& kind, const std::string& name) {
    add(kind, name, "force", 3);
    add(kind, name, "torque", 3);
  }
  void skip(std::size_t count) { at_ += count; }
  [[nodiscard]] std::vector<Group> list() const { return list_; }

 private:
  std::size_t at_;
  std::vector<Group> list_;
};

/// The groups of the columns of a scene's rows, behind the time.
std::vector<Group> groups_of(const SceneFile& scene, const BodyTree& tree) {
  Groups groups(1);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const auto [q, q_count, v, v_count] = tree.place(i);
    const std::string& name = scene.bodies[static_cast<std::size_t>(i)].name;
    groups.add("coordinates", name, "", static_cast<std::size_t>(q_count));
    groups.add("rates", name, "", static_cast<std::size_t>(v_count));
  }
  groups.skip(scene.memory_names.size());
  for (const BodyDescription& body : scene.bodies) {
    if (!scene.reactions) break;
    groups.add_force("reactions", body.name);
    groups.add("reactions", body.name, "drive_torque", 1);
  }
  for (const Element& element : scene.elements) {
    if (scene.element_forces) groups.add_force("elements", name(element));
  }
  for (const Constraint& constraint : scene.constraints) {
    if (scene.constraint_forces) groups.add_force("constraints", constraint.name);
  }
  for (const SceneSensor& sensor : scene.sensors) {
    for (const SensorPart& part : parts(sensor, scene.bodies)) {
      groups.add("sensors", sensor.name, part.name, part.components.size());
    }
  }
  return groups.list();
}

std::vector<Group> part_groups_of(const SceneFile& scene) {
  Groups groups(0);
  for (const BodyDescription& body : scene.bodies) {
    for (const char* const part : {"relative", "guide", "coriolis"}) {
      groups.add("parts", body.name, part, 6);
    }
  }
  return groups.list();
}

/// Force and torque of the parts of the law for every body.
std::vector<double> parts_at(const SceneSolver& model, double t, const JointState& state) {
  std::vector<double> numbers;
  for (int i = 0; i < static_cast<int>(model.tree().bodies().size()); ++i) {
    const ForceParts<Body> parts = model.terms(t, state, i);
    for (const Motor<>& part : {parts.relative.value, parts.guide.value, parts.coriolis.value}) {
      numbers.insert(numbers.end(), part.resultant.begin(), part.resultant.end());
      numbers.insert(numbers.end(), part.moment.begin(), part.moment.end());
    }
  }
  return numbers;
}

SolveRequest request_of(const RunOptions& options) {
  if (options.times && options.t_end) {
    throw InvalidInput("t_end and times exclude each other: give one of them");
  }
  if (options.times && options.times->empty()) throw InvalidInput("times must not be empty");
  SolveRequest request{options.t_end, options.tolerance, {}};
  if (options.times) request.t_end = options.times->back();
  if (request.t_end && !std::isfinite(*request.t_end)) {
    throw InvalidInput("t_end must be a finite number");
  }
  if (options.method) {
    request.method = method_named(*options.method);
    if (!request.method) {
      throw InvalidInput("method '" + *options.method +
                         "' is none of auto, closed form, verner98, gauss16, radau13, splitting, "
                         "taylor");
    }
  }
  return request;
}

SceneFile scene_of(const SceneText& text, const RunOptions& options) {
  SceneFile scene = text.read(request_of(options));
  scene.reactions = options.reactions;
  scene.element_forces = options.elements;
  scene.constraint_forces = options.constraints;
  if (options.times && options.times->front() < scene.t_begin) {
    throw InvalidInput("times must not begin before t_begin of the scene");
  }
  if (options.times) {
    scene.output_times = with_samples(*options.times, scene.sensors, scene.t_begin, scene.t_end);
  }
  if (scene.output_times.empty() || scene.output_times.back() < scene.t_end) {
    scene.output_times.push_back(scene.t_end);
  }
  return scene;
}

/// The rows of a run, as those of simulate, until a stop.
void add_rows(const SceneFile& scene, const SceneSolver& model, const Trajectory<JointState>& run,
              bool terms, const std::stop_token& stop, Motion& motion) {
  const RowForces forces{scene.reactions, scene.element_forces, scene.constraint_forces};
  SensorReadings readings(scene);
  for (std::size_t i = 0; i < run.states.size() && !stop.stop_requested(); ++i) {
    std::vector<double> numbers = row(model, run.times[i], run.states[i], forces);
    const std::vector<double> own = readings.row(model, run.times[i], run.states[i]);
    numbers.insert(numbers.end(), own.begin(), own.end());
    motion.rows.add(numbers);
    if (terms) motion.parts.add(parts_at(model, run.times[i], run.states[i]));
  }
}

}  // namespace

SceneFile SceneText::read(SolveRequest request) const {
  request.settings = settings;
  return parse_scene(text, path, request);
}

std::pair<std::string, std::vector<std::string>> examine(const SceneText& scene) {
  SolveRequest request;
  const bool has_end = number_in_scene(scene.text, "solve.t_end").has_value();
  const bool is_set = std::any_of(scene.settings.begin(), scene.settings.end(),
                                  [](const auto& one) { return one.key == "solve.t_end"; });
  if (!has_end && !is_set) {
    request.t_end = number_in_scene(scene.text, "solve.t_begin").value_or(0) + 1;
  }
  const SceneFile file = scene.read(request);
  (void)make_model(file);
  std::vector<std::string> bodies;
  for (const BodyDescription& body : file.bodies) bodies.push_back(body.name);
  return {file.title, bodies};
}

Motion solve_scene(const SceneText& text, const RunOptions& options,
                   const pybind11::object& progress) {
  const SceneFile scene = scene_of(text, options);
  const std::unique_ptr<SceneSolver> model = make_model(scene);
  SolveOptions solve_options = options_of(scene);
  solve_options.output_times = scene.output_times;
  Motion motion{scene.title, name(scene.model), columns(scene), groups_of(scene, model->tree()),
                part_groups_of(scene)};
  run_interruptibly(progress, [&](const std::stop_token& stop, std::atomic<double>& share) {
    solve_options.stop = stop;
    const auto on_output = [&](double t, const JointState&) {
      share = (t - scene.t_begin) / scene.duration();
      return OutputAction::proceed;
    };
    const auto run = model->solve(solve_options, start_of(scene), on_output);
    motion.report = run.report;
    motion.errors = run.errors;
    if (run.report.status != RunStatus::complete) return;
    add_rows(scene, *model, run, options.terms, stop, motion);
    if (const auto log = error_of_logs(scene, *model, run, stop)) motion.error_of_log = log->worst;
  });
  if (motion.report.status == RunStatus::failed) throw ComputationFailed(motion.report.message);
  const Terms terms = model->equation_terms();
  motion.terms.assign(terms.begin(), terms.end());
  return motion;
}

Members ensemble(const SceneText& text, const std::vector<std::string>& variations,
                 std::size_t members, std::uint64_t seed, int threads, const RunOptions& options,
                 const pybind11::object& progress) {
  EnsembleRequest request{request_of(options), {}, members, seed};
  request.solve.settings = text.settings;
  for (const std::string& one : variations) request.variations.push_back(parse_variation(one));
  const SceneEnsemble all(text.text, text.path, request);
  std::vector<SceneMember> computed;
  run_interruptibly(progress, [&](const std::stop_token& stop, std::atomic<double>& share) {
    const auto report = [&share](double done) {
      share = done;
      return true;
    };
    computed = all.compute({threads, report, stop});
  });
  Members result{all.keys(), all.columns()};
  const std::vector<double> none(all.columns().size(), std::numeric_limits<double>::quiet_NaN());
  for (const SceneMember& member : computed) {
    const bool failed = member.status != RunStatus::complete;
    result.varied.add(member.varied);
    result.ends.add(failed ? none : member.end);
    result.errors.push_back(failed ? std::numeric_limits<double>::quiet_NaN() : member.error);
    result.messages.push_back(failed ? member.message : "");
    result.missed += !failed && !member.tolerance_kept ? 1 : 0;
  }
  return result;
}
