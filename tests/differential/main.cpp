// test.differential: random scene files, solved by several methods of the library and by an
// independent integrator. A difference is a fault; its scene is shrunk and kept.
//
// generate*     scenes over the whole language, weighted towards usual ones
// draw.cpp      their numbers, and functions of time
// toml*         their text as files
// log.cpp       logs of guides, and the ways to write them down
// runs.cpp      the library, by the functions of simulate
// reference*    the independent integrator: no code of dynamics/
// judge.cpp     the definition of faults
// examine.cpp   a process for each scene, against crashes and hangs
// shrink.cpp    the smallest scene that still fails
// known.txt     kinds of faults that are reported but tolerated, up to a number of scenes

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <fstream>
#include <map>
#include <programs/shared/progress.hpp>
#include <set>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "examine.hpp"
#include "generate.hpp"
#include "shrink.hpp"

namespace {

using namespace differential;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t interrupted = 0;
extern "C" void on_interrupt(int /*signal*/) { interrupted = 1; }

/// A known kind of faults that is not repaired yet.
struct Known {
  double most;        ///< scenes of 400 that may have it
  std::string begin;  ///< of its name
};

struct Request {
  std::uint64_t count = 400;
  std::vector<std::uint64_t> seeds = {};
  double minutes = 0;  ///< 0: no limit
  long only = -1;
  unsigned jobs = 2;
  double shrink_seconds = 20;
  bool print = false;
  std::filesystem::path out = "differential";
  std::string known_file = {};
  std::vector<Known> known = {};
  Examination how = {};

  [[nodiscard]] bool is_known(const std::string& kind) const {
    return std::any_of(known.begin(), known.end(),
                       [&kind](const Known& one) { return kind.starts_with(one.begin); });
  }
};

/// The lines of a file without blank ones and those that begin with #.
std::vector<Known> known_in(const std::string& file) {
  std::vector<Known> result;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::size_t blank = line.find(' ');
    result.push_back({std::stod(line.substr(0, blank)), line.substr(blank + 1)});
  }
  return result;
}

/// Data shared by the processes.
struct Shared {
  std::atomic<std::uint64_t> next;
  std::atomic<std::uint64_t> done;
  std::atomic<std::uint64_t> answered;
  std::atomic<std::uint64_t> referenced;
  std::atomic<std::uint64_t> faulty;
  std::atomic<bool> stop;
};

std::uint64_t today() {
  const std::time_t now = std::time(nullptr);
  const std::tm date = *std::gmtime(&now);
  return static_cast<std::uint64_t>((date.tm_year + 1900) * 10000 + (date.tm_mon + 1) * 100 +
                                    date.tm_mday);
}

/// The scenes of all seeds in turn.
struct Number {
  std::uint64_t seed;
  std::uint64_t index;
};

Number number(const Request& request, std::uint64_t i) {
  const std::uint64_t n = request.seeds.size();
  return {request.seeds[i % n], i / n};
}

std::string slug(const std::string& kind) {
  std::string result;
  for (const char c : kind.substr(0, 70)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain) result += c;
    if (!plain && !result.empty() && result.back() != '-') result += '-';
  }
  return result;
}

/// A new folder for an example of the kind; empty if three exist.
std::filesystem::path folder_for(const Request& request, const std::string& kind) {
  for (int i = 1; i <= 3; ++i) {
    const auto folder = request.out / fmt::format("{}-{}", slug(kind), i);
    if (std::filesystem::create_directory(folder)) return folder;
  }
  return {};
}

void keep(const Request& request, const Number& number, const Scene& scene, const Fault& fault) {
  const std::filesystem::path folder = folder_for(request, fault.kind);
  if (folder.empty()) return;
  const auto write = [&folder, &fault](const Scene& s, const char* name) {
    std::ofstream(folder / name) << "# " << fault.kind << "\n# " << fault.detail << "\n"
                                 << to_toml(s);
    write_logs(s, folder);
  };
  write(scene, fmt::format("seed-{}-{}.toml", number.seed, number.index).c_str());
  const auto fails = [&](const Scene& tried) {
    const Verdict verdict = examine(tried, request.how);
    return std::any_of(verdict.faults.begin(), verdict.faults.end(),
                       [&fault](const Fault& f) { return f.kind == fault.kind; });
  };
  write(shrink(scene, fails, request.shrink_seconds), "least.toml");
}

void try_scene(const Request& request, const Number& number, Shared& shared) {
  const Scene scene = generate(Random(number.seed, number.index));
  const Verdict verdict = examine(scene, request.how);
  shared.answered += verdict.answered ? 1 : 0;
  shared.referenced += verdict.referenced ? 1 : 0;
  std::ofstream(request.out / "scenes.txt", std::ios::app)
      << fmt::format("{} {}: {}\n", number.seed, number.index, verdict.notes);
  const bool fails = std::any_of(verdict.faults.begin(), verdict.faults.end(),
                                 [&](const Fault& fault) { return !request.is_known(fault.kind); });
  if (fails) shared.faulty += 1;
  for (const Fault& fault : verdict.faults) {
    std::ofstream(request.out / "faults.txt", std::ios::app)
        << fmt::format("{}\t{}\t{}\t{}\n", fault.kind, number.seed, number.index, fault.detail);
    if (!request.is_known(fault.kind)) keep(request, number, scene, fault);
  }
  shared.done += 1;
}

