// gyro_ensemble: the drift of many gyros in Cardan's suspension. Their tilt, knock and moments of
// inertia are scattered about those of one drawing.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <optional>
#include <programs/shared/command_line.hpp>
#include <programs/shared/progress.hpp>
#include <string>
#include <vector>

#include <dynamics/ensemble/ensemble.hpp>
#include <dynamics/ensemble/part_files.hpp>
#include <dynamics/file/atomic_file.hpp>
#include <dynamics/gimbal/cardan_gyro_laws.hpp>

#ifdef KREISEL_WITH_MPI
#include <dynamics/ensemble/ranks.hpp>
using Ranks = kreisel::Ranks;
#else
/// The ranks of a program without MPI: this process alone.
class Ranks {
 public:
  Ranks(int& /*argc*/, char**& /*argv*/) {}
  [[nodiscard]] static int rank() { return 0; }
  [[nodiscard]] static int size() { return 1; }
  [[nodiscard]] std::size_t next() { return next_++; }
  void give_up(int /*status*/) {}
  void wait_for_all() {}

 private:
  std::size_t next_ = 0;
};
#endif

namespace {

using namespace kreisel;
using Gyro = CardanGyro<RestingFrame<>>;

volatile std::sig_atomic_t interrupted = 0;

extern "C" void on_interrupt(int /*signal*/) { interrupted = 1; }

struct Request {
  std::size_t members = 10000;
  std::uint64_t seed = 1;
  int threads = 0;
  double t_end = 5;
  double tolerance = 1e-8;
  double scatter = 0.01;
  std::string csv;
  std::string parts;
};

const char* const columns = "member,tilt,knock,C,alpha,drift,drift_by_law,error,message";

/// Tilt in radian, knock in rad/s; the moments of rotor and rings by `scatter` of their own.
Member<Gyro> make(const Request& request, MemberRandom& random) {
  CardanMoments moments{.rotor = {0.005, 0.005, 0.008},
                        .inner_ring = {0.002, 0.0015, 0.0028},
                        .outer_ring = {0.006, 0.0045, 0.005}};
  const auto scattered = [&] { return 1 + request.scatter * std::tanh(random.normal()); };
  moments.rotor.head<2>() *= scattered();
  moments.rotor.z() *= scattered();
  moments.inner_ring *= scattered();
  moments.outer_ring *= scattered();
  const double tilt = random.normal(0.5, 0.05);
  const double knock = random.normal(1, 0.1);
  return {Gyro(moments, {}, {}), {.beta = tilt, .beta_rate = knock, .phi_rate = 50}};
}

/// The mean of alpha' with a bell-shaped weight, so that the ends of the nutations have little
/// influence.
double drift(const Trajectory<Gyro::State>& trajectory) {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
    const double weight =
        std::pow(std::sin(std::numbers::pi * trajectory.times[i] / trajectory.times.back()), 6);
    sum += weight * trajectory.states[i].alpha_rate;
    weights += weight;
  }
  return sum / weights;
}

/// The row of a member; for a failed member it contains only the message.
std::string row(const Request& request, std::size_t index,
                const Trajectory<Gyro::State>& trajectory) {
  const RunReport& report = trajectory.report;
  if (report.status != RunStatus::complete) {
    std::string message = report.message;
    std::replace(message.begin(), message.end(), '"', '\'');
    return fmt::format("{},,,,,,,,\"{}\"", index, message);
  }
  MemberRandom random(request.seed, index);
  const auto [gyro, start] = make(request, random);
  const GimbalDrift law =
      gimbal_drift(gyro.moments(), start.beta, 0, start.beta_rate, start.phi_rate);
  return fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},", index,
                     start.beta, start.beta_rate, gyro.moments().rotor.z(),
                     trajectory.states.back().alpha, drift(trajectory), law.drift,
                     report.error_estimate);
}

/// Mean and deviation of a column, summed in the order of members.
struct Statistics {
  double count = 0, mean = 0, squares = 0;

  void add(double x) {
    count += 1;
    const double off = x - mean;
    mean += off / count;
    squares += off * (x - mean);
  }
  [[nodiscard]] double deviation() const { return std::sqrt(squares / std::max(1.0, count - 1)); }
};

void print_summary(const Request& request, const std::vector<std::string>& rows, double seconds) {
  Statistics drift, law;
  double error = 0;
  std::size_t failed = 0;
  for (const std::string& line : rows) {
    std::array<double, 8> field{};
    const char* at = line.c_str();
    std::size_t read = 0;
    for (; read < field.size(); ++read) {
      char* end = nullptr;
      field[read] = std::strtod(at, &end);
      if (end == at || *end != ',') break;
      at = end + 1;
    }
    if (read < field.size()) {
      ++failed;
      continue;
    }
    drift.add(field[5]);
    law.add(field[6]);
    error = std::max(error, field[7]);
  }
  fmt::print("members                {} of {}, {} failed\n", rows.size(), request.members, failed);
  fmt::print("drift, rad/s           mean {:.6e}, deviation {:.6e}\n", drift.mean,
             drift.deviation());
  fmt::print("    by Magnus's law    mean {:.6e}, deviation {:.6e}\n", law.mean, law.deviation());
  fmt::print("greatest error         {:.1e} (estimated; asked for {:.1e})\n", error,
             request.tolerance);
  if (!rows.empty()) {
    fmt::print("run time               {:.3f} s, {:.1f} us a member\n", seconds,
               1e6 * seconds / static_cast<double>(rows.size()));
  }
}

