#pragma once

#include "random.hpp"
#include "scene.hpp"

/// Numbers, vectors and functions of time as users type them.

namespace differential {

/// Rounded to a number of digits, as typed.
[[nodiscard]] double rounded(double x, int digits);

/// A typical size, most often 1.
[[nodiscard]] double plain(Random& r, double least = 0.01, double most = 100);

[[nodiscard]] double sign(Random& r);

[[nodiscard]] Vector unit(Random& r);

/// A direction, mostly along an axis.
[[nodiscard]] Vector direction(Random& r);

[[nodiscard]] Vector vector(Random& r, double least = 0.01, double most = 10);

[[nodiscard]] Eigen::Vector4d attitude(Random& r);

[[nodiscard]] Angle phase(Random& r);

[[nodiscard]] Angle angle(Random& r);

[[nodiscard]] double speed(Random& r);

/// An angular rate; most users write radian.
[[nodiscard]] Angle rate(Random& r, bool degrees = false);

/// Oscillations, often of one frequency.
[[nodiscard]] Series series(Random& r, double size, double frequency);

/// A scalar function of time.
[[nodiscard]] Signal number_signal(Random& r, double size);

/// A function of time of about this size, along the direction that `along` draws.
template <class Along>
[[nodiscard]] Signal smooth_signal(Random& r, double size, const Along& along) {
  Signal s;
  if (r.chance(0.5)) s.series.constant = size * plain(r, 0.1, 3) * along();
  if (r.chance(0.4)) s.rate = 0.3 * size * plain(r, 0.1, 3) * along();
  const int terms = r.below(3);
  for (int i = 0; i < terms; ++i) {
    s.series.terms.push_back({size * plain(r, 0.1, 3) * along(), {plain(r, 0.1, 10)}, phase(r)});
  }
  return s;
}

/// The same, or one that jumps a few times in the first seconds.
template <class Along>
[[nodiscard]] Signal any_signal(Random& r, double size, const Along& along) {
  if (r.chance(0.4)) return smooth_signal(r, size, along);
  Signal s;
  s.jumps.is_broken_line = r.chance(0.5);
  double t = r.pick({0.0, 0.0, 0.1, -1.0});
  const int count = 1 + r.below(4);
  for (int i = 0; i < count; ++i) {
    s.jumps.times.push_back(t);
    s.jumps.values.push_back(size * plain(r, 0.1, 3) * along());
    t += rounded(r.pick({0.05, 0.3, 1.0, 2.5}) * r.between(0.5, 1), 2);
  }
  return s;
}

}  // namespace differential
