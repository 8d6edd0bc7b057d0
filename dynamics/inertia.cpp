#include <cstdio>

#include <dynamics/inertia.hpp>

namespace kreisel {

namespace detail {

void refuse_inertia(const std::string& what, const char* why, double a, double b, double c) {
  char text[160];
  std::snprintf(text, sizeof text, why, a, b, c);
  throw InvalidInput(what + ": " + text);
}

/// The legal tensor nearest to a tensor whose principal moments a <= b <= c violate a + b >= c or a
/// >= 0, in the sum of squares of all entries:
///
///   T + e/3 (1 - 2 v v^t)  with e = c - a - b and v along c;  (b + c)/2 (1 - v v^t)  with v along
///   a, if the first has a moment below 0
[[nodiscard]] inline Symmetric3<double> nearest_legal(const Symmetric3<double>& t,
                                                      const std::array<double, 3>& moments) {
  const auto& [a, b, c] = moments;
  const Symmetric3<double> one{1, 1, 1, 0, 0, 0};
  const Symmetric3<double> square{
      t.xx * t.xx + t.xy * t.xy + t.xz * t.xz, t.xy * t.xy + t.yy * t.yy + t.yz * t.yz,
      t.xz * t.xz + t.yz * t.yz + t.zz * t.zz, t.xx * t.xy + t.xy * t.yy + t.xz * t.yz,
      t.xx * t.xz + t.xy * t.yz + t.xz * t.zz, t.xy * t.xz + t.yy * t.yz + t.yz * t.zz};
  // v v^t of the moment x, from the other moments p and q: (T - p)(T - q) over its value along v
  const auto along = [&](double x, double p, double q) {
    return 1 / ((x - p) * (x - q)) * (square - (p + q) * t + p * q * one);
  };
  if (2 * a + c - b >= 0) return t + (c - a - b) / 3 * (one - 2.0 * along(c, a, b));
  return (b + c) / 2 * (one - along(a, b, c));
}

void refuse_moments(const std::string& what, const char* why, const Symmetric3<double>& t,
                    const std::array<double, 3>& moments) {
  const auto& [a, b, c] = moments;
  char text[320];
  int used = std::snprintf(text, sizeof text, why, a, b, c);
  const double violation = std::max(c - a - b, -a);
  if (violation <= 1e-3 * c) {
    const Symmetric3<double> m = nearest_legal(t, moments);
    used += std::snprintf(text + used, sizeof text - static_cast<std::size_t>(used),
                          ", by %.2g of the greatest; nearest legal tensor: [%.14g, %.14g, %.14g",
                          violation / c, m.xx, m.yy, m.zz);
    const bool is_diagonal = t.xy == 0 && t.xz == 0 && t.yz == 0;
    std::snprintf(text + used, sizeof text - static_cast<std::size_t>(used),
                  is_diagonal ? "]" : ", %.14g, %.14g, %.14g]", m.xy, m.xz, m.yz);
  }
  throw InvalidInput(what + ": " + text);
}

}  // namespace detail

template void check(const Inertia<double>& T, Mass rule, const std::string& what);

}  // namespace kreisel
