#pragma once

#include <array>
#include <cstddef>

namespace kreisel::test {

/// The solution of y' = f(t, y) at `end` in long double, by a number of equal steps of the order 16.
///
/// Each step takes Gragg's modified midpoint rule with 2, 4, ... 16 parts and extrapolates the results
/// in the square of the part's length. No formula is that of the library's integrators.
///
/// Source : E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, II.9
template <std::size_t N, class F>
[[nodiscard]] std::array<long double, N> extrapolated(const F& f, std::array<long double, N> y,
                                                      long double begin, long double end,
                                                      int steps) {
  using State = std::array<long double, N>;
  constexpr std::size_t columns = 8;
  const long double H = (end - begin) / steps;
  const auto moved = [](const State& from, long double h, const State& rate) {
    State to = from;
    for (std::size_t i = 0; i < N; ++i) to[i] += h * rate[i];
    return to;
  };
  const auto midpoints = [&](long double t, const State& start, int parts) {
    const long double h = H / parts;
    State before = start;
    State now = moved(start, h, f(t, start));
    for (int k = 1; k < parts; ++k) {
      const State next = moved(before, 2 * h, f(t + k * h, now));
      before = now;
      now = next;
    }
    const State after = moved(before, h, f(t + H, now));
    State mean;
    for (std::size_t i = 0; i < N; ++i) mean[i] = (now[i] + after[i]) / 2;
    return mean;
  };
  for (int step = 0; step < steps; ++step) {
    const long double t = begin + step * H;
    std::array<State, columns> table;
    for (std::size_t k = 0; k < columns; ++k) {
      table[k] = midpoints(t, y, 2 * static_cast<int>(k + 1));
      for (std::size_t j = k; j-- > 0;) {
        const long double ratio = static_cast<long double>(k + 1) / static_cast<long double>(j + 1);
        for (std::size_t i = 0; i < N; ++i) {
          table[j][i] = table[j + 1][i] + (table[j + 1][i] - table[j][i]) / (ratio * ratio - 1);
        }
      }
    }
    y = table[0];
  }
  return y;
}

}  // namespace kreisel::test
