#pragma once

#include <dynamics/guide/motion.hpp>

namespace kreisel {

/// A frame at rest in another: u = v = 0. Exact; all guide kinds at rest give the same numbers
/// (tests/dynamics/rigid/fixed_point_body.cpp).
template <class G = Guide, class I = Inertial, class S = double>
struct RestingFrame {
  Displacement<I, G, S> X = {};  ///< where it rests

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& /*t*/) const { return {X, {}, {}}; }

  [[nodiscard]] SteadyMotion<detail::ZeroVector, detail::ZeroVector> steady() const { return {}; }
};

namespace detail {

/// True if a guide is a RestingFrame.
template <class M>
inline constexpr bool is_resting = false;
template <class G, class I, class S>
inline constexpr bool is_resting<RestingFrame<G, I, S>> = true;

}  // namespace detail

}  // namespace kreisel
