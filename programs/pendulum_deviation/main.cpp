// The pendulum deviation calculator: the equilibrium of a physical pendulum on the rotating earth,
// the change of its period, and the error of each number.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sys/ioctl.h>
#include <unistd.h>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/printable.hpp>

#include "../shared/exit_status.hpp"
#include "../shared/gnuplot.hpp"
#include "../shared/outputs.hpp"
#include "../shared/progress.hpp"
#include "request.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int run(const Request& request) {
  const Clock::time_point start = Clock::now();
  const std::vector<std::filesystem::path> inputs{request.list};
  if (request.csv) outputs::refuse_input("--csv", *request.csv, inputs);
  if (request.plot) outputs::refuse_input("--plot", *request.plot, inputs);
  if (request.plot) gnuplot::require_installed();
  std::optional<kreisel::AtomicFile> table;
  if (request.csv) table.emplace(*request.csv);
  std::vector<Row> rows;
  rows.reserve(request.sites.size());
  {
    Progress progress;
    for (const Site& site : request.sites) {
      if (signals::caught() != 0) break;
      rows.push_back(compute(request, site));
      const std::size_t all = request.sites.size();
      progress.report(static_cast<double>(rows.size()) / static_cast<double>(all),
                      [&] { return fmt::format("{} of {}", rows.size(), all); });
    }
  }
  const double run_time_s = seconds_since(start);
  if (table) {
    write_csv(*table, rows);
    outputs::leave_standard_output_to(*request.csv);
  }
  if (request.json) {
    print_json(request, rows, run_time_s);
  } else {
    print_table(request, rows, run_time_s);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  if (request.plot && !rows.empty() && signals::caught() == 0) draw(request, rows);
  if (rows.size() < request.sites.size()) {
    fmt::print(stderr,
               "pendulum_deviation: interrupted after {} of {} sites; what was computed is kept\n",
               rows.size(), request.sites.size());
    return exit_status::of_signal();
  }
  if (signals::caught() != 0) return exit_status::of_signal();
  const auto unknown =
      std::count_if(rows.begin(), rows.end(), [](const Row& row) { return !row.is_bounded(); });
  if (unknown == 0) return exit_status::complete;
  fmt::print(stderr, "pendulum_deviation: the error of {} of {} sites has no bound\n", unknown,
             rows.size());
  return exit_status::tolerance_missed;
}

template <class E>
[[noreturn]] void rethrow_with(const std::string& name, const E& error) {
  throw E(name.empty() ? error.what() : kreisel::printable(name, 100) + ": " + error.what());
}

}  // namespace

Row compute(const Request& request, const Site& site) {
  const Clock::time_point start = Clock::now();
  try {
    Row row{kreisel::deviation_at(site.place, request), site, 0};
    row.run_time_s = seconds_since(start);
    return row;
  } catch (const kreisel::InvalidInput& error) {
    rethrow_with(site.name, error);
  } catch (const kreisel::ComputationFailed& error) {
    rethrow_with(site.name, error);
  }
}

int main(int argc, char** argv) {
  signals::watch();
  return exit_status::of("pendulum_deviation", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : exit_status::complete;
  });
}
