// simulate: integrates the motion of a scene file to a tolerance of the global error.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/text_file.hpp>
#include <motor/error.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/outputs.hpp"
#include "../shared/progress.hpp"
#include "output.hpp"
#include "request.hpp"
#include "resume_file.hpp"
#include "row_file.hpp"

using namespace kreisel;

namespace {

using kreisel::RunStatus;

constexpr double before_all = -std::numeric_limits<double>::infinity();

/// The start of a run, or the point from which it continues.
struct Begin {
  kreisel::SolveOptions options;
  kreisel::JointState state;
  double latest = before_all;                  ///< time of the last existing row
  std::vector<std::vector<double>> rows = {};  ///< the rows that are kept
};

Begin from_the_start(const kreisel::SceneFile& scene) {
  return {options_of(scene), start_of(scene)};
}

/// A run that starts with the state of a row.
Begin from_row(const kreisel::SceneSolver& model, const kreisel::SceneFile& scene,
               const std::vector<double>& row) {
  Begin begin = from_the_start(scene);
  begin.latest = row.front();
  begin.options.begin = begin.latest;
  begin.state = state_of(model, row);
  std::erase_if(begin.options.output_times, [&](double t) { return t <= begin.latest; });
  if (begin.options.output_times.empty()) begin.options.output_times.push_back(scene.t_end);
  return begin;
}

/// The text of a scene with the values that replace some of it.
std::string with_settings(std::string text, const kreisel::SolveRequest& request) {
  for (const auto& [key, value, place] : request.settings) {
    text.append(key).append("=").append(value).append("\n");
  }
  return text;
}

/// The rows and the checkpoint of a run, both written during the computation.
struct Record {
  Record(const Request& request, const std::string& scene_text, const kreisel::SceneFile& scene,
         const kreisel::SceneSolver& solver)
      : model(solver),
        t_begin(scene.t_begin),
        forces{scene.reactions, scene.element_forces, scene.constraint_forces},
        sensors(scene),
        chosen(scene.columns.empty() ? std::vector<std::size_t>{}
                                     : chosen_columns(columns(scene), scene.columns)),
        rows(*request.csv, of_chosen(columns(scene))),
        resume(*request.csv, identity(with_settings(scene_text, request.solve), scene)) {}

  const kreisel::SceneSolver& model;
  double t_begin;
  kreisel::RowForces forces;
  kreisel::SensorReadings sensors;
  std::vector<std::size_t> chosen;  ///< columns; empty: all
  RowFile rows;
  ResumeFile resume;
  std::vector<std::vector<double>> earlier = {};    ///< rows before this run that sensors depend on
  std::chrono::steady_clock::time_point next = {};  ///< when the next checkpoint is due

  /// The numbers of a row, in the order of the columns. Sensors that depend on earlier rows read the
  /// states that these hold, so that a continued run gives the same readings.
  [[nodiscard]] std::vector<double> numbers_at(double t, const kreisel::JointState& state) {
    std::vector<double> numbers = row(model, t, state, forces);
    const std::vector<double> own =
        sensors.row(model, t, sensors.need_all_rows() ? state_of(model, numbers) : state);
    numbers.insert(numbers.end(), own.begin(), own.end());
    return of_chosen(std::move(numbers));
  }

  /// Brings the sensors to their state after the earlier rows up to t.
  void read_up_to(double t) {
    for (const auto& numbers : earlier) {
      if (numbers.front() > t) break;
      (void)sensors.row(model, numbers.front(), state_of(model, numbers));
    }
  }

  /// The entries of the chosen columns.
  template <class Entry>
  [[nodiscard]] std::vector<Entry> of_chosen(std::vector<Entry> all) const {
    if (chosen.empty()) return all;
    std::vector<Entry> result;
    for (const std::size_t i : chosen) result.push_back(all[i]);
    return result;
  }

  /// Writes the checkpoint of a run that starts after these rows, or removes it if the run starts
  /// at t_begin.
  void begin_behind(double t, const RowFile::Mark& end) const {
    if (t > t_begin) {
      resume.write({t, t, end, {}});
    } else {
      resume.remove();
    }
  }

  /// Starts again. Rows are removed first: after a kill in between, the checkpoint does not match
  /// the rows, and the next run starts again too.
  void begin_again(double begin) {
    rows.begin_again();
    read_up_to(begin);
    if (const auto end = rows.end()) begin_behind(begin, *end);
    next = {};
  }

