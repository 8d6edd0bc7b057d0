#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include <motor/motor.hpp>
#include <motor/static_zero.hpp>
#include <motor/tensor.hpp>

namespace kreisel {

/// A displacement without frame tags: rotation R and translation x,  p -> R p + x. Robotics: a
/// pose, an element of SE(3).
///
/// As a change of coordinates it takes components in a frame B to components in a frame A: R
/// rotates B axes into A axes, x is B's origin on A axes. The rotation is a matrix: applying it
/// costs less than applying a quaternion (benchmarks/kernels.cpp).
///
/// Units  : [translation] = metre
template <class S = double>
struct Pose {
  Matrix3<S> rotation = Matrix3<S>::Identity();
  Vector3<S> translation = Vector3<S>::Zero();

  using Scalar = S;

  /// The pose of a quaternion of any norm whose square is a normal number (1e-150 to 1e150). q and
  /// s q give the same rotation to rounding.
  [[nodiscard]] static Pose from(const Eigen::Quaternion<S>& q,
                                 const Vector3<S>& translation = Vector3<S>::Zero()) {
    const Vector3<S> v = q.vec();
    const S two_over_norm2 = S(2) / q.squaredNorm();
    const Matrix3<S> k = skew(v);
    const Matrix3<S> turn = two_over_norm2 * (q.w() * k + k * k);
    return {Matrix3<S>::Identity() + turn, translation};
  }

  /// The displaced point:  R p + x.
  [[nodiscard, gnu::always_inline]] Vector3<S> point(const Vector3<S>& p) const {
    using detail::component;
    return {component(rotation, 0, p) + translation.x(),
            component(rotation, 1, p) + translation.y(),
            component(rotation, 2, p) + translation.z()};
  }

  [[nodiscard]] Pose inverse() const {
    return {rotation.transpose(), -detail::transposed_product(rotation, translation)};
  }

  [[gnu::always_inline]] friend Pose operator*(const Pose& a, const Pose& b) {
    Pose X{Matrix3<S>(), Vector3<S>()};  // not made the unit first
    if constexpr (std::is_same_v<S, double>) {
      const detail::Mat3dByColumns R(a.rotation.data());
      detail::multiply(R, b.rotation, X.rotation);
      const auto x = detail::Vec3d::from(a.translation.data());
      (x + R.combined(b.translation.data())).to(X.translation.data());
    } else {
      detail::multiply(a.rotation, b.rotation, X.rotation);
      X.translation = a.point(b.translation);
    }
    return X;
  }

  /// The displaced motor:  {R a; R a0 + x x R a}. Axes and point of reduction change together.
  /// Cost: 42 flops.
  [[gnu::always_inline]] friend Motor<S> operator*(const Pose& X, const Motor<S>& a) {
    detail::Read<S> px = X.translation.x(), py = X.translation.y(), pz = X.translation.z();
    const auto moved = [&](const auto& n, const auto& m) -> Motor<S> {
      const S x = n.x();
      const S y = n.y();
      const S z = n.z();
      return {{x, y, z},
              detail::by_two(S(m.x() + (py * z - pz * y)), S(m.y() + (pz * x - px * z)),
                             S(m.z() + (px * y - py * x)))};
    };
    if constexpr (std::is_same_v<S, double>) {
      const detail::Mat3dByColumns R(X.rotation.data());
      return moved(R.combined(a.resultant.data()), R.combined(a.moment.data()));
    } else {
      return moved(detail::product(X.rotation, a.resultant), detail::product(X.rotation, a.moment));
    }
  }

