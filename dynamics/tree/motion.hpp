#pragma once

#include <cmath>
#include <type_traits>

#include <dynamics/tree/tree.hpp>
#include <motor/static_zero.hpp>

/// The motions of the links of a tree. All vectors are on the GUIDE's axes, each link's about its
/// own origin: then no rotations are needed between links, and inertias are only shifted.

namespace kreisel::detail {

template <class S = double>
struct LinkPose {
  Matrix3<S> R = Matrix3<S>::Identity();  ///< body to guide axes
  Vector3<S> r = Vector3<S>::Zero();      ///< from the parent's origin to the link's
  Vector3<S> axis = Vector3<S>::Zero();   ///< of a revolute, prismatic or screw joint
};

/// The absolute angular velocity w = u' + u, its inertial rate, and the inertial acceleration of
/// the origin, from which a uniform gravity may be subtracted.
///
/// The pairs (dw; a) are accelerations of points, not motors. In motors of a guide at 465 m/s, as
/// on the earth, terms u x v would cancel and leave rounding errors. The DIFFERENCE of two such
/// pairs at the same velocities is a motor.
template <class S = double>
struct LinkMotion {
  Vector3<S> w = Vector3<S>::Zero();
  Vector3<S> dw = Vector3<S>::Zero();
  Vector3<S> a = Vector3<S>::Zero();
};

template <class S>
[[nodiscard]] Vector3<S> three(const S* x) {
  return {x[0], x[1], x[2]};
}

template <class S>
[[nodiscard]] Matrix3<S> rotation(const S* q) {
  return Rotation<S>::from(Eigen::Quaternion<S>(q[3], q[0], q[1], q[2])).matrix();
}

template <class S>
[[nodiscard]] Vector3<S> column(const Matrix3<S>& R, int k) {
  return {R(0, k), R(1, k), R(2, k)};
}

template <class S>
[[nodiscard]] Vector3<S> row(const Matrix3<S>& R, int k) {
  return {R(k, 0), R(k, 1), R(k, 2)};
}

template <class S>
[[nodiscard]] Vector3<S> multiply(const Matrix3<S>& A, const Vector3<double>& b) {
  return {A(0, 0) * b[0] + A(0, 1) * b[1] + A(0, 2) * b[2],
          A(1, 0) * b[0] + A(1, 1) * b[1] + A(1, 2) * b[2],
          A(2, 0) * b[0] + A(2, 1) * b[1] + A(2, 2) * b[2]};
}

/// The rotation from a link to its parent, for the angle of a revolute or screw joint.
template <class S>
void turn_by_angle(const Link& link, const S& angle, Matrix3<S>& turned) {
  using std::cos;
  using std::sin;
  const S c = cos(angle);
  const S s = sin(angle);
  for (int k = 0; k < 9; ++k) {
    turned(k) = link.still(k) + c * link.cosine(k) + s * link.sine(k);
  }
}

/// Sets the pose of a link that is not revolute.
template <class S>
[[gnu::noinline]] void set_other_pose(const Link& link, const LinkPose<S>& parent, const S* q,
                                      LinkPose<S>& p) {
  const Vector3<double>& a = link.axis;
  Vector3<S> offset(link.position.x(), link.position.y(), link.position.z());
  Matrix3<S> still;
  for (int k = 0; k < 9; ++k) still(k) = link.still(k);
  if (link.has_one_rate()) {
    p.axis = multiply(parent.R, link.axis);
    const S x = link.pitch * q[link.q];
    offset += Vector3<S>(x * a.x(), x * a.y(), x * a.z());
    if (link.kind == LinkKind::screw) turn_by_angle(link, q[link.q], still);
  }
  if (link.kind == LinkKind::free) offset += three(q + link.q + 4);
  if (coordinate_count(link.kind) >= 4) {
    Matrix3<S> turned;
    multiply(still, rotation(q + link.q), turned);
    still = turned;
  }
  multiply(parent.R, still, p.R);
  p.r = parent.R * offset;
}

/// Sets the pose of a link from its parent's pose and its coordinates. The functions here write in
/// place: copying results at once would stall the processor.
template <class S>
void set_pose(const Link& link, const LinkPose<S>& parent, const S* q, LinkPose<S>& p) {
  if (link.kind != LinkKind::revolute) {
    set_other_pose(link, parent, q, p);
    return;
  }
  Matrix3<S> turned;
  turn_by_angle(link, q[link.q], turned);
  multiply(parent.R, turned, p.R);
  p.r = multiply(parent.R, link.position);
  p.axis = multiply(parent.R, link.axis);
}

/// Adds the motion of a joint that is not revolute to the motion of its parent.
template <class S>
[[gnu::noinline]] void add_other_motion(const Link& link, const LinkPose<S>& pose,
                                        const LinkPose<S>& parent, const LinkMotion<S>& above,
                                        const S* v, const std::type_identity_t<S>* dv,
                                        LinkMotion<S>& m) {
  if (link.has_one_rate()) {
    const S twice = 2.0 * link.pitch * v[link.v];
    m.a += twice * cross(above.w, pose.axis);
    if (dv) m.a += S(link.pitch * dv[link.v]) * pose.axis;
    if (link.kind == LinkKind::prismatic) return;
    const Vector3<S> turn = v[link.v] * pose.axis;
    m.w += turn;
    m.dw += cross(above.w, turn);
    if (dv) m.dw += dv[link.v] * pose.axis;
    return;
  }
  const Vector3<S> turn = pose.R * three(v + link.v);
  m.w += turn;
  m.dw += cross(above.w, turn);
  if (dv) m.dw += pose.R * three(dv + link.v);
  if (link.kind != LinkKind::free) return;
  const Vector3<S> slide = parent.R * three(v + link.v + 3);
  m.a += S(2) * cross(above.w, slide);
  if (dv) m.a += parent.R * three(dv + link.v + 3);
}

/// Sets the motion of a link from its parent's motion, its rates v and their derivatives dv (null:
/// 0).
///
///   w = w_P + S v,   dw = dw_P + S dv + bias,   a = a_P + dw_P x r + w_P x (w_P x r) + ...
///
/// Source : paper 002 (18)-(19) from link to link; the guide is the first link
template <class S>
void set_motion(const Link& link, const LinkPose<S>& pose, const LinkPose<S>& parent,
                const LinkMotion<S>& above, const S* v, const std::type_identity_t<S>* dv,
                LinkMotion<S>& m) {
  m.a = above.a + cross(above.dw, pose.r) + cross(above.w, cross(above.w, pose.r));
  if (link.kind == LinkKind::revolute && link.moves()) {
    const Vector3<S> turn = v[link.v] * pose.axis;
    const S rate = dv ? dv[link.v] : S(0);
    m.w = above.w + turn;
    m.dw = above.dw + cross(above.w, turn) + rate * pose.axis;
    return;
  }
  m.w = above.w;
  m.dw = above.dw;
  if (link.moves()) add_other_motion(link, pose, parent, above, v, dv, m);
}

/// The position of a link's origin in the guide, and the velocity motor V' relative to the guide
/// about this origin.
template <class S = double>
struct LinkPlace {
  Vector3<S> x = Vector3<S>::Zero();
  Motor<S> V = {};
};

template <class S>
LinkPlace<S> place(const Link& link, const LinkPose<S>& pose, const LinkPose<S>& parent,
                   const LinkPlace<S>& above, const S* v) {
  LinkPlace<S> p{above.x + pose.r, above.V.reduced_at(pose.r)};
  if (!link.moves()) return p;
  if (link.turns_by_angle()) p.V.resultant += v[link.v] * pose.axis;
  if (link.has_one_rate()) p.V.moment += S(link.pitch * v[link.v]) * pose.axis;
  if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) {
    p.V.resultant += pose.R * three(v + link.v);
  }
  if (link.kind == LinkKind::free) p.V.moment += parent.R * three(v + link.v + 3);
  return p;
}

