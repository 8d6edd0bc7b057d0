#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <dynamics/rigid/free_body.hpp>

namespace kreisel {

/// The inertia tensor of a body rotated by small angles (alpha, beta, gamma), on the original axes,
/// to first order:  T + skew(angles) T + (skew(angles) T)^t.
///
/// Source : paper 002 (41)-(43), the general matrix after (43); Phi = the negative off-diagonals
/// Error  : |angles|^2 (greatest - least moment of inertia), to leading order
template <class S>
[[nodiscard]] Symmetric3<S> first_order_tensor(const Symmetric3<S>& T, const Vector3<S>& angles) {
  const Matrix3<S> turning = skew(angles) * T.matrix();
  return T + Symmetric3<S>::from(turning + turning.transpose());
}

/// The tensor of a rotated body for principal axes, moments (Theta_A, Theta_B, Theta_C): only
/// products of inertia appear.
///
/// Source : paper 002, the last matrix before section 8b
template <class S>
[[nodiscard]] Symmetric3<S> first_order_tensor(const Vector3<S>& moments,
                                               const Vector3<S>& angles) {
  const S A = moments.x(), B = moments.y(), C = moments.z();
  return {A, B, C, (A - B) * angles.z(), (C - A) * angles.y(), (B - C) * angles.x()};
}

/// A body on elastic mounts in a moving guide: the engine block on an aircraft. It has small
/// oscillations about the pose in which its frame and the guide coincide:
///
///   M q'' + C q' + K q = f,   q = (displacement r; angles alpha, beta, gamma), on guide axes
///
/// With u, ou the guide's angular velocity and acceleration, W = skew(ou) + skew(u)^2, a the
/// acceleration of its origin less gravity, s = m r_s, J = sum of m p p^t:
///
///          r                    angles                                     f
///   M :    m                    -skew(s)                                   -(m a + W s)
///          skew(s)              Theta                                      -(s x a + ax(W J))
///   C :    2 m skew(u)          -2 skew(u) skew(s)
///          2 skew(s) skew(u)    2 skew(J u)
///   K :    m W                  -W skew(s)
///          skew(s) W            skew(a) skew(s) + [ax(W E_i J - W J E_i)]
///
/// The mounts add to C, K and f. [..] has the columns i = 1, 2, 3, E_i = skew(e_i) and ax(B) =
/// (B_32 - B_23, B_13 - B_31, B_21 - B_12).
///
/// Exact to first order in q, also where the guide turns fast. The static moments m r_s, which are
/// of first order too, are included; paper 002 omits them, and the tensor's first-order part.
///
/// Source : paper 002 section 8a, (19) with the tensor of (41)-(43)
/// Units  : metre, radian
/// Error  : of second order in q; linear_error() measures it against the exact equations
/// Cost   : constant coefficients, on a guide at rest or in steady motion without gravity, are
///          computed once
template <class M>
class SmallOscillations {
  static_assert(detail::is_guide<M>,
                "the guide of a body must return a FrameMotion<Guide, Inertial>");

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 12, 1>;
  using Vector6 = Eigen::Matrix<S, 6, 1>;
  using Matrix6 = Eigen::Matrix<S, 6, 6>;

  struct State {
    Vector3<S> displacement = Vector3<S>::Zero();
    Vector3<S> angles = Vector3<S>::Zero();
    Vector3<S> velocity = Vector3<S>::Zero();
    Vector3<S> angular_velocity = Vector3<S>::Zero();
  };

  /// The coefficients of the equations at one time.
  struct Coefficients {
    Matrix6 mass, damping, stiffness;
    Vector6 force;
  };

  /// `gravity` is uniform on inertial axes.
  SmallOscillations(const InertiaTensor<Body, S>& inertia, M guide,
                    std::vector<ElasticMount<S>> mounts,
                    const Vector3<S>& gravity = Vector3<S>::Zero())
      : inertia_(inertia), guide_(std::move(guide)), mounts_(std::move(mounts)), gravity_(gravity) {
    check(inertia.value, Mass::positive, "small oscillations");
    const Matrix3<S> s = skew(inertia.value.first_moment);
    mass_ << inertia.value.mass * Matrix3<S>::Identity(), -s, s, inertia.value.tensor.matrix();
    factor_.compute(mass_);
    if (!(factor_.vectorD().minCoeff() > 0)) {
      throw InvalidInput(
          "small oscillations: the body's inertia is singular (a point or a needle)");
    }
    if constexpr (SteadyGuide<M>) {
      if (detail::is_resting<M> || gravity.isZero(0)) steady_ = coefficients_at(0);
    }
  }

  [[nodiscard]] Coefficients coefficients(const S& t) const {
    return steady_ ? *steady_ : coefficients_at(t);
  }

  /// The vector field  y' = rates(t, y)  on  y = (r; angles; their rates).
  [[nodiscard]] Vector rates(const S& t, const Vector& y) const {
    return steady_ ? rates_by(*steady_, y) : rates_by(coefficients_at(t), y);
  }

