#pragma once

#include <cmath>

#include <dynamics/body/tree.hpp>

/// How the links of a tree move. All on the GUIDE's axes, each link about its own origin: then
/// nothing is turned between the links, and inertias only shift.

namespace kreisel::detail {

struct LinkPose {
  Matrix3<double> R = Matrix3<double>::Identity();  ///< body to guide axes
  Vector3<double> r = Vector3<double>::Zero();      ///< from the parent's origin to its own
  Vector3<double> axis = Vector3<double>::Zero();   ///< of a revolute or prismatic joint
};

/// The absolute angular velocity w = u' + u, its inertial rate, and the inertial acceleration of
/// the origin, from which a uniform gravity may be taken off.
///
/// Accelerations of points, not motors: where the guide runs at 465 m/s, as on the earth, the
/// motors' u x v comes and goes again and leaves its rounding. The DIFFERENCE of two such pairs
/// (dw; a) at the same velocities is a motor.
struct LinkMotion {
  Vector3<double> w = Vector3<double>::Zero();
  Vector3<double> dw = Vector3<double>::Zero();
  Vector3<double> a = Vector3<double>::Zero();
};

[[nodiscard]] inline Vector3<double> three(const double* x) { return {x[0], x[1], x[2]}; }

[[nodiscard]] inline Matrix3<double> rotation(const double* q) {
  return Pose<>::from(Eigen::Quaterniond(q[3], q[0], q[1], q[2])).rotation;
}

/// C = A B. Spelt out, because g++ 12 calls Eigen's instead of inlining it.
inline void multiply(const Matrix3<double>& A, const Matrix3<double>& B, Matrix3<double>& C) {
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) C(i, k) = A(i, 0) * B(0, k) + A(i, 1) * B(1, k) + A(i, 2) * B(2, k);
  }
}

[[nodiscard]] inline Vector3<double> multiply(const Matrix3<double>& A, const Vector3<double>& b) {
  return {A(0, 0) * b[0] + A(0, 1) * b[1] + A(0, 2) * b[2],
          A(1, 0) * b[0] + A(1, 1) * b[1] + A(1, 2) * b[2],
          A(2, 0) * b[0] + A(2, 1) * b[1] + A(2, 2) * b[2]};
}

/// The pose of a link that does not turn by a single angle.
[[gnu::noinline]] inline void set_other_pose(const Link& link, const LinkPose& parent,
                                             const double* q, LinkPose& p) {
  Vector3<double> offset = link.position;
  Matrix3<double> turned = link.still;
  if (link.kind == LinkKind::prismatic) {
    p.axis = parent.R * link.axis;
    offset += q[link.q] * link.axis;
  }
  if (link.kind == LinkKind::free) offset += three(q + link.q + 4);
  if (coordinate_count(link.kind) >= 4) turned = link.still * rotation(q + link.q);
  p.R = parent.R * turned;
  p.r = parent.R * offset;
}

/// The pose of a link from its parent's and its coordinates. Written in place, here and below:
/// results copied right after they were made would wait for each other.
inline void set_pose(const Link& link, const LinkPose& parent, const double* q, LinkPose& p) {
  if (link.kind != LinkKind::revolute) {
    set_other_pose(link, parent, q, p);
    return;
  }
  const double c = std::cos(q[link.q]);
  const double s = std::sin(q[link.q]);
  Matrix3<double> turned;
  for (int k = 0; k < 9; ++k) {
    turned(k) = link.still(k) + c * link.cosine(k) + s * link.sine(k);
  }
  multiply(parent.R, turned, p.R);
  p.r = multiply(parent.R, link.position);
  p.axis = multiply(parent.R, link.axis);
}

/// What another joint than a revolute one adds to the motion of its parent.
[[gnu::noinline]] inline void add_other_motion(const Link& link, const LinkPose& pose,
                                               const LinkPose& parent, const LinkMotion& above,
                                               const double* v, const double* dv, LinkMotion& m) {
  if (link.kind == LinkKind::prismatic) {
    m.a += (2 * v[link.v]) * above.w.cross(pose.axis);
    if (dv) m.a += dv[link.v] * pose.axis;
    return;
  }
  const Vector3<double> turn = pose.R * three(v + link.v);
  m.w += turn;
  m.dw += above.w.cross(turn);
  if (dv) m.dw += pose.R * three(dv + link.v);
  if (link.kind != LinkKind::free) return;
  const Vector3<double> slide = parent.R * three(v + link.v + 3);
  m.a += 2 * above.w.cross(slide);
  if (dv) m.a += parent.R * three(dv + link.v + 3);
}

