// ensemble: runs a scene file many times with varied numbers, and reports the final states.

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <stop_token>
#include <string>
#include <vector>

#include <dynamics/ensemble/workers.hpp>
#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/csv.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/file/readings.hpp>
#include <dynamics/file/scene_numbers.hpp>
#include <dynamics/file/text_file.hpp>
#include <motor/error.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/outputs.hpp"
#include "../shared/progress.hpp"
#include "request.hpp"

using namespace kreisel;

namespace {

using kreisel::RunStatus;

struct Member {
  RunStatus status = RunStatus::cancelled;
  std::string message;         ///< of a failed member
  std::vector<double> varied;  ///< in the order of the keys
  std::vector<double> end;     ///< joints and sensors, in the order of simulate's rows
  double error = 0;
  bool tolerance_kept = false;
};

/// The scene, the keys of its varied numbers, and the columns common to its members.
struct Scene {
  const Request& request;
  std::vector<std::string> keys;  ///< of the varied numbers
  kreisel::SceneNumbers numbers;
  std::vector<std::string> columns;
};

Scene read(const Request& request) {
  // Reports mistakes that all members would share.
  const std::string text = kreisel::read_text(request.scene, kreisel::largest_scene_file);
  kreisel::SceneFile file = kreisel::parse_scene(text, request.scene, request.solve);
  if (request.csv) outputs::refuse_input("--csv", *request.csv, files_read(request.scene, file));
  std::vector<std::string> keys;
  for (const Variation& variation : request.variations) {
    keys.insert(keys.end(), variation.keys.begin(), variation.keys.end());
  }
  (void)make_model(file);  // refuses what the reader cannot
  file.reactions = false;
  file.element_forces = false;
  file.constraint_forces = false;
  std::vector<std::string> names = columns(file);
  names.erase(names.begin());  // the time
  return {request, keys, kreisel::SceneNumbers(text, keys), std::move(names)};
}

/// Runs a member as simulate runs a file with the numbers drawn.
Member compute(const Scene& scene, std::size_t index, const std::stop_token& stop) {
  const Request& request = scene.request;
  Member member;
  kreisel::MemberRandom random(request.seed, index);
  const double share = request.members == 1
                           ? 0
                           : static_cast<double>(index) / static_cast<double>(request.members - 1);
  for (const Variation& variation : request.variations) {
    const double drawn = variation.drawn(share, random);
    for (std::size_t k = 0; k < variation.keys.size(); ++k) {
      const double given = scene.numbers.values()[member.varied.size()];
      member.varied.push_back(variation.applied(given, drawn));
    }
  }
  try {
    kreisel::SceneFile file =
        kreisel::parse_scene(scene.numbers.with(member.varied), request.scene, request.solve);
    for (kreisel::SceneSensor& sensor : file.sensors) {
      if (sensor.errors) sensor.errors->seed += index;  // each member has its own noise
    }
    const auto model = make_model(file);
    kreisel::SolveOptions options = options_of(file);
    options.stop = stop;
    const auto run = model->solve(options, start_of(file));
    member.status = run.report.status;
    member.message = run.report.message;
    if (run.report.status != RunStatus::complete) return member;
    member.end = row(*model, file.t_end, run.states.back(), {});
    member.end.erase(member.end.begin());
    const std::vector<double> readings = kreisel::SensorReadings(file).last_row(*model, run);
    member.end.insert(member.end.end(), readings.begin(), readings.end());
    member.error = run.report.error_estimate;
    member.tolerance_kept = run.report.tolerance_kept;
    const auto finite = [](double x) { return std::isfinite(x); };
    if (!finite(member.error) || !std::all_of(member.end.begin(), member.end.end(), finite)) {
      member.status = RunStatus::failed;
      member.message = "the end of the motion or its error is not finite";
    }
  } catch (const std::exception& error) {
    if (stop.stop_requested()) return member;  // cancelled
    member.status = RunStatus::failed;
    member.message = error.what();  // several lines for a scene
    std::replace(member.message.begin(), member.message.end(), '\n', ';');
  }
  return member;
}

std::vector<Member> compute(const Scene& scene) {
  std::vector<Member> members(scene.request.members);
  Progress progress;
  const auto report = [&](double share) {
    progress.report(share, [&] { return fmt::format("of {} members", members.size()); });
    return signals::caught() == 0;
  };
  [[maybe_unused]] const bool all = kreisel::parallel_for(
      members.size(), {scene.request.threads, report, signals::token()},
      [&](std::size_t i, const std::stop_token& stop) { members[i] = compute(scene, i, stop); });
  return members;
}

void write_csv(kreisel::AtomicFile& file, const Scene& scene, const std::vector<Member>& members) {
  std::ostream& out = file.stream();
  out << "member";
  for (const std::string& key : scene.keys) out << ',' << kreisel::csv_field(key);
  for (const std::string& name : scene.columns) out << ',' << kreisel::csv_field(name);
  out << ",error_estimate,message\n";
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& member = members[i];
    if (member.status == RunStatus::cancelled) continue;
    out << i;
    for (const double x : member.varied) out << fmt::format(",{:.17g}", x);
    for (std::size_t k = 0; k < scene.columns.size(); ++k) {
      out << (member.end.empty() ? "," : fmt::format(",{:.17g}", member.end[k]));
    }
    if (member.status == RunStatus::complete) {
      out << fmt::format(",{:.17g},\n", member.error);
    } else {
      out << ",," << kreisel::csv_field(member.message) << '\n';
    }
  }
  file.commit();
}

