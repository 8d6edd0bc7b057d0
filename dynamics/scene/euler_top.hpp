#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <complex>
#include <utility>
#include <vector>

#include <dynamics/inertia.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// What stays while a top moves. Kovalevskaya's invariant, for w = (p, q, r), is
///
///   |(p + iq)^2 - (k_x + i k_y)(gamma_x + i gamma_y) / C|^2
///
/// Units  : J, N m s, 1/s^4
template <class S = double>
struct TopInvariants {
  S energy;             ///< w.(Theta w)/2 + weight_moment.gamma
  S vertical_momentum;  ///< gamma.(Theta w + h)
  S axial_momentum;     ///< C w_z + h_z: stays if A = B and weight and h lie along z
  S kovalevskaya;       ///< hers, above: stays if A = B = 2C, k_z = 0 and h = 0
  Vector3<S> momentum;  ///< Theta w + h on inertial axes: stays without weight
};

/// A top held at a point of the inertial frame: Euler's free top, the heavy tops of Lagrange and of
/// Kovalevskaya, and the gyrostat, which carries a rotor driven at constant speed against it.
///
///   Theta w' + w x (Theta w + h) = -k x gamma,   gamma = the vertical on body axes
///
/// HeldBody has the same and more, on a guide that moves; this one knows that nothing does, and
/// takes principal axes.
///
/// Source : L. Euler; Lagrange; S. Kovalevskaya, Acta Math. 12 (1889) 177, whose invariant is named
///          after her; paper 002 section 4 (the case V' = V); gyrostat: paper 000
/// Frame  : body axes = principal axes through the held point; inertial z up
/// Units  : kg m^2, N m, N m s, rad/s
/// Throws : InvalidInput where no body has such moments of inertia, or one of them is 0
class EulerTop {
 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 7, 1>;

  struct State {
    Eigen::Quaternion<S> attitude =
        Eigen::Quaternion<S>::Identity();              ///< body to inertial, any norm
    Vector3<S> angular_velocity = Vector3<S>::Zero();  ///< w, on body axes
  };

  /// `weight_moment` is k = m g r_s, mass times gravity times centre of mass; `rotor_momentum` is
  /// h, the rotor's inertia times its relative speed (its inertia belongs to `moments` as well).
  explicit EulerTop(const Vector3<S>& moments, const Vector3<S>& weight_moment = Vector3<S>::Zero(),
                    const Vector3<S>& rotor_momentum = Vector3<S>::Zero())
      : moments_(moments),
        weight_moment_(weight_moment),
        rotor_momentum_(rotor_momentum),
        heavy_(!weight_moment.isZero(0)),
        has_rotor_(!rotor_momentum.isZero(0)),
        inverse_(moments.cwiseInverse()) {
    check(Inertia<S>{0, Vector3<S>::Zero(), {moments.x(), moments.y(), moments.z()}},
          Mass::zero_allowed, "Euler top");
    if (!(moments.minCoeff() > 0)) {
      throw InvalidInput(
          "Euler top: a moment of inertia about the held point is 0: the rotation about "
          "that axis is not determined");
    }
    if (!(weight_moment - weight_moment).isZero(0) ||
        !(rotor_momentum - rotor_momentum).isZero(0)) {
      throw InvalidInput("Euler top: weight moment or rotor momentum is not finite");
    }
    for (int i = 0; i < 3; ++i) {
      inverse_rest_[i] = -std::fma(moments[i], inverse_[i], S(-1)) * inverse_[i];
    }
  }

  [[nodiscard]] const Vector3<S>& moments() const { return moments_; }
  [[nodiscard]] const Vector3<S>& weight_moment() const { return weight_moment_; }
  [[nodiscard]] const Vector3<S>& rotor_momentum() const { return rotor_momentum_; }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; w).
  [[nodiscard]] Vector rates(const S& /*t*/, const Vector& y) const {
    const auto [q, w] = from_vector(y);
    // Differences of moments come first: exact where two of them agree, so that a symmetric top
    // keeps its spin to the last bit.
    const S A = moments_.x(), B = moments_.y(), C = moments_.z();
    Vector3<S> torque((B - C) * w.y() * w.z(), (C - A) * w.z() * w.x(), (A - B) * w.x() * w.y());
    if (heavy_) torque -= weight_moment_.cross(vertical(q));
    if (has_rotor_) torque += rotor_momentum_.cross(w);
    const Eigen::Vector4d dq = attitude_rate(q, w);
    const auto turn = [&](int i) { return torque[i] * inverse_[i] + torque[i] * inverse_rest_[i]; };
    return Vector(dq[0], dq[1], dq[2], dq[3], turn(0), turn(1), turn(2));
  }

  [[nodiscard]] TopInvariants<S> invariants(const State& state) const {
    const auto& [q, w] = state;
    const Vector3<S> gamma = vertical(q);
    const Vector3<S> L = moments_.cwiseProduct(w) + rotor_momentum_;
    using Complex = std::complex<S>;
    const Complex z(w.x(), w.y());
    const Complex k(weight_moment_.x(), weight_moment_.y());
    const S C = moments_.z();
    return {w.dot(moments_.cwiseProduct(w)) / 2 + weight_moment_.dot(gamma), gamma.dot(L), L.z(),
            std::norm(z * z - k / C * Complex(gamma.x(), gamma.y())),
            Pose<S>::from(q).rotation * L};
  }

  /// Those of the invariants that this top keeps, by name.
  [[nodiscard]] std::vector<std::pair<const char*, S>> conserved(const S& /*t*/,
                                                                 const State& state) const {
    const TopInvariants<S> all = invariants(state);
    std::vector<std::pair<const char*, S>> kept{{"energy", all.energy},
                                                {"vertical momentum", all.vertical_momentum}};
    const bool flat = weight_moment_.z() == 0;
    const bool axial = weight_moment_.x() == 0 && weight_moment_.y() == 0;
    const bool round = moments_.x() == moments_.y();
    const bool rotor_axial = rotor_momentum_.x() == 0 && rotor_momentum_.y() == 0;
    if (round && axial && rotor_axial) kept.emplace_back("axial momentum", all.axial_momentum);
    if (axial && flat) kept.emplace_back("momentum", all.momentum.norm());
    if (round && flat && moments_.x() == 2 * moments_.z() && rotor_momentum_.isZero(0)) {
      kept.emplace_back("kovalevskaya", all.kovalevskaya);
    }
    return kept;
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {4, 3};

  [[nodiscard]] static Vector to_vector(const State& state) {
    return (Vector() << state.attitude.coeffs(), state.angular_velocity).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(Eigen::Vector4d(y.head<4>())), y.tail<3>()};
  }

 private:
  /// Inertial z on body axes, the last row of the rotation.
  [[nodiscard]] static Vector3<S> vertical(const Eigen::Quaternion<S>& q) {
    const S x = q.x(), y = q.y(), z = q.z(), w = q.w();
    const S scale = 1 / (x * x + y * y + z * z + w * w);
    return {2 * scale * (x * z - w * y), 2 * scale * (y * z + w * x),
            scale * (w * w + z * z - x * x - y * y)};
  }

  Vector3<S> moments_;
  Vector3<S> weight_moment_;
  Vector3<S> rotor_momentum_;
  bool heavy_;
  bool has_rotor_;
  Vector3<S> inverse_;
  Vector3<S> inverse_rest_;  ///< what the rounded inverses lack: else a long run would show it
};

}  // namespace kreisel
