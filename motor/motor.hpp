#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <type_traits>

#include <motor/simd.hpp>

namespace kreisel {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

template <class S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;

// motor/simd.hpp says why the kernels are written component by component.

namespace detail {

/// The type in which an operand is read before any part of a result is stored. Numbers are read by
/// value, because the compiler cannot see that storing the result leaves the operands unchanged.
/// Dual numbers are not copied.
template <class S>
using Read = std::conditional_t<std::is_arithmetic_v<S>, const S, const S&>;

/// The i-th component of R v.
template <class S>
[[nodiscard, gnu::always_inline]] inline S component(const Matrix3<S>& R, int i,
                                                     const Vector3<S>& v) {
  return R(i, 0) * v.x() + R(i, 1) * v.y() + R(i, 2) * v.z();
}

/// R v
template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> product(const Matrix3<S>& R,
                                                            const Vector3<S>& v) {
  return {component(R, 0, v), component(R, 1, v), component(R, 2, v)};
}

/// C = A B, computed in place: nine numbers computed first and stored later do not fit the
/// registers.
template <class S>
[[gnu::always_inline]] inline void multiply(const Matrix3<S>& A, const Matrix3<S>& B,
                                            Matrix3<S>& C) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) C(i, k) = A(i, 0) * B(0, k) + A(i, 1) * B(1, k) + A(i, 2) * B(2, k);
  }
}
[[gnu::always_inline]] inline void multiply(const Mat3dByColumns& A, const Matrix3<double>& B,
                                            Matrix3<double>& C) {
  A.combined(B.data()).to(C.data());
  A.combined(B.data() + 3).to(C.data() + 3);
  A.combined(B.data() + 6).to(C.data() + 6);
}
[[gnu::always_inline]] inline void multiply(const Matrix3<double>& A, const Matrix3<double>& B,
                                            Matrix3<double>& C) {
  multiply(Mat3dByColumns(A.data()), B, C);
}

/// R^t v
template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> transposed_product(const Matrix3<S>& R,
                                                                       const Vector3<S>& v) {
  return {R(0, 0) * v.x() + R(1, 0) * v.y() + R(2, 0) * v.z(),
          R(0, 1) * v.x() + R(1, 1) * v.y() + R(2, 1) * v.z(),
          R(0, 2) * v.x() + R(1, 2) * v.y() + R(2, 2) * v.z()};
}

