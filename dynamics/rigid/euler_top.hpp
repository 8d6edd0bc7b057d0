#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/inertia.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/attitude_series.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

/// The invariants of a top. Kovalevskaya's invariant, for w = (p, q, r), is
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

/// The state of an Euler top.
struct EulerTopState {
  Eigen::Quaternion<double> attitude =
      Eigen::Quaternion<double>::Identity();                   ///< body to inertial, any norm
  Vector3<double> angular_velocity = Vector3<double>::Zero();  ///< w, on body axes
};

/// A top with a fixed point in the inertial frame. It is Euler's free top, the heavy top of
/// Lagrange or of Kovalevskaya, or the gyrostat, whose rotor is driven at constant relative speed.
///
///   Theta w' + w x (Theta w + h) = -k x gamma,   gamma = the vertical on body axes
///
/// FixedPointBody covers the same motions and more, on a moving guide. This class is for a guide at
/// rest and principal axes.
///
/// Source : L. Euler; Lagrange; S. Kovalevskaya, Acta Math. 12 (1889) 177, whose invariant is named
///          after her; paper 002 section 4 (the case V' = V); gyrostat: paper 000
/// Frame  : body axes = principal axes through the fixed point; inertial z up
/// Units  : kg m^2, N m, N m s, rad/s
/// Throws : InvalidInput if no body has such moments of inertia, or one of them is 0
///
/// P      : number type of moments and momenta: double, or a pack for several tops side by side
template <class P>
class BasicEulerTop {
 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 7, 1>;

  using State = EulerTopState;

  /// `weight_moment` is k = m g r_s, mass times gravity times centre of mass. `rotor_momentum` is
  /// h, the rotor's moment of inertia times its relative speed; `moments` contain the rotor's
  /// inertia as well.
  explicit BasicEulerTop(const Vector3<S>& moments,
                         const Vector3<S>& weight_moment = Vector3<S>::Zero(),
                         const Vector3<S>& rotor_momentum = Vector3<S>::Zero())
      : moments_(moments),
        weight_moment_(weight_moment),
        rotor_momentum_(rotor_momentum),
        load_(load(!weight_moment.isZero(0), !rotor_momentum.isZero(0))),
        tensor_({moments.x(), moments.y(), moments.z()}) {
    check(Inertia<S>{0, Vector3<S>::Zero(), {moments.x(), moments.y(), moments.z()}},
          Mass::zero_allowed, "Euler top");
    if (!(moments.minCoeff() > 0)) {
      throw InvalidInput(
          "Euler top: a moment of inertia about the fixed point is 0: the rotation about "
          "that axis is not determined");
    }
    if (!(weight_moment - weight_moment).isZero(0) ||
        !(rotor_momentum - rotor_momentum).isZero(0)) {
      throw InvalidInput("Euler top: weight moment or rotor momentum is not finite");
    }
  }

  /// Several tops, each in one lane of N.
  template <class N>
  [[nodiscard]] static std::optional<BasicEulerTop<N>> side_by_side(
      const std::array<const BasicEulerTop*, std::size_t(N::lanes)>& tops) {
    return BasicEulerTop<N>(tops);
  }

