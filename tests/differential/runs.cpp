#include "runs.hpp"

#include <algorithm>
#include <ctime>
#include <exception>
#include <fstream>
#include <memory>
#include <set>

#include <dynamics/file/model.hpp>
#include <dynamics/file/scene_file.hpp>
#include <motor/error.hpp>

using namespace kreisel;

namespace differential {

namespace {

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// The joints' values in the order of JointValues.
JointValues values(const kreisel::BodyTree& tree, const Scene& scene,
                   const kreisel::JointState& state) {
  static constexpr int coordinates[] = {0, 1, 1, 2, 4, 7};
  static constexpr int rates[] = {0, 1, 1, 2, 3, 6};
  JointValues result;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto kind = static_cast<std::size_t>(scene.bodies[i].kind);
    if (coordinates[kind] == 0) continue;
    const auto place = tree.place(static_cast<int>(i));
    const auto put = [&result](const Eigen::VectorXd& from, int begin, int count) {
      for (int k = 0; k < count; ++k) result.push_back(from[begin + k]);
    };
    put(state.coordinates, place.q, coordinates[kind]);
    put(state.rates, place.v, rates[kind]);
  }
  return result;
}

Answer run_by(const kreisel::SceneSolver& model, const Scene& scene, const kreisel::SceneFile& file,
              const std::string& method, const Limits& limits) {
  Answer answer{.asked = method};
  kreisel::Task task;
  task.times = file.output_times;
  task.tolerance = file.tolerance;
  task.method = *kreisel::method_named(method);
  task.most_evaluations = limits.evaluations;
  const double end = processor_seconds() + limits.seconds;
  unsigned calls = 0;
  bool late = false;
  const auto too_long = [&] {
    if (++calls % 64 == 0) late = processor_seconds() > end;
    return late;
  };
  try {
    const auto run = model.solve(
        task, start_of(file), [](double, const kreisel::JointState&) { return true; }, too_long);
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
      (late || answer.message.find("evaluations are spent") != std::string::npos);
  return answer;
}

/// The same scene, computed no finer than to 1e-6.
kreisel::SceneFile roughly(kreisel::SceneFile file) {
  file.tolerance = std::max(file.tolerance, 1e-6);
  return file;
}

/// The same scene at 300 times between its outputs, and at more and more before the first of them.
kreisel::SceneFile with_many_outputs(kreisel::SceneFile file) {
  constexpr int many = 320;
  file.output_times = {0};
  for (double part = 1e-8; part < 1; part *= 1.5) {
    file.output_times.push_back(part * (file.t_end / many));
  }
  for (int i = 1; i <= many; ++i) file.output_times.push_back(i * (file.t_end / many));
  return file;
}

kreisel::SceneFile with_one_output(kreisel::SceneFile file) {
  file.output_times = {file.t_end};
  return file;
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
    for (std::size_t i = 0; i < scene.guide.size(); ++i) {
      if (scene.guide[i].kind != LinkKind::table) continue;
      std::ofstream(folder / log_name(i)) << scene.guide[i].log.csv(scene.t_end);
    }
    const kreisel::SceneFile file = kreisel::parse_scene(to_toml(scene), folder / "scene.toml");
    const std::unique_ptr<kreisel::SceneSolver> model = make_model(file);
    answers.contradictions = contradictions(model->equation_terms());
    for (const std::string& method : methods) {
      begin(method);
      answers.by_method.push_back(run_by(*model, scene, file, method, limits));
    }
    begin("sizes");
    answers.way = run_by(*model, scene, with_many_outputs(roughly(file)), "auto", limits);
    begin("the end alone");
    answers.end = run_by(*model, scene, with_one_output(roughly(file)), "auto", limits);
  } catch (const std::exception& error) {
    answers.refused = error.what();
  }
  return answers;
}

}  // namespace differential
