#pragma once

#include <Eigen/Geometry>

#include <cmath>

/// Right-hand sides written by hand, each for one scene alone: doubles, no frames, no unneeded
/// terms, every constant computed beforehand.

namespace by_hand {

using V3 = Eigen::Vector3d;
using Top = Eigen::Matrix<double, 7, 1>;    // quaternion x, y, z, w; angular velocity
using Free = Eigen::Matrix<double, 13, 1>;  // quaternion; position; angular velocity; velocity
using Gyro = Eigen::Matrix<double, 6, 1>;   // alpha, beta, phi; their rates
using Angle = Eigen::Vector2d;

/// The matrix of a quaternion of norm 1, which the integrator would have to keep, or of any norm.
enum class Norm { any, one };

template <Norm norm>
struct Rotation {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz;

  explicit Rotation(double x, double y, double z, double w) {
    const double s = norm == Norm::one ? 2 : 2 / (x * x + y * y + z * z + w * w);
    const double a = s * x, b = s * y, c = s * z;
    xx = 1 - (b * y + c * z), xy = a * y - c * w, xz = a * z + b * w;
    yx = a * y + c * w, yy = 1 - (a * x + c * z), yz = b * z - a * w;
    zx = a * z - b * w, zy = b * z + a * w, zz = 1 - (a * x + b * y);
  }

