#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <type_traits>

/// What code asks that branches on numbers, for one number and for a pack of them alike
/// (dynamics/ensemble/pack.hpp): comparisons give a bool or one bool a lane.
namespace kreisel::detail {

[[nodiscard]] constexpr bool all(bool condition) { return condition; }
[[nodiscard]] constexpr bool any(bool condition) { return condition; }

template <class N>
[[nodiscard]] constexpr N select(bool condition, const N& yes, const N& no) {
  return condition ? yes : no;
}

/// The greatest over the lanes; a NaN stays.
template <class N>
requires std::is_floating_point_v<N>
[[nodiscard]] constexpr N greatest_lane(N x) { return x; }

template <class N>
inline constexpr bool is_pack = false;
template <class N>
requires(N::lanes > 0) inline constexpr bool is_pack<N> = true;

/// How many numbers a number holds.
template <class N>
inline constexpr int lanes_of = 1;
template <class N>
requires is_pack<N>
inline constexpr int lanes_of<N> = N::lanes;

/// What lanes share, like the time: of a pack double, else the number itself.
template <class N>
using ScalarOf = std::conditional_t<is_pack<N>, double, N>;

/// Whether all components of a vector are finite, in all lanes.
template <class Vector>
[[nodiscard]] bool finite(const Vector& v) {
  using N = typename Vector::Scalar;
  if constexpr (is_pack<N>) {
    return all((v - v).sum() == N(0));
  } else {
    return (v - v).isZero(N(0));
  }
}

/// The numbers that `get` takes from as many objects as N has lanes, side by side: of a vector each
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
