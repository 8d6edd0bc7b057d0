#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <type_traits>

/// Functions for code that branches on numbers, written for one number and for a pack of numbers
/// alike (dynamics/ensemble/pack.hpp). A comparison gives one bool, or one bool per lane.
namespace kreisel::detail {

[[nodiscard]] constexpr bool all(bool condition) { return condition; }
[[nodiscard]] constexpr bool any(bool condition) { return condition; }

template <class N>
[[nodiscard]] constexpr N select(bool condition, const N& yes, const N& no) {
  return condition ? yes : no;
}

/// The greatest value over the lanes; NaN if any lane is NaN.
template <class N>
requires std::is_floating_point_v<N>
[[nodiscard]] constexpr N greatest_lane(N x) { return x; }

template <class N>
inline constexpr bool is_pack = false;
template <class N>
requires(N::lanes > 0) inline constexpr bool is_pack<N> = true;

/// The number of lanes of a number: 1 unless it is a pack.
template <class N>
inline constexpr int lanes_of = 1;
template <class N>
requires is_pack<N>
inline constexpr int lanes_of<N> = N::lanes;

/// The type of values that all lanes share, such as the time: double for a pack, else the number
/// itself.
template <class N>
using ScalarOf = std::conditional_t<is_pack<N>, double, N>;

/// True if all components of a vector are finite, in all lanes.
template <class Vector>
[[nodiscard]] bool finite(const Vector& v) {
  using N = typename Vector::Scalar;
  if constexpr (is_pack<N>) {
    return all((v - v).sum() == N(0));
  } else {
    return (v - v).isZero(N(0));
  }
}

/// The numbers that `get` takes from as many objects as N has lanes, packed; for a vector, each
/// component.
template <class N, class Object, class Get>
[[nodiscard]] auto gathered(const std::array<const Object*, std::size_t(N::lanes)>& objects,
                            const Get& get) {
  if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(get(*objects[0]))>>) {
    N result;
    for (int k = 0; k < N::lanes; ++k) result.set_lane(k, get(*objects[std::size_t(k)]));
    return result;
  } else {
    Eigen::Matrix<N, 3, 1> result;
    for (int i = 0; i < 3; ++i) {
      result[i] = gathered<N>(objects, [&](const Object& object) { return get(object)[i]; });
    }
    return result;
  }
}

}  // namespace kreisel::detail