  [[nodiscard]] V3 back(const V3& v) const {
    return {xx * v.x() + yx * v.y() + zx * v.z(), xy * v.x() + yy * v.y() + zy * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
};

// --- Tops with a fixed point in the inertial frame -------------------------------------------------

struct PrincipalTop {
  V3 moments;
  V3 k = V3::Zero();  // weight moment
  V3 difference{moments.y() - moments.z(), moments.z() - moments.x(), moments.x() - moments.y()};

  template <bool heavy, Norm norm = Norm::any>
  [[nodiscard]] Top rates(const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    double A = difference.x() * b * c, B = difference.y() * c * a, C = difference.z() * a * b;
    if constexpr (heavy) {
      const Rotation<norm> R(qx, qy, qz, qw);
      A -= k.y() * R.zz - k.z() * R.zy;
      B -= k.z() * R.zx - k.x() * R.zz;
      C -= k.x() * R.zy - k.y() * R.zx;
    }
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    return Top(qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc,
               qw * hc + qx * hb - qy * ha, -(qx * ha + qy * hb + qz * hc), A / moments.x(),
               B / moments.y(), C / moments.z());
  }
};

/// On arbitrary axes: six numbers of the tensor, six of its inverse.
struct GeneralTop {
  Eigen::Matrix3d T;
  V3 k;  // weight moment
  Eigen::Matrix3d I = T.inverse();

  [[nodiscard]] Top operator()(const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    const Rotation<Norm::any> R(qx, qy, qz, qw);
    const double La = T(0, 0) * a + T(0, 1) * b + T(0, 2) * c;
    const double Lb = T(0, 1) * a + T(1, 1) * b + T(1, 2) * c;
    const double Lc = T(0, 2) * a + T(1, 2) * b + T(2, 2) * c;
    const double A = Lb * c - Lc * b - (k.y() * R.zz - k.z() * R.zy);
    const double B = Lc * a - La * c - (k.z() * R.zx - k.x() * R.zz);
    const double C = La * b - Lb * a - (k.x() * R.zy - k.y() * R.zx);
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    return Top(qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc,
               qw * hc + qx * hb - qy * ha, -(qx * ha + qy * hb + qz * hc),
               I(0, 0) * A + I(0, 1) * B + I(0, 2) * C, I(0, 1) * A + I(1, 1) * B + I(1, 2) * C,
               I(0, 2) * A + I(1, 2) * B + I(2, 2) * C);
  }
};

// --- Bodies on a guide that turns ------------------------------------------------------------------

/// A ball pendulum on the earth, x south, z up: the earth's rate has no y component, gravity only a
/// z component. State: attitude and rate against the earth. The rate of R^t w_E is -u' x R^t w_E.
struct BallPendulum {
  V3 moments;
  V3 earth;
  double k;  // mass times arm times gravity, the arm downwards
  double BC = moments.y() - moments.z(), CA = moments.z() - moments.x(),
         AB = moments.x() - moments.y();

  template <Norm norm = Norm::any>
  [[nodiscard]] Top rates(const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    const Rotation<norm> R(qx, qy, qz, qw);
    const double ex = R.xx * earth.x() + R.zx * earth.z();
    const double ey = R.xy * earth.x() + R.zy * earth.z();
    const double ez = R.xz * earth.x() + R.zz * earth.z();
    const double wx = a + ex, wy = b + ey, wz = c + ez;
    const double dwx = (BC * wy * wz - k * R.zy) / moments.x();
    const double dwy = (CA * wz * wx + k * R.zx) / moments.y();
    const double dwz = AB * wx * wy / moments.z();
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    return Top(qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc,
               qw * hc + qx * hb - qy * ha, -(qx * ha + qy * hb + qz * hc), dwx + (b * ez - c * ey),
               dwy + (c * ex - a * ez), dwz + (a * ey - b * ex));
  }
};

/// A body with arbitrary inertia and a fixed point, on a guide that turns steadily with u. Gravity
/// rests in the inertial frame; in the guide it is n n.g + cos(|u| t) (g - n n.g) + sin(|u| t) g x
/// n.
struct HeldOnTurningGuide {
  Eigen::Matrix3d T;
  V3 s;  // first moment
  V3 u;
  V3 g;     // at t = 0, on guide axes
  V3 held;  // inertial acceleration of the fixed point, on guide axes
  Eigen::Matrix3d I = T.inverse();
  double rate = u.norm();
  V3 along = u.dot(g) / u.squaredNorm() * u;
  V3 across = g - along;
  V3 aside = g.cross(u / rate);
  V3 steady = along - held;

  [[nodiscard]] Top operator()(double t, const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    const double co = std::cos(rate * t), si = std::sin(rate * t);
    const Rotation<Norm::any> R(qx, qy, qz, qw);
    const V3 G = R.back({steady.x() + co * across.x() + si * aside.x(),
                         steady.y() + co * across.y() + si * aside.y(),
                         steady.z() + co * across.z() + si * aside.z()});
    const V3 e = R.back(u);
    const double wx = a + e.x(), wy = b + e.y(), wz = c + e.z();
    const double La = T(0, 0) * wx + T(0, 1) * wy + T(0, 2) * wz;
    const double Lb = T(0, 1) * wx + T(1, 1) * wy + T(1, 2) * wz;
    const double Lc = T(0, 2) * wx + T(1, 2) * wy + T(2, 2) * wz;
    const double A = Lb * wz - Lc * wy + (s.y() * G.z() - s.z() * G.y());
    const double B = Lc * wx - La * wz + (s.z() * G.x() - s.x() * G.z());
    const double C = La * wy - Lb * wx + (s.x() * G.y() - s.y() * G.x());
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    return Top(qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc,
               qw * hc + qx * hb - qy * ha, -(qx * ha + qy * hb + qz * hc),
               I(0, 0) * A + I(0, 1) * B + I(0, 2) * C + (b * e.z() - c * e.y()),
               I(0, 1) * A + I(1, 1) * B + I(1, 2) * C + (c * e.x() - a * e.z()),
               I(0, 2) * A + I(1, 2) * B + I(2, 2) * C + (a * e.y() - b * e.x()));
  }
};

/// A body with arbitrary inertia and a fixed point, in a lift that moves up and down by sin(2 t)
/// without turning.
struct HeldInLift {
  Eigen::Matrix3d T;
  V3 s;  // first moment
  V3 g;
  Eigen::Matrix3d I = T.inverse();

  [[nodiscard]] Top operator()(double t, const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    const Rotation<Norm::any> R(qx, qy, qz, qw);
    const V3 G = R.back({g.x(), g.y(), g.z() - 4 * std::sin(2 * t)});
    const double La = T(0, 0) * a + T(0, 1) * b + T(0, 2) * c;
    const double Lb = T(0, 1) * a + T(1, 1) * b + T(1, 2) * c;
    const double Lc = T(0, 2) * a + T(1, 2) * b + T(2, 2) * c;
    const double A = Lb * c - Lc * b + (s.y() * G.z() - s.z() * G.y());
    const double B = Lc * a - La * c + (s.z() * G.x() - s.x() * G.z());
    const double C = La * b - Lb * a + (s.x() * G.y() - s.y() * G.x());
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    return Top(qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc,
               qw * hc + qx * hb - qy * ha, -(qx * ha + qy * hb + qz * hc),
               I(0, 0) * A + I(0, 1) * B + I(0, 2) * C, I(0, 1) * A + I(1, 1) * B + I(1, 2) * C,
               I(0, 2) * A + I(1, 2) * B + I(2, 2) * C);
  }
};

/// A body on principal axes through its centre of mass, free in a guide that turns steadily with u.
/// Gravity rests in the guide; `steady` is gravity less the acceleration of the guide's origin.
struct FreeOnTurningGuide {
  V3 moments;
  V3 u;
  V3 steady;
  double BC = moments.y() - moments.z(), CA = moments.z() - moments.x(),
         AB = moments.x() - moments.y();

  [[nodiscard]] Free operator()(const Free& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], rx = y[4], ry = y[5], rz = y[6];
    const double a = y[7], b = y[8], c = y[9], vx = y[10], vy = y[11], vz = y[12];
    const Rotation<Norm::any> R(qx, qy, qz, qw);
    const double px = u.y() * rz - u.z() * ry, py = u.z() * rx - u.x() * rz,
                 pz = u.x() * ry - u.y() * rx;
    const V3 G =
        R.back({steady.x() - (u.y() * pz - u.z() * py), steady.y() - (u.z() * px - u.x() * pz),
                steady.z() - (u.x() * py - u.y() * px)});
    const V3 e = R.back(u);
    const double wx = a + e.x(), wy = b + e.y(), wz = c + e.z();
    const double kx = wx + e.x(), ky = wy + e.y(), kz = wz + e.z();
    const double ha = 0.5 * a, hb = 0.5 * b, hc = 0.5 * c;
    Free dy;
    dy << qw * ha + qy * hc - qz * hb, qw * hb + qz * ha - qx * hc, qw * hc + qx * hb - qy * ha,
        -(qx * ha + qy * hb + qz * hc), R.xx * vx + R.xy * vy + R.xz * vz,
        R.yx * vx + R.yy * vy + R.yz * vz, R.zx * vx + R.zy * vy + R.zz * vz,
        BC * wy * wz / moments.x() + (b * e.z() - c * e.y()),
        CA * wz * wx / moments.y() + (c * e.x() - a * e.z()),
        AB * wx * wy / moments.z() + (a * e.y() - b * e.x()), G.x() - (ky * vz - kz * vy),
        G.y() - (kz * vx - kx * vz), G.z() - (kx * vy - ky * vx);
    return dy;
  }
};

// --- Plane pendulums -------------------------------------------------------------------------------

struct PlanePendulumAtRest {
  double E;