  /// The displaced motor tensor, by congruence:  (X T) (X A) = X (T A)  for every motor A.
  friend MotorTensor<S> operator*(const Pose& X, const MotorTensor<S>& T) {
    const Matrix3<S>& R = X.rotation;
    const Matrix3<S> k = skew(X.translation);
    MotorTensor<S> rotated{R * T.rr * R.transpose(), R * T.rm * R.transpose(),
                           R * T.mr * R.transpose(), R * T.mm * R.transpose()};
    rotated.mr += k * rotated.rr;
    rotated.mm += k * rotated.rm;
    rotated.rr -= rotated.rm * k;
    rotated.mr -= rotated.mm * k;
    return rotated;
  }
};

namespace detail {

/// c[0] + c[1] x + c[2] x^2 + ..., summed in pairs that do not wait for each other.
template <std::size_t n>
[[nodiscard, gnu::always_inline]] inline double by_pairs(double x, const std::array<double, n>& c) {
  if constexpr (n == 1) {
    return c[0];
  } else {
    std::array<double, (n + 1) / 2> pairs;
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      ((pairs[i] = c[2 * i] + x * c[2 * i + 1]), ...);
    }
    (std::make_index_sequence<n / 2>());
    if constexpr (n % 2 == 1) pairs[n / 2] = c[n - 1];
    return by_pairs(x * x, pairs);
  }
}

/// first + second x + third x^2 + ..., where the first term is the greatest. It is added last, so
/// that nothing else is rounded at its size.
template <class... Rest>
[[nodiscard, gnu::always_inline]] inline double polynomial(double x, double first, Rest... rest) {
  return first + x * by_pairs(x, std::array{rest...});
}

/// The squared angle below which three terms of a series in it have an error under u/5000.
template <class S>
[[nodiscard]] S small_squared_angle() {
  using std::cbrt;
  static const S bound = cbrt(std::numeric_limits<S>::epsilon());
  return bound;
}

/// The coefficients of a rotation by theta in powers of its vector, smooth functions of theta^2:
///
///   sine = sin(theta)/theta,  versine = (1 - cos(theta))/theta^2,  rest = (1 - sine)/theta^2.
template <class S>
struct OverPowers {
  S sine;
  S versine;
  S rest;

  [[nodiscard, gnu::always_inline]] static OverPowers of(const S& t2) {
    using std::cos;
    using std::sin;
    using std::sqrt;
    if constexpr (std::is_same_v<S, double>) {
      if (t2 < 10) {
        // Polynomials through the Chebyshev points of [0, 10], with as many points as bring the
        // error below rounding. They need no root and no quotient, and nothing cancels. They are
        // centred on the middle, where the terms are small.
        const double x = t2 - 5;
        return {polynomial(x, 0.351844907875699, -0.09691177843328656, 0.005740644068100509,
                           -0.00014917585773936058, 2.186424820636489e-06, -2.0616823366817982e-08,
                           1.3570958273630947e-10, -6.59370821442229e-13, 2.462769897000255e-15,
                           -7.295848612193184e-18, 1.755264802987073e-20),
                polynomial(x, 0.32345457529143334, -0.029506424270716765, 0.0010556959324789944,
                           -1.9784384225787982e-05, 2.274804016833481e-07, -1.7675839219919887e-09,
                           9.903060524708328e-12, -4.190399829738396e-14, 1.3871436033344526e-16,
                           -3.687890300511132e-19),
                polynomial(x, 0.1296310184248602, -0.006543847998314729, 0.00016064078604284258,
                           -2.2929856606960823e-06, 2.131216801234889e-08, -1.39068929152316e-10,
                           6.718692350324501e-13, -2.4996802575406287e-15, 7.384273522823804e-18,
                           -1.7728724485362963e-20)};
      }
    } else if (t2 < small_squared_angle<S>()) {
      return {S(1) - t2 / S(6) * (S(1) - t2 / S(20)), S(0.5) - t2 / S(24) * (S(1) - t2 / S(30)),
              S(1) / S(6) - t2 / S(120) * (S(1) - t2 / S(42))};
    }
    const S theta = sqrt(t2);
    const S s = sin(theta / S(2));
    const S sine = sin(theta) / theta;
    return {sine, S(2) * s * s / t2, (S(1) - sine) / t2};
  }
};

}  // namespace detail

