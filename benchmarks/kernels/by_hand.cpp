// The operations on arrays of numbers, without a library: the least cost.

#include <cmath>

#include "contender.hpp"

namespace kernels {

namespace {

using Six = std::array<double, 6>;
using Ten = std::array<double, 10>;
using Twelve = std::array<double, 12>;

inline Six product(const double* a, const double* b) {
  return {a[1] * b[2] - a[2] * b[1],
          a[2] * b[0] - a[0] * b[2],
          a[0] * b[1] - a[1] * b[0],
          a[1] * b[5] - a[2] * b[4] + a[4] * b[2] - a[5] * b[1],
          a[2] * b[3] - a[0] * b[5] + a[5] * b[0] - a[3] * b[2],
          a[0] * b[4] - a[1] * b[3] + a[3] * b[1] - a[4] * b[0]};
}

inline Six momentum(const double* T, const double* V) {
  const double m = T[0], x = T[1], y = T[2], z = T[3];
  return {m * V[3] + V[1] * z - V[2] * y,
          m * V[4] + V[2] * x - V[0] * z,
          m * V[5] + V[0] * y - V[1] * x,
          y * V[5] - z * V[4] + T[4] * V[0] + T[7] * V[1] + T[8] * V[2],
          z * V[3] - x * V[5] + T[7] * V[0] + T[5] * V[1] + T[9] * V[2],
          x * V[4] - y * V[3] + T[8] * V[0] + T[9] * V[1] + T[6] * V[2]};
}

inline Six sum(const Six& a, const Six& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5]};
}

inline double row(const double* R, int i, const double* v) {
  return R[i] * v[0] + R[i + 3] * v[1] + R[i + 6] * v[2];
}

inline Six displaced(const double* X, const double* a) {
  const double x = row(X, 0, a), y = row(X, 1, a), z = row(X, 2, a);
  return {x,
          y,
          z,
          row(X, 0, a + 3) + X[10] * z - X[11] * y,
          row(X, 1, a + 3) + X[11] * x - X[9] * z,
          row(X, 2, a + 3) + X[9] * y - X[10] * x};
}

inline Twelve composed(const double* X, const double* Y) {
  return {row(X, 0, Y),
          row(X, 1, Y),
          row(X, 2, Y),
          row(X, 0, Y + 3),
          row(X, 1, Y + 3),
          row(X, 2, Y + 3),
          row(X, 0, Y + 6),
          row(X, 1, Y + 6),
          row(X, 2, Y + 6),
          row(X, 0, Y + 9) + X[9],
          row(X, 1, Y + 9) + X[10],
          row(X, 2, Y + 9) + X[11]};
}

/// R T R^t, then Steiner's terms for the first moment s and the mass.
inline Ten displaced_inertia(const double* X, const double* T) {
  const auto times_row = [&](int i) {
    const double x = X[i], y = X[i + 3], z = X[i + 6];
    return std::array{T[4] * x + T[7] * y + T[8] * z, T[7] * x + T[5] * y + T[9] * z,
                      T[8] * x + T[9] * y + T[6] * z};
  };
  const auto p = times_row(0), q = times_row(1), r = times_row(2);
  const double m = T[0], x = X[9], y = X[10], z = X[11];
  const double sx = row(X, 0, T + 1), sy = row(X, 1, T + 1), sz = row(X, 2, T + 1);
  const double fx = sx + m / 2 * x, fy = sy + m / 2 * y, fz = sz + m / 2 * z;
  const double xx = 2 * x * fx, yy = 2 * y * fy, zz = 2 * z * fz;
  return {m,
          sx + m * x,
          sy + m * y,
          sz + m * z,
          row(X, 0, p.data()) + yy + zz,
          row(X, 1, q.data()) + xx + zz,
          row(X, 2, r.data()) + xx + yy,
          row(X, 1, p.data()) - (x * fy + y * fx),
          row(X, 2, p.data()) - (x * fz + z * fx),
          row(X, 2, q.data()) - (y * fz + z * fy)};
}

