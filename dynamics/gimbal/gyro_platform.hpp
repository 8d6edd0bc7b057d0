#pragma once

#include <Eigen/Core>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/inertia.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/tree/description.hpp>

namespace kreisel {

/// The linear equations of the frames of a GyroPlatform.
enum class PlatformEquations {
  printed,    ///< as the paper prints (27): the sign of L6 Omega2 in row 5 is wrong
  corrected,  ///< (27) with that sign
  complete    ///< all that is linear in the angles, for any motion of the platform
};

/// A platform stabilized by three gyros: the paper's example.
///
///   platform -> frame 4 (axis +2, alpha4) -> housing 5 (axis +3, beta5) -> rotor 6 (+1)
///                                         -> housing 7 (axis -3, beta7) -> rotor 8 (-1)
///   platform -> frame 9 (axis +3, alpha9) -> housing 10 (axis +1, beta10) -> rotor 11 (+2)
///
/// Velocities are (Omega1, Omega2, Omega3, alpha4', beta5', beta7', alpha9', beta10'), angles the
/// last five. Omega is the angular velocity of the platform on its own axes. It is no rate of
/// coordinates, so the paper's rows 1 to 3 lack a term.
///
/// Source : paper 000 sections 2 and 4, (20)-(27), corrected as docs/errata.md says
/// Frame  : the platform's axes 1, 2, 3; the axes of the other frames are parallel to them at zero
///          angles
/// Units  : kg, m, kg m^2, N m s
struct GyroPlatform {
  using Angles = Eigen::Matrix<double, 5, 1>;
  using Matrix8 = Eigen::Matrix<double, 8, 8>;
  using Rows = Eigen::Matrix<double, 3, 8>;

  /// A frame or housing whose centre of mass is on its axis.
  struct Part {
    double mass = 0;
    Vector3<double> moments = Vector3<double>::Zero();  ///< about the centre, about 1, 2, 3
  };
  struct Wheel {
    double mass = 0;
    double about = 0;   ///< C
    double across = 0;  ///< about any axis through the centre at right angles to it
  };

  InertiaTensor<Body> platform = {};                     ///< about O, of the platform alone
  Vector3<double> position_4 = Vector3<double>::Zero();  ///< of the joints, from O
  Vector3<double> position_9 = Vector3<double>::Zero();  ///< and of housing 10 in frame 9
  double arm_5 = 0;  ///< of the housings, from position_4 along axis 2
  double arm_7 = 0;
  Part frame_4, housing_5, housing_7, frame_9, housing_10;
  Wheel rotor_6, rotor_8, rotor_11;
  Vector3<double> L = Vector3<double>::Zero();  ///< L6, L8, L11, or p of free rotors

  /// Principal moments of F (frame 4), H (5), K (7), f (9), h (10) with the rotors' about axes
  /// across theirs, without C6, C8, C11.
  struct Moments {
    Vector3<double> F, H, K, f, h;
  };
  [[nodiscard]] Moments moments() const {
    return {frame_4.moments, housing_5.moments + across(rotor_6, 0),
            housing_7.moments + across(rotor_8, 0), frame_9.moments,
            housing_10.moments + across(rotor_11, 1)};
  }

  /// J4, J5, J7, J9, J10: the moments of inertia about the five axes.
  [[nodiscard]] Angles axis_moments() const {
    const auto [F, H, K, f, h] = moments();
    return {F[1] + H[1] + K[1], H[2], K[2], f[2] + h[2], h[0]};
  }

  /// The same platform as bodies, for BodySystem. `base` joins the platform to the guide. The
  /// rotors' relative rates, L/C if regulated, are part of the state.
  [[nodiscard]] std::vector<BodyDescription> bodies(const Joint& base, RotorMode mode) const {
    const auto body = [](const char* name, const char* parent, const Vector3<double>& axis,
                         const Vector3<double>& position, const Part& part) {
      BodyDescription b;
      b.name = name;
      b.parent = parent;
      b.joint = {.kind = JointKind::revolute, .axis = axis, .position = position};
      b.inertia = InertiaTensor<Body>::about_centre(part.mass, Vector3<double>::Zero(),
                                                    part.moments.asDiagonal().toDenseMatrix());
      return b;
    };
    const auto rotor = [&](const char* name, const char* parent, const Vector3<double>& axis,
                           int along, const Wheel& wheel) {
      Vector3<double> moments = across(wheel, along);
      moments[along] = wheel.about;
      BodyDescription b = body(name, parent, axis, {0, 0, 0}, {wheel.mass, moments});
      b.rotor = Rotor{.mode = mode};
      return b;
    };
    BodyDescription root;
    root.name = "platform";
    root.joint = base;
    root.inertia = platform;
    return {root,
            body("frame 4", "platform", {0, 1, 0}, position_4, frame_4),
            body("housing 5", "frame 4", {0, 0, 1}, {0, arm_5, 0}, housing_5),
            rotor("rotor 6", "housing 5", {1, 0, 0}, 0, rotor_6),
            body("housing 7", "frame 4", {0, 0, -1}, {0, arm_7, 0}, housing_7),
            rotor("rotor 8", "housing 7", {-1, 0, 0}, 0, rotor_8),
            body("frame 9", "platform", {0, 0, 1}, position_9, frame_9),
            body("housing 10", "frame 9", {1, 0, 0}, {0, 0, 0}, housing_10),
            rotor("rotor 11", "housing 10", {0, 1, 0}, 1, rotor_11)};
  }