[[noreturn]] void work(Request request, Shared& shared) {
  std::signal(SIGINT, SIG_IGN);
  request.how.folder = request.out / fmt::format("logs-{}", getpid());
  std::filesystem::create_directory(request.how.folder);
  while (!shared.stop) {
    const std::uint64_t i = shared.next++;
    if (i >= request.count) break;
    try_scene(request, number(request, i), shared);
  }
  std::filesystem::remove_all(request.how.folder);
  _exit(0);
}

/// Waits for the workers, shows their progress, and stops them at the end of the time.
void watch(const Request& request, Shared& shared, std::size_t workers) {
  const auto begin = Clock::now();
  Progress progress;
  while (workers > 0) {
    if (waitpid(-1, nullptr, WNOHANG) > 0) {
      workers -= 1;
      continue;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const double spent = std::chrono::duration<double>(Clock::now() - begin).count() / 60;
    if (interrupted != 0 || (request.minutes > 0 && spent > request.minutes)) shared.stop = true;
    const double by_count = static_cast<double>(shared.done) / static_cast<double>(request.count);
    const double by_time = request.minutes > 0 ? spent / request.minutes : 0;
    progress.report(std::max(by_count, by_time), [&] {
      return fmt::format("{} scenes, {} with faults{}", shared.done.load(), shared.faulty.load(),
                         shared.stop ? ", stopping" : "");
    });
  }
}

/// Prints the number of each kind of fault. Returns true if a known kind exceeds its limit.
[[nodiscard]] bool summarise(const Request& request, const Shared& shared) {
  std::map<std::string, int> kinds;
  std::ifstream file(request.out / "faults.txt");
  for (std::string line; std::getline(file, line);) kinds[line.substr(0, line.find('\t'))] += 1;
  fmt::print(
      "{} scenes, {} answered, {} of them compared with the independent integrator; {} with "
      "faults\n",
      shared.done.load(), shared.answered.load(), shared.referenced.load(), shared.faulty.load());
  for (const auto& [kind, count] : kinds) {
    fmt::print("{:5} {}{}\n", count, kind, request.is_known(kind) ? "  (known)" : "");
    std::ifstream least(request.out / (slug(kind) + "-1") / "least.toml");
    for (std::string line; std::getline(least, line);) fmt::print("      | {}\n", line);
  }
  bool too_often = false;
  for (const Known& known : request.known) {
    int count = 0;
    for (const auto& [kind, times] : kinds) count += kind.starts_with(known.begin) ? times : 0;
    const double most = known.most * std::max(1.0, static_cast<double>(shared.done) / 400);
    if (count <= most) continue;
    fmt::print("too often: {} times, limit {}: {}\n", count, most, known.begin);
    too_often = true;
  }
  return too_often;
}

int run_all(const Request& request) {
  std::filesystem::remove_all(request.out);
  std::filesystem::create_directories(request.out);
  void* const memory =
      mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return 3;
  auto& shared = *new (memory) Shared{};
  std::size_t workers = 0;
  for (; workers < request.jobs; ++workers) {
    if (fork() == 0) work(request, shared);
  }
  watch(request, shared, workers);
  const bool too_often = summarise(request, shared);
  if (interrupted != 0) return 130;
  return too_often || shared.faulty > 0 ? 1 : 0;
}

int run_one(const Request& request) {
  const Number one{request.seeds.front(), static_cast<std::uint64_t>(request.only)};
  const Scene scene = generate(Random(one.seed, one.index));
  fmt::print("{}", to_toml(scene));
  if (request.print) return 0;
  std::filesystem::create_directories(request.out);
  Request here = request;
  here.how.folder = request.out;
  const Verdict verdict = examine(scene, here.how);
  fmt::print("# {}\n# independent motion: {}\n", verdict.notes, verdict.referenced);
  for (const Fault& fault : verdict.faults) fmt::print("# {}: {}\n", fault.kind, fault.detail);
  return verdict.faults.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  request.seeds = {1, today()};
  CLI::App app{"Random scene files by several methods and by an independent integrator"};
  app.add_option("--count", request.count, "number of scenes")->capture_default_str();
  app.add_option("--seed", request.seeds, "of the random scenes; 1 and the day's date by default");
  app.add_option("--minutes", request.minutes, "after which no further scene begins");
  app.add_option("--jobs", request.jobs, "processes side by side")->capture_default_str();
  app.add_option("--out", request.out, "folder for failing scenes")->capture_default_str();
  app.add_option("--shrink", request.shrink_seconds, "seconds to shrink a failing scene")
      ->capture_default_str();
  app.add_option("--methods", request.how.methods, "to compare with each other");
  app.add_option("--evaluations", request.how.limits.evaluations, "of each run of steps");
  app.add_option("--seconds", request.how.limits.seconds, "of processor time for each method");
  app.add_option("--work", request.how.limits.work, "operations of the independent integrator");
  app.add_option("--only", request.only, "only the scene of this number");
  app.add_option("--known", request.known_file, "file of kinds of faults that do not count")
      ->check(CLI::ExistingFile);
  app.add_flag("--print", request.print, "with --only: print it, do not run it");
  CLI11_PARSE(app, argc, argv);
  request.known = known_in(request.known_file);
  if (request.only >= 0) return run_one(request);
  fmt::print("seeds");
  for (const std::uint64_t seed : request.seeds) fmt::print(" {}", seed);
  fmt::print("\n");
  std::fflush(stdout);
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  return run_all(request);
}
