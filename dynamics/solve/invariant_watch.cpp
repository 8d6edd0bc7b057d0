#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <dynamics/solve/invariant_watch.hpp>

namespace kreisel::detail {

double InvariantWatch::least_error(double t, std::span<const double> y,
                                   std::span<const double> sizes) const {
  if (drifts_.empty()) return 0;
  const auto invariants_at = [&](std::span<const double> state) {
    std::vector<InvariantDrift> values;
    scene_.note_invariants(t, state, values);
    return values;
  };
  const std::vector<InvariantDrift> here = invariants_at(y);
  std::vector<double> range(here.size(), 0);
  std::vector<double> moved(y.begin(), y.end());
  const std::vector<int> blocks = scene_.blocks();
  std::size_t i = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const double size = blocks[k] == 4 ? 1 : sizes[k];  // quaternions
    for (const std::size_t end = i + static_cast<std::size_t>(blocks[k]); i < end; ++i) {
      // A change by a part of the size gives the effect of small errors. Where they have no effect,
      // the change by the whole size counts.
      moved[i] = y[i] + size;
      const std::vector<InvariantDrift> far = invariants_at(moved);
      constexpr double part = 1e-6;
      moved[i] = y[i] + part * size;
      const std::vector<InvariantDrift> near = invariants_at(moved);
      moved[i] = y[i];
      for (std::size_t m = 0; m < here.size(); ++m) {
        range[m] += std::max(std::abs(far[m].start - here[m].start),
                             std::abs(near[m].start - here[m].start) / part);
      }
    }
  }
  double least = 0;
  for (std::size_t m = 0; m < here.size(); ++m) {
    // The potential of a planet is far greater than its changes.
    const double own_rounding =
        16 * std::numeric_limits<double>::epsilon() * std::abs(drifts_[m].start);
    constexpr double rounding = 1e-13;
    const double error = (drifts_[m].largest - own_rounding) / range[m];
    if (error > rounding) least = std::max(least, error);
  }
  return least;
}

}  // namespace kreisel::detail
