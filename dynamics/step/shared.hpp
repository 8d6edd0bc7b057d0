#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/signal/same_time.hpp>
#include <dynamics/step/compensated.hpp>
#include <motor/double_double_functions.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>

/// Functions shared by the steppers.
namespace kreisel::detail {

template <class... Words>
[[noreturn]] void refuse_steps(const Words&... words) {
  std::ostringstream text;
  text.precision(10);
  (text << ... << words);
  throw InvalidInput(text.str());
}

template <class Failure = ComputationFailed, class S, class... Words>
[[noreturn]] void stop_integration(const S& t, const Words&... words) {
  std::ostringstream text;
  text.precision(17);
  text << "integration stopped at t = " << t << " s: ";
  (text << ... << words);
  throw Failure(text.str());
}

template <class S>
[[noreturn]] void stop_without_evaluations(const S& t, double allowed) {
  stop_integration(t, allowed, " evaluations are spent; a larger tolerance or another method may ",
                   "need fewer");
}

/// Keeps the reason why a field fails at a trial point. A shorter step may avoid that point. If no
/// step does, it is the reason to stop.
template <class S>
class TrialFailure {
 public:
  /// True if a step from t finds rates at all its points.
  template <class Trial>
  [[nodiscard]] bool succeeds(const S& t, const Trial& trial) {
    try {
      trial();
      return true;
    } catch (const ComputationFailed& error) {
      reason_ = error.what();
      t_ = t;
      return false;
    }
  }

  /// Stops for the reason if the field failed at t or later.
  void stop(const S& t) const {
    if (!reason_.empty() && t == t_) stop_integration(t, reason_);
  }

