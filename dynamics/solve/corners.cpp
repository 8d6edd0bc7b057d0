#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <dynamics/solve/run.hpp>
#include <dynamics/step/shared.hpp>

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

/// A time difference that times near t tell from 0.
double rounding_of(double t) { return 4 * std::numeric_limits<double>::epsilon() * std::abs(t); }

/// The part of the way to a corner after which a step from t ends before it.
double short_of(double way, double t) {
  constexpr double before = 0.999;
  return std::min(before * way, way - rounding_of(t));
}

/// The time until the first of the corners, if their functions change at their present rates. Values
/// without a sign are at a corner if it is nearer than `width`.
///
/// way : 1 forwards, -1 backwards
double time_to_corner(const std::vector<Corner>& here, double way, double width) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Corner& corner : here) {
    const double ahead = way * -corner.value / corner.rate;
    const bool has_sign = std::abs(corner.value) > corner.rounding;
    if (ahead > 0 && (has_sign || ahead <= width)) nearest = std::min(nearest, ahead);
  }
  return nearest;
}

}  // namespace

std::vector<Corner> SteppedRun::corners_after(double from) const {
  return scene_.corners(on_this_side(t(), from, jumps_), state());
}

/// Functions of corners are interpolated between both ends of the step, because its stages may lie on
/// both sides of a corner. Their dependence on time alone is known.
std::optional<SteppedRun::CornerTime> SteppedRun::first_corner(const std::vector<Corner>& first,
                                                               double from,
                                                               const Eigen::VectorXd& y) const {
  const double h = t() - from;
  const auto at_begin = [&](double time) {
    return scene_.corners(time, {y.data(), static_cast<std::size_t>(y.size())});
  };
  const std::vector<Corner> last = corners_after(from);
  const std::vector<Corner> later = at_begin(on_this_side(t(), from, jumps_));
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
        found = {from + change->s * h, change->is_sure};
      }
      break;
    }
  }
  return found;
}

double SteppedRun::width_of_corner(double t) const {
  return std::max(corner_width_ * uncut_, 2 * rounding_of(t));
}

void SteppedRun::cross_corner(double ahead, double end, double output) {
  const double from = t();
  const double way = std::copysign(1, end - from);
  const double stop = next_stop(from, end, jumps_);
  const double beyond = from + way * (ahead + 2 * width_of_corner(from));
  cross((stop - beyond) * way > 0 ? beyond : stop, output);
}

/// A step must not end at a corner: its last stages would lie on both sides. Steps end before it, each
/// a thousand times nearer, until the last one crosses it. Error control alone would cut a step that
/// leads across a corner again and again.
void SteppedRun::step_to_corner(double end, double output) {
  const double from = t();
  const double way = std::copysign(1, end - from);
  const Eigen::VectorXd y = sampled_state();
  const std::vector<Corner> first = scene_.corners(on_this_side(from, end, jumps_),
                                                   {y.data(), static_cast<std::size_t>(y.size())});
  if (uncut_ == 0) uncut_ = 1e-3 * std::abs(end - from);
  const double width = width_of_corner(from);
  const double near = time_to_corner(first, way, width);
  if (near <= width) return cross_corner(near, end, output);
  const double goal = from + way * short_of(near, from);
  prepare_undo();
  step_towards((end - goal) * way > 0 ? goal : end, output);
  if (t() != goal) uncut_ = length();
  constexpr int most = 50;
  for (int i = 0; i < most && t() != from; ++i) {
    const std::optional<CornerTime> corner = first_corner(first, from, y);
    const double limit = t();
    if (!corner || !undo_step()) return;
    if (t() != from) return;  // a change of method took two steps
    const double ahead = std::abs(corner->t - from);
    if (ahead <= width) return cross_corner(ahead, end, output);
    const double at = from + way * (corner->is_sure ? short_of(ahead, from) : ahead);
    if ((limit - at) * way <= 0) return;
    step_towards(at, output);
  }
}

}  // namespace kreisel::detail