  /// Writes a checkpoint every 50 ms, or less often if that would take over 5 % of the time.
  template <class Take>
  void offer(double begin, double t, const Take& take) {
    const auto end = rows.end();
    const auto now = std::chrono::steady_clock::now();
    if (!end || now < next) return;
    resume.write({begin, t, *end, take()});
    const auto written = std::chrono::steady_clock::now();
    next = std::max(now + std::chrono::milliseconds(50), written + 20 * (written - now));
  }
};

void refuse_rows(const RowFile& file, const std::string& why) {
  throw kreisel::InvalidInput(file.place().string() + ": --resume: " + why);
}

/// The row at that time; nothing if there is none.
const RowFile::Row* row_at(const std::vector<RowFile::Row>& rows, double t) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [t](const auto& row) { return row.values.front() == t; });
  return found == rows.end() ? nullptr : &*found;
}

/// Continues from a checkpoint; nothing if it does not match the rows.
std::optional<Begin> from_checkpoint(const kreisel::SceneSolver& model,
                                     const kreisel::SceneFile& scene,
                                     const std::vector<RowFile::Row>& rows, RowFile& file,
                                     Checkpoint& checkpoint) {
  const RowFile::Row* const last = row_at(rows, checkpoint.t);
  const bool goes_on = checkpoint.begin > scene.t_begin;
  const RowFile::Row* const first = goes_on ? row_at(rows, checkpoint.begin) : nullptr;
  if (last == nullptr || last->end != checkpoint.row) return std::nullopt;
  if (goes_on && first == nullptr) return std::nullopt;
  Begin begin = first != nullptr ? from_row(model, scene, first->values) : from_the_start(scene);
  begin.latest = checkpoint.t;
  begin.options.checkpoint = std::move(checkpoint.numbers);
  file.go_on(first != nullptr ? std::optional(first->end) : std::nullopt, last->end);
  fmt::print(stderr, "simulate: going on from t = {:.17g} s\n", begin.latest);
  return begin;
}

/// Continues the rows of a file, from its checkpoint if there is one.
///
/// Throws : kreisel::InvalidInput if the file's rows do not belong to this scene
Begin from_rows(const kreisel::SceneSolver& model, Record& record,
                const kreisel::SceneFile& scene) {
  const std::vector<RowFile::Row> rows = record.rows.read_rows();
  Begin begin = from_the_start(scene);
  if (rows.empty()) return begin;
  const std::vector<double>& start = rows.front().values;
  if (start.front() == scene.t_begin && start != record.numbers_at(scene.t_begin, begin.state)) {
    refuse_rows(record.rows, "the rows begin with another state than the scene");
  }
  const RowFile::Row& last = rows.back();
  if (last.values.front() > scene.t_end) refuse_rows(record.rows, "the rows go on after t_end");
  std::string why_not;
  std::optional<Checkpoint> checkpoint = record.resume.read(why_not);
  std::optional<Begin> found;
  if (checkpoint) {
    found = from_checkpoint(model, scene, rows, record.rows, *checkpoint);
    why_not = "does not belong to these rows, which were changed since";
  }
  if (found) {
    begin = *std::move(found);
  } else if (last.values.front() <= scene.t_begin) {
    record.rows.go_on(std::nullopt, std::nullopt);
    fmt::print(stderr, "simulate: beginning again, for there is no row but the start\n");
  } else {
    begin = from_row(model, scene, last.values);
    record.rows.go_on(last.end, last.end);
    record.begin_behind(begin.latest, last.end);
    fmt::print(stderr,
               "simulate: going on from t = {:.17g} s with new steps, for {} {}; how the error of "
               "the rows grows from there is not in the error estimate\n",
               last.values.front(), record.resume.place().string(), why_not);
  }
  for (const RowFile::Row& row : rows) {
    if (row.values.front() <= begin.latest) begin.rows.push_back(row.values);
  }
  if (record.sensors.need_all_rows()) {
    record.earlier = begin.rows;
    record.read_up_to(begin.latest);
  }
  return begin;
}

/// Inserts the states of earlier rows before those of a continued run.
void put_before(kreisel::Trajectory<kreisel::JointState>& run, const kreisel::SceneSolver& model,
                const std::vector<std::vector<double>>& rows) {
  std::vector<double> times;
  std::vector<kreisel::JointState> states;
  for (const auto& row : rows) {
    if (row.front() >= run.times.front()) break;
    times.push_back(row.front());
    states.push_back(state_of(model, row));
  }
  run.times.insert(run.times.begin(), times.begin(), times.end());
  run.states.insert(run.states.begin(), states.begin(), states.end());
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  run.errors.insert(run.errors.begin(), times.size(), unknown);
}