  /// B, exact. Source : (21), there to second order
  [[nodiscard]] static Rows spin_rows(const Angles& q) {
    using std::cos;
    using std::sin;
    const double c4 = cos(q[0]), s4 = sin(q[0]), c9 = cos(q[3]), s9 = sin(q[3]);
    const double c5 = cos(q[1]), s5 = sin(q[1]), c7 = cos(q[2]), s7 = sin(q[2]);
    const double c10 = cos(q[4]), s10 = sin(q[4]);
    Rows B;
    B << c4 * c5, s5, -s4 * c5, s5, 0, 0, 0, 0,  //
        -c4 * c7, s7, s4 * c7, s7, 0, 0, 0, 0,   //
        -s9 * c10, c9 * c10, s10, 0, 0, 0, s10, 0;
    return B;
  }

  /// The diagonal of A_R. Source : (22)
  [[nodiscard]] Vector3<double> spin_inertias() const {
    return {rotor_6.about, rotor_8.about, rotor_11.about};
  }

  /// A to first order. Source : (23), there constant: the variable part is as large as terms that
  /// (24) keeps
  [[nodiscard]] Matrix8 carrier_inertia(const Angles& q) const {
    const auto [F, H, K, f, h] = moments();
    const Angles J = axis_moments();
    Matrix8 A = Matrix8::Zero();
    const auto set = [&A](int i, int k, double x) { A(i, k) = A(k, i) = x; };
    A.diagonal().tail<5>() = J;
    set(1, 3, J[0]);
    set(2, 4, J[1]);
    set(2, 5, -J[2]);
    set(2, 6, J[3]);
    set(0, 7, J[4]);
    const double a4 = q[0], b5 = q[1], b7 = q[2], a9 = q[3], b10 = q[4];
    const double turned = (H[0] - H[1]) * b5 - (K[0] - K[1]) * b7;
    set(0, 1, turned + (f[0] - f[1] + h[0] - h[1]) * a9);
    set(0, 2, -(F[0] - F[2] + H[0] - H[2] + K[0] - K[2]) * a4);
    set(1, 2, (h[1] - h[2]) * b10);
    set(0, 3, turned);
    set(0, 4, J[1] * a4);
    set(0, 5, -J[2] * a4);
    set(1, 6, (h[1] - h[2]) * b10);
    set(1, 7, J[4] * a9);
    A.topLeftCorner<3, 3>() += at_rest();
    return A;
  }

  /// B^t A_R B to first order. Source : (24), completed by (1,2), (1,3), (2,3)
  [[nodiscard]] Matrix8 spin_inertia(const Angles& q) const {
    const double C_6 = rotor_6.about, C_8 = rotor_8.about, C_11 = rotor_11.about;
    Matrix8 A = Matrix8::Zero();
    const auto set = [&A](int i, int k, double x) { A(i, k) = A(k, i) = x; };
    set(0, 0, C_6 + C_8);
    set(1, 1, C_11);
    set(0, 1, C_6 * q[1] - C_8 * q[2] - C_11 * q[3]);
    set(0, 2, -(C_6 + C_8) * q[0]);
    set(1, 2, C_11 * q[4]);
    set(0, 3, C_6 * q[1] - C_8 * q[2]);
    set(1, 6, C_11 * q[4]);
    return A;
  }