  /// The terms of the coefficients: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    const std::string of_turning = turns ? "" : "the guide does not turn";
    const bool unsteadily = turns && !SteadyGuide<M>;
    const bool falls = !gravity_.isZero(0);
    Terms list;
    list.add("relative", "M q''");
    list.add("guide", "(m W, -W skew(s); skew(s) W, [ax(W E_i J - W J E_i)]) q, W s, ax(W J)",
             turns, of_turning);
    list.add("guide", "skew(ou) in W", unsteadily,
             turns && !unsteadily ? "the guide moves steadily" : of_turning);
    list.add("guide", "m a, s x a, skew(a) skew(s) q", !detail::is_resting<M>,
             detail::is_resting<M> ? "the guide rests" : "");
    list.add("Coriolis", "(2 m skew(u), -2 skew(u) skew(s); 2 skew(s) skew(u), 2 skew(J u)) q'",
             turns, of_turning);
    list.add("load", "gravity in a", falls, falls ? "" : "none is given");
    list.add("load", "mounts", !mounts_.empty(), mounts_.empty() ? "none is given" : "");
    return list;
  }

  /// The same body with the exact equations.
  [[nodiscard]] auto exact() const {
    const auto mounts = [all = mounts_](const LoadContext<S>& s) {
      Force<Body, S> sum;
      for (const ElasticMount<S>& mount : all) sum = sum + mount(s);
      return sum;
    };
    return FreeBody(inertia_, guide_, mounts, UniformGravity<Inertial, S>{gravity_});
  }

  /// The state of the exact body that this one approximates.
  [[nodiscard]] static auto exact_state(const State& state) {
    const Matrix3<S> R = exp(Motor<S>{state.angles, Vector3<S>::Zero()}).rotation;
    typename decltype(std::declval<SmallOscillations>().exact())::State result;
    result.attitude = Eigen::Quaternion<S>(R);
    result.position = state.displacement;
    result.velocity.value = {R.transpose() * state.angular_velocity,
                             R.transpose() * state.velocity};
    return result;
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 4> blocks = {3, 3, 3, 3};

  [[nodiscard]] static Vector to_vector(const State& state) {
    return (Vector() << state.displacement, state.angles, state.velocity, state.angular_velocity)
        .finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {y.segment<3>(0), y.segment<3>(3), y.segment<3>(6), y.segment<3>(9)};
  }

 private:
  static constexpr bool turns = detail::turns<M>();

  [[nodiscard]] Coefficients coefficients_at(const S& t) const {
    const FrameMotion<Guide, Inertial, S> motion = guide_(t);
    const Vector3<S> a =
        motion.origin_acceleration() - motion.X.value.rotation.transpose() * gravity_;
    const auto& [m, s, tensor] = inertia_.value;
    const Matrix3<S> s_cross = skew(s);

    Coefficients c;
    c.mass = mass_;
    c.damping.setZero();
    c.stiffness.setZero();
    c.stiffness.template bottomRightCorner<3, 3>() = skew(a) * s_cross;
    c.force << -(m * a), -s.cross(a);
    if constexpr (turns) {
      const Vector3<S>& u = motion.V.value.resultant;
      const Matrix3<S> U = skew(u);
      const Matrix3<S> W = skew(Vector3<S>(motion.dV.value.resultant)) + U * U;
      const Matrix3<S> theta = tensor.matrix();
      const Matrix3<S> J = theta.trace() / 2 * Matrix3<S>::Identity() - theta;
      c.damping << 2 * m * U, -2 * U * s_cross, 2 * s_cross * U, 2 * skew(Vector3<S>(J * u));
      Matrix3<S> turning;
      for (int i = 0; i < 3; ++i) {
        const Matrix3<S> E = skew(Vector3<S>(Vector3<S>::Unit(i)));
        turning.col(i) = axial(W * E * J - W * J * E);
      }
      c.stiffness += (Matrix6() << m * W, -W * s_cross, s_cross * W, turning).finished();
      c.force -= (Vector6() << W * s, axial(W * J)).finished();
    }
    for (const ElasticMount<S>& mount : mounts_) add(mount, c);
    return c;
  }

  [[nodiscard]] Vector rates_by(const Coefficients& c, const Vector& y) const {
    const Vector6 force = c.force - c.damping * y.tail<6>() - c.stiffness * y.head<6>();
    return (Vector() << y.tail<6>(), factor_.solve(force)).finished();
  }

  /// sum of p x (B p) over masses is ax(B J).
  [[nodiscard]] static Vector3<S> axial(const Matrix3<S>& b) {
    return {b(2, 1) - b(1, 2), b(0, 2) - b(2, 0), b(1, 0) - b(0, 1)};
  }

  /// Adds a mount's force F - k d - c d', d = r + angles x b, and its torque about the body's
  /// origin. F turns the body further as the end b moves: a geometric stiffness.
  static void add(const ElasticMount<S>& mount, Coefficients& c) {
    const Vector3<S>& b = mount.body_end;
    const Matrix3<S> b_cross = skew(b);
    const Vector3<S> F = mount.preload - mount.stiffness * (b - mount.guide_end);
    Eigen::Matrix<S, 3, 6> deflection;
    deflection << Matrix3<S>::Identity(), -b_cross;
    c.stiffness += deflection.transpose() * mount.stiffness * deflection;
    c.damping += deflection.transpose() * mount.damping * deflection;
    c.stiffness.template bottomRightCorner<3, 3>() -= skew(F) * b_cross;
    c.force += (Vector6() << F, b.cross(F)).finished();
  }

  InertiaTensor<Body, S> inertia_;
  M guide_;
  std::vector<ElasticMount<S>> mounts_;
  Vector3<S> gravity_;
  Matrix6 mass_;
  Eigen::LDLT<Matrix6> factor_;
  std::optional<Coefficients> steady_;  ///< constant coefficients
};

static_assert(Scene<SmallOscillations<RestingFrame<>>>);

}  // namespace kreisel