/// The statistics of a column, summed in the order of members.
struct Statistics {
  std::string name;
  double count = 0, mean = 0, squares = 0;
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double x) {
    count += 1;
    const double off = x - mean;
    mean += off / count;
    squares += off * (x - mean);
    least = std::min(least, x);
    greatest = std::max(greatest, x);
  }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / std::max(1.0, count - 1)); }
};

/// The number of members of each kind, and the spread of the complete ones.
struct Summary {
  std::size_t complete = 0, failed = 0, off = 0;
  double error = 0;
  std::string message;  ///< of the first failed member
  std::vector<Statistics> columns;
};

Summary summary(const Scene& scene, const std::vector<Member>& members) {
  Summary result;
  for (const std::string& key : scene.keys) result.columns.push_back({key});
  for (const std::string& name : scene.columns) result.columns.push_back({name});
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Member& member = members[i];
    if (member.status == RunStatus::failed) {
      if (result.failed++ == 0) result.message = fmt::format("member {}: {}", i, member.message);
    }
    if (member.status != RunStatus::complete) continue;
    ++result.complete;
    if (!member.tolerance_kept) ++result.off;
    result.error = std::max(result.error, member.error);
    auto column = result.columns.begin();
    for (const double x : member.varied) (column++)->add(x);
    for (const double x : member.end) (column++)->add(x);
  }
  return result;
}

void print_json(const Request& request, const Summary& all) {
  nlohmann::ordered_json columns = nlohmann::ordered_json::object();
  for (const Statistics& column : all.columns) {
    if (column.count == 0) continue;
    columns[column.name] = {{"mean", column.mean},
                            {"deviation", column.deviation()},
                            {"least", column.least},
                            {"greatest", column.greatest}};
  }
  const nlohmann::ordered_json text{{"members", request.members}, {"complete", all.complete},
                                    {"failed", all.failed},       {"tolerance_not_kept", all.off},
                                    {"seed", request.seed},       {"error_estimate", all.error},
                                    {"columns", columns}};
  fmt::print("{}\n", text.dump(2));
}

void print_summary(const Request& request, const Summary& all) {
  fmt::print("{} of {} members, {} failed; greatest error {:.1e}, estimated\n\n", all.complete,
             request.members, all.failed, all.error);
  std::size_t width = 0;
  const auto shown = [](const Statistics& column) { return kreisel::printable(column.name, 60); };
  for (const Statistics& column : all.columns) width = std::max(width, shown(column).size());
  fmt::print("{:{}} {:>14} {:>14} {:>14} {:>14}\n", "", width, "mean", "deviation", "least",
             "greatest");
  for (const Statistics& column : all.columns) {
    if (column.count == 0) continue;
    fmt::print("{:{}} {:14.6g} {:14.6g} {:14.6g} {:14.6g}\n", shown(column), width, column.mean,
               column.deviation(), column.least, column.greatest);
  }
}

int run(const Request& request) {
  const Scene scene = read(request);
  std::optional<kreisel::AtomicFile> table;
  if (request.csv) table.emplace(*request.csv);
  const std::vector<Member> members = compute(scene);
  if (table) {
    write_csv(*table, scene, members);
    outputs::leave_standard_output_to(*request.csv);
  }
  const Summary all = summary(scene, members);
  if (request.json) {
    print_json(request, all);
  } else {
    print_summary(request, all);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  if (all.failed > 0) {
    fmt::print(stderr, "ensemble: {} of {} members failed; {}\n", all.failed, request.members,
               all.message);
  }
  if (all.off > 0) {
    fmt::print(stderr, "ensemble: {} of {} members did not reach the tolerance\n", all.off,
               request.members);
  }
  if (signals::caught() != 0 && all.complete + all.failed < request.members) {
    fmt::print(stderr, "ensemble: interrupted; {} of {} members were computed\n",
               all.complete + all.failed, request.members);
    return exit_status::of_signal();
  }
  if (signals::caught() != 0) return exit_status::of_signal();
  if (all.failed > 0) return exit_status::failed;
  return all.off > 0 ? exit_status::tolerance_missed : exit_status::complete;
}

}  // namespace

int main(int argc, char** argv) {
  signals::watch();
  return exit_status::of("ensemble", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : 0;
  });
}
