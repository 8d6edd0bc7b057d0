#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

#include "peer.hpp"

/// Code written by hand for this chain or this gyro alone.
namespace scenes {

/// Articulated bodies and Newton-Euler for chains of revolute joints, on body axes, moments about
/// the body's origin, as in textbooks. R takes body to parent axes. A base at rest is known at
/// compile time, which saves a tenth.
template <bool moves>
class HandWrittenChain {
 public:
  using V3 = Eigen::Vector3d;
  using M3 = Eigen::Matrix3d;

  explicit HandWrittenChain(const Chain& chain)
      : gravity_(vector(chain.gravity)),
        turning_(vector(chain.turning)),
        links_(chain.links.size()) {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& given = chain.links[i];
      const V3 c = vector(given.centre);
      Part& l = links_[i];
      l.axis = vector(given.axis);
      l.position = vector(given.position);
      l.mass = given.mass;
      l.s = l.mass * c;
      l.tensor = -l.mass * skew(c) * skew(c);
      l.tensor.diagonal() += vector(given.moments);
    }
  }

  void forward(const double* q, const double* v, double* dv) {
    spread(q, v, nullptr);
    for (Part& l : links_) {
      l.M = l.mass * M3::Identity();
      l.H = skew(l.s);
      l.J = l.tensor;
    }
    for (std::size_t i = links_.size(); i-- > 0;) {
      Part& l = links_[i];
      l.h.noalias() = l.H.transpose() * l.axis;
      l.j.noalias() = l.J * l.axis;
      l.d = 1 / l.axis.dot(l.j);
      l.u = -l.axis.dot(l.n);
      if (i == 0) break;
      Part& p = links_[i - 1];
      const V3 hd = l.d * l.h;
      const V3 jd = l.d * l.j;
      const M3 M = l.M - hd * l.h.transpose();
      const M3 H = l.H - jd * l.h.transpose();
      const M3 J = l.J - jd * l.j.transpose();
      const M3& R = l.R;
      const M3 x = skew(l.position);
      const M3 Mp = R * M * R.transpose();
      const M3 Hp = R * H * R.transpose();
      const M3 Jp = R * J * R.transpose();
      const M3 xH = x * Hp.transpose();
      const M3 xM = x * Mp;
      p.M += Mp;
      p.H += Hp + xM;
      p.J += Jp + xH + xH.transpose() - xM * x;
      const V3 f = R * (l.f + l.u * hd);
      p.f += f;
      p.n += R * (l.n + l.u * jd) + l.position.cross(f);
    }
    V3 dw = V3::Zero();
    V3 a = V3::Zero();
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Part& l = links_[i];
      const V3 moved = a + dw.cross(l.position);
      a.noalias() = l.R.transpose() * moved;
      dw = V3(l.R.transpose() * dw);
      dv[i] = (l.u - l.h.dot(a) - l.j.dot(dw)) * l.d;
      dw += dv[i] * l.axis;
    }
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) {
    spread(q, v, dv);
    for (std::size_t i = links_.size(); i-- > 0;) {
      const Part& l = links_[i];
      force[i] = l.axis.dot(l.n);
      if (i == 0) break;
      Part& p = links_[i - 1];
      const V3 f = l.R * l.f;
      p.f += f;
      p.n += l.R * l.n + l.position.cross(f);
    }
  }

 private:
  struct Part {
    V3 axis, position, s;
    M3 tensor;
    double mass = 0;
    M3 R, M, H, J;
    V3 f, n, h, j;
    double d = 0;
    double u = 0;
  };

  static V3 vector(const Triple& v) { return {v[0], v[1], v[2]}; }

  static M3 skew(const V3& v) {
    M3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
  }

  void spread(const double* q, const double* v, const double* dv) {
    V3 w = V3::Zero();
    if constexpr (moves) w = turning_;
    V3 dw = V3::Zero();
    V3 a = -gravity_;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Part& l = links_[i];
      const double c = std::cos(q[i]);
      const double s = std::sin(q[i]);
      l.R = (1 - c) * l.axis * l.axis.transpose() + s * skew(l.axis);
      l.R.diagonal().array() += c;
      const V3 moved = a + dw.cross(l.position) + w.cross(w.cross(l.position));
      a.noalias() = l.R.transpose() * moved;
      const V3 w_parent = l.R.transpose() * w;
      const V3 turn = v[i] * l.axis;
      dw = V3(l.R.transpose() * dw) + w_parent.cross(turn);
      if (dv) dw += dv[i] * l.axis;
      w = w_parent + turn;
      l.f = l.mass * a + dw.cross(l.s) + w.cross(w.cross(l.s));
      l.n = l.s.cross(a) + l.tensor * dw + w.cross(l.tensor * w);
    }
  }

  V3 gravity_, turning_;
  std::vector<Part> links_;
};

