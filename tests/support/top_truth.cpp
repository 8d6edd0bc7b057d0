#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <support/top_truth.hpp>

namespace kreisel::test {

namespace {

constexpr std::size_t order = 36;

/// Local error of a step, relative to the fastest of all quantities.
constexpr double tolerance = 1e-27;

/// A function of time as a Taylor polynomial.
using Series = std::array<Digits50, order + 1>;
using Series3 = std::array<Series, 3>;

/// Coefficient k of a product.
Digits50 product(const Series& a, const Series& b, std::size_t k) {
  Digits50 sum = 0;
  for (std::size_t i = 0; i <= k; ++i) sum += a[i] * b[k - i];
  return sum;
}

/// Coefficient k of component i of a x b.
Digits50 cross(const Series3& a, const Series3& b, std::size_t i, std::size_t k) {
  const std::size_t j = (i + 1) % 3;
  const std::size_t l = (i + 2) % 3;
  return product(a[j], b[l], k) - product(a[l], b[j], k);
}

Digits50 sum(const Series& a, const Digits50& h) {
  Digits50 value = 0;
  for (std::size_t k = a.size(); k-- > 0;) value = value * h + a[k];
  return value;
}

/// e_z of the inertial frame, on body axes.
Vector3<Digits50> vertical(const Eigen::Quaternion<Digits50>& q) {
  return {2 * (q.x() * q.z() - q.w() * q.y()), 2 * (q.y() * q.z() + q.w() * q.x()),
          q.w() * q.w() + q.z() * q.z() - q.x() * q.x() - q.y() * q.y()};
}

using Quaternion = Eigen::Quaternion<Digits50>;

Quaternion power(Quaternion q, long n) {
  Quaternion result(1, 0, 0, 0);
  for (; n > 0; n /= 2) {
    if (n % 2 == 1) result = result * q;
    q = q * q;
  }
  return result;
}

/// x + i y as a quaternion about e_z, for its powers.
Quaternion complex(const Digits50& x, const Digits50& y) { return {x, 0, 0, y}; }

/// first (later/first)^n  of complex numbers.
Quaternion after(const Quaternion& first, const Quaternion& later, long n) {
  if (first.squaredNorm() == 0) return first;
  return first * power(later * first.inverse(), n);
}

}  // namespace

TopTruth::TopTruth(const Vector3<double>& moments_, const Vector3<double>& rotor_,
                   double weight_moment_, const Vector3<double>& omega0,
                   const Eigen::Quaterniond& attitude0)
    : moments(cast<Digits50>(moments_)),
      rotor(cast<Digits50>(rotor_)),
      weight_moment(weight_moment_),
      omega(cast<Digits50>(omega0)),
      attitude(attitude0.w(), attitude0.x(), attitude0.y(), attitude0.z()) {
  attitude.coeffs() /= Digits50(sqrt(attitude.coeffs().dot(attitude.coeffs())));
}

Digits50 TopTruth::step(const Digits50& longest) {
  Series3 w;      // omega
  Series3 L;      // Theta omega + rotor
  Series3 gamma;  // the vertical
  Series3 v;      // of q = (s; v)
  Series s;
  const Vector3<Digits50> up = vertical(attitude);
  for (int i = 0; i < 3; ++i) {
    const auto n = static_cast<std::size_t>(i);
    w[n][0] = omega[i];
    L[n][0] = moments[i] * omega[i] + rotor[i];
    gamma[n][0] = up[i];
    v[n][0] = attitude.vec()[i];
  }
  s[0] = attitude.w();

  const bool heavy = weight_moment != 0;
  for (std::size_t k = 0; k < order; ++k) {
    const Digits50 next = 1 / Digits50(static_cast<int>(k + 1));
    for (std::size_t i = 0; i < 3; ++i) {
      Digits50 torque = cross(L, w, i, k);
      if (i == 0) torque += weight_moment * gamma[1][k];
      if (i == 1) torque -= weight_moment * gamma[0][k];
      L[i][k + 1] = torque * next;
      w[i][k + 1] = L[i][k + 1] / moments[static_cast<int>(i)];
      if (heavy) gamma[i][k + 1] = cross(gamma, w, i, k) * next;
      v[i][k + 1] = (product(s, w[i], k) + cross(v, w, i, k)) * next / 2;
    }
    s[k + 1] =
        -(product(v[0], w[0], k) + product(v[1], w[1], k) + product(v[2], w[2], k)) * next / 2;
  }

  double fastest = 0;
  double last = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    fastest = std::max(fastest, std::abs(static_cast<double>(w[i][0])));
    for (std::size_t k = order - 1; k <= order; ++k) {
      last = std::max(
          {last, std::abs(static_cast<double>(w[i][k])), std::abs(static_cast<double>(v[i][k]))});
    }
  }
  const double reach =
      last == 0 ? 1e300 : std::pow(tolerance * std::max(fastest, 1.0) / last, 1.0 / order);
  const Digits50 h = abs(longest) <= reach ? longest : Digits50(longest < 0 ? -reach : reach);