/// The velocity motor of a link about its origin per unit of the joint's k-th rate.
template <class S>
[[nodiscard]] Motor<S> direction(const Link& link, const LinkPose<S>& pose,
                                 const LinkPose<S>& parent, int k) {
  const Vector3<S> zero = Vector3<S>::Zero();
  if (link.kind == LinkKind::revolute) return {pose.axis, zero};
  if (link.kind == LinkKind::prismatic) return {zero, pose.axis};
  if (link.kind == LinkKind::screw) return {pose.axis, S(link.pitch) * pose.axis};
  return k < 3 ? Motor<S>{column(pose.R, k), zero} : Motor<S>{zero, column(parent.R, k - 3)};
}

/// An inertia on the axes to which R rotates:  (m; R s; R Theta R^t).
template <class S>
void turn(const Matrix3<S>& R, const Inertia<>& T, Inertia<S>& result) {
  const Symmetric3<>& t = T.tensor;
  Matrix3<S> half;  // R Theta
  for (int i = 0; i < 3; ++i) {
    half(i, 0) = R(i, 0) * t.xx + R(i, 1) * t.xy + R(i, 2) * t.xz;
    half(i, 1) = R(i, 0) * t.xy + R(i, 1) * t.yy + R(i, 2) * t.yz;
    half(i, 2) = R(i, 0) * t.xz + R(i, 1) * t.yz + R(i, 2) * t.zz;
  }
  const auto entry = [&](int i, int k) -> S {
    return half(i, 0) * R(k, 0) + half(i, 1) * R(k, 1) + half(i, 2) * R(k, 2);
  };
  result.mass = T.mass;
  result.first_moment = multiply(R, T.first_moment);
  result.tensor = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

/// An inertia reduced at a point P; r leads from P to the present origin.
[[nodiscard]] inline Inertia<> shifted(const Vector3<double>& r, const Inertia<>& T) {
  return {T.mass, T.first_moment + T.mass * r,
          T.tensor + offset_product(r, T.first_moment + (T.mass / 2) * r)};
}

/// A force motor at the end of r, reduced at the beginning of r.
template <class S>
[[nodiscard]] Motor<S> carried(const Vector3<S>& r, const Motor<S>& P) {
  return {P.resultant, P.moment + cross(r, P.resultant)};
}

/// The inertia force of T in the motion m: the left side of the equation of motion, with the
/// vectors of (19),  {m a + dw x s + w x (w x s);  s x a + Theta dw + w x Theta w}.
template <class S>
[[nodiscard]] Motor<S> inertia_force(const Inertia<S>& T, const LinkMotion<S>& m) {
  const auto& [w, dw, a] = m;
  const Vector3<S>& s = T.first_moment;
  return {T.mass * a + cross(dw, s) + cross(w, cross(w, s)),
          cross(s, a) + T.tensor * dw + cross(w, T.tensor * w)};
}

}  // namespace kreisel::detail
