#pragma once

#include <dynamics/inertia.hpp>
#include <motor/displacement.hpp>
#include <motor/motor.hpp>

/// The same quantity in another scalar.

namespace kreisel::test {

template <class To, class S, int Rows, int Columns>
[[nodiscard]] Eigen::Matrix<To, Rows, Columns> cast(const Eigen::Matrix<S, Rows, Columns>& m) {
  return m.unaryExpr([](const S& x) { return static_cast<To>(x); });
}

template <class To, class S>
[[nodiscard]] Motor<To> cast(const Motor<S>& a) {
  return {cast<To>(a.resultant), cast<To>(a.moment)};
}

template <class To, class S>
[[nodiscard]] Pose<To> cast(const Pose<S>& X) {
  return {cast<To>(X.rotation), cast<To>(X.translation)};
}

template <class To, class S>
[[nodiscard]] Symmetric3<To> cast(const Symmetric3<S>& m) {
  return {static_cast<To>(m.xx), static_cast<To>(m.yy), static_cast<To>(m.zz),
          static_cast<To>(m.xy), static_cast<To>(m.xz), static_cast<To>(m.yz)};
}

template <class To, class S>
[[nodiscard]] Inertia<To> cast(const Inertia<S>& T) {
  return {static_cast<To>(T.mass), cast<To>(T.first_moment), cast<To>(T.tensor)};
}

}  // namespace kreisel::test
