// simulate: the motion that a scene file describes, computed to a tolerance of the global error.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <motor/error.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/progress.hpp"
#include "columns.hpp"
#include "output.hpp"
#include "request.hpp"
#include "resume_file.hpp"
#include "row_file.hpp"

namespace {

using kreisel::RunStatus;

/// Where a run begins, or goes on.
struct Begin {
  kreisel::Task task;
  JointState state;
  double latest = -std::numeric_limits<double>::infinity();  ///< of the rows that are there
  std::vector<std::vector<double>> rows = {};                ///< those that are kept
};

Begin from_the_start(const kreisel::SceneFile& scene) {
  Begin begin{{}, start_of(scene)};
  begin.task.times = scene.output_times;
  if (begin.task.times.empty() || begin.task.times.back() < scene.t_end) {
    begin.task.times.push_back(scene.t_end);
  }
  begin.task.tolerance = scene.tolerance;
  begin.task.method = scene.method;
  return begin;
}

/// Goes on with the rows of a file, from the bookmark if there is one of them.
///
/// Throws : kreisel::InvalidInput where the file's rows are not of this scene
Begin from_rows(const Model& model, RowFile& file, const ResumeFile& resume,
                const kreisel::SceneFile& scene) {
  Begin begin = from_the_start(scene);
  auto rows = file.keep_rows();
  if (rows.empty()) return begin;
  if (rows.front().front() == 0 && rows.front() != row(model, 0, begin.state, scene.reactions)) {
    throw kreisel::InvalidInput("--resume: the rows begin with another state than the scene");
  }
  if (rows.back().front() > scene.t_end) {
    throw kreisel::InvalidInput("--resume: the rows go on after t_end");
  }
  auto bookmark = resume.read();
  if (bookmark && file.go_on_behind(bookmark->bytes)) {
    std::erase_if(rows, [&](const auto& row) { return row.front() > bookmark->t; });
    begin.task.bookmark = std::move(bookmark->numbers);
    begin.latest = bookmark->t;
    fmt::print(stderr, "simulate: going on from t = {:.17g} s\n", begin.latest);
  } else {
    begin.latest = rows.back().front();
    begin.task.begin = begin.latest;
    begin.state = state_of(model.tree(), rows.back());
    std::erase_if(begin.task.times, [&](double t) { return t <= begin.latest; });
    if (begin.task.times.empty()) begin.task.times.push_back(scene.t_end);
    fmt::print(stderr,
               "simulate: going on from t = {:.17g} s with new steps, for {}.resume is missing or "
               "of another run; how what the rows are off by grows from there is not in the error "
               "estimate\n",
               begin.latest, file.place().string());
  }
  begin.rows = std::move(rows);
  return begin;
}

/// The states of rows before those of a run that went on with them.
void put_before(kreisel::Trajectory<JointState>& run, const Model& model,
                const std::vector<std::vector<double>>& rows) {
  std::vector<double> times;
  std::vector<JointState> states;
  for (const auto& row : rows) {
    if (row.front() >= run.times.front()) break;
    times.push_back(row.front());
    states.push_back(state_of(model.tree(), row));
  }
  run.times.insert(run.times.begin(), times.begin(), times.end());
  run.states.insert(run.states.begin(), states.begin(), states.end());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  run.errors.insert(run.errors.begin(), times.size(), unknown);
}

/// Takes down where the run is, every fifth of a second.
class Bookmarks {
 public:
  explicit Bookmarks(const ResumeFile& file) : file_(file) {}

  void begin_again() { latest_ = {}; }

  template <class Take>
  void offer(double t, long long bytes, const Take& take) {
    const auto now = std::chrono::steady_clock::now();
    if (latest_ && now - *latest_ < std::chrono::milliseconds(200)) return;
    latest_ = now;
    file_.write({t, bytes, take()});
  }

 private:
  const ResumeFile& file_;
  std::optional<std::chrono::steady_clock::time_point> latest_;
};

int run(const Request& request) {
  kreisel::SceneFile scene = kreisel::read_scene(request.scene, request.solve);
  scene.reactions = scene.reactions || request.reactions;
  scene.terms = scene.terms || request.terms;
  if (request.resume && scene.model != kreisel::SceneModel::exact) {
    throw kreisel::InvalidInput("--resume: an approximation is computed as a whole");
  }
  const std::unique_ptr<Model> model = make_model(scene);
  std::optional<RowFile> file;
  std::optional<ResumeFile> resume;
  std::optional<Bookmarks> bookmarks;
  if (request.csv) {
    file.emplace(*request.csv, columns(model->tree(), scene.reactions));
    resume.emplace(*request.csv, identity(request.scene, scene));
    bookmarks.emplace(*resume);
  }
  Begin begin = request.resume ? from_rows(*model, *file, *resume, scene) : from_the_start(scene);
  kreisel::Task& task = begin.task;
  const bool end_is_a_row = !scene.output_times.empty() && scene.output_times.back() == scene.t_end;
  double latest = begin.latest;
  if (bookmarks) {
    task.offer_bookmark = [&](const auto& take) {
      const auto bytes = file->bytes();
      if (bytes) bookmarks->offer(latest, *bytes, take);
    };
  }
  kreisel::Trajectory<JointState> trajectory;
  {
    Progress progress;
    const auto listener = [&](double t, const JointState& state) {
      if (file && t <= latest) {
        file->begin_again();
        bookmarks->begin_again();
      }
      latest = t;
      const bool is_there =
          task.begin > 0 && t == task.begin;  // the end of a run that was complete
      if (file && !is_there && (end_is_a_row || t < scene.t_end)) {
        file->write(row(*model, t, state, scene.reactions));
      }
      progress.report(t / scene.t_end,
                      [&] { return fmt::format("t = {:.4g} of {:.4g} s", t, scene.t_end); });
      return signals::caught() == 0;
    };
    trajectory = model->solve(task, begin.state, listener, [] { return signals::caught() != 0; });
  }
  if (file) file->close();
  const kreisel::RunReport& report = trajectory.report;
  const double reached =
      trajectory.times.empty() ? std::max(0.0, begin.latest) : trajectory.times.back();
  if (signals::caught() != 0 && !(reached == scene.t_end && report.status == RunStatus::complete)) {
    fmt::print(stderr, "simulate: interrupted after t = {:.9g} of {:.9g} s{}\n", reached,
               scene.t_end,
               file ? "; rows up to there are kept, and --resume goes on with them" : "");
    return exit_status::of_signal();
  }
  if (report.status == RunStatus::failed) {
    throw kreisel::ComputationFailed(
        fmt::format("failed after t = {:.9g} s: {}", reached, report.message));
  }
  if (resume) resume->remove();
  put_before(trajectory, *model, begin.rows);
  const Result result{scene, *model, trajectory, scene.reactions, scene.terms};
  require_finite(result);
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
  return report.tolerance_kept ? exit_status::complete : exit_status::tolerance_missed;
}

}  // namespace

int main(int argc, char** argv) {
  signals::watch();
  return exit_status::of("simulate", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : 0;
  });
}
