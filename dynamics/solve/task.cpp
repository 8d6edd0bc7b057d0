#include <cmath>

#include <dynamics/solve/task.hpp>

namespace kreisel::detail {

void check(const Task& task) {
  if (!(task.tolerance >= 1e-15 && task.tolerance <= 1e-2)) {
    refuse_task("tolerance = ", task.tolerance,
                " lies outside [1e-15, 1e-2], what double precision can promise");
  }
  if (!(task.smallest >= 0 && std::isfinite(task.smallest))) {
    refuse_task("smallest = ", task.smallest, " must be finite, 0 or above");
  }
  for (const double jump : task.jumps) {
    if (!std::isfinite(jump)) refuse_task("the time of a jump, ", jump, ", is not finite");
  }
  if (!(task.most_evaluations > 0)) {
    refuse_task("most_evaluations = ", task.most_evaluations, " must be above 0");
  }
  if (task.times.empty()) refuse_task("no output times are given");
  const double direction = task.times.back() < task.begin ? -1 : 1;
  double before = task.begin;
  if (!std::isfinite(before)) refuse_task("the time of the beginning is not finite");
  for (const double t : task.times) {
    if (!std::isfinite(t)) refuse_task("an output time is not finite");
    if (direction * (t - before) < 0) {
      refuse_task("output times turn round: t = ", t, " s comes after ", before, " s");
    }
    before = t;
  }
}

}  // namespace kreisel::detail
