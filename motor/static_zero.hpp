#pragma once

#include <type_traits>

#include <motor/motor.hpp>
#include <motor/simd.hpp>

/// Zeros that are known at compile time. A formula is written once, with every term that a scene
/// can have. A quantity that a scene does not have is StaticZero by its type, and so is every
/// product of it.
///
/// Products of vectors and rotations are always inlined; motor/simd.hpp says why.

namespace kreisel::detail {

/// A zero that is known at compile time.
struct StaticZero {
  template <class T>
  friend StaticZero operator*(const T&, StaticZero) {
    return {};
  }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend StaticZero operator*(StaticZero, const T&) {
    return {};
  }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend StaticZero operator/(StaticZero, const T&) {
    return {};
  }

  friend StaticZero operator+(StaticZero, StaticZero) { return {}; }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend T operator+(const T& x, StaticZero) { return x; }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend T operator+(StaticZero, const T& x) { return x; }

  friend StaticZero operator-(StaticZero) { return {}; }
  friend StaticZero operator-(StaticZero, StaticZero) { return {}; }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend T operator-(const T& x, StaticZero) { return x; }
  template <class T>
  requires(!std::is_same_v<T, StaticZero>) friend auto operator-(StaticZero, const T& x) {
    return -x;
  }
};

template <class T>
inline constexpr bool is_static_zero = std::is_same_v<T, StaticZero>;

/// The number type of a sum or product of A and B: dual numbers win over doubles.
template <class A, class B>
using Joint = std::conditional_t<std::is_arithmetic_v<A>, B, A>;

template <class A, class B>
using Product = std::conditional_t<is_static_zero<A> || is_static_zero<B>, StaticZero, Joint<A, B>>;

template <class A, class B>
using Total =
    std::conditional_t<is_static_zero<A>, B, std::conditional_t<is_static_zero<B>, A, Joint<A, B>>>;

/// A vector whose components are each a number or StaticZero.
template <class X, class Y = X, class Z = X>
struct Components {
  X x = {};
  Y y = {};
  Z z = {};

  static constexpr bool static_zero = is_static_zero<X> && is_static_zero<Y> && is_static_zero<Z>;
};

using ZeroVector = Components<StaticZero>;

template <class S>
[[nodiscard]] Components<S> components(const Vector3<S>& v) {
  return {v.x(), v.y(), v.z()};
}

template <class S>
[[nodiscard]] Vector3<S> vector(const Components<S>& a) {
  return {a.x, a.y, a.z};
}

/// The vector of the components. StaticZero components become 0.
template <class S, class X, class Y, class Z>
[[nodiscard]] Vector3<S> vector(const Components<X, Y, Z>& a) {
  return {S(S(0) + a.x), S(S(0) + a.y), S(S(0) + a.z)};
}

/// The components and w = 0. StaticZero components become 0.
template <class X, class Y, class Z>
[[nodiscard]] Vec4d vec4d(const Components<X, Y, Z>& a) {
  return {0.0 + a.x, 0.0 + a.y, 0.0 + a.z, 0};
}

template <class X, class Y, class Z, class P, class Q, class R>
[[nodiscard]] auto operator+(const Components<X, Y, Z>& a, const Components<P, Q, R>& b) {
  using Sum = Components<Total<X, P>, Total<Y, Q>, Total<Z, R>>;
  return Sum{a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class X, class Y, class Z, class P, class Q, class R>
[[nodiscard]] auto operator-(const Components<X, Y, Z>& a, const Components<P, Q, R>& b) {
  using Difference = Components<Total<X, P>, Total<Y, Q>, Total<Z, R>>;
  return Difference{a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class X, class Y, class Z, class S>
[[nodiscard]] auto operator*(const S& s, const Components<X, Y, Z>& a) {
  return Components<Product<S, X>, Product<S, Y>, Product<S, Z>>{s * a.x, s * a.y, s * a.z};
}

template <class X, class Y, class Z, class S>
[[nodiscard]] auto operator/(const Components<X, Y, Z>& a, const S& s) {
  return Components<Product<S, X>, Product<S, Y>, Product<S, Z>>{a.x / s, a.y / s, a.z / s};
}

template <class X, class Y, class Z, class P, class Q, class R>
[[nodiscard, gnu::always_inline]] inline auto cross(const Components<X, Y, Z>& a,
                                                    const Components<P, Q, R>& b) {
  using First = Total<Product<Y, R>, Product<Z, Q>>;
  using Second = Total<Product<Z, P>, Product<X, R>>;
  using Third = Total<Product<X, Q>, Product<Y, P>>;
  return Components<First, Second, Third>{
      First(a.y * b.z - a.z * b.y), Second(a.z * b.x - a.x * b.z), Third(a.x * b.y - a.y * b.x)};
}

/// A rotation matrix as nine numbers; the compiler drops the numbers that are not read.
template <class S>
struct Rotation {
  S xx, xy, xz, yx, yy, yz, zx, zy, zz;

  /// The rotation of a quaternion of any norm, as Pose::from.
  [[nodiscard]] static Rotation from(const Eigen::Quaternion<S>& q) {
    const S &x = q.x(), &y = q.y(), &z = q.z(), &w = q.w();
    const S scale = S(2) / S(x * x + y * y + z * z + w * w);
    const S sx = scale * x, sy = scale * y, sz = scale * z;
    return {S(S(1) - (sy * y + sz * z)), S(sx * y - sz * w),          S(sx * z + sy * w),
            S(sx * y + sz * w),          S(S(1) - (sx * x + sz * z)), S(sy * z - sx * w),
            S(sx * z - sy * w),          S(sy * z + sx * w),          S(S(1) - (sx * x + sy * y))};
  }

  [[nodiscard]] static Rotation from(const Matrix3<S>& R) {
    return {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
  }

  [[nodiscard]] Matrix3<S> matrix() const {
    return (Matrix3<S>() << xx, xy, xz, yx, yy, yz, zx, zy, zz).finished();
  }
};

/// R v
template <class S, class X, class Y, class Z>
[[nodiscard, gnu::always_inline]] inline auto rotated(const Rotation<S>& R,
                                                      const Components<X, Y, Z>& v) {
  using N = Total<Product<S, X>, Total<Product<S, Y>, Product<S, Z>>>;
  return Components<N>{N(R.xx * v.x + R.xy * v.y + R.xz * v.z),
                       N(R.yx * v.x + R.yy * v.y + R.yz * v.z),
                       N(R.zx * v.x + R.zy * v.y + R.zz * v.z)};
}

/// R^t v
template <class S, class X, class Y, class Z>
[[nodiscard, gnu::always_inline]] inline auto rotated_back(const Rotation<S>& R,
                                                           const Components<X, Y, Z>& v) {
  using N = Total<Product<S, X>, Total<Product<S, Y>, Product<S, Z>>>;
  return Components<N>{N(R.xx * v.x + R.yx * v.y + R.zx * v.z),
                       N(R.xy * v.x + R.yy * v.y + R.zy * v.z),
                       N(R.xz * v.x + R.yz * v.y + R.zz * v.z)};
}

}  // namespace kreisel::detail