  for (std::size_t i = 0; i < 3; ++i) omega[static_cast<int>(i)] = sum(w[i], h);
  attitude = {sum(s, h), sum(v[0], h), sum(v[1], h), sum(v[2], h)};
  return h;
}

void TopTruth::advance(const Digits50& time) {
  Digits50 left = time;
  while (left != 0) left -= step(left);
}

Vector3<Digits50> TopTruth::acceleration() const {
  const Vector3<Digits50> L = moments.cwiseProduct(omega) + rotor;
  const Vector3<Digits50> up = vertical(attitude);
  const Vector3<Digits50> weight(weight_moment * up.y(), -weight_moment * up.x(), 0);
  return (L.cross(omega) + weight).cwiseQuotient(moments);
}

Digits50 TopTruth::advance_period(double guess) {
  const Vector3<Digits50> omega0 = omega;
  const Digits50 up0 = vertical(attitude).z();
  int fastest = 0;
  acceleration().cwiseAbs().maxCoeff(&fastest);
  Digits50 period = guess;
  advance(period);
  // Newton's method doubles the 15 digits of the guess each time.
  for (int i = 0; i < 2; ++i) {
    const Vector3<Digits50> up = vertical(attitude);
    const Digits50 late = weight_moment == 0
                              ? Digits50((omega - omega0)[fastest] / acceleration()[fastest])
                              : Digits50((up.z() - up0) / up.cross(omega).z());
    advance(-late);
    period -= late;
  }
  return period;
}

void TopTruth::advance_far(double time, double guess) {
  // Away from a turning point, where the tilt does not determine the time.
  advance(guess / 8);
  const Vector3<Digits50> omega0 = omega;
  const Quaternion q0 = attitude;
  const Digits50 period = advance_period(guess);
  const long n = static_cast<long>(time / guess) - 1;
  if (weight_moment == 0) {
    attitude = q0 * power(q0.conjugate() * attitude, n);
    omega = omega0;
  } else {
    const Quaternion alpha = after(complex(q0.w(), q0.z()), complex(attitude.w(), attitude.z()), n);
    const Quaternion beta = after(complex(q0.x(), q0.y()), complex(attitude.x(), attitude.y()), n);
    const Quaternion across =
        after(complex(omega0.x(), omega0.y()), complex(omega.x(), omega.y()), n);
    attitude = {alpha.w(), beta.w(), beta.z(), alpha.z()};
    omega = {across.w(), across.z(), omega0.z()};
  }
  advance(Digits50(time) - guess / 8 - n * period);
}

double TopTruth::rate_error(const Vector3<double>& other) const {
  const Vector3<Digits50> difference = omega - cast<Digits50>(other);
  return static_cast<double>(Digits50(sqrt(difference.dot(difference))));
}

double TopTruth::attitude_error(const Eigen::Quaterniond& other) const {
  const Eigen::Quaternion<Digits50> q(other.w(), other.x(), other.y(), other.z());
  const Eigen::Quaternion<Digits50> turn = attitude.conjugate() * q;
  return 2 * static_cast<double>(Digits50(sqrt(turn.vec().dot(turn.vec()))));
}

}  // namespace kreisel::test