/// The function for angles that are not small.
inline Twelve exponential(const double* w) {
  const double* v = w + 3;
  const double t2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
  const double theta = std::sqrt(t2), s = std::sin(theta / 2);
  const double a = 2 * s * std::cos(theta / 2) / theta, b = 2 * s * s / t2, c = (1 - a) / t2;
  const double x = b * w[0], y = b * w[1], z = b * w[2], d = 1 - b * t2;
  const double wv = c * (w[0] * v[0] + w[1] * v[1] + w[2] * v[2]);
  return {d + x * w[0],
          x * w[1] + a * w[2],
          x * w[2] - a * w[1],
          x * w[1] - a * w[2],
          d + y * w[1],
          y * w[2] + a * w[0],
          x * w[2] + a * w[1],
          y * w[2] - a * w[0],
          d + z * w[2],
          a * v[0] + wv * w[0] + y * v[2] - z * v[1],
          a * v[1] + wv * w[1] + z * v[0] - x * v[2],
          a * v[2] + wv * w[2] + x * v[1] - y * v[0]};
}

/// The function for angles that are neither small nor near the half turn.
inline Six logarithm(const double* X) {
  const double* x = X + 9;
  const double twice = (X[0] + X[4] + X[8] + 1) / 2;
  const double a = (X[5] - X[7]) / 2, b = (X[6] - X[2]) / 2, c = (X[1] - X[3]) / 2;
  const double s = std::sqrt(a * a + b * b + c * c);
  const double theta = 2 * std::atan2(s, twice), ratio = theta / s, gamma = ratio * twice / 2;
  const double w[3] = {ratio * a, ratio * b, ratio * c};
  const double wx = (1 - gamma) / (theta * theta) * (w[0] * x[0] + w[1] * x[1] + w[2] * x[2]);
  return {w[0],
          w[1],
          w[2],
          gamma * x[0] + wx * w[0] - (w[1] * x[2] - w[2] * x[1]) / 2,
          gamma * x[1] + wx * w[1] - (w[2] * x[0] - w[0] * x[2]) / 2,
          gamma * x[2] + wx * w[2] - (w[0] * x[1] - w[1] * x[0]) / 2};
}

const auto as_it_is = [](const auto& numbers) { return numbers; };

}  // namespace

std::vector<Contender> by_hand(const All& numbers) {
  const auto work = [&numbers](const char* operation, auto operate) {
    return contender(operation, "by hand", numbers, operate, as_it_is);
  };
  return {
      work("motor product", [](const Numbers& n) { return product(n.a.data(), n.b.data()); }),
      work("inertia times motor",
           [](const Numbers& n) { return momentum(n.inertia.data(), n.a.data()); }),
      work("displace a motor",
           [](const Numbers& n) { return displaced(n.pose.data(), n.a.data()); }),
      work("displace an inertia",
           [](const Numbers& n) { return displaced_inertia(n.pose.data(), n.inertia.data()); }),
      work("compose displacements",
           [](const Numbers& n) { return composed(n.pose.data(), n.other.data()); }),
      work("momentum bias",
           [](const Numbers& n) {
             return product(n.a.data(), momentum(n.inertia.data(), n.a.data()).data());
           }),
      work("Newton-Euler residual",
           [](const Numbers& n) {
             return sum(momentum(n.inertia.data(), n.b.data()),
                        product(n.a.data(), momentum(n.inertia.data(), n.a.data()).data()));
           }),
      work("rate seen from elsewhere",
           [](const Numbers& n) {
             const Six p = product(n.a.data(), momentum(n.inertia.data(), n.a.data()).data());
             return Six{n.b[0] - p[0], n.b[1] - p[1], n.b[2] - p[2],
                        n.b[3] - p[3], n.b[4] - p[4], n.b[5] - p[5]};
           }),
      work("exponential", [](const Numbers& n) { return exponential(n.a.data()); }),
      work("logarithm", [](const Numbers& n) { return logarithm(n.pose.data()); }),
  };
}

}  // namespace kernels
