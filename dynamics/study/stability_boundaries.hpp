#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <vector>

#include <dynamics/study/floquet.hpp>

namespace kreisel {

/// The point of the unit circle at which a pair of multipliers leaves it.
enum class BoundaryKind { minus_one, plus_one, krein };

/// A zero of one of the three discriminants of PairedMultipliers.
struct StabilityBoundary {
  double parameter = 0;
  double error = 0;  ///< of the parameter: the discriminant's error over its slope
  BoundaryKind kind = BoundaryKind::minus_one;
};

/// A range of the parameter in which the motion is unstable. An end of the examined range counts as
/// a boundary with the error 0.
struct UnstableInterval {
  StabilityBoundary begin;
  StabilityBoundary end;
  double growth = 1;  ///< greatest multiplier in the middle, per period
};

namespace detail {

struct Discriminant {
  double value;
  double error;
};

[[nodiscard]] inline Discriminant discriminant(const PairedMultipliers& m, BoundaryKind kind) {
  switch (kind) {
    case BoundaryKind::minus_one: return {m.at_minus_one(), m.one_error()};
    case BoundaryKind::plus_one: return {m.at_plus_one(), m.one_error()};
    default: return {m.krein(), m.krein_error()};
  }
}

/// The zero of g between a and b, with the values ga and gb of different signs. False position that
/// halves the weight of an end that stays twice; every third step is a bisection.
template <class Function>
[[nodiscard]] double zero_between(const Function& g, double a, double ga, double b, double gb) {
  const double close =
      2 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
  for (int k = 0; k < 200 && b - a > close; ++k) {
    const double c = k % 3 == 2
                         ? (a + b) / 2
                         : std::clamp(b - gb * (b - a) / (gb - ga), a + close / 2, b - close / 2);
    const double gc = g(c);
    if ((gc > 0) == (gb > 0)) {
      b = c;
      gb = gc;
      ga /= 2;
    } else {
      a = c;
      ga = gc;
      gb /= 2;
    }
  }
  return (a + b) / 2;
}

/// A position between a and c with g below 0, or c if there is none. g(b) must be lower than g(a)
/// and g(c). Golden section with parabolas: a tongue far narrower than the sampling is the bottom
/// of a parabola. The parabola touches 0 at the tip of the tongue. The search ends if the parabola
/// through a, b, c stays above half of g(b) twice.
template <class Function>
[[nodiscard]] double below_zero(const Function& g, double a, double ga, double b, double gb,
                                double c, double gc) {
  const double golden = (3 - std::sqrt(5.0)) / 2;
  const double close = 1e-9 * std::max(std::abs(a), std::abs(c));
  double second = b, third = b, g_second = gb, g_third = gb;
  const double none = c;
  double length = 0;
  int hopeless = 0;
  for (int k = 0; k < 60 && c - a > close; ++k) {
    if (gb < 0) return b;
    const double left = (gb - ga) / (b - a);
    const double bend = ((gc - gb) / (c - b) - left) / (c - a);
    const double slope = left + bend * (b - a);
    hopeless = gb - slope * slope / (4 * bend) > gb / 2 ? hopeless + 1 : 0;
    if (hopeless == 2) return none;
    // Through the three lowest so far, if the bottom lies well inside.
    const double r = (b - second) * (gb - g_third);
    const double q = (b - third) * (gb - g_second);
    const double denominator = 2 * (q - r);
    double x = denominator != 0 ? b - ((b - third) * q - (b - second) * r) / denominator : a;
    const bool inside = x > a + close / 4 && x < c - close / 4 && std::abs(x - b) > close / 8;
    if (!inside || (k > 1 && std::abs(x - b) > length / 2)) {
      x = b - a > c - b ? b - golden * (b - a) : b + golden * (c - b);
    }
    length = std::abs(x - b);
    const double gx = g(x);
    if (gx <= gb) {
      (x < b ? c : a) = b;
      (x < b ? gc : ga) = gb;
      third = second;
      g_third = g_second;
      second = b;
      g_second = gb;
      b = x;
      gb = gx;
    } else {
      (x < b ? a : c) = x;
      (x < b ? ga : gc) = gx;
      third = second;
      g_third = g_second;
      second = x;
      g_second = gx;
    }
  }
  return none;
}

}  // namespace detail

/// The values of a parameter from `from` to `to` at which stability changes. They are the zeros of
/// the three discriminants, each bracketed and refined to rounding.
///
/// Between samples a discriminant may dip below 0 and return (a narrow tongue). Each local extremum
/// towards 0 is therefore refined. Two tongues of one kind within two samples are missed, and so
/// are tongues narrower than 1e-9 of the parameter.
///
/// At     : callable (double parameter) -> PairedMultipliers
/// Error  : reported for each, and a bound: at paired_multipliers()' default accuracy below
///              2e-13 of the parameter, tongues of 4e-4 included (tests/dynamics/study/floquet.cpp)
/// Cost   : samples + 1 transition matrices, and some 15 for each boundary
/// Throws : InvalidInput if from < to does not hold or there are fewer than 2 samples
template <class At>
[[nodiscard]] std::vector<StabilityBoundary> stability_boundaries(const At& at, double from,
                                                                  double to, int samples = 200) {
  if (!(from < to) || samples < 2) {
    std::ostringstream text;
    text << "stability boundaries: [" << from << ", " << to << "] in " << samples
         << " samples: from < to and at least 2 samples are needed";
    throw InvalidInput(text.str());
  }
  const auto count = static_cast<std::size_t>(samples) + 1;
  std::vector<double> parameter(count);
  std::vector<PairedMultipliers> sample(count);
  for (std::size_t i = 0; i < count; ++i) {
    parameter[i] = from + (to - from) * static_cast<double>(i) / samples;
    sample[i] = at(parameter[i]);
  }
  std::vector<StabilityBoundary> found;
  for (const auto kind : {BoundaryKind::minus_one, BoundaryKind::plus_one, BoundaryKind::krein}) {
    const auto value = [&](double p) { return detail::discriminant(at(p), kind).value; };
    const auto add = [&](double a, double ga, double b, double gb) {
      const double p = detail::zero_between(value, a, ga, b, gb);
      const double h = std::min({1e-3 * (b - a), p - a, b - p});
      const double slope = h > 0 ? (value(p + h) - value(p - h)) / (2 * h) : (gb - ga) / (b - a);
      const double error = detail::discriminant(at(p), kind).error / std::abs(slope);
      found.push_back({p, error, kind});
    };
    const auto g = [&](std::size_t i) { return detail::discriminant(sample[i], kind).value; };
    for (std::size_t i = 0; i + 1 < count; ++i) {
      if ((g(i) > 0) != (g(i + 1) > 0)) {
        add(parameter[i], g(i), parameter[i + 1], g(i + 1));
        continue;
      }
      if (i == 0) continue;
      const double sign = g(i) > 0 ? 1 : -1;
      const bool dips = sign * g(i) <= sign * g(i - 1) && sign * g(i) < sign * g(i + 1) &&
                        (g(i - 1) > 0) == (g(i) > 0);
      if (!dips) continue;
      const auto towards = [&](double p) { return sign * value(p); };
      const double low =
          detail::below_zero(towards, parameter[i - 1], sign * g(i - 1), parameter[i], sign * g(i),
                             parameter[i + 1], sign * g(i + 1));
      if (low == parameter[i + 1]) continue;
      const double g_low = value(low);
      add(parameter[i - 1], g(i - 1), low, g_low);
      add(low, g_low, parameter[i + 1], g(i + 1));
    }
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.parameter < b.parameter; });
  return found;
}