/// The exponential of a motor A = (w; v): the displacement by a constant velocity motor (twist) A
/// in unit time, a screw motion,
///
///   R = 1 + a S + b S^2,   x = v + b S v + c S^2 v = a v + b S v + c w w.v,   S = skew(w),
///   a = sin(theta)/theta,  b = (1 - cos(theta))/theta^2,  c = (1 - a)/theta^2,   theta = |w|.
///
/// In doubles a, b and c are polynomials in theta^2 where theta^2 is below 10, so small angles need
/// no case of their own. Each of the two forms of x has the smaller error on its side of theta = 1.
///
/// Source : Rodrigues; the exponential map of SE(3)
/// Error  : |R - exact| <= 8u, |x - exact| <= 8u |v| up to theta = pi, beyond it both times
///          theta/pi (tests/motor/displacement.cpp)
template <class S>
[[nodiscard]] Pose<S> exp(const Motor<S>& A) {
  const auto w = detail::components(A.resultant);
  const auto v = detail::components(A.moment);
  const S t2 = w.x * w.x + w.y * w.y + w.z * w.z;
  const auto over = detail::OverPowers<S>::of(t2);
  const auto bw = over.versine * w;
  // Computed before the rotation, which would otherwise have to wait in registers.
  detail::Components<S> x;
  if (t2 < S(1)) {
    const auto wv = cross(w, v);
    x = v + (over.versine * wv + over.rest * cross(w, wv));
  } else {
    const S along = over.rest * (w.x * v.x + w.y * v.y + w.z * v.z);
    x = cross(bw, v) + (over.sine * v + along * w);
  }
  const S cosine = S(1) - over.versine * t2;
  const auto aw = over.sine * w;
  const S xy = bw.x * w.y;
  const S xz = bw.x * w.z;
  const S yz = bw.y * w.z;
  Pose<S> X{Matrix3<S>(), Vector3<S>()};
  X.rotation(0, 0) = cosine + bw.x * w.x;
  X.rotation(1, 0) = xy + aw.z;
  X.rotation(2, 0) = xz - aw.y;
  X.rotation(0, 1) = xy - aw.z;
  X.rotation(1, 1) = cosine + bw.y * w.y;
  X.rotation(2, 1) = yz + aw.x;
  X.rotation(0, 2) = xz + aw.y;
  X.rotation(1, 2) = yz - aw.x;
  X.rotation(2, 2) = cosine + bw.z * w.z;
  X.translation = detail::vector<S>(x);
  return X;
}

/// The unit quaternion (w >= 0) of a rotation matrix, from its largest component.
///
/// Error  : <= 4u at every angle, because no component is formed by cancellation
template <class S>
[[nodiscard]] Eigen::Quaternion<S> quaternion(const Matrix3<S>& R) {
  Eigen::Quaternion<S> q(R);
  if (q.w() < S(0)) q.coeffs() = -q.coeffs();
  return q;
}