 private:
  std::string reason_;
  S t_ = S(0);
};

inline void require_blocks(std::span<const int> blocks, int components) {
  int sum = 0;
  for (const int size : blocks) sum += size;
  if (sum != components) {
    refuse_steps("blocks of ", sum, " components for a state of ", components);
  }
}

inline void require_step(double step) {
  if (!(step > 0 && std::isfinite(step))) {
    refuse_steps("step = ", step, " s must be a finite number above 0");
  }
}

/// `end`, or the first discontinuity between t and `end`. Jumps are in order. One that differs from t
/// or `end` only by rounding is at that time: no step fits between them.
template <class S>
[[nodiscard]] S next_stop(const S& t, const S& end, const std::vector<S>& jumps) {
  const auto stops = [&](const S& jump) { return !is_same_time(jump, t); };
  const auto goal = [&end](const S& jump) { return is_same_time(jump, end) ? end : jump; };
  if (t < end) {
    auto next = std::upper_bound(jumps.begin(), jumps.end(), t);
    while (next != jumps.end() && !stops(*next)) ++next;
    return next != jumps.end() && *next < end ? goal(*next) : end;
  }
  auto next = std::make_reverse_iterator(std::lower_bound(jumps.begin(), jumps.end(), t));
  while (next != jumps.rend() && !stops(*next)) ++next;
  return next != jumps.rend() && *next > end ? goal(*next) : end;
}

/// Times in order.
template <class S>
[[nodiscard]] std::vector<S> sorted(std::vector<S> times) {
  std::sort(times.begin(), times.end());
  return times;
}

/// True if a step of length h is the last one of the distance `left`, up to 256 roundings of h.
template <class S>
[[nodiscard]] bool is_last(const S& h, const S& left) {
  using std::abs;
  return abs(left) <= abs(h) * (S(1) + S(256) * std::numeric_limits<S>::epsilon());
}

/// True if a field writes its rate into a vector that has its size already.
template <class Field, class S, class Vector>
inline constexpr bool writes_in_place =
    std::is_invocable_v<Field&, const S&, const Vector&, Vector&>;

/// The rate of a field, for both ways to call it.
template <class Field, class S, class Vector>
void call(Field& field, const S& t, const Vector& y, Vector& rate) {
  if constexpr (writes_in_place<Field, S, Vector>) {
    field(t, y, rate);
  } else {
    rate = field(t, y);
  }
}

/// As above, as a new vector. The field constructs the result in place, without a copy.
template <class Field, class S, class Vector>
[[nodiscard]] Vector rate_of(Field& field, const S& t, const Vector& y) {
  if constexpr (writes_in_place<Field, S, Vector>) {
    Vector rate(y.size());
    field(t, y, rate);
    return rate;
  } else {
    return field(t, y);
  }
}

/// A state, converted to another vector type.
template <class To, class From>
[[nodiscard]] To vector_of(const From& y) {
  const auto components = static_cast<std::ptrdiff_t>(y.size());
  To result(components);
  std::copy_n(y.data(), components, result.data());
  return result;
}

/// The nearest time on the given side of t if the field is discontinuous at t; else t.
template <class S>
[[nodiscard]] S on_this_side(const S& t, const S& side, const std::vector<S>& jumps) {
  using std::nextafter;
  S here = t;
  bool jumps_here = false;
  auto near = std::lower_bound(jumps.begin(), jumps.end(), t);
  if (near != jumps.begin() && is_same_time(*std::prev(near), t)) --near;
  for (; near != jumps.end() && is_same_time(*near, t); ++near) {
    jumps_here = true;
    here = side > t ? std::max(here, *near) : std::min(here, *near);
  }
  return jumps_here ? S(nextafter(here, side)) : t;
}

/// Moves the components of a state by a number of units in the last digit, up and down in turn.
template <class Vector>
void move_last_digits(Vector& y, double by) {
  using Number = typename Vector::Scalar;
  using Scalar = ScalarOf<Number>;
  const Scalar part = Scalar(by) * std::numeric_limits<Scalar>::epsilon();
  for (int i = 0; i < int(y.size()); ++i) {
    const Number moved = part * y[i];
    y[i] += i % 2 == 0 ? moved : Number(-moved);
  }
}

/// Perturbs the change in a step by a number of units in the last digit, each component up or down
/// at random. A repeated step of the same length is perturbed in the same way, another step
/// differently. Runs of different accuracy are therefore perturbed differently.
///
/// Source : the random bits: G. Steele, D. Lea, C. Flood, Fast splittable pseudorandom number
///          generators, OOPSLA 2014 (SplitMix64)
template <class Vector>
void perturb(Vector& change, double digits, double step, double length) {
  using Number = typename Vector::Scalar;
  using Scalar = ScalarOf<Number>;
  if (digits == 0) return;
  std::uint64_t bits = (static_cast<std::uint64_t>(step) + 1) * 0x9E3779B97F4A7C15U;
  bits += std::bit_cast<std::uint64_t>(length) + std::bit_cast<std::uint64_t>(digits);
  bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
  bits ^= bits >> 31U;
  const Scalar part = Scalar(digits) * std::numeric_limits<Scalar>::epsilon();
  for (int i = 0; i < int(change.size()); ++i) {
    const bool up = ((bits >> (static_cast<unsigned>(i) % 64U)) & 1U) != 0;
    change[i] += Number(up ? part : -part) * change[i];
  }
}

/// `count` steps of equal length, at most the requested one. The length has 106 bits: over
/// many steps its rounding is an error of time that grows with their number.
struct EqualSteps {
  double count;
  DoubleDouble length;

  template <class S>
  EqualSteps(const Compensated<S>& time, const S& end, double step) {
    if (!std::isfinite(static_cast<double>(end))) refuse_steps("the end time is not finite");
    const DoubleDouble left =
        (DoubleDouble(end) - DoubleDouble(time.value)) - DoubleDouble(time.rest);
    // An end at a multiple of the step takes exactly that many steps, despite rounding.
    count = std::max(1.0, std::ceil(abs(left).hi / step * (1 - 1e-12)));
    length = left / count;
    const double moved = std::abs(length.hi);
    const double there =
        std::max(std::abs(static_cast<double>(time.value)), std::abs(static_cast<double>(end)));
    if (left.hi != 0 && !(moved > 4 * std::numeric_limits<double>::epsilon() * there)) {
      stop_integration(time.value, "steps of ", step, " s are too short to move time on");
    }
  }
};

}  // namespace kreisel::detail
