// simulate: the motion that a scene file describes, computed to a tolerance of the global error.

#include <fmt/core.h>

#include <csignal>
#include <cstdio>
#include <limits>
#include <optional>

#include <motor/error.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/progress.hpp"
#include "columns.hpp"
#include "output.hpp"
#include "request.hpp"
#include "row_file.hpp"

namespace {

using kreisel::RunStatus;

volatile std::sig_atomic_t interrupted = 0;

extern "C" void on_interrupt(int /*signal*/) { interrupted = 1; }

/// A run as far as the rows of a file go.
struct Begin {
  double t = 0;
  JointState state;
};

/// Throws : kreisel::InvalidInput where the file's rows are not of this scene
Begin last_row(const Model& model, RowFile& file, const kreisel::SceneFile& scene, bool reactions) {
  const auto rows = file.keep_rows();
  const JointState start = start_of(scene);
  if (rows.front().front() == 0 && rows.front() != row(model, 0, start, reactions)) {
    throw kreisel::InvalidInput("--resume: the rows begin with another state than the scene");
  }
  const double t = rows.back().front();
  if (t > scene.t_end) throw kreisel::InvalidInput("--resume: the rows go on after t_end");
  return {t, state_of(model.tree(), rows.back())};
}

/// The output times after `begin`, and the end.
std::vector<double> times(const kreisel::SceneFile& scene, double begin, bool resumed) {
  std::vector<double> result;
  for (const double t : scene.output_times) {
    if (!resumed || t > begin) result.push_back(t);
  }
  if (result.empty() || result.back() < scene.t_end) result.push_back(scene.t_end);
  return result;
}

int run(const Request& request) {
  kreisel::SceneFile scene = kreisel::read_scene(request.scene, request.solve);
  scene.reactions = scene.reactions || request.reactions;
  scene.terms = scene.terms || request.terms;
  const std::unique_ptr<Model> model = make_model(scene);
  std::optional<RowFile> file;
  if (request.csv) file.emplace(*request.csv, columns(model->tree(), scene.reactions));
  Begin begin{0, start_of(scene)};
  if (request.resume) {
    begin = last_row(*model, *file, scene, scene.reactions);
    fmt::print(stderr,
               "simulate: going on from t = {:.17g} s; how what the rows are off by grows from "
               "there is not in the error estimate\n",
               begin.t);
  }

  kreisel::Task task;
  task.begin = begin.t;
  task.times = times(scene, begin.t, request.resume);
  task.tolerance = scene.tolerance;
  task.method = scene.method;
  const bool end_is_a_row = !scene.output_times.empty() && scene.output_times.back() == scene.t_end;
  double latest = -std::numeric_limits<double>::infinity();
  kreisel::Trajectory<JointState> trajectory;
  {
    Progress progress;
    const auto listener = [&](double t, const JointState& state) {
      if (file && t <= latest) file->begin_again();
      latest = t;
      const bool is_new = !request.resume || t > begin.t;
      const bool is_row = is_new && (end_is_a_row || t < scene.t_end);
      if (file && is_row) file->write(row(*model, t, state, scene.reactions));
      progress.report((t - begin.t) / (scene.t_end - begin.t),
                      [&] { return fmt::format("t = {:.4g} of {:.4g} s", t, scene.t_end); });
      return interrupted == 0;
    };
    trajectory = model->solve(task, begin.state, listener, [] { return interrupted != 0; });
  }
  if (file) file->close();
  const kreisel::RunReport& report = trajectory.report;
  const double reached = trajectory.times.empty() ? begin.t : trajectory.times.back();
  if (interrupted != 0 && !(reached == scene.t_end && report.status == RunStatus::complete)) {
    fmt::print(stderr,
               "simulate: interrupted after t = {:.9g} of {:.9g} s; rows up to there are "
               "kept\n",
               reached, scene.t_end);
    return 130;
  }
  if (report.status == RunStatus::failed) {
    throw kreisel::ComputationFailed(
        fmt::format("failed after t = {:.9g} s: {}", reached, report.message));
  }
  const Result result{scene, *model, trajectory, scene.reactions, scene.terms};
  if (request.plot) draw(result, *request.plot);
  if (request.json) {
    print_json(result);
  } else {
    print_summary(result);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  if (!report.tolerance_kept) {
    fmt::print(stderr,
               "simulate: the tolerance {:.1e} was not reached, the error is about {:.1e}\n",
               report.tolerance, report.error_estimate);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  return exit_status("simulate", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : 0;
  });
}
