#include <cmath>
#include <cstddef>
#include <numbers>

#include <dynamics/study/margins.hpp>

namespace kreisel {

namespace {

using Complex = std::complex<double>;

/// The zero of a function that changes its sign between a and b, by bisection.
template <class F>
double crossing(const F& function, double a, double b) {
  const bool rises = function(a) < 0;
  while (b - a > 1e-14 * b) {
    const double middle = a + (b - a) / 2;
    if (middle <= a || middle >= b) break;
    ((function(middle) < 0) == rises ? a : b) = middle;
  }
  return a + (b - a) / 2;
}

/// The frequencies in a range at which a function changes its sign. It is evaluated at the given
/// frequencies and at a hundred of each decade.
template <class F>
std::vector<double> crossings(const F& function, const std::vector<double>& frequencies) {
  std::vector<double> result;
  for (std::size_t i = 1; i < frequencies.size(); ++i) {
    const double ratio = frequencies[i] / frequencies[i - 1];
    const bool is_range = ratio > 1 && std::isfinite(ratio);
    const int parts = is_range ? static_cast<int>(std::ceil(100 * std::log10(ratio))) : 1;
    double a = frequencies[i - 1];
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      const double b = k < parts ? frequencies[i - 1] * std::pow(ratio, share) : frequencies[i];
      if ((function(a) < 0) != (function(b) < 0)) result.push_back(crossing(function, a, b));
      a = b;
    }
  }
  return result;
}

}  // namespace

LoopMargins loop_margins(const std::function<Complex(double)>& loop,
                         const std::vector<double>& frequencies) {
  LoopMargins margins;
  const auto excess = [&loop](double w) { return std::abs(loop(w)) - 1; };
  for (const double w : crossings(excess, frequencies)) {
    const double margin =
        std::remainder(std::arg(loop(w)) + std::numbers::pi, 2 * std::numbers::pi);
    const bool is_smaller = !margins.phase || std::abs(margin) < std::abs(margins.phase->margin);
    if (is_smaller) margins.phase = {w, margin};
  }
  const auto sideways = [&loop](double w) { return loop(w).imag(); };
  for (const double w : crossings(sideways, frequencies)) {
    const Complex there = loop(w);
    if (there.real() >= 0) continue;
    const double margin = 1 / std::abs(there);
    const bool is_nearer =
        !margins.gain || std::abs(std::log(margin)) < std::abs(std::log(margins.gain->margin));
    if (is_nearer) margins.gain = {w, margin};
  }
  return margins;
}

std::optional<double> bandwidth(const std::function<Complex(double)>& response,
                                const std::vector<double>& frequencies) {
  if (frequencies.empty()) return std::nullopt;
  const double level = std::abs(response(frequencies.front())) / std::numbers::sqrt2;
  const auto falls =
      crossings([&](double w) { return std::abs(response(w)) - level; }, frequencies);
  if (falls.empty()) return std::nullopt;
  return falls.front();
}

}  // namespace kreisel
