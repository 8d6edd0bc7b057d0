#include "runs.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>
#include <set>
#include <stop_token>
#include <thread>
#include <variant>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/model.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_sensor.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace differential {

namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Asks a run to stop when the process has computed for so many seconds more.
class Deadline {
 public:
  explicit Deadline(double seconds)
      : end_(processor_seconds() + seconds),
        watch_([this](const std::stop_token& over) { wait(over); }) {}

  [[nodiscard]] std::stop_token token() const { return late_.get_token(); }
  [[nodiscard]] bool has_passed() const { return late_.stop_requested(); }

 private:
  void wait(const std::stop_token& over) {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any never;
    while (!over.stop_requested() && processor_seconds() < end_) {
      never.wait_for(lock, over, std::chrono::milliseconds(10), [] { return false; });
    }
    if (!over.stop_requested()) late_.request_stop();
  }

  double end_;
  std::stop_source late_;
  std::jthread watch_;
};

/// The joints' values in the order of JointValues.
JointValues values(const kreisel::BodyTree& tree, const Scene& scene,
                   const kreisel::JointState& state) {
  JointValues result;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto place = tree.place(static_cast<int>(i));
    const auto put = [&result](const Eigen::VectorXd& from, int begin, int count) {
      for (int k = 0; k < count; ++k) result.push_back(from[begin + k]);
    };
    put(state.coordinates, place.q, place.q_count);
    put(state.rates, place.v, place.v_count);
  }
  return result;
}

Answer run_by(const kreisel::SceneSolver& model, const Scene& scene, const kreisel::SceneFile& file,
              const std::string& method, const Limits& limits) {
  Answer answer{.asked = method};
  kreisel::SolveOptions options;
  options.begin = file.t_begin;
  options.output_times = file.output_times;
  options.tolerance = file.tolerance;
  options.discontinuities = file.discontinuities;
  options.method = *kreisel::method_named(method);
  options.max_evaluations = limits.evaluations;
  const Deadline deadline(limits.seconds);
  options.stop = deadline.token();
  try {
    const auto run = model.solve(options, start_of(file));
    const kreisel::RunReport& report = run.report;
    answer.answered = report.status == kreisel::RunStatus::complete;
    answer.message = report.message;
    answer.method = report.method;
    answer.changes = report.changes;
    answer.sizes = report.sizes;
    answer.estimate = report.error_estimate;
    answer.tolerance = report.tolerance;
    answer.kept = report.tolerance_kept;
    answer.evaluations = report.all_evaluations;
    answer.steps = report.effort.steps;
    if (!run.errors.empty()) answer.end_error = run.errors.back();
    answer.times = run.times;
    for (const kreisel::JointState& state : run.states) {
      answer.states.push_back(values(model.tree(), scene, state));
    }
    for (const auto& [name, start, largest] : report.invariants) {
      answer.drifts.push_back({name, start, largest});
    }
  } catch (const std::exception& error) {
    answer.message = error.what();
  }
  answer.out_of_budget =
      !answer.answered &&
      (deadline.has_passed() || answer.message.find("evaluations are spent") != std::string::npos);
  return answer;
}

/// The same scene with a tolerance of 1e-6 at best.
kreisel::SceneFile roughly(kreisel::SceneFile file) {
  file.tolerance = std::max(file.tolerance, 1e-6);
  return file;
}

/// The same scene with 300 times between its outputs, and progressively more before the first.
kreisel::SceneFile with_many_outputs(kreisel::SceneFile file) {
  constexpr int many = 320;
  const double step = file.duration() / many;
  file.output_times = {file.t_begin};
  for (double part = 1e-8; part < 1; part *= 1.5) {
    file.output_times.push_back(file.t_begin + part * step);
  }
  for (int i = 1; i < many; ++i) file.output_times.push_back(file.t_begin + i * step);
  file.output_times.push_back(file.t_end);
  return file;
}

kreisel::SceneFile with_one_output(kreisel::SceneFile file) {
  file.output_times = {file.t_end};
  return file;
}

/// The greatest difference of a number of the state, without rotors, whose speed approximations do
/// not change.
double greatest_difference(Scene scene, const Answer& a, const Answer& b) {
  while (scene.bodies.back().rotor) scene.bodies.pop_back();
  const std::vector<int> carriers = blocks(scene);
  const int count = std::accumulate(carriers.begin(), carriers.end(), 0);
  double greatest = 0;
  for (std::size_t i = 0; i < std::min(a.states.size(), b.states.size()); ++i) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
      greatest = std::max(greatest, std::abs(a.states[i][k] - b.states[i][k]));
    }
  }
  return greatest;
}

kreisel::SceneFile without_model(kreisel::SceneFile file) {
  file.model = kreisel::SceneModel::exact;
  return file;
}

/// The answer by the file's model, and its error relative to the exact motion.
std::pair<Answer, double> run_approximation(const Scene& scene, const kreisel::SceneFile& file,
                                            const kreisel::SceneSolver& model,
                                            const Limits& limits) {
  const auto exact_file = without_model(file);
  const Answer exact = run_by(*make_model(exact_file), scene, exact_file, "auto", limits);
  Answer answer = run_by(model, scene, file, "auto", limits);
  const double off = greatest_difference(scene, answer, exact);
  return {std::move(answer), off};
}

Approximate approximate(const Scene& scene, const kreisel::SceneFile& file, const Limits& limits) {
  const auto model = make_model(file);
  auto [answer, off] = run_approximation(scene, file, *model, limits);
  const Scene near = nearer(scene);
  const kreisel::SceneFile near_file = kreisel::parse_scene(to_toml(near), "nearer.toml");
  const auto near_off = run_approximation(near, near_file, *make_model(near_file), limits).second;
  return {std::move(answer), model->model_error(), off, near_off};
}

