#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <dynamics/solve/run.hpp>

namespace kreisel::detail {

namespace {

/// The cubic with given values and slopes at both ends of [0, 1].
struct Cubic {
  double value_0, slope_0, value_1, slope_1;

  [[nodiscard]] double operator()(double s) const {
    const double r = 1 - s;
    return r * r * ((1 + 2 * s) * value_0 + s * slope_0) +
           s * s * ((1 + 2 * r) * value_1 - r * slope_1);
  }

  [[nodiscard]] double slope(double s) const {
    const double r = 1 - s;
    return 6 * s * r * (value_1 - value_0) + r * (r - 2 * s) * slope_0 + s * (s - 2 * r) * slope_1;
  }

  /// Where the cubic may have changed its sign: its extremes in (0, 1), and the end.
  [[nodiscard]] std::vector<double> turns() const {
    const double a = 3 * (2 * (value_0 - value_1) + slope_0 + slope_1);
    const double b = 2 * (3 * (value_1 - value_0) - 2 * slope_0 - slope_1);
    std::vector<double> at;
    const double square = b * b - 4 * a * slope_0;
    if (square >= 0) {
      const double sum = -(b + std::copysign(std::sqrt(square), b)) / 2;
      for (const double s : {sum / a, slope_0 / sum}) {
        if (s > 0 && s < 1) at.push_back(s);
      }
      std::sort(at.begin(), at.end());
    }
    at.push_back(1);
    return at;
  }

  /// The distance from a straight line, at most.
  [[nodiscard]] double bend() const {
    const double mean = value_1 - value_0;
    return std::abs(slope_0 - mean) + std::abs(slope_1 - mean);
  }
};

/// A place in a step at which a function changes its sign, or may do so.
struct Change {
  double s;
  bool is_sure;
};

/// A zero of f in [a, b], where it changes its sign, from above or from below 0.
template <class F>
double zero_between(const F& f, bool from_above, double a, double b) {
  for (int i = 0; i < 50; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) > 0) == from_above ? a : b) = middle;
  }
  return b;
}

/// The first change of sign of g in (begin, end], a part of a step, where it has nearly the course of
/// a cubic. Smaller values than `rounding` have no sign. Near an extreme g is known but for `unsure`.
template <class G, class Slope>
std::optional<Change> first_change(const G& g, const Slope& slope, double begin, double end,
                                   double rounding, double unsure) {
  const double part = end - begin;
  const Cubic course{g(begin), part * slope(begin), g(end), part * slope(end)};
  // A step may begin at a corner.
  constexpr double begins = 1e-6;
  const double start = std::max(begin, begins);
  const bool above = std::abs(g(start)) > rounding ? g(start) > 0 : slope(start) > 0;
  double before = start;
  for (const double turn : course.turns()) {
    const double s = begin + turn * part;
    if (s <= start) continue;
    const double there = g(s);
    if ((there > 0) != above && std::abs(there) > rounding) {
      return Change{zero_between(g, above, before, s), true};
    }
    if (s < 1 && std::abs(there) < unsure) return Change{s, false};
    before = s;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Corner> SteppedRun::corners_here() const { return scene_.corners(t(), state()); }

/// Functions of corners are interpolated between both ends of the step, because its stages may lie on
/// both sides of a corner. Their dependence on time alone is known.
std::optional<SteppedRun::CornerTime> SteppedRun::first_corner(double from,
                                                               const Eigen::VectorXd& y) const {
  const double h = t() - from;
  const auto at_begin = [&](double time) {
    return scene_.corners(time, {y.data(), static_cast<std::size_t>(y.size())});
  };
  const std::vector<Corner> first = at_begin(from);
  const std::vector<Corner> last = corners_here();
  const std::vector<Corner> later = at_begin(t());
  constexpr double most_parts = 1e5;
  const double parts =
      std::clamp(std::ceil(std::abs(h) * scene_.corner_frequency()), 1.0, most_parts);
  std::optional<CornerTime> found;
  double earliest = 2;
  for (std::size_t k = 0; k < first.size(); ++k) {
    const double of_time = later[k].value - first[k].value;
    const Cubic of_state{first[k].value, h * (first[k].rate - first[k].rate_in_time),
                         last[k].value - of_time, h * (last[k].rate - last[k].rate_in_time)};
    const auto g = [&](double s) {
      if (s == 0) return first[k].value;
      if (s == 1) return last[k].value;
      return of_state(s) + at_begin(from + s * h)[k].value - first[k].value;
    };
    const auto slope = [&](double s) {
      return of_state.slope(s) + h * at_begin(from + s * h)[k].rate_in_time;
    };
    constexpr double errs = 0.05;  // of the bend, for half a radian in a step
    for (double i = 0; i < parts && i / parts < earliest; ++i) {
      const auto change = first_change(g, slope, i / parts, (i + 1) / parts, first[k].rounding,
                                       errs * of_state.bend());
      if (!change) continue;
      if (change->s < earliest) {
        earliest = change->s;
        found = {from + change->s * h, k, change->is_sure};
      }
      break;
    }
  }
  return found;
}

/// Takes the last step anew, up to the corner, which Newton's method finds by the ends of such steps.
void SteppedRun::end_step_at(const CornerTime& corner, double output) {
  const double limit = t();
  double at = corner.t;
  constexpr int most = 8;
  for (int i = 0; i < most; ++i) {
    if (!undo_step()) return;
    const double h = at - t();
    if (h * (limit - t()) <= 0) return;  // a change of method took two steps
    step_towards(at, output);
    if (!corner.is_sure || t() != at) return;
    const Corner now = corners_here()[corner.function];
    const double off = -now.value / now.rate;
    // Nearer times cannot be told apart.
    constexpr double least = 1e-12;
    const double width =
        std::max(least * std::abs(h), 8 * std::numeric_limits<double>::epsilon() * std::abs(at));
    if (std::abs(off) <= width || i + 1 == most) {
      crosses_ = std::copysign(std::min(std::abs(off), std::abs(h)) + 2 * width, h);
      return;
    }
    const double next = at + off;
    const bool is_inside = (next - (at - h)) * h > 0 && (limit - next) * h >= 0;
    at = is_inside ? next : at - h / 2;
  }
}

void SteppedRun::step_to_corner(double end, double output) {
  if (crosses_ != 0) {
    const double beyond = t() + std::exchange(crosses_, 0);
    step_towards(std::abs(beyond - t()) < std::abs(end - t()) ? beyond : end, output);
    return;
  }
  const double from = t();
  const Eigen::VectorXd y = vector_of<Eigen::VectorXd>(state());
  prepare_undo();
  step_towards(end, output);
  constexpr int most = 50;
  for (int i = 0; i < most && crosses_ == 0 && t() != from; ++i) {
    const std::optional<CornerTime> corner = first_corner(from, y);
    if (!corner) return;
    end_step_at(*corner, output);
  }
}

}  // namespace kreisel::detail