/// Computes the run and writes its rows. After a signal it ends early, and `latest` is the time
/// that was reached.
kreisel::Trajectory<kreisel::JointState> compute(const kreisel::SceneFile& scene,
                                                 const kreisel::SceneSolver& model, Begin& begin,
                                                 std::optional<Record>& record, double& latest) {
  kreisel::SolveOptions& options = begin.options;
  options.stop = signals::token();
  const bool end_is_a_row = !scene.output_times.empty() && scene.output_times.back() == scene.t_end;
  if (record) {
    options.offer_checkpoint = [&](const auto& take) {
      record->offer(options.begin, latest, take);
    };
  }
  Progress progress;
  const auto on_output = [&](double t, const kreisel::JointState& state) {
    if (record && t <= latest) record->begin_again(options.begin);
    latest = t;
    const bool is_there =
        options.begin > scene.t_begin && t == options.begin;  // the end of a run that was complete
    if (record && !is_there && (end_is_a_row || t < scene.t_end)) {
      record->rows.write(record->numbers_at(t, state));
    }
    progress.report((t - scene.t_begin) / scene.duration(),
                    [&] { return fmt::format("t = {:.4g} of {:.4g} s", t, scene.t_end); });
    return signals::caught() == 0 ? OutputAction::proceed : OutputAction::stop;
  };
  try {
    auto run = model.solve(options, begin.state, on_output);
    if (record) record->rows.close();
    return run;
  } catch (const std::exception&) {
    if (signals::caught() == 0) throw;
    kreisel::Trajectory<kreisel::JointState> none;  // the signal is the reason
    none.report.status = RunStatus::cancelled;
    return none;
  }
}

void print(const Result& result, bool as_json) {
  if (as_json) {
    print_json(result);
  } else {
    print_summary(result);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
}

int run(const Request& request) {
  const std::string text = kreisel::read_text(request.scene, kreisel::largest_scene_file);
  kreisel::SceneFile scene = kreisel::parse_scene(text, request.scene, request.solve);
  scene.reactions = scene.reactions || request.reactions;
  scene.terms = scene.terms || request.terms;
  if (request.resume && scene.model != kreisel::SceneModel::exact) {
    throw kreisel::InvalidInput("--resume: an approximation is computed as a whole");
  }
  if (request.resume && !scene.columns.empty()) {
    throw kreisel::InvalidInput("--resume: the rows hold the columns of [output] alone, no states");
  }
  const std::unique_ptr<kreisel::SceneSolver> model = make_model(scene);
  std::optional<Record> record;
  if (request.csv) {
    const auto inputs = files_read(request.scene, scene);
    outputs::refuse_input("--csv", *request.csv, inputs);
    outputs::refuse_input("--csv", request.csv->string() + ".resume", inputs);
    record.emplace(request, text, scene, *model);
    outputs::leave_standard_output_to(*request.csv);
  }
  Begin begin = request.resume ? from_rows(*model, *record, scene) : from_the_start(scene);
  double latest = begin.latest;
  kreisel::Trajectory<kreisel::JointState> trajectory =
      compute(scene, *model, begin, record, latest);
  const kreisel::RunReport& report = trajectory.report;
  const double reached =
      trajectory.times.empty() ? std::max(scene.t_begin, latest) : trajectory.times.back();
  const bool complete = reached == scene.t_end && report.status == RunStatus::complete;
  if (signals::caught() != 0 && !complete) {
    fmt::print(stderr, "simulate: interrupted after t = {:.9g} of {:.9g} s{}\n", reached,
               scene.t_end,
               record ? "; rows up to there are kept, and --resume goes on with them" : "");
    return exit_status::of_signal();
  }
  if (report.status == RunStatus::failed) {
    throw kreisel::ComputationFailed(
        fmt::format("failed after t = {:.9g} s: {}", reached, report.message));
  }
  put_before(trajectory, *model, begin.rows);
  const auto log_error = error_of_logs(scene, *model, trajectory, signals::token());
  if (!log_error) {
    fmt::print(stderr, "simulate: interrupted while the error of the log was estimated\n");
    return exit_status::of_signal();
  }
  const Result result{scene,
                      *model,
                      trajectory,
                      scene.reactions,
                      scene.terms,
                      *log_error,
                      SensorReadings(scene).last_row(*model, trajectory)};
  require_finite(result);
  print(result, request.json);
  if (request.plot) draw(result, *request.plot);
  if (record) record->resume.remove();
  if (!report.tolerance_kept) {
    fmt::print(stderr,
               "simulate: the tolerance {:.1e} was not reached, the error is about {:.1e}\n",
               report.tolerance, report.error_estimate);
  }
  if (signals::caught() != 0) return exit_status::of_signal();
  return report.tolerance_kept ? exit_status::complete : exit_status::tolerance_missed;
}

}  // namespace

int main(int argc, char** argv) {
  signals::watch();
  return exit_status::of("simulate", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : exit_status::complete;
  });
}