  [[nodiscard]] Angle operator()(const Angle& y) const { return {y[1], -(E * std::sin(y[0]))}; }
};

/// (23) with E, 2K, F and H divided by Theta_C beforehand.
struct PlanePendulum {
  double E, F, H, K2;

  [[nodiscard]] Angle operator()(const Angle& y) const {
    const double s = std::sin(y[0]);
    const double c = std::cos(y[0]);
    return {y[1], -(s * (E + K2 * c) + F * c + H * (1 - 2 * s * s))};
  }
};

/// (23) on principal axes, with E, F, H and K computed from the guide's motion at each call. Motion
/// returns u, ou and g' at t.
template <class Motion>
struct PlanePendulumOnGuide {
  Motion motion;
  double k;  // mass times arm over Theta_C
  double d;  // (Theta_B - Theta_A) / Theta_C

  [[nodiscard]] Angle operator()(double t, const Angle& y) const {
    const auto [u, du, g] = motion(t);
    const double s = std::sin(y[0]);
    const double c = std::cos(y[0]);
    const double H = d * (u.x() * u.y());
    const double K2 = d * ((u.y() - u.x()) * (u.y() + u.x()));
    return {y[1], -(s * (k * g.x() + K2 * c) - k * g.y() * c + H * (1 - 2 * s * s)) - du.z()};
  }
};

// --- The Cardan gyro -------------------------------------------------------------------------------

/// Symmetric rotor; bearings of spring and damper, if `braced`.
struct CardanGyro {
  double A_1, C_1, A_2, B_2, C_2, A_3, C_3_less_B_3;
  double outer_stiffness, outer_damping, inner_stiffness, inner_damping;
  V3 base = V3::Zero();
  double A = A_1 + A_2;
  double B = A_1 + B_2;

