#include <cstddef>
#include <vector>

#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/tree/time_function.hpp>

namespace kreisel {

/// A signal, and the order of its derivative.
struct TimeFunction::Source {
  Signal<double> signal;
  int order;
};

TimeFunction::TimeFunction(const Signal<double>& signal, int order)
    : source_(std::make_shared<const Source>(Source{signal, order})) {
  value_ = [source = source_](double t) { return source->signal.derivative(t, source->order); };
}

double TimeFunction::slope(double t) const {
  if (source_) return source_->signal.derivative(t, source_->order + 1);
  return detail::slope_in_time(value_, t);
}

bool TimeFunction::is_analytic() const { return source_ && source_->signal.is_analytic(); }

void TimeFunction::coefficients(double t, double h, std::span<double> result) const {
  const auto order = static_cast<std::size_t>(source_->order);
  std::vector<double> all(result.size() + order);
  source_->signal.coefficients(t, h, all);
  for (std::size_t n = 0; n < result.size(); ++n) {
    result[n] = all[n + order];
    for (std::size_t i = 1; i <= order; ++i) result[n] *= static_cast<double>(n + i) / h;
  }
}

}  // namespace kreisel
