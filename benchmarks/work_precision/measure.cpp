// Runs, their CPU time, and a progress bar.

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <unistd.h>
#include <utility>

#include "point.hpp"

namespace work_precision {

namespace {

volatile std::sig_atomic_t stopped = 0;

/// The first Ctrl-C ends the measurement, a second one the program.
void stop(int signal) {
  stopped = 1;
  std::signal(signal, SIG_DFL);
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A progress line on stderr, on a terminal only.
class Bar {
 public:
  explicit Bar(std::size_t total) : total_(total), shown_(isatty(STDERR_FILENO) == 1) {}
  ~Bar() {
    if (shown_) fmt::print(stderr, "\r{:79}\r", "");
  }
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;

  void show(std::size_t done, const Run& next) const {
    if (!shown_) return;
    constexpr std::size_t width = 24;
    const std::size_t full = width * done / total_;
    const double passed =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    std::string left = "";
    if (done > 0) {
      const auto s =
          static_cast<int>(passed * static_cast<double>(total_ - done) / static_cast<double>(done));
      left = fmt::format("{}:{:02} left", s / 60, s % 60);
    }
    const std::string what = fmt::format("{}, {}", next.scene, next.method);
    fmt::print(stderr, "\r[{}{}] {:3} % {:>11}  {:32.32}", std::string(full, '#'),
               std::string(width - full, '.'), 100 * done / total_, left, what);
    std::fflush(stderr);
  }

 private:
  std::size_t total_;
  bool shown_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

Point measure(const Run& run, const Thoroughness& thoroughness) {
  Point point{run.scene, run.method, run.setting, NAN, NAN, NAN, ok, {}};
  std::vector<double> times;
  double all = 0;
  const auto enough = [&] {
    if (stopped || all > thoroughness.patience / 3) return true;
    if (times.size() < thoroughness.repetitions) return false;
    return all > thoroughness.time_enough || times.size() >= thoroughness.most_repetitions;
  };
  const double first = cpu_seconds();
  try {
    do {
      const double begin = cpu_seconds();
      Result result = run.run();
      times.push_back(cpu_seconds() - begin);
      all += times.back();
      point.error = result.error;
      point.evaluations = result.evaluations;
      point.promise = std::move(result.promise);
    } while (!enough());
    const auto middle = times.begin() + std::ptrdiff_t(times.size() / 2);
    std::nth_element(times.begin(), middle, times.end());
    point.seconds = *middle;
    if (!std::isfinite(point.error)) point.status = "returned a NaN as success";
  } catch (const std::exception& error) {
    point.seconds = cpu_seconds() - first;
    point.status = error.what();
    std::replace(point.status.begin(), point.status.end(), ',', ';');
    std::replace(point.status.begin(), point.status.end(), '\n', ' ');
  }
  return point;
}

}  // namespace

bool interrupted() { return stopped != 0; }

Thoroughness Thoroughness::full() {
  Thoroughness t{false, {}, 1e7, 1, 0.05, 3, 51};
  for (int k = 3; k <= 14; ++k) t.tolerances.push_back(std::pow(10.0, -k));
  return t;
}

Thoroughness Thoroughness::in_a_minute() {
  return {true, {1e-4, 1e-7, 1e-10, 1e-13}, 1e6, 0.1, 0.005, 1, 5};
}

std::vector<Point> measure(const std::vector<Run>& runs, const Thoroughness& thoroughness) {
  std::signal(SIGINT, &stop);
  std::vector<Point> points;
  const Bar bar(runs.size());
  bool too_slow = false;
  for (std::size_t i = 0; i < runs.size() && !stopped; ++i) {
    const Run& run = runs[i];
    bar.show(i, run);
    const bool new_method =
        i == 0 || runs[i - 1].scene != run.scene || runs[i - 1].method != run.method;
    if (new_method) too_slow = false;
    if (too_slow) {
      points.push_back({run.scene, run.method, run.setting, NAN, NAN, NAN, not_tried, {}});
      continue;
    }
    points.push_back(measure(run, thoroughness));
    too_slow = points.back().seconds > thoroughness.patience;
  }
  return points;
}

}  // namespace work_precision