  [[nodiscard]] const Vector3<P>& moments() const { return moments_; }
  [[nodiscard]] const Vector3<P>& weight_moment() const { return weight_moment_; }
  [[nodiscard]] const Vector3<P>& rotor_momentum() const { return rotor_momentum_; }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; w), for double and dual
  /// numbers.
  template <class N>
  [[nodiscard]] Eigen::Matrix<N, 7, 1> rates(const std::type_identity_t<N>& /*t*/,
                                             const Eigen::Matrix<N, 7, 1>& y) const {
    const Eigen::Quaternion<N> q(y[3], y[0], y[1], y[2]);
    const Vector3<N> w(y[4], y[5], y[6]);
    detail::Components<N> torque = tensor_.gyroscopic_torque(detail::components(w));
    if (load_ != Load::none) {
      if (load_ != Load::weight) {
        torque = torque + cross(detail::components(rotor_momentum_), detail::components(w));
      }
      if (load_ != Load::rotor) torque = torque + torque_of_weight(q);
    }
    const detail::Components<N> dw = tensor_.solve(torque);
    const Eigen::Matrix<N, 4, 1> dq = attitude_rate(q, w);
    return detail::gathered<N>(dq[0], dq[1], dq[2], dq[3], dw.x, dw.y, dw.z);
  }
  [[nodiscard]] Vector rates(S t, const Vector& y) const { return rates<S>(t, y); }

  /// The Taylor series of the motion, for TaylorSteps. Formulas: rigid/attitude_series.hpp.
  [[nodiscard]] auto series() const requires std::is_same_v<P, double> {
    const detail::Components<S> k = detail::components(weight_moment_);
    const detail::Components<S> h = detail::components(rotor_momentum_);
    return detail::AttitudeSeries<detail::PrincipalTensor<>, detail::Components<S>, Downwards,
                                  detail::RateAxes::body, detail::Components<S>>(tensor_, k, {}, h);
  }

  /// -k x gamma, the moment of the weight about the fixed point, on body axes.
  ///
  /// Units  : N m
  template <class N>
  [[nodiscard]] Vector3<N> weight_torque(const Eigen::Quaternion<N>& q) const {
    return detail::vector<N>(torque_of_weight(q));
  }

  [[nodiscard]] TopInvariants<S> invariants(const State& state) const {
    const auto& [q, w] = state;
    const detail::Components<S> gamma = vertical(q);
    const Vector3<S>& k = weight_moment_;
    const detail::Components<S> L{moments_.x() * w.x() + rotor_momentum_.x(),
                                  moments_.y() * w.y() + rotor_momentum_.y(),
                                  moments_.z() * w.z() + rotor_momentum_.z()};
    const S twice_kinetic =
        moments_.x() * w.x() * w.x() + moments_.y() * w.y() * w.y() + moments_.z() * w.z() * w.z();
    const S potential = k.x() * gamma.x + k.y() * gamma.y + k.z() * gamma.z;
    // (w_x + i w_y)^2 - (k_x + i k_y)(gamma_x + i gamma_y)/C
    const S C = moments_.z();
    const S real = w.x() * w.x() - w.y() * w.y() - (k.x() * gamma.x - k.y() * gamma.y) / C;
    const S imaginary = 2 * w.x() * w.y() - (k.x() * gamma.y + k.y() * gamma.x) / C;
    return {twice_kinetic / 2 + potential, gamma.x * L.x + gamma.y * L.y + gamma.z * L.z, L.z,
            real * real + imaginary * imaginary,
            detail::vector<S>(rotated(detail::Rotation<S>::from(q), L))};
  }

  /// The invariants that this top keeps, by name.
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

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    const bool rotor = load_ == Load::rotor || load_ == Load::both;
    const bool weight = load_ == Load::weight || load_ == Load::both;
    Terms list;
    list.add("relative", "w x (Theta w)");
    list.add("relative", "products of inertia in Theta", false, "body axes are principal axes");
    list.add("relative", "w x h", rotor, rotor ? "" : "no rotor");
    list.add("guide", "all", false, "the top is held in the inertial frame");
    list.add("Coriolis", "all", false, "the top is held in the inertial frame");
    list.add("load", "k x gamma", weight, weight ? "" : "no weight, or held at its centre of mass");
    return list;
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {4, 3};

  /// For linear equations: the first component of each quaternion, and the kinds of components.
  [[nodiscard]] static constexpr std::array<int, 1> quaternions() { return {0}; }
  static constexpr std::array names = {"q_x", "q_y", "q_z", "q_w", "w_x", "w_y", "w_z"};

  [[nodiscard]] static Vector to_vector(const State& state) {
    return (Vector() << state.attitude.coeffs(), state.angular_velocity).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(Eigen::Vector4d(y.head<4>())), y.tail<3>()};
  }

 private:
  /// A guide at rest with gravity of size 1 downwards.
  struct Downwards {
    detail::ZeroVector u = {};
    detail::Components<S> g = {0, 0, -1};
    struct {
    } field = {};
  };

  enum class Load : char { none, weight, rotor, both };

  [[nodiscard]] static constexpr Load load(bool heavy, bool has_rotor) {
    if (heavy) return has_rotor ? Load::both : Load::weight;
    return has_rotor ? Load::rotor : Load::none;
  }

  template <class>
  friend class BasicEulerTop;

  using One = BasicEulerTop<S>;

  explicit BasicEulerTop(const std::array<const One*, std::size_t(detail::lanes_of<P>)>& tops)
      : moments_(gathered(tops, &One::moments_)),
        weight_moment_(gathered(tops, &One::weight_moment_)),
        rotor_momentum_(gathered(tops, &One::rotor_momentum_)),
        load_(load(any_bears(tops, &One::weight_moment_), any_bears(tops, &One::rotor_momentum_))),
        tensor_({moments_.x(), moments_.y(), moments_.z()}) {}

  template <class Tops>
  [[nodiscard]] static Vector3<P> gathered(const Tops& tops, Vector3<S> One::*member) {
    return detail::gathered<P>(tops,
                               [&](const auto& top) -> const Vector3<S>& { return top.*member; });
  }

  template <class Tops>
  [[nodiscard]] static bool any_bears(const Tops& tops, Vector3<S> One::*member) {
    return std::any_of(tops.begin(), tops.end(),
                       [&](const One* top) { return !(top->*member).isZero(0); });
  }

  /// Inertial z on body axes, the last row of the rotation.
  template <class N>
  [[nodiscard]] static detail::Components<N> vertical(const Eigen::Quaternion<N>& q) {
    const detail::Rotation<N> R = detail::Rotation<N>::from(q);
    return {R.zx, R.zy, R.zz};
  }

  template <class N>
  [[nodiscard]] detail::Components<N> torque_of_weight(const Eigen::Quaternion<N>& q) const {
    return cross(vertical(q), detail::components(weight_moment_));
  }

  Vector3<P> moments_;
  Vector3<P> weight_moment_;
  Vector3<P> rotor_momentum_;
  Load load_;
  detail::PrincipalTensor<P> tensor_;
};

using EulerTop = BasicEulerTop<double>;

static_assert(Scene<EulerTop> && HasSeries<EulerTop> && HasConserved<EulerTop>);

}  // namespace kreisel