  /// The part of B^t A_R B in (13), at zero angles; rows 1-3 also have W x (A* u).
  ///
  /// Source : (25), in rows 5, 7, 10 with the factor 1/2 of (13), and completed
  [[nodiscard]] Matrix8 spin_inertia_rate(const Vector3<double>& W, const Angles& dq) const {
    const double C_6 = rotor_6.about, C_8 = rotor_8.about, C_11 = rotor_11.about;
    const double w24 = W[1] + dq[0], w39 = W[2] + dq[3];
    Matrix8 G;
    G << 0, 0, 0, -(C_6 + C_8) * W[2], C_6 * w24, -C_8 * w24, -C_11 * W[1], 0,                //
        0, 0, 0, 0, C_6 * W[0], -C_8 * W[0], -C_11 * W[0], C_11 * w39,                        //
        0, 0, 0, -(C_6 + C_8) * W[0], 0, 0, 0, C_11 * W[1],                                   //
        (C_6 + C_8) * W[2] / 2, 0, (C_6 + C_8) * W[0] / 2, 0, C_6 * W[0], -C_8 * W[0], 0, 0,  //
        -C_6 * w24 / 2, -C_6 * W[0] / 2, 0, -C_6 * W[0] / 2, 0, 0, 0, 0,                      //
        C_8 * w24 / 2, C_8 * W[0] / 2, 0, C_8 * W[0] / 2, 0, 0, 0, 0,                         //
        C_11 * W[1] / 2, C_11 * W[0] / 2, 0, 0, 0, 0, 0, C_11 * W[1],                         //
        0, -C_11 * w39 / 2, -C_11 * W[1] / 2, 0, 0, 0, -C_11 * W[1] / 2, 0;
    return G;
  }

  /// G_R to first order, skew. Source : (26), with the rows and columns 1-3, whose velocities are
  /// no rates of coordinates; as printed they are 0
  [[nodiscard]] Matrix8 gyroscopic(const Angles& q, bool as_printed = false) const {
    const double L_6 = L[0], L_8 = L[1], L_11 = L[2];
    Matrix8 G = Matrix8::Zero();
    const auto set = [&G](int i, int k, double x) {
      G(i, k) = x;
      G(k, i) = -x;
    };
    if (!as_printed) {
      set(0, 1, L_11 * q[4] + (L_8 - L_6) * q[0]);
      set(0, 2, -L_11 - L_6 * q[1] - L_8 * q[2]);
      set(1, 2, L_6 - L_8 - L_11 * q[3]);
    }
    set(0, 3, (L_8 - L_6) * q[0]);
    set(2, 3, L_8 - L_6);
    set(0, 4, -L_6 * q[1]);
    set(1, 4, L_6);
    set(3, 4, L_6);
    set(0, 5, L_8 * q[2]);
    set(1, 5, L_8);
    set(3, 5, L_8);
    set(0, 6, -L_11);
    set(1, 6, -L_11 * q[3]);
    set(1, 7, -L_11 * q[4]);
    set(2, 7, L_11);
    set(6, 7, L_11);
    return G;
  }

  /// The second derivatives of the angles by linear equations, for a prescribed motion W(t), W' of
  /// the platform; Q are forces along the five angles.
  ///
  /// Source : (27). It leaves out products J W W, which matter where the terms of the momenta
  ///          cancel, as (L6 - L8) in row 4
  [[nodiscard]] Angles linear_accelerations(PlatformEquations equations, const Vector3<double>& W,
                                            const Vector3<double>& dW, const Angles& q,
                                            const Angles& dq, const Angles& Q) const {
    const double L_6 = L[0], L_8 = L[1], L_11 = L[2];
    const double a4 = q[0], b5 = q[1], b7 = q[2], a9 = q[3], b10 = q[4];
    const Angles J = axis_moments();
    const double sign = equations == PlatformEquations::printed ? -1 : 1;
    Angles r = Q;
    r[0] -= J[0] * dW[1] + (L_6 - L_8) * W[2] + L_6 * dq[1] + L_8 * dq[2] + (L_6 - L_8) * W[0] * a4;
    r[1] -= J[1] * dW[2] - sign * L_6 * W[1] - L_6 * dq[0] + L_6 * W[0] * b5;
    r[2] -= -J[2] * dW[2] - L_8 * W[1] - L_8 * dq[0] - L_8 * W[0] * b7;
    r[3] -= J[3] * dW[2] + L_11 * W[0] + L_11 * dq[4] + L_11 * W[1] * a9;
    r[4] -= J[4] * dW[0] - L_11 * W[2] - L_11 * dq[3] + L_11 * W[1] * b10;
    if (equations == PlatformEquations::complete) {
      r -= products(W, dW, q, dq);
    } else {
      r[0] -= (rotor_6.about * b5 - rotor_8.about * b7) * dW[0];
      r[3] -= rotor_11.about * dW[1] * b10;
    }
    return r.cwiseQuotient(J);
  }

