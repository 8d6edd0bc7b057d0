#pragma once

#include <cstddef>
#include <vector>

#include <dynamics/solve/solve_options.hpp>

namespace kreisel::detail {

/// The times at which two runs are compared: the output times and, if these are few, others in
/// between. The error estimate then does not depend on the outputs requested.
class ComparisonTimes {
 public:
  ComparisonTimes(const SolveOptions& options, bool adds) {
    constexpr int least = 16;
    const double end = options.output_times.back();
    const bool forwards = end > options.begin;
    const auto before = [&](double a, double b) { return forwards ? a < b : a > b; };
    const int added =
        adds && options.output_times.size() < least && end != options.begin ? least - 1 : 0;
    int next = 1;
    for (const double t : options.output_times) {
      for (; next <= added; ++next) {
        const double between = options.begin + next * ((end - options.begin) / least);
        if (!before(between, t)) break;
        times_.push_back({between, false});
      }
      times_.push_back({t, true});
    }
  }

  [[nodiscard]] std::size_t size() const { return times_.size(); }
  [[nodiscard]] double operator[](std::size_t i) const { return times_[i].t; }
  [[nodiscard]] bool is_output(std::size_t i) const { return times_[i].is_output; }

  /// The last output time before the i-th time; `begin` if there is none.
  [[nodiscard]] double last_output(std::size_t i, double begin) const {
    while (i > 0) {
      if (times_[--i].is_output) return times_[i].t;
    }
    return begin;
  }

 private:
  struct Time {
    double t;
    bool is_output;
  };
  std::vector<Time> times_;
};

}  // namespace kreisel::detail
