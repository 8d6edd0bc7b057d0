#include <cmath>

#include <dynamics/solve/solve_options.hpp>

namespace kreisel::detail {

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

}  // namespace kreisel::detail
