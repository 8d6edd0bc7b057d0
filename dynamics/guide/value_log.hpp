#pragma once

#include <cmath>
#include <cstddef>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/tabulated.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A log of a number or a vector. A number is the x component; the others are 0.
struct ValueLog {
  std::vector<double> times;  ///< s
  std::vector<Vector3<double>> values;
  double late = 0;  ///< s, as MotionLog::late
};

namespace detail {

/// The values as positions, with an attitude of 0.
[[nodiscard]] inline std::vector<PiecewisePose<double>::Components> value_components(
    const ValueLog& log) {
  std::vector<PiecewisePose<double>::Components> result;
  for (const Vector3<double>& value : log.values) {
    result.push_back((PiecewisePose<double>::Components() << 0, 0, 0, 0, value).finished());
  }
  return result;
}

inline void check(const ValueLog& log) {
  const auto refuse = [](const auto&... words) {
    std::ostringstream text;
    text.precision(10);
    text << "log of a signal: ";
    (text << ... << words);
    throw InvalidInput(text.str());
  };
  const std::size_t n = log.times.size();
  if (n < 4) refuse(n, " samples where a signal needs 4 or more");
  if (log.values.size() != n) refuse(n, " times, ", log.values.size(), " values");
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(log.times[i]) || !log.values[i].allFinite()) {
      refuse("sample ", i + 1, ": not a finite number");
    }
    if (i > 0 && !(log.times[i] > log.times[i - 1])) {
      refuse("sample ", i + 1, ", t = ", log.times[i],
             " s: must be later than the sample before, t = ", log.times[i - 1], " s");
    }
  }
}

}  // namespace detail

/// The signal of a log: a spline through the samples, or one that smooths them, as in
/// TabulatedFrame. `spline.position_every` is the number of samples per knot.
///
/// Error  : O(h^6) of the value, one power less for each derivative, h the spacing
/// Throws : InvalidInput: under four samples, lengths that differ, a number that is not finite,
///          times that do not increase. The signal throws at times outside the log
template <class Value = double>
[[nodiscard]] Signal<Value> logged_signal(const ValueLog& log, const LogSpline& spline = {}) {
  detail::check(log);
  const PiecewisePose<double> pieces =
      detail::SplineInterpolation<double>(log.times, detail::value_components(log),
                                          spline.degree_for(log.times.size()),
                                          spline.position_every)
          .pieces("log of a signal");
  Polynomials<Value> result{pieces.breakpoints(), pieces.end(), 1, {}};
  for (std::size_t k = 0; k < result.begins.size(); ++k) {
    const auto coefficients = pieces.coefficients(k);
    result.terms = coefficients.size();
    for (const auto& c : coefficients) {
      if constexpr (std::is_same_v<Value, double>) {
        result.coefficients.push_back(c[4]);
      } else {
        result.coefficients.emplace_back(c.template tail<3>());
      }
    }
  }
  return Signal<Value>::polynomials(std::move(result));
}

}  // namespace kreisel