// Namespace kreisel::detail uses these sums and products in place of Eigen's. Each of Eigen's makes
// the compiler instantiate a dozen classes that nothing else needs: half of the compile time of a
// system of bodies.

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator+(const Vector3<S>& a,
                                                              const Vector3<S>& b) {
  return {a.x() + b.x(), a.y() + b.y(), a.z() + b.z()};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator-(const Vector3<S>& a,
                                                              const Vector3<S>& b) {
  return {a.x() - b.x(), a.y() - b.y(), a.z() - b.z()};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator-(const Vector3<S>& a) {
  return {-a.x(), -a.y(), -a.z()};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator*(const S& s, const Vector3<S>& a) {
  return {s * a.x(), s * a.y(), s * a.z()};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator/(const Vector3<S>& a, const S& s) {
  return {a.x() / s, a.y() / s, a.z() / s};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> operator*(const Matrix3<S>& R,
                                                              const Vector3<S>& v) {
  return product(R, v);
}

template <class S>
[[nodiscard, gnu::always_inline]] inline Vector3<S> cross(const Vector3<S>& a,
                                                          const Vector3<S>& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
          a.x() * b.y() - a.y() * b.x()};
}

template <class S>
[[nodiscard, gnu::always_inline]] inline S dot(const Vector3<S>& a, const Vector3<S>& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

template <class S>
[[gnu::always_inline]] inline Vector3<S>& operator+=(Vector3<S>& a, const Vector3<S>& b) {
  return a = a + b;
}

template <class S>
[[gnu::always_inline]] inline Vector3<S>& operator-=(Vector3<S>& a, const Vector3<S>& b) {
  return a = a - b;
}

}  // namespace detail

/// A motor (screw): the field of moments  m(P) = m(O) + r x OP,  stored as its reduction (r; m) at
/// a point O. Robotics: a spatial vector, that is a twist or a wrench.
///
/// Three kinds share this type, because they obey the same reduction law and the same products:
///
/// - velocity motors (angular velocity; velocity of O): twists
/// - force motors (force; torque about O): wrenches
/// - momentum motors (momentum; angular momentum about O)
///
/// The resultant comes first for every kind.
///
/// Source : paper 002 section 2, "Motor" {Resultante; Moment}; von Mises 1924
/// Frame  : untagged, axes and O are the caller's; frame.hpp puts them into the type
/// Units  : [moment] = [resultant] * metre
template <class S = double>
struct Motor {
  Vector3<S> resultant = Vector3<S>::Zero();
  Vector3<S> moment = Vector3<S>::Zero();

  using Scalar = S;

  /// The same motor reduced at another point P:  (r; m + r x OP).
  [[nodiscard]] Motor reduced_at(const Vector3<S>& p_OP) const {
    return {resultant, moment + resultant.cross(p_OP)};
  }

  Motor& operator+=(const Motor& b) { return *this = *this + b; }
  Motor& operator-=(const Motor& b) { return *this = *this - b; }

  [[gnu::always_inline]] friend Motor operator+(const Motor& a, const Motor& b) {
    const auto& [p, p0] = a;
    const auto& [q, q0] = b;
    return {{p.x() + q.x(), p.y() + q.y(), p.z() + q.z()},
            {p0.x() + q0.x(), p0.y() + q0.y(), p0.z() + q0.z()}};
  }
  [[gnu::always_inline]] friend Motor operator-(const Motor& a, const Motor& b) {
    const auto& [p, p0] = a;
    const auto& [q, q0] = b;
    return {detail::by_two(S(p.x() - q.x()), S(p.y() - q.y()), S(p.z() - q.z())),
            detail::by_two(S(p0.x() - q0.x()), S(p0.y() - q0.y()), S(p0.z() - q0.z()))};
  }
  friend Motor operator-(const Motor& a) { return {-a.resultant, -a.moment}; }
  friend Motor operator*(const S& s, const Motor& a) { return {s * a.resultant, s * a.moment}; }
  friend Motor operator*(const Motor& a, const S& s) { return s * a; }
  friend Motor operator/(const Motor& a, const S& s) { return {a.resultant / s, a.moment / s}; }
  friend bool operator==(const Motor& a, const Motor& b) {
    return a.resultant == b.resultant && a.moment == b.moment;
  }
};

/// Motor product  [A B] = (a x b; a x b0 + a0 x b): the rate of B when the velocity motor A carries
/// B.
///
/// Source : paper 002 section 2, "[A B]", motorisches Produkt; the Lie bracket of se(3)
/// Error  : componentwise <= 2u (resultant), 4u (moment) * sum of |terms|, u = 2^-53
/// Cost   : 30 flops
template <class S>
[[nodiscard, gnu::always_inline]] inline Motor<S> cross(const Motor<S>& a, const Motor<S>& b) {
  detail::Read<S> ax = a.resultant.x(), ay = a.resultant.y(), az = a.resultant.z();
  detail::Read<S> bx = b.resultant.x(), by = b.resultant.y(), bz = b.resultant.z();
  detail::Read<S> ax0 = a.moment.x(), ay0 = a.moment.y(), az0 = a.moment.z();
  detail::Read<S> bx0 = b.moment.x(), by0 = b.moment.y(), bz0 = b.moment.z();
  return {{ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx},
          detail::by_two(S(ay * bz0 - az * by0 + ay0 * bz - az0 * by),
                         S(az * bx0 - ax * bz0 + az0 * bx - ax0 * bz),
                         S(ax * by0 - ay * bx0 + ax0 * by - ay0 * bx))};
}

/// Reciprocal product  a . b0 + a0 . b: the power of a force motor on a velocity motor.
///
/// Source : von Mises 1924, "skalares Produkt"; independent of the point of reduction
/// Error  : <= 6u * sum of |terms|, u = 2^-53
/// Cost   : 11 flops
template <class S>
[[nodiscard]] inline S reciprocal(const Motor<S>& a, const Motor<S>& b) {
  return a.resultant.dot(b.moment) + a.moment.dot(b.resultant);
}

/// The matrix of the vector product:  skew(a) b = a x b.
template <class S>
[[nodiscard]] Matrix3<S> skew(const Vector3<S>& a) {
  const S zero(0);
  return (Matrix3<S>() << zero, -a.z(), a.y(), a.z(), zero, -a.x(), -a.y(), a.x(), zero).finished();
}

}  // namespace kreisel
