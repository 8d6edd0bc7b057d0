#include "draw.hpp"

#include <algorithm>
#include <cmath>

namespace differential {

/// Rounded to a number of digits, as typed.
double rounded(double x, int digits) {
  if (x == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(x))) - digits + 1);
  const double scaled = std::round(x / unit);
  return unit < 1 ? scaled / std::round(1 / unit) : scaled * unit;
}

/// A typical size, most often 1.
double plain(Random& r, double least, double most) {
  if (r.chance(0.4)) return 1;
  if (r.chance(0.4)) return std::clamp(r.pick({0.1, 0.2, 0.5, 2.0, 5.0, 10.0}), least, most);
  return rounded(r.spread(least, most), r.chance(0.7) ? 2 : 15);
}

double sign(Random& r) { return r.chance(0.5) ? 1 : -1; }

Vector unit(Random& r) {
  Vector v = Vector::Zero();
  v[r.below(3)] = sign(r);
  return v;
}

/// A direction, mostly along an axis.
Vector direction(Random& r) {
  if (r.chance(0.75)) return unit(r);
  if (r.chance(0.5)) return {sign(r), sign(r), r.chance(0.5) ? 0 : 1.0};
  Vector v;
  do {
    for (double& x : v) x = rounded(r.between(-1, 1), 3);
  } while (v.norm() < 0.1);
  return v;
}

Vector vector(Random& r, double least, double most) {
  if (r.chance(0.2)) return Vector::Zero();
  return plain(r, least, most) * direction(r);
}

Eigen::Vector4d attitude(Random& r) {
  const double half = std::sqrt(0.5);
  if (r.chance(0.15)) return {1, 0, 0, 0};
  if (r.chance(0.3)) {
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    q[r.below(3) + 1] = r.chance(0.5) ? 1 : half;  // half or quarter turns
    q[0] = q.squaredNorm() < 0.9 ? sign(r) * half : 0;
    return q;
  }
  Eigen::Vector4d q;
  for (double& x : q) x = r.between(-1, 1);
  return q.normalized();
}

Angle phase(Random& r) {
  if (r.chance(0.7)) return {90.0 * r.below(5), true};
  return {rounded(r.between(-3, 3), 3), false};
}

Angle angle(Random& r) {
  if (r.chance(0.3)) return {0, r.chance(0.5)};
  if (r.chance(0.3)) return {r.pick({90.0, -90.0, 180.0, 45.0, 360.0, 30.0}), true};
  if (r.chance(0.15)) return {sign(r) * r.pick({1e-20, 1e-14, 1e-9, 1e-6}), false};
  return {rounded(r.between(-3, 3), 2), false};
}

double speed(Random& r) {
  if (r.chance(0.5)) return 0;
  if (r.chance(0.08)) return sign(r) * r.pick({1e-12, 1e-6, 1e3});
  return sign(r) * plain(r, 0.01, 30);
}

/// An angular rate; most users write radian.
Angle rate(Random& r, bool degrees) {
  if (degrees) return {r.pick({0.0, 1.0, 10.0, 90.0, -360.0, 720.0}), true};
  return {speed(r), false};
}

/// Oscillations, often of one frequency.
Series series(Random& r, double size, double frequency) {
  Series s;
  if (r.chance(0.25)) s.constant = size * vector(r, 0.1, 3);
  const int terms = r.below(3) + (s.constant.isZero(0) ? 1 : 0);
  for (int i = 0; i < terms; ++i) {
    const double w = r.chance(0.6) ? frequency : plain(r, 0.1, 10);
    const bool degrees = r.chance(0.1);
    const Angle turning{degrees ? rounded(w / 0.0174533, 3) : w, degrees};
    s.terms.push_back({size * plain(r, 0.1, 3) * direction(r), turning, phase(r)});
  }
  return s;
}

/// A scalar function of time.
Signal number_signal(Random& r, double size) {
  return any_signal(r, size, [&r] { return Vector(sign(r) * Vector::UnitX()); });
}

}  // namespace differential
