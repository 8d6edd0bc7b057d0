#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <dynamics/study/rotor_sweep.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

bool oscillates(const WhirlingMode& mode) {
  return mode.root.imag() > mode.error || mode.harmonic != 0;
}

bool grows(const WhirlingMode& mode) { return mode.root.real() > mode.error; }

/// The likeness of two modes whose speeds differ by `step`. On a carrier that turns, a frequency may
/// pass through 0: the mode is then continued by its conjugate.
double likeness(const WhirlingMode& a, const WhirlingMode& b, double step) {
  const double same = std::abs(a.shape.dot(b.shape));
  const bool is_carried = std::abs(b.frequency() - b.root.imag()) > 1e-9 && b.harmonic == 0;
  const bool may_pass_zero = is_carried && a.root.imag() + b.root.imag() <= 2 * std::abs(step);
  if (!may_pass_zero) return same;
  return std::max(same, std::abs(a.shape.dot(b.shape.conjugate())));
}

/// Appends the modes at one more speed to the most similar curves. The other modes start new
/// curves.
void connect(std::vector<ModeCurve>& curves, std::vector<WhirlingMode> modes, std::size_t before,
             double step) {
  struct Pair {
    double likeness;
    std::size_t curve, mode;
  };
  std::vector<Pair> pairs;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!curves[c].back()) continue;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      pairs.push_back({likeness(*curves[c].back(), modes[m], step), c, m});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.likeness > b.likeness; });
  std::vector<bool> taken(modes.size(), false);
  for (const auto& [like, c, m] : pairs) {
    if (like < 0.3 || taken[m] || curves[c].size() > before) continue;
    curves[c].emplace_back(modes[m]);
    taken[m] = true;
  }
  for (ModeCurve& curve : curves) {
    if (curve.size() == before) curve.emplace_back();
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    if (taken[m]) continue;
    curves.emplace_back(before);
    curves.back().emplace_back(std::move(modes[m]));
  }
}

/// The zero of a continuous function between a and b, where its values are f_a and f_b, by the
/// false position with halved weights (Illinois).
template <class F>
double zero(const F& function, double a, double f_a, double b, double f_b, double accuracy) {
  double last = a;
  for (int i = 0; i < 200 && f_b != 0; ++i) {
    const double c = b - f_b * (b - a) / (f_b - f_a);
    const double f_c = function(c);
    if ((f_c < 0) == (f_b < 0)) {
      f_a /= 2;
    } else {
      a = b;
      f_a = f_b;
    }
    b = c;
    f_b = f_c;
    if (std::abs(b - last) <= accuracy / 4 * std::abs(b) || f_a == 0) break;
    last = b;
  }
  return b;
}

/// The modes of one speed, kept for searches.
class CurveAt {
 public:
  CurveAt(const ModesAt& modes, const WhirlingMode& a, const WhirlingMode& b, double step)
      : modes_(modes), a_(a), b_(b), step_(step) {}

  /// The mode on the curve from a to b.
  [[nodiscard]] WhirlingMode operator()(double speed) const {
    const std::vector<WhirlingMode> all = modes_(speed);
    const WhirlingMode* best = nullptr;
    double greatest = -1;
    for (const WhirlingMode& mode : all) {
      const double like = likeness(a_, mode, step_) + likeness(b_, mode, step_);
      if (like <= greatest || !oscillates(mode)) continue;
      greatest = like;
      best = &mode;
    }
    if (best == nullptr) throw ComputationFailed("critical speed: the mode is lost between speeds");
    return *best;
  }

 private:
  const ModesAt& modes_;
  const WhirlingMode& a_;
  const WhirlingMode& b_;
  double step_;
};

/// Appends the crossings of a curve with the line of an order.
void add_critical(const ModesAt& modes, std::size_t index, double order, double accuracy,
                  RotorSweep& sweep) {
  const ModeCurve& curve = sweep.curves[index];
  const auto above = [order](const WhirlingMode& mode, double speed) {
    return mode.frequency() - order * std::abs(speed);
  };
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (!curve[i - 1] || !curve[i]) continue;
    const double from = sweep.speeds[i - 1], to = sweep.speeds[i];
    const double f_from = above(*curve[i - 1], from), f_to = above(*curve[i], to);
    // A frequency may stay at the line over an interval, but for rounding.
    if ((f_from < -curve[i - 1]->error) == (f_to < -curve[i]->error)) continue;
    const CurveAt at(modes, *curve[i - 1], *curve[i], to - from);
    const auto distance = [&](double speed) { return above(at(speed), speed); };
    const double speed = zero(distance, from, f_from, to, f_to, accuracy);
    sweep.critical.push_back({speed, order, at(speed), index});
  }
}

/// The growing mode of a speed; none if motions do not grow.
std::optional<WhirlingMode> growing(const std::vector<WhirlingMode>& modes) {
  std::optional<WhirlingMode> fastest;
  for (const WhirlingMode& mode : modes) {
    const bool is_faster = !fastest || mode.root.real() > fastest->root.real();
    if (grows(mode) && is_faster) fastest = mode;
  }
  return fastest;
}

/// The limit of stability between two speeds, by bisection.
StabilityLimit limit_between(const ModesAt& modes, double a, double b, WhirlingMode mode,
                             bool begins, double accuracy) {
  const double width = accuracy * std::max(std::abs(a), std::abs(b));
  while (std::abs(b - a) > width) {
    const double middle = a + (b - a) / 2;
    const auto now = growing(modes(middle));
    if (now) mode = *now;
    (now.has_value() == begins ? b : a) = middle;
  }
  return {a + (b - a) / 2, begins, std::move(mode)};
}

void check(const std::vector<double>& speeds, const SweepOptions& options) {
  for (const double order : options.orders) {
    if (order > 0 && std::isfinite(order)) continue;
    throw InvalidInput("rotor sweep: the orders of critical speeds must be above 0");
  }
  const bool rises =
      std::adjacent_find(speeds.begin(), speeds.end(), std::greater_equal<>()) == speeds.end();
  const bool falls =
      std::adjacent_find(speeds.begin(), speeds.end(), std::less_equal<>()) == speeds.end();
  if (!rises && !falls) throw InvalidInput("rotor sweep: the speeds must rise or fall");
}

}  // namespace

RotorSweep rotor_sweep(const ModesAt& modes, std::vector<double> speeds,
                       const SweepOptions& options) {
  check(speeds, options);
  RotorSweep sweep;
  sweep.speeds = std::move(speeds);
  std::optional<WhirlingMode> before;
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i) {
    const double from = i > 0 ? sweep.speeds[i - 1] : sweep.speeds[i], to = sweep.speeds[i];
    std::vector<WhirlingMode> now = modes(to);
    std::optional<WhirlingMode> growth = growing(now);
    if (i > 0 && growth.has_value() != before.has_value()) {
      const bool begins = growth.has_value();
      sweep.limits.push_back(
          limit_between(modes, from, to, begins ? *growth : *before, begins, options.accuracy));
    }
    before = std::move(growth);
    now.erase(std::remove_if(now.begin(), now.end(), std::not_fn(oscillates)), now.end());
    connect(sweep.curves, std::move(now), i, to - from);
  }
  for (const double order : options.orders) {
    for (std::size_t c = 0; c < sweep.curves.size(); ++c) {
      add_critical(modes, c, order, options.accuracy, sweep);
    }
  }
  std::stable_sort(sweep.critical.begin(), sweep.critical.end(),
                   [](const auto& a, const auto& b) { return a.speed < b.speed; });
  return sweep;
}

}  // namespace kreisel