  /// The terms of linear_accelerations(): see kreisel::terms.
  [[nodiscard]] Terms terms(PlatformEquations equations = PlatformEquations::complete) const {
    const bool complete = equations == PlatformEquations::complete;
    const std::string of_order = complete ? "" : "(27) keeps what has a factor L";
    Terms list;
    list.add("relative", "J_i alpha_i''");
    list.add("relative", "L alpha', L beta'");
    list.add("relative", "products of angles and rates", false, "linear in the angles");
    list.add("guide", "J_i W'");
    list.add("guide", "L W", true,
             equations == PlatformEquations::printed ? "L6 W2 in row 5 with the wrong sign" : "");
    list.add("guide", "L W times angles");
    list.add("guide", "C W' times angles", true,
             complete ? "" : "without those of rows 5, 7, 10 and of frames and housings");
    list.add("guide", "J W W, J W W times angles", complete, of_order);
    list.add("Coriolis", "J W alpha'", complete, of_order);
    list.add("load", "Q along the five axes");
    return list;
  }

 private:
  [[nodiscard]] static Vector3<double> across(const Wheel& wheel, int along) {
    Vector3<double> moments = Vector3<double>::Constant(wheel.across);
    moments[along] = 0;
    return moments;
  }

  /// The inertia of all parts about O in the normal position, without C6, C8, C11.
  [[nodiscard]] Matrix3<double> at_rest() const {
    const auto [F, H, K, f, h] = moments();
    Matrix3<double> sum = platform.value.tensor.matrix();
    const auto add = [&sum](double mass, const Vector3<double>& x, const Vector3<double>& about) {
      sum += mass * (x.squaredNorm() * Matrix3<double>::Identity() - x * x.transpose());
      sum.diagonal() += about;
    };
    const Vector3<double> along(0, 1, 0);
    add(frame_4.mass, position_4, F);
    add(housing_5.mass + rotor_6.mass, position_4 + arm_5 * along, H);
    add(housing_7.mass + rotor_8.mass, position_4 + arm_7 * along, K);
    add(frame_9.mass + housing_10.mass + rotor_11.mass, position_9, f + h);
    return sum;
  }

  /// All terms linear in the angles and of the size J W^2 or J W', on the left side.
  [[nodiscard]] Angles products(const Vector3<double>& W, const Vector3<double>& dW,
                                const Angles& q, const Angles& dq) const {
    const auto [F, H, K, f, h] = moments();
    const double hs = H[0] + rotor_6.about, ks = K[0] + rotor_8.about, g = h[1] + rotor_11.about;
    const double e4 = hs + ks + F[0] - F[2] - H[2] - K[2];
    const double e9 = g + f[1] - f[0] - h[0];
    const double a4 = q[0], b5 = q[1], b7 = q[2], a9 = q[3], b10 = q[4];
    const double w1 = W[0], w2 = W[1], w3 = W[2];
    Angles r;
    r[0] = (dW[0] + w2 * w3) * ((hs - H[1]) * b5 - (ks - K[1]) * b7) +
           w1 * (hs - H[1] - H[2]) * dq[1] - w1 * (ks - K[1] - K[2]) * dq[2] +
           (w1 * w1 - w3 * w3) * e4 * a4 + w1 * w3 * e4;
    r[1] = -w1 * (hs - H[1] - H[2]) * dq[0] + (w2 * w3 * (hs - H[1]) + H[2] * dW[0]) * a4 +
           (w1 * w1 - w2 * w2) * (hs - H[1]) * b5 - w1 * w2 * (hs - H[1]);
    r[2] = w1 * (ks - K[1] - K[2]) * dq[0] - (w2 * w3 * (ks - K[1]) + K[2] * dW[0]) * a4 +
           (w1 * w1 - w2 * w2) * (ks - K[1]) * b7 + w1 * w2 * (ks - K[1]);
    r[3] = (dW[1] + w1 * w3) * (g - h[2]) * b10 + w2 * (g - h[0] - h[2]) * dq[4] +
           (w2 * w2 - w1 * w1) * e9 * a9 + w1 * w2 * e9;
    r[4] = -w2 * (g - h[0] - h[2]) * dq[3] + (w1 * w3 * (g - h[2]) + h[0] * dW[1]) * a9 +
           (w2 * w2 - w3 * w3) * (g - h[2]) * b10 - w2 * w3 * (g - h[2]);
    return r;
  }
};

}  // namespace kreisel
