#pragma once

#include <motor/frame.hpp>
#include <motor/rate.hpp>

namespace kreisel {

/// How a frame G moves against a frame I at one moment: pose, velocity, acceleration.
///
/// Velocity and rate are written in G, reduced at G's ORIGIN, and the rate is seen from G: numbers
/// and their plain time derivatives, nothing to transport (T = P). To reach the body, displace them:
/// X_BG * V and X_BG * dV. What must not be done is to differentiate the velocity of the guide-fixed
/// point that coincides with a moving point of the body; that would be a PlainRate.
///
/// Source : paper 002 section 2, F and oF
/// Units  : metre, rad/s, m/s, rad/s^2, m/s^2
template <class G, class I, class S = double>
struct FrameMotion {
  Displacement<I, G, S> X;           ///< attitude and place of G in I
  Velocity<G, I, G, S> V;            ///< (u; v of G's origin)
  Rate<G, Velocity<G, I, G, S>> dV;  ///< (ou; ov), componentwise derivatives on G's axes

  /// The inertial acceleration of G's origin on G's axes:  ov + u x v.
  [[nodiscard]] Vector3<S> origin_acceleration() const {
    return dV.value.moment + V.value.resultant.cross(V.value.moment);
  }
};

/// The motion of C against A from those of C against B and of B against A. Exact: poses multiply,
/// velocities add, and the rate of V_BA is handed to the observer C by its transport term.
///
///   V_CA = V_CB + V_BA,   (d/dt)_C V_CA = (d/dt)_C V_CB + (d/dt)_B V_BA - [V_CB V_BA]
///
/// Source : paper 002 section 2, V = V' + F and (4c), for a chain of guides: earth, ship, device
/// Error  : <= 1e-15 * sum of |terms| in each of the three (tests/dynamics/guide/motion.cpp)
template <class C, class B, class A, class S>
[[nodiscard]] FrameMotion<C, A, S> operator*(const FrameMotion<B, A, S>& outer,
                                             const FrameMotion<C, B, S>& inner) {
  const Displacement<C, B, S> X_CB = inner.X.inverse();
  const Velocity<B, A, C, S> V_BA = X_CB * outer.V;
  const auto dV_BA = X_CB * outer.dV;
  return {outer.X * inner.X, inner.V + V_BA, inner.dV + seen_from<C>(dV_BA, inner.V, V_BA)};
}

}  // namespace kreisel
