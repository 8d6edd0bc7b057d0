#include <cmath>
#include <cstddef>
#include <vector>

#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve_options.hpp>

namespace kreisel {

std::vector<double> linspace(double from, double to, std::size_t count) {
  if (!std::isfinite(from) || !std::isfinite(to)) {
    detail::refuse_task("linspace from ", from, " to ", to, ": both ends must be finite");
  }
  if (count < 2) {
    detail::refuse_task("linspace of ", count, " numbers: both ends need a count of 2 or more");
  }
  std::vector<double> numbers(count);
  const auto last = static_cast<double>(count - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / last;
    numbers[i] = (1 - share) * from + share * to;
  }
  return numbers;
}

namespace detail {

namespace {

constexpr double most_outputs = 1e7;

/// Throws : InvalidInput if t_end and output_step span no grid
void check_grid(double begin, double end, double step) {
  if (!std::isfinite(begin)) refuse_task("the time of the beginning is not finite");
  if (!std::isfinite(end)) refuse_task("t_end = ", end, " is not finite");
  if (!(step > 0 && std::isfinite(step))) {
    refuse_task("output_step = ", step, " must be finite and above 0");
  }
  if (!(std::abs(end - begin) <= most_outputs * step)) {
    refuse_task("output_step = ", step, " makes more than ten million outputs from ", begin, " to ",
                end, " s: take a greater step");
  }
}

[[nodiscard]] std::vector<double> output_times_of(const SolveOptions& options) {
  if (!options.output_times.empty()) {
    if (!options.t_end && !options.output_step) return options.output_times;
    refuse_task("output_times are given beside ", options.t_end ? "t_end" : "output_step",
                ": give output_times alone, or t_end with output_step");
  }
  if (!options.t_end) {
    refuse_task(options.output_step ? "output_step is given without t_end"
                                    : "no output times are given: set output_times or t_end");
  }
  if (!options.output_step) return {*options.t_end};
  check_grid(options.begin, *options.t_end, *options.output_step);
  return output_grid(options.begin, *options.t_end, *options.output_step);
}

}  // namespace

std::vector<double> output_grid(double begin, double end, double step) {
  const double count = std::abs(end - begin) / step;
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count) + 2);
  for (std::size_t i = 0; static_cast<double>(i) < count - 1e-9; ++i) {
    times.push_back(begin + static_cast<double>(i) * std::copysign(step, end - begin));
  }
  times.push_back(end);
  return times;
}

SolveOptions with_output_times(const SolveOptions& options) {
  SolveOptions result = options;
  result.output_times = output_times_of(options);
  result.t_end.reset();
  result.output_step.reset();
  return result;
}

void check(const SolveOptions& options) {
  if (!(options.tolerance >= 1e-15 && options.tolerance <= 1e-2)) {
    refuse_task("tolerance = ", options.tolerance,
                " lies outside [1e-15, 1e-2], what double precision can promise");
  }
  if (!(options.absolute_scale >= 0 && std::isfinite(options.absolute_scale))) {
    refuse_task("absolute_scale = ", options.absolute_scale, " must be finite, 0 or above");
  }
  for (const double jump : options.discontinuities) {
    if (!std::isfinite(jump)) refuse_task("the time of a jump, ", jump, ", is not finite");
  }
  if (!(options.max_evaluations > 0)) {
    refuse_task("max_evaluations = ", options.max_evaluations, " must be above 0");
  }
  if (options.output_times.empty()) refuse_task("no output times are given");
  const double direction = options.output_times.back() < options.begin ? -1 : 1;
  double before = options.begin;
  if (!std::isfinite(before)) refuse_task("the time of the beginning is not finite");
  for (const double t : options.output_times) {
    if (!std::isfinite(t)) refuse_task("an output time is not finite");
    if (direction * (t - before) < 0) {
      refuse_task("output times turn round: t = ", t, " s comes after ", before, " s");
    }
    before = t;
  }
}

}  // namespace detail

}  // namespace kreisel