/// The unstable ranges of a parameter between `from` and `to`.
///
/// Between two boundaries the verdict does not change, so that one test in the middle decides. A
/// discriminant that only touches 0 is no end of a range. One that changes its sign while another
/// pair is unstable is no end either.
///
/// Cost and throws : as stability_boundaries(), and one transition matrix for each piece
template <class At>
[[nodiscard]] std::vector<UnstableInterval> unstable_intervals(const At& at, double from, double to,
                                                               int samples = 200) {
  std::vector<StabilityBoundary> ends = stability_boundaries(at, from, to, samples);
  ends.insert(ends.begin(), StabilityBoundary{from, 0, BoundaryKind::minus_one});
  ends.push_back({to, 0, BoundaryKind::minus_one});
  std::vector<UnstableInterval> intervals;
  bool before = false;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const PairedMultipliers middle = at((ends[i].parameter + ends[i + 1].parameter) / 2);
    const bool unstable = middle.verdict() == Stability::unstable;
    if (unstable && before) {
      intervals.back().end = ends[i + 1];
      intervals.back().growth = std::max(intervals.back().growth, middle.growth());
    } else if (unstable) {
      intervals.push_back({ends[i], ends[i + 1], middle.growth()});
    }
    before = unstable;
  }
  return intervals;
}

}  // namespace kreisel