/// True if equal steps are worth the time: a motion that is short, smooth and not stiff.
bool suits_equal_steps(const Scene& scene, const Answer& automatic) {
  return automatic.answered && automatic.method != "radau13" && automatic.evaluations < 1000 &&
         !scene.has_log();
}

std::vector<double> reactions(const kreisel::SceneSolver& model, const kreisel::SceneFile& file) {
  std::vector<double> result;
  const kreisel::JointReactions carried = model.reactions(file.t_begin, start_of(file));
  for (const auto& on_body : carried.on_body) {
    const auto& [force, torque] = on_body.value;
    result.insert(result.end(), force.begin(), force.end());
    result.insert(result.end(), torque.begin(), torque.end());
  }
  return result;
}

/// The readings of sensors, quaternions as x, y, z, w.
std::vector<double> readings(const Scene& scene, const kreisel::SceneSolver& model,
                             const kreisel::SceneFile& file) {
  std::vector<double> result =
      kreisel::SensorReadings(file).row(model, file.t_begin, start_of(file));
  auto at = result.begin();
  for (const Sensor& sensor : scene.sensors) {
    for (const int count : parts_of(scene, sensor)) {
      if (count == 4) std::rotate(at, at + 1, at + 4);
      at += count;
    }
  }
  return result;
}

/// The sensors' readings in the first rows, all for the state at the start.
std::vector<double> first_rows(const kreisel::SceneSolver& model, const kreisel::SceneFile& file) {
  kreisel::SensorReadings readings(file);
  std::vector<double> result;
  for (std::size_t i = 0; i < std::min<std::size_t>(file.output_times.size(), 3); ++i) {
    const auto row = readings.row(model, file.output_times[i], start_of(file));
    result.insert(result.end(), row.begin(), row.end());
  }
  return result;
}

/// True if random errors are not the same a second time, or do not change with the seed.
bool is_wrongly_random(const Scene& scene, const kreisel::SceneSolver& model,
                       kreisel::SceneFile file) {
  const auto counts = [](const Sensor& sensor) {
    return sensor.errors && sensor.errors->noise.minCoeff() > 0 && sensor.errors->resolution == 0 &&
           sensor.errors->range == 0 && sensor.increments.empty();
  };
  if (std::none_of(scene.sensors.begin(), scene.sensors.end(), counts)) return false;
  const std::vector<double> first = first_rows(model, file);
  if (first_rows(model, file) != first) return true;
  for (auto& sensor : file.sensors) {
    if (sensor.errors) ++sensor.errors->seed;
  }
  return first_rows(model, file) == first;
}

bool misread(const Scene& scene, const kreisel::SceneFile& file) {
  const bool other_method =
      !scene.method.empty() && file.method != kreisel::method_named(scene.method);
  const auto loose = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                   [](const Body& body) { return body.loose; });
  const std::size_t constraints = scene.constraints.size() + static_cast<std::size_t>(loose);
  return other_method || file.title != scene.title || file.reactions != scene.reports ||
         file.constraints.size() != constraints || file.element_forces != scene.reports ||
         file.elements.size() != scene.elements.size() || file.terms != scene.reports;
}

/// Terms that the report both keeps and drops.
std::vector<std::string> contradictions(const kreisel::Terms& terms) {
  std::set<std::string> kept;
  bool weight = false;
  for (const kreisel::Term& term : terms) {
    if (!term.kept) continue;
    kept.insert(term.part + ": " + term.name);
    weight = weight || (term.part == "load" && term.name.find("gravit") != std::string::npos);
  }
  std::vector<std::string> result;
  for (const kreisel::Term& term : terms) {
    if (term.kept) continue;
    const std::string name = term.part + ": " + term.name;
    const bool none = term.why.find("none is given") != std::string::npos;
    const bool about_weight = name.find("gravit") != std::string::npos;
    if (kept.contains(name) || (weight && none && about_weight)) result.push_back(name);
  }
  return result;
}

}  // namespace

Answers run(const Scene& scene, const std::vector<std::string>& methods, const Limits& limits,
            const std::filesystem::path& folder,
            const std::function<void(const std::string&)>& begin) {
  Answers answers;
  try {
    begin("reader");
    write_logs(scene, folder);
    const kreisel::SceneFile file = kreisel::parse_scene(to_toml(scene), folder / "scene.toml");
    const kreisel::SceneFile exact_file = without_model(file);
    const std::unique_ptr<kreisel::SceneSolver> model = make_model(exact_file);
    answers.contradictions = contradictions(model->equation_terms());
    answers.misread = misread(scene, file);
    for (const std::string& method : methods) {
      const auto& before = answers.by_method;
      if (method == "gauss16" && !before.empty() && !suits_equal_steps(scene, before.front())) {
        continue;
      }
      begin(method);
      answers.by_method.push_back(run_by(*model, scene, exact_file, method, limits));
    }
    if (file.reactions && answers.by_method.front().answered) {
      begin("reactions");
      answers.reactions = reactions(*model, file);
    }
    if (!scene.sensors.empty()) {
      begin("sensors");
      answers.readings = readings(scene, *model, file);
      answers.wrongly_random = is_wrongly_random(scene, *model, exact_file);
      answers.wrong_increments = wrong_increments(*model, exact_file);
    }
    begin("sizes");
    answers.way = run_by(*model, scene, with_many_outputs(roughly(exact_file)), "auto", limits);
    begin("the end alone");
    answers.end = run_by(*model, scene, with_one_output(roughly(exact_file)), "auto", limits);
    if (!scene.model.empty()) {
      begin("model " + scene.model);
      answers.approximate = approximate(scene, file, limits);
    }
  } catch (const std::exception& error) {
    answers.refused = error.what();
  }
  return answers;
}

}  // namespace differential