/// A gyro in Cardan's suspension with a symmetric rotor. Its three axes meet in the centre of mass
/// of all bodies. Indices 1, 2, 3: rotor, inner ring, outer ring.
struct HandWrittenGyro {
  double A_1, C_1;
  double A_2, B_2, C_2;
  double A_3, B_3, C_3;

  /// The gyro on a base at rest, by Lagrange's equations. With the rotor's momentum N about its
  /// axis and K = C_2 - A_2 - A_1
  ///
  ///   (A_3 + C_2 sin^2 b + (A_2 + A_1) cos^2 b) a'' = -b' cos b (2 K a' sin b + N)
  ///                                 (B_2 + A_1) b'' =  a' cos b (  K a' sin b + N)
  ///                            f'' + (a' sin b)' = 0
  void resting(const double* y, double* dv) const {
    const double s = std::sin(y[1]);
    const double c = std::cos(y[1]);
    const double da = y[3];
    const double db = y[4];
    const double turn = da * s;
    const double N = C_1 * (turn + y[5]);
    const double K = (C_2 - A_2 - A_1) * turn;
    const double dda = -db * c * (2 * K + N) / (A_3 + C_2 * s * s + (A_2 + A_1) * c * c);
    dv[0] = dda;
    dv[1] = da * c * (K + N) / (B_2 + A_1);
    dv[2] = -(dda * s + da * db * c);
  }

  /// The gyro on a base with constant angular velocity u, by Euler's equations. x, y, z are angular
  /// velocities on each ring's axes, dx, dy, dz their rates without the unknown accelerations.
  void moving(const double* u, const double* y, double* dv) const {
    const double sa = std::sin(y[0]);
    const double ca = std::cos(y[0]);
    const double s = std::sin(y[1]);
    const double c = std::cos(y[1]);
    const double da = y[3];
    const double db = y[4];
    const double x3 = da + u[0];
    const double y3 = u[1] * ca + u[2] * sa;
    const double z3 = u[2] * ca - u[1] * sa;
    const double dy3 = da * z3;
    const double dz3 = -da * y3;
    const double x2 = x3 * c - z3 * s;
    const double y2 = y3 + db;
    const double z2 = x3 * s + z3 * c;
    const double dx2 = -dz3 * s - db * z2;
    const double dz2 = dz3 * c + db * x2;
    const double A = A_2 + A_1;
    const double B = B_2 + A_1;
    const double N = C_1 * (z2 + y[5]);
    const double about_a = A * dx2 + (C_2 - B) * y2 * z2 + y2 * N;
    const double about_b = B * dy3 + (A - C_2) * z2 * x2 - x2 * N;
    const double about_c = C_2 * dz2 + (B_2 - A_2) * x2 * y2;
    const double about_outer = c * about_a + s * about_c + (C_3 - B_3) * y3 * z3;
    const double dda = -about_outer / (A_3 + C_2 * s * s + A * c * c);
    dv[0] = dda;
    dv[1] = -about_b / B;
    dv[2] = -dz2 - dda * s;
  }
};

}  // namespace scenes
