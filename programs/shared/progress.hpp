#pragma once

#include <fmt/core.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <string>
#include <unistd.h>

/// A progress line on the terminal, after half a second; silent in a pipe.
class Progress {
  using Clock = std::chrono::steady_clock;

 public:
  Progress() = default;
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
  }

  /// Reports the share that is done, in [0, 1], and words for it.
  template <class Words>
  void report(double share, const Words& words) {
    if (!shown_) return;
    const double elapsed = std::chrono::duration<double>(Clock::now() - start_).count();
    if (elapsed < next_ || !(share > 0)) return;
    next_ = elapsed + 0.1;
    drawn_ = true;
    fmt::print(stderr, "\r{:30} {:3.0f} %  {}, {:.0f} s left\033[K",
               std::string(static_cast<std::size_t>(30 * share), '#'), 100 * share, words(),
               elapsed / share - elapsed);
    std::fflush(stderr);
  }

 private:
  bool shown_ = isatty(STDERR_FILENO) != 0;
  bool drawn_ = false;
  double next_ = 0.5;
  Clock::time_point start_ = Clock::now();
};
