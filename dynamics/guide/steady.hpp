#pragma once

#include <dynamics/guide/motion.hpp>

namespace kreisel {

/// A frame in steady screw motion, with constant velocity motor (twist): fixed on a turntable, on
/// the earth, on a circular orbit.
///
///   X(t) = exp(V t) X(0),   V = (u; v) written in I;  on G's axes V is constant too, so oF = 0.
///
/// Source : the exponential map of SE(3); the earth in paper 002 section 5
/// Units  : metre, rad/s, m/s, second
/// Error  : <= 32u of |u| and lengths up to a few turns     (tests/dynamics/guide/kinds.cpp)
template <class G = Guide, class I = Inertial, class S = double>
struct SteadyFrame {
  Displacement<I, G, S> X = {};  ///< at t = 0
  Velocity<G, I, I, S> V = {};   ///< against I, written in I

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    return {{exp(V.value * t) * X.value}, X.inverse() * V, {}};
  }

  [[nodiscard]] FrameTurning<S> turning(const S& /*t*/) const {
    return {(X.inverse() * V).value.resultant, Vector3<S>::Zero()};
  }

  [[nodiscard]] SteadyMotion<detail::Components<S>, detail::Components<S>> steady() const {
    const Motor<S> F = (X.inverse() * V).value;
    return {detail::components(F.resultant),
            detail::components(Vector3<S>(F.resultant.cross(F.moment)))};
  }
};

}  // namespace kreisel
