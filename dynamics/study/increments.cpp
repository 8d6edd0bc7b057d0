#include <dynamics/step/explicit.hpp>
#include <dynamics/study/increments.hpp>

namespace kreisel {

Increments increments(const std::function<InertialReading(double t)>& readings, double begin,
                      double end, const std::vector<double>& breaks) {
  const auto field = [&readings](double t, const IncrementEquations::Numbers& numbers) {
    return IncrementEquations::rates(numbers, readings(t));
  };
  ExplicitRungeKutta<IncrementEquations::Numbers, decltype(field)> steps(
      field, begin, IncrementEquations::start(), {.relative = 1e-15, .absolute_scale = 1e-9},
      IncrementEquations::blocks);
  steps.stop_at(breaks);
  return IncrementEquations::increments(steps.advance_to(end));
}

}  // namespace kreisel