namespace detail {

/// Modified Rodrigues parameters tan(theta/4) n of a rotation by theta about n, without a root and
/// a quotient. They come from the row of 4 q q^t that contains the i-th vector component of the
/// quaternion q.
template <int i, class S>
[[nodiscard]] Components<S> rodrigues_by_row(const Matrix3<S>& R) {
  using std::abs;
  using std::sqrt;
  constexpr int j = (i + 1) % 3;
  constexpr int k = (j + 1) % 3;
  S n[3];
  n[i] = S(1) + R(i, i) - R(j, j) - R(k, k);
  n[j] = R(j, i) + R(i, j);
  n[k] = R(k, i) + R(i, k);
  const S last = R(k, j) - R(j, k);
  const S norm = sqrt(last * last + n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  const S scale = (last < S(0) ? S(-1) : S(1)) / (abs(last) + norm);
  return {scale * n[0], scale * n[1], scale * n[2]};
}

/// Rotations beyond 120 degrees, where the greatest component of the quaternion is one of its
/// vector. Not inline: other callers must not save the registers that this function takes.
template <class S>
[[nodiscard, gnu::noinline]] Components<S> rodrigues_of_wide_turn(const Matrix3<S>& R) {
  if (R(0, 0) > R(1, 1) && R(0, 0) > R(2, 2)) return rodrigues_by_row<0>(R);
  return R(1, 1) > R(2, 2) ? rodrigues_by_row<1>(R) : rodrigues_by_row<2>(R);
}

/// Modified Rodrigues parameters m = tan(theta/4) n, |m| <= 1. Up to 120 degrees they come from the
/// skew part of R, k = 2 sin(theta) n, which vanishes at the half turn:
///
///   m = 4 k/(a + sqrt(a^2 + 16 k^2)),   a = (1 + trace)^2 + k^2  (= 8 (1 + cos(theta))).
///
/// The trace alone would also give a, but with twice the error where R is a rotation only to
/// rounding.
template <class S>
[[nodiscard, gnu::always_inline]] inline Components<S> rodrigues(const Matrix3<S>& R) {
  using std::sqrt;
  const S trace = R(0, 0) + R(1, 1) + R(2, 2);
  if (!(trace > S(0))) return rodrigues_of_wide_turn(R);
  const Components<S> k{S(R(2, 1) - R(1, 2)), S(R(0, 2) - R(2, 0)), S(R(1, 0) - R(0, 1))};
  const S k2 = k.x * k.x + k.y * k.y + k.z * k.z;
  const S a = (S(1) + trace) * (S(1) + trace) + k2;
  return S(S(4) / (a + sqrt(a * a + S(16) * k2))) * k;
}

/// The relative difference h of arc and tangent for p = tan^2(theta/4):  theta/4 = (1 - p h(p))
/// tan(theta/4).
template <class S>
[[nodiscard, gnu::always_inline]] inline S arc_less(const S& p) {
  using std::atan2;
  using std::sqrt;
  if constexpr (std::is_same_v<S, double>) {
    // A polynomial through h at the Chebyshev points of [0, 1], with as many points as bring the
    // error of p h below rounding. It is centred on their middle, where the terms are small.
    return polynomial(p - 0.5, 0.2591604972657936, -0.11081482513071414, 0.054814840604579904,
                      -0.029135862645225958, 0.016172974900145312, -0.009243096224092707,
                      0.005394792734515503, -0.0031991751955030576, 0.0019209389488175712,
                      -0.0011650648417818904, 0.000712529877324769, -0.0004387712318266148,
                      0.0002713884068435811, -0.00016895422802807932, 0.00010789905799306997,
                      -6.77580169120214e-05, 3.504433556095341e-05, -2.2095024431396628e-05,
                      2.8373324902198374e-05, -1.806195461861215e-05);
  } else if (p < small_squared_angle<S>()) {
    return S(1) / S(3) - p / S(5) * (S(1) - p * (S(5) / S(7)));
  } else {
    const S tangent = sqrt(p);
    const S arc = atan2(tangent, S(1));  // Eigen's dual numbers return another type
    return (S(1) - arc / tangent) / p;
  }
}

}  // namespace detail

/// The logarithm of a displacement: the motor A with exp(A) = X and |A.resultant| <= pi.
///
/// It uses the modified Rodrigues parameters m of R, whose length is tan(theta/4), with M =
/// skew(m):
///
///   resultant = 4 f m,   moment = x - 2 f M x + g M^2 x = f (1 - p) x - 2 f M x + g m m.x,
///   p = m.m,   f = 1 - p h = (theta/4)/tan(theta/4),   g = (1 - (1 - p) f)/p = 1 + h (1 - p).
///
/// Nothing cancels at small angles, and nothing vanishes at the half turn. Each of the two forms of
/// the moment has the smaller error on its side of theta = 1.
///
/// Several answers: at the half turn both signs of the axis are right. The axis returned has a
/// positive largest component unless rounding decides otherwise.
///
/// Error  : log(exp(A)), relative in each half, measured over 1e6 motors, in units of 1e-16
///          (printed by tests/motor/displacement.cpp)
///            theta      < 1e-8   1e-8..1e-3   1e-3..1   1..pi-1e-3   pi-1e-3..pi
///            resultant     1          9           9           7            5
///            moment        1          2           4           9.5         10.5
template <class S>
[[nodiscard]] Motor<S> log(const Pose<S>& X) {
  const auto m = detail::rodrigues(X.rotation);
  const auto x = detail::components(X.translation);
  const auto mx = cross(m, x);
  const S p = m.x * m.x + m.y * m.y + m.z * m.z;
  const S h = detail::arc_less(p);
  const S f = S(1) - p * h;
  const S g = S(1) + h * (S(1) - p);
  detail::Components<S> moment;
  if (p < S(0.0625)) {
    moment = x - (S(S(2) * f) * mx - g * cross(m, mx));
  } else {
    const S along = g * (m.x * x.x + m.y * x.y + m.z * x.z);
    moment = S(f * (S(1) - p)) * x - (S(S(2) * f) * mx - along * m);
  }
  return {detail::vector<S>(S(S(4) * f) * m), detail::vector<S>(moment)};
}

}  // namespace kreisel
