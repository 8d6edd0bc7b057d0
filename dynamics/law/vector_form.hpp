#pragma once

#include <dynamics/inertia.hpp>
#include <dynamics/law/relative.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>

/// The law of motion in vectors, term by term as in paper 002 sections 3 and 4 (corrected). These
/// forms are for reading, for teaching, and as a second way to the same number. The motor forms of
/// relative.hpp and momentum.hpp state the same law with fewer operations.
///
/// Letters: u', v' are the relative motor at the body's origin O'. u, v are the guide motor at O',
/// v the velocity of the point of the guide frame that coincides with O'. r = r_s is the centre of
/// mass, T the tensor about O'. A mark before a letter is the observer: * body, o guide. All on
/// body axes.

namespace kreisel {

/// (18): both velocities differentiated in the body, where T (true moment) and P (plain) are the
/// same.
///
///   P = m{*v' + *u' x r + u' x v' + u' x (u' x r)} + m{*v + *u x r + u x v + u x (u x r)}
///     + m{u' x v + u x v' + u' x (u x r) + u x (u' x r)}
///   M = {m r x (*v' + u' x v') + T *u' + u' x T u'} + {m r x (*v + u x v) + T *u + u x T u}
///     + {m r x (u' x v + u x v') + u' x T u + u x T u'}
///
/// Source : paper 002 (18a), (18b); the braces are its relative, guide and Coriolis parts
template <class B, class G, class I, class S>
[[nodiscard]] ForceParts<B, S> vector_form_18(const InertiaTensor<B, S>& T,
                                              const Velocity<B, G, B, S>& V_rel,
                                              const Velocity<G, I, B, S>& F,
                                              const Rate<B, Velocity<B, G, B, S>>& dV_rel,
                                              const Rate<B, Velocity<G, I, B, S>>& dF) {
  const S m = T.value.mass;
  const Vector3<S> mr = T.value.first_moment;  // a body without mass has no r
  const Symmetric3<S>& t = T.value.tensor;
  const auto& [u1, v1] = V_rel.value;
  const auto& [u, v] = F.value;
  const auto& [du1, dv1] = dV_rel.value;
  const auto& [du, dv] = dF.value;
  const auto part = [&](const Vector3<S>& dw, const Vector3<S>& dx, const Vector3<S>& w,
                        const Vector3<S>& x) {
    return Motor<S>{m * (dx + w.cross(x)) + dw.cross(mr) + w.cross(w.cross(mr)),
                    mr.cross(dx + w.cross(x)) + t * dw + w.cross(t * w)};
  };
  const Motor<S> coriolis{
      m * (u1.cross(v) + u.cross(v1)) + u1.cross(u.cross(mr)) + u.cross(u1.cross(mr)),
      mr.cross(u1.cross(v) + u.cross(v1)) + u1.cross(t * u) + u.cross(t * u1)};
  return {{part(du1, dv1, u1, v1)}, {part(du, dv, u, v)}, {coriolis}};
}

/// (19): the guide velocity differentiated in the guide, ov as true moment T (guide-fixed point).
///
///   P = m{*v' + *u' x r + u' x v' + u' x (u' x r)} + m{ov + ou x r + u x v + u x (u x r)}
///     + 2m{u x v' + u x (u' x r)}
///   M = {m r x (*v' + u' x v') + T *u' + u' x T u'} + {m r x (ov + u x v) + T ou + u x T u}
///     + {2m r x (u x v') + u' x T u + u x T u' + T (u x u')}
///
/// Source : paper 002 (19a), (19b); with the plain ov the factor 2 of u x v' would be 1
template <class B, class G, class I, class S>
[[nodiscard]] ForceParts<B, S> vector_form_19(const InertiaTensor<B, S>& T,
                                              const Velocity<B, G, B, S>& V_rel,
                                              const Velocity<G, I, B, S>& F,
                                              const Rate<B, Velocity<B, G, B, S>>& dV_rel,
                                              const Rate<G, Velocity<G, I, B, S>>& dF) {
  const S m = T.value.mass;
  const Vector3<S> mr = T.value.first_moment;
  const Symmetric3<S>& t = T.value.tensor;
  const Vector3<S>& u1 = V_rel.value.resultant;
  const Vector3<S>& v1 = V_rel.value.moment;
  const Vector3<S>& u = F.value.resultant;
  // The relative and guide parts are those of (18); only the observer of F has changed.
  ForceParts<B, S> parts =
      vector_form_18(T, V_rel, F, dV_rel, Rate<B, Velocity<G, I, B, S>>{dF.value});
  parts.coriolis.value = {S(2) * (m * u.cross(v1) + u.cross(u1.cross(mr))),
                          S(2) * mr.cross(u.cross(v1)) + u1.cross(t * u) + u.cross(t * u1) +
                              t * Vector3<S>(u.cross(u1))};
  return parts;
}

/// (20): momenta about the moving O', plainly differentiated in the guide.
///
///   P = oG + oG_f + u x (G + G_f)
///   M = oJ + oJ_f + u x (J + J_f) + (v + v') x (G + G_f)
///
/// Source : paper 002 (20a), (20b); the print has v for v + v', which loses v' x (G + G_f) when O'
///          moves in the guide (docs/errata.md)
template <class B, class G, class I, class S>
[[nodiscard]] Force<B, S> vector_form_20(const Velocity<B, G, B, S>& V_rel,
                                         const Velocity<G, I, B, S>& F, const Momentum<B, S>& J,
                                         const PlainRate<G, Momentum<B, S>>& dJ,
                                         const Momentum<B, S>& J_f,
                                         const PlainRate<G, Momentum<B, S>>& dJ_f) {
  const Vector3<S>& u = F.value.resultant;
  const Vector3<S> point = F.value.moment + V_rel.value.moment;
  const Motor<S> momentum = J.value + J_f.value;
  const Motor<S> rate = dJ.value + dJ_f.value;
  return {{rate.resultant + u.cross(momentum.resultant),
           rate.moment + u.cross(momentum.moment) + point.cross(momentum.resultant)}};
}

/// (21), a particle:  P = m{ov' + ov_0 + u x v_0 + ou x r + u x (u x r) + 2 u x v'}.
///
/// r, v' and ov' are the particle's position, velocity and acceleration in the guide. u, ou, v_0,
/// ov_0 are the guide's angular velocity and the velocity of its origin, with their derivatives in
/// the guide.
///
/// Source : paper 002 (21)
/// Frame  : all on the axes of the guide
template <class S>
[[nodiscard]] Vector3<S> particle_force(const S& mass, const Vector3<S>& r, const Vector3<S>& v_rel,
                                        const Vector3<S>& dv_rel, const Motor<S>& F,
                                        const Motor<S>& dF) {
  const auto& [u, v0] = F;
  const auto& [du, dv0] = dF;
  return mass *
         (dv_rel + dv0 + u.cross(v0) + du.cross(r) + u.cross(u.cross(r)) + S(2) * u.cross(v_rel));
}

/// (22), a body fixed in the guide:  T oF + [F (T F)] in vectors,
///
///   P = m{ov + ou x r + u x v + u x (u x r)},   M = m r x (ov + u x v) + T ou + u x T u.
///
/// Source : paper 002 (22a), (22b)
template <class G, class I, class S>
[[nodiscard]] Force<G, S> carried_body_force(const InertiaTensor<G, S>& T,
                                             const Velocity<G, I, G, S>& F,
                                             const Rate<G, Velocity<G, I, G, S>>& dF) {
  const S m = T.value.mass;
  const Vector3<S> mr = T.value.first_moment;
  const auto& [u, v] = F.value;
  const auto& [du, dv] = dF.value;
  return {{m * (dv + u.cross(v)) + du.cross(mr) + u.cross(u.cross(mr)),
           mr.cross(dv + u.cross(v)) + T.value.tensor * du + u.cross(T.value.tensor * u)}};
}

/// Euler's equations of a body with a fixed origin, or reduced at its centre of mass:
///
///   M = T du + u x T u
///
/// Source : paper 002 section 4, last equation
template <class S>
[[nodiscard]] Vector3<S> euler_torque(const Symmetric3<S>& T, const Vector3<S>& u,
                                      const Vector3<S>& du) {
  return T * du + u.cross(T * u);
}

}  // namespace kreisel