/// The motion of a link from its parent's, its rates v and their rates dv (null: all 0).
///
///   w = w_P + S v,   dw = dw_P + S dv + bias,   a = a_P + dw_P x r + w_P x (w_P x r) + ...
///
/// Source : paper 002 (18)-(19) from link to link; the guide is only the link that all begin with
inline void set_motion(const Link& link, const LinkPose& pose, const LinkPose& parent,
                       const LinkMotion& above, const double* v, const double* dv, LinkMotion& m) {
  m.a = above.a + above.dw.cross(pose.r) + above.w.cross(above.w.cross(pose.r));
  if (link.kind == LinkKind::revolute && link.moves()) {
    const Vector3<double> turn = v[link.v] * pose.axis;
    const double rate = dv ? dv[link.v] : 0;
    m.w = above.w + turn;
    m.dw = above.dw + above.w.cross(turn) + rate * pose.axis;
    return;
  }
  m.w = above.w;
  m.dw = above.dw;
  if (link.moves()) add_other_motion(link, pose, parent, above, v, dv, m);
}

/// The velocity motor V' against the guide of a link at its own origin, and that origin's place in
/// the guide.
struct LinkPlace {
  Vector3<double> x = Vector3<double>::Zero();
  Motor<> V = {};
};

inline LinkPlace place(const Link& link, const LinkPose& pose, const LinkPose& parent,
                       const LinkPlace& above, const double* v) {
  LinkPlace p{above.x + pose.r, above.V.reduced_at(pose.r)};
  if (!link.moves()) return p;
  if (link.kind == LinkKind::revolute) p.V.resultant += v[link.v] * pose.axis;
  if (link.kind == LinkKind::prismatic) p.V.moment += v[link.v] * pose.axis;
  if (link.kind == LinkKind::spherical || link.kind == LinkKind::free) {
    p.V.resultant += pose.R * three(v + link.v);
  }
  if (link.kind == LinkKind::free) p.V.moment += parent.R * three(v + link.v + 3);
  return p;
}

/// The velocity motor that the k-th rate of a joint, at 1, gives the link at its origin.
[[nodiscard]] inline Motor<> direction(const Link& link, const LinkPose& pose,
                                       const LinkPose& parent, int k) {
  const Vector3<double> zero = Vector3<double>::Zero();
  if (link.kind == LinkKind::revolute) return {pose.axis, zero};
  if (link.kind == LinkKind::prismatic) return {zero, pose.axis};
  return k < 3 ? Motor<>{pose.R.col(k), zero} : Motor<>{zero, parent.R.col(k - 3)};
}

/// Ten numbers on the axes that R turns to:  (m; R s; R Theta R^t).
inline void turn(const Matrix3<double>& R, const Inertia<>& T, Inertia<>& result) {
  const Symmetric3<>& t = T.tensor;
  Matrix3<double> half;  // R Theta
  for (int i = 0; i < 3; ++i) {
    half(i, 0) = R(i, 0) * t.xx + R(i, 1) * t.xy + R(i, 2) * t.xz;
    half(i, 1) = R(i, 0) * t.xy + R(i, 1) * t.yy + R(i, 2) * t.yz;
    half(i, 2) = R(i, 0) * t.xz + R(i, 1) * t.yz + R(i, 2) * t.zz;
  }
  const auto entry = [&](int i, int k) {
    return half(i, 0) * R(k, 0) + half(i, 1) * R(k, 1) + half(i, 2) * R(k, 2);
  };
  result.mass = T.mass;
  result.first_moment = multiply(R, T.first_moment);
  result.tensor = {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

/// Reduced at a point P, when r leads from P to the present origin.
[[nodiscard]] inline Inertia<> shifted(const Vector3<double>& r, const Inertia<>& T) {
  return {T.mass, T.first_moment + T.mass * r,
          T.tensor + offset_product(r, Vector3<double>(T.first_moment + (T.mass / 2) * r))};
}

/// A force motor at the end of r, reduced at its beginning.
[[nodiscard]] inline Motor<> carried(const Vector3<double>& r, const Motor<>& P) {
  return {P.resultant, P.moment + r.cross(P.resultant)};
}

/// The force motor of the inertia T in that motion: the left side of the law, by the vectors of
/// (19),  {m a + dw x s + w x (w x s);  s x a + Theta dw + w x Theta w}.
[[nodiscard]] inline Motor<> inertia_force(const Inertia<>& T, const LinkMotion& m) {
  const auto& [w, dw, a] = m;
  const Vector3<double>& s = T.first_moment;
  return {T.mass * a + dw.cross(s) + w.cross(w.cross(s)),
          s.cross(a) + T.tensor * dw + w.cross(T.tensor * w)};
}

}  // namespace kreisel::detail
