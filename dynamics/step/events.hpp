#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <dynamics/step/shared.hpp>

namespace kreisel {

/// Direction of a zero crossing.
enum class Crossing { any, rising, falling };

/// Integrates until g(t, y) changes its sign, or to `end`. Returns the time of the crossing, where
/// the integration then stands and may continue. Returns nothing if `end` is reached first.
///
/// The integration stands just behind the crossing, where g has its new sign. The next call
/// therefore finds the next crossing, and a zero of g at the start does not count. A g that touches
/// zero without crossing is no event. Two crossings within a sixteenth of a step are not found.
///
/// Steps  : has step_towards, t, y, at and back_to, as ExplicitRungeKutta
/// Error  : of the time 4 units in its last place, plus that of the trajectory
///          (tests/dynamics/step/events.cpp)
/// Cost   : 16 evaluations of g a step, and 10 more of the field
/// Throws : ComputationFailed naming the time where g is not finite, and as the steps do
template <class Steps, class Function>
[[nodiscard]] std::optional<typename Steps::Scalar> advance_to_event(
    Steps& steps, const Function& g, const typename Steps::Scalar& end,
    Crossing wanted = Crossing::any) {
  using Scalar = typename Steps::Scalar;
  constexpr int samples = 16;
  const auto counts = [wanted](const Scalar& before, const Scalar& after) {
    const bool rising = before < Scalar(0) && after > Scalar(0);
    const bool falling = before > Scalar(0) && after < Scalar(0);
    return (rising && wanted != Crossing::falling) || (falling && wanted != Crossing::rising);
  };
  const auto checked = [](const Scalar& time, const Scalar& g_now) {
    if (!(g_now - g_now == Scalar(0))) {
      detail::stop_integration(time, "the event's function is not finite");
    }
    return g_now;
  };
  const auto value = [&](const Scalar& time) {
    return checked(time, Scalar(g(time, steps.at(time))));
  };

  Scalar left = steps.t();
  Scalar g_left = checked(left, Scalar(g(left, steps.y())));
  while (steps.t() != end) {
    const Scalar from = steps.t();
    steps.step_towards(end);
    const Scalar length = steps.t() - from;
    for (int i = 1; i <= samples; ++i) {
      const Scalar right =
          i == samples ? steps.t() : Scalar(from + length * Scalar(i) / Scalar(samples));
      const Scalar g_right = value(right);
      if (!counts(g_left, g_right)) {
        if (g_right != Scalar(0)) {  // after an exact zero the next sign decides
          left = right;
          g_left = g_right;
        }
        continue;
      }
      // Illinois method: false position that halves the weight of an end that stays twice.
      Scalar a = left, ga = g_left, b = right, gb = g_right;
      const Scalar close =
          Scalar(4) * std::numeric_limits<Scalar>::epsilon() * std::max(std::abs(a), std::abs(b));
      for (int k = 0; k < 200 && std::abs(b - a) > close; ++k) {
        Scalar c = k % 3 == 2 ? Scalar((a + b) / 2) : Scalar(b - gb * (b - a) / (gb - ga));
        // Away from the ends: an iteration that reaches an end would not leave it.
        const Scalar margin = std::copysign(close / Scalar(2), b - a);
        c = b > a ? std::clamp(c, Scalar(a + margin), Scalar(b - margin))
                  : std::clamp(c, Scalar(b - margin), Scalar(a + margin));
        const Scalar gc = value(c);
        if ((gc > Scalar(0)) == (gb > Scalar(0)) && gc != Scalar(0)) {
          b = c;
          gb = gc;
          ga /= Scalar(2);
        } else {
          a = c;
          ga = gc;
          gb /= Scalar(2);
        }
      }
      steps.back_to(b);
      return b;
    }
  }
  return std::nullopt;
}

}  // namespace kreisel