void write_csv(const std::string& path, const std::vector<std::string>& rows) {
  AtomicFile file(path);
  file.stream() << columns << '\n';
  for (const std::string& line : rows) file.stream() << line << '\n';
  file.commit();
}

/// The rows of these members, without those that an interruption has left out.
std::vector<std::string> compute(const Request& request, const MemberRange& range,
                                 const std::function<void(double)>& report) {
  Sampling sampling{
      .count = range.count, .first = range.first, .seed = request.seed, .threads = request.threads};
  sampling.progress = [&](double share) {
    report(share);
    return interrupted == 0;
  };
  constexpr int outputs = 128;
  const SolveOptions options{.t_end = request.t_end,
                             .output_step = request.t_end / outputs,
                             .tolerance = request.tolerance};
  const auto result = ensemble(
      sampling, [&](std::size_t /*index*/, MemberRandom& random) { return make(request, random); },
      options);
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < result.members.size(); ++i) {
    if (result.members[i].report.status == RunStatus::cancelled) continue;
    rows.push_back(row(request, range.first + i, result.members[i]));
  }
  return rows;
}

/// Computes the parts that no file has yet, shared between the ranks. Returns the rows of all
/// files, on rank 0.
std::vector<std::string> compute_in_parts(const Request& request, Ranks& ranks) {
  const PartFiles parts(
      request.parts,
      fmt::format("seed {}, t_end {:.17g}, tolerance {:.17g}, scatter {:.17g}", request.seed,
                  request.t_end, request.tolerance, request.scatter),
      request.members);
  const std::vector<std::size_t> missing = parts.missing();
  if (ranks.rank() == 0 && missing.size() < parts.size()) {
    fmt::print(stderr, "gyro_ensemble: {} of {} parts are there; the others are computed\n",
               parts.size() - missing.size(), parts.size());
  }
  ranks.wait_for_all();  // before the first new part appears
  {
    std::optional<Progress> progress;
    if (ranks.rank() == 0) progress.emplace();
    for (std::size_t i = ranks.next(); i < missing.size() && interrupted == 0; i = ranks.next()) {
      const MemberRange range = parts.range(missing[i]);
      const auto rows = compute(request, range, [&](double share) {
        if (!progress) return;
        progress->report((static_cast<double>(i) + share) / static_cast<double>(missing.size()),
                         [&] { return fmt::format("members from {}", range.first); });
      });
      if (rows.size() == range.count) parts.write(missing[i], rows);
    }
  }
  ranks.wait_for_all();
  std::vector<std::string> all;
  if (ranks.rank() != 0) return all;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (!parts.has(part)) {
      const auto [first, count] = parts.range(part);
      fmt::print(stderr, "gyro_ensemble: members {} to {} are missing; run again for them\n", first,
                 first + count - 1);
      continue;
    }
    const auto rows = parts.read(part);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

int run(const Request& request, Ranks& ranks) {
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::string> rows;
  if (!request.parts.empty()) {
    rows = compute_in_parts(request, ranks);
  } else if (ranks.size() > 1) {
    throw InvalidInput("several ranks need --parts, a folder that all of them see");
  } else {
    Progress progress;
    rows = compute(request, {0, request.members}, [&](double share) {
      progress.report(share, [&] { return fmt::format("of {} members", request.members); });
    });
  }
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  if (ranks.rank() != 0) return 0;
  if (!request.csv.empty()) write_csv(request.csv, rows);
  print_summary(request, rows, taken.count());
  if (std::fflush(stdout) != 0) throw ComputationFailed("standard output: not written");
  if (interrupted != 0) return 130;
  return rows.size() == request.members ? 0 : 3;
}

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app("How far scattered gyros in Cardan's suspension drift. SI units and radians.\n");
  app.name("gyro_ensemble");
  Request request;
  app.add_option("--members", request.members)->check(CLI::Range(1, 100000000));
  app.add_option("--seed", request.seed, "of all that is scattered");
  app.add_option("--threads", request.threads, "0: as many as the machine runs at once")
      ->check(CLI::Range(0, 4096));
  app.add_option("--t-end", request.t_end, "s")->check(CLI::PositiveNumber);
  app.add_option("--tolerance", request.tolerance, "of the global error of each");
  app.add_option("--scatter", request.scatter, "of the moments of inertia, at most")
      ->check(CLI::Range(0.0, 0.2));
  app.add_option("--csv", request.csv, "a row for each member")->type_name("FILE");
  app.add_option("--parts", request.parts,
                 "keep results in parts, and go on from those that are there; with mpirun all "
                 "ranks share the work")
      ->type_name("FOLDER");
  if (!command_line::parse(app, argc, argv)) return {};
  return request;
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<Ranks> ranks;
  const auto fail = [&](const std::exception& error, int status) {
    std::fprintf(stderr, "gyro_ensemble: %s\n", error.what());  // fmt's may throw
    if (ranks && ranks->size() > 1) ranks->give_up(status);
    return status;
  };
  try {
    ranks.emplace(argc, argv);
    std::signal(SIGINT, on_interrupt);
    std::signal(SIGTERM, on_interrupt);
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request, *ranks) : 0;
  } catch (const InvalidInput& error) {
    return fail(error, 2);
  } catch (const std::exception& error) {
    return fail(error, 3);
  }
}