  /// The moment of springs and friction, if there are any, less a given moment.
  template <bool braced>
  [[nodiscard]] double braced_a(const Gyro& y, double moment) const {
    return braced ? -outer_stiffness * y[0] - outer_damping * y[3] - moment : -moment;
  }
  template <bool braced>
  [[nodiscard]] double braced_b(const Gyro& y, double moment) const {
    return braced ? -inner_stiffness * y[1] - inner_damping * y[4] - moment : -moment;
  }

  /// Lagrange's equations on a base at rest.
  template <bool regulated>
  [[nodiscard]] Gyro at_rest(const Gyro& y) const {
    const double s = std::sin(y[1]), c = std::cos(y[1]);
    const double da = y[3], db = y[4], df = y[5];
    const double p = C_1 * (df + da * s);
    const double g = (C_2 - A) * s * c * da;
    const double ddb = braced_b<true>(y, -((g + p * c) * da)) / B;
    if constexpr (regulated) {
      const double J = A_3 + A * c * c + (C_1 + C_2) * s * s;
      const double dda = braced_a<true>(y, (2 * g + (p + C_1 * da * s) * c) * db) / J;
      return Gyro(da, db, df, dda, ddb, 0);
    } else {
      const double J = A_3 + A * c * c + C_2 * s * s;
      const double dda = braced_a<true>(y, (2 * g + p * c) * db) / J;
      return Gyro(da, db, df, dda, ddb, -(dda * s + da * db * c));
    }
  }

  /// Euler's equations of the three bodies on a base that turns steadily.
  template <bool regulated, bool braced = true>
  [[nodiscard]] Gyro on_base(const Gyro& y) const {
    const double sa = std::sin(y[0]), ca = std::cos(y[0]), s = std::sin(y[1]), c = std::cos(y[1]);
    const double da = y[3], db = y[4], df = y[5];
    const double x3 = da + base.x(), y3 = base.y() * ca + base.z() * sa,
                 z3 = base.z() * ca - base.y() * sa;
    const double dy3 = da * z3, dz3 = -da * y3;
    const double x2 = x3 * c - z3 * s, y2 = y3 + db, z2 = x3 * s + z3 * c;
    const double dx2 = -dz3 * s - db * z2, dz2 = dz3 * c + db * x2;
    const double H = C_1 * (z2 + df);
    const double a = A * dx2 + (C_2 - B) * y2 * z2 + y2 * H;
    const double b = B * dy3 + (A - C_2) * z2 * x2 - x2 * H;
    const double held = regulated ? C_1 + C_2 : C_2;  // turns with the inner ring about C
    const double cc = held * dz2 + (B_2 - A_2) * x2 * y2;
    const double J = A_3 + A * c * c + held * s * s;
    const double outer = C_3_less_B_3 * y3 * z3;
    const double dda = braced_a<braced>(y, c * a + s * cc + outer) / J;
    const double ddb = braced_b<braced>(y, b) / B;
    if constexpr (regulated) return Gyro(da, db, df, dda, ddb, 0);
    return Gyro(da, db, df, dda, ddb, -(dz2 + dda * s));
  }
};

}  // namespace by_hand
