// ensemble: runs a scene file many times with varied numbers, and reports the final states.

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/ensemble/scene_ensemble.hpp>
#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/csv.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/file/text_file.hpp>
#include <motor/error.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/gnuplot.hpp"
#include "../shared/outputs.hpp"
#include "../shared/progress.hpp"
#include "plot.hpp"
#include "request.hpp"

using namespace kreisel;

namespace {

using kreisel::RunStatus;

std::vector<SceneMember> compute(const SceneEnsemble& ensemble, int threads) {
  Progress progress;
  const auto report = [&](double share) {
    progress.report(share,
                    [&] { return fmt::format("of {} members", ensemble.request().members); });
    return signals::caught() == 0;
  };
  return ensemble.compute({threads, report, signals::token()});
}

void write_csv(kreisel::AtomicFile& file, const SceneEnsemble& ensemble,
               const std::vector<SceneMember>& members) {
  std::ostream& out = file.stream();
  out << "member";
  for (const std::string& key : ensemble.keys()) out << ',' << kreisel::csv_field(key);
  for (const std::string& name : ensemble.columns()) out << ',' << kreisel::csv_field(name);
  out << ",error_estimate,message\n";
  for (std::size_t i = 0; i < members.size(); ++i) {
    const SceneMember& member = members[i];
    if (member.status == RunStatus::cancelled) continue;
    out << i;
    for (const double x : member.varied) out << fmt::format(",{:.17g}", x);
    for (std::size_t k = 0; k < ensemble.columns().size(); ++k) {
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

void print_json(const EnsembleRequest& request, const EnsembleSummary& all) {
  nlohmann::ordered_json columns = nlohmann::ordered_json::object();
  for (const ColumnSpread& column : all.columns) {
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

void print_summary(const EnsembleRequest& request, const EnsembleSummary& all) {
  fmt::print("{} of {} members, {} failed; greatest error {:.1e}, estimated\n\n", all.complete,
             request.members, all.failed, all.error);
  std::size_t width = 0;
  const auto shown = [](const ColumnSpread& column) { return kreisel::printable(column.name, 60); };
  for (const ColumnSpread& column : all.columns) width = std::max(width, shown(column).size());
  fmt::print("{:{}} {:>14} {:>14} {:>14} {:>14}\n", "", width, "mean", "deviation", "least",
             "greatest");
  for (const ColumnSpread& column : all.columns) {
    if (column.count == 0) continue;
    fmt::print("{:{}} {:14.6g} {:14.6g} {:14.6g} {:14.6g}\n", shown(column), width, column.mean,
               column.deviation(), column.least, column.greatest);
  }
}

int run(const Request& request) {
  const std::string text = kreisel::read_text(request.scene, kreisel::largest_scene_file);
  const SceneEnsemble ensemble(text, request.scene, request.ensemble);
  if (request.csv) {
    outputs::refuse_input("--csv", *request.csv, files_read(request.scene, ensemble.scene()));
  }
  if (request.plot) {
    gnuplot::require_installed();
    gnuplot::open_folder(*request.plot);
  }
  std::optional<kreisel::AtomicFile> table;
  if (request.csv) table.emplace(*request.csv);
  const std::vector<SceneMember> members = compute(ensemble, request.threads);
  if (table) {
    write_csv(*table, ensemble, members);
    outputs::leave_standard_output_to(*request.csv);
  }
  const EnsembleSummary all = summary(ensemble, members);
  if (request.json) {
    print_json(ensemble.request(), all);
  } else {
    print_summary(ensemble.request(), all);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  if (request.plot && signals::caught() == 0) draw(ensemble, members, all, *request.plot);
  if (all.failed > 0) {
    fmt::print(stderr, "ensemble: {} of {} members failed; {}\n", all.failed, members.size(),
               all.message);
  }
  if (all.off > 0) {
    fmt::print(stderr, "ensemble: {} of {} members did not reach the tolerance\n", all.off,
               members.size());
  }
  if (signals::caught() != 0 && all.complete + all.failed < members.size()) {
    fmt::print(stderr, "ensemble: interrupted; {} of {} members were computed\n",
               all.complete + all.failed, members.size());
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
