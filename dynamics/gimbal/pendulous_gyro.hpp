#pragma once

#include <Eigen/Core>

#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/gimbal/cardan_parts.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/inertia.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The three bodies of a Cardan gyro with centres of mass anywhere and full inertia tensors.
///
/// Each inertia is about the point where the axes meet. A ring's axes are the guide's at zero
/// angles. The rotor's axes are those of the inner ring at phi = 0.
///
/// Units : kg, kg m, kg m^2; metre
struct PendulousBodies {
  Inertia<> rotor;
  Inertia<> inner_ring;
  Inertia<> outer_ring;
  Vector3<double> point = Vector3<double>::Zero();  ///< where the axes meet, on guide axes
};

namespace detail {

/// The motion of a ring on its own axes: angular velocity, its rate without second derivatives of
/// the angles, apparent gravity.
template <class N>
struct RingMotion {
  Vector3<N> w, dw, g;

  /// The motion of a body that turns on this one about the axis k.
  [[nodiscard]] RingMotion turned(int k, const SinCos<N>& angle, const N& rate) const {
    const Vector3<N> along = rate * Vector3<N>::Unit(k);
    const Vector3<N> carried = back(k, angle, w);
    return {carried + along, back(k, angle, dw) + carried.cross(along), back(k, angle, g)};
  }

  /// A vector on the axes of the body that is turned about the axis k, and from there.
  [[nodiscard]] static Vector3<N> back(int k, const SinCos<N>& angle, const Vector3<N>& v) {
    return forth(k, {N(-angle.sin), angle.cos}, v);
  }
  [[nodiscard]] static Vector3<N> forth(int k, const SinCos<N>& angle, const Vector3<N>& v) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    Vector3<N> result = v;
    result[i] = angle.cos * v[i] - angle.sin * v[j];
    result[j] = angle.sin * v[i] + angle.cos * v[j];
    return result;
  }
};

/// The torque that a body's motion takes, without second derivatives:  T dw + w x T w - s x g.
template <class N>
[[nodiscard]] Vector3<N> torque_taken(const Inertia<>& body, const RingMotion<N>& motion) {
  const Inertia<N> T = lifted<N>(body);
  const Vector3<N> momentum = T.tensor * motion.w;
  return T.tensor * motion.dw + motion.w.cross(momentum) - T.first_moment.cross(motion.g);
}

}  // namespace detail

/// The gyro in Cardan's suspension with centres of mass off the axes, an unbalanced rotor and
/// products of inertia, on a guide in arbitrary motion. Exact, for all angles. A CardanGyro whose
/// centres lie where the axes meet costs less.
///
///   K_i = Theta_i dw_i + w_i x Theta_i w_i - s_i x g'     each body on its own axes
///   A.(K_3 + K_2 + K_1) = Q_alpha,   B.(K_2 + K_1) = Q_beta,   C.K_1 = Q_phi
///
/// A, B, C are the axes, s = m r_s, and g' = g - a the apparent gravity where the axes meet. Weight
/// is a torque of the pendulosity s; the acceleration a of a vehicle is one as well.
///
/// Source : paper 002 (35)-(40) corrected, with (42) and (48), to which [v (G + G_f)] is added:
///          with J_f = T F it gives -s x (g - a) (docs/errata.md)
/// Frame  : angles and axes as in CardanGyro; the state counts from the references of the bearings
/// Units  : rad/s, N m
/// Error  : of the accelerations <= 1e-12 of the greatest, against BodySystem
///          (tests/dynamics/gimbal/pendulous_gyro.cpp)
/// Throws : InvalidInput for an inertia that no body has, and for stiffness, damping or friction
///          below 0; ComputationFailed from rates() where the mass matrix is singular
///
/// Loads : none, UniformGravity<Guide> or UniformGravity<Inertial>
template <class M, class Rotor = FreeRotor, class... Loads>
class PendulousGyro : public detail::CardanStates {
  static_assert((detail::is_field<Loads> && ...), "the loads are fields of uniform gravity");

 public:
  PendulousGyro(const PendulousBodies& bodies, const CardanBearings& bearings, M guide,
                Rotor rotor = {}, const Loads&... gravity)
      : bodies_(bodies),
        bearings_(bearings),
        guide_(std::move(guide)),
        rotor_(std::move(rotor)),
        gravity_(gravity...),
        apparent_(detail::components(bodies_.point), guide_, "pendulous gyro", gravity...) {
    check(bodies.rotor, Mass::zero_allowed, "pendulous gyro, rotor");
    check(bodies.inner_ring, Mass::zero_allowed, "pendulous gyro, inner ring");
    check(bodies.outer_ring, Mass::zero_allowed, "pendulous gyro, outer ring");
    if (!(bodies.rotor.tensor.zz > 0)) {
      throw InvalidInput("pendulous gyro: the rotor has no moment of inertia about its axis");
    }
    for (const double number :
         {bearings.outer.stiffness, bearings.outer.damping, bearings.inner.stiffness,
          bearings.inner.damping, double(rotor_.friction)}) {
      if (number >= 0) continue;
      throw InvalidInput(
          "pendulous gyro: stiffness, damping and friction must be 0 or above; weight is gravity "
          "on "
          "centres of mass");
    }
  }

  [[nodiscard]] const PendulousBodies& bodies() const { return bodies_; }
  [[nodiscard]] const CardanBearings& bearings() const { return bearings_; }

  /// The guide's u and ou, and g', on guide axes.
  template <class N>
  [[nodiscard]] auto apparent(const N& t) const {
    return std::apply([&](const Loads&... all) { return apparent_.at(guide_, t, all...); },
                      gravity_);
  }

  /// The vector field  y' = rates(t, y)  on  y = (alpha, beta, phi; their rates), for double and
  /// dual numbers.
  template <class N>
  [[nodiscard]] Eigen::Matrix<N, 6, 1> rates(const std::type_identity_t<N>& t,
                                             const Eigen::Matrix<N, 6, 1>& y) const {
    using Ring = detail::RingMotion<N>;
    const auto alpha = detail::sin_cos(bearings_.outer.reference, y[0]);
    const auto beta = detail::sin_cos(bearings_.inner.reference, y[1]);
    const auto phi = detail::sin_cos(detail::StaticZero{}, y[2]);
    const auto now = apparent(N(t));
    const Ring guide{detail::vector<N>(now.u), detail::vector<N>(now.du), detail::vector<N>(now.g)};
    const Ring outer = guide.turned(0, alpha, y[3]);
    const Ring inner = outer.turned(1, beta, y[4]);
    const Ring rotor = inner.turned(2, phi, y[5]);
    const Vector3<N> K_1 = detail::torque_taken(bodies_.rotor, rotor);
    const Vector3<N> K_2 =
        detail::torque_taken(bodies_.inner_ring, inner) + Ring::forth(2, phi, K_1);
    const Vector3<N> K_3 =
        detail::torque_taken(bodies_.outer_ring, outer) + Ring::forth(1, beta, K_2);
    const Vector3<N> force(spin_torque(N(t), y[5]) - K_1.z(),
                           resistance(bearings_.inner, y[1], y[4]) - K_2.y(),
                           resistance(bearings_.outer, y[0], y[3]) - K_3.x());
    const Vector3<N> dd = solved(mass_matrix(beta, phi), force);
    return detail::gathered<N>(y[3], y[4], y[5], dd[2], dd[1], dd[0]);
  }
  [[nodiscard]] Vector rates(double t, const Vector& y) const { return rates<double>(t, y); }

  /// True if friction or damping can make the equations stiff.
  [[nodiscard]] bool may_be_stiff() const {
    return bearings_.outer.damping != 0 || bearings_.inner.damping != 0 || rotor_.friction != 0;
  }

  /// The terms of rates(): see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    using Now = decltype(apparent(0.0));
    constexpr bool turns = !decltype(Now::u)::static_zero;
    constexpr bool pulled = !decltype(Now::g)::static_zero;
    const std::string rests = turns ? "" : "the guide does not turn";
    Terms list;
    list.add("relative", "w x Theta w of three bodies, with products of inertia");
    list.add("guide", "u x Theta u, Theta ou, and u in w", turns, rests);
    list.add("guide", "s x g' of three bodies", pulled,
             pulled ? "" : "neither gravity nor acceleration");
    list.add("load", "springs and friction of the rings' bearings");
    list.add("load", "drive and friction of the rotor", !regulated,
             regulated ? "the motor keeps phi'" : "");
    return list;
  }

 private:
  static constexpr bool regulated = std::is_same_v<Rotor, RegulatedRotor>;

  template <class N>
  [[nodiscard]] static N resistance(const CardanBearing& bearing, const N& q, const N& dq) {
    return -(bearing.stiffness * q + bearing.damping * dq);
  }

  template <class N>
  [[nodiscard]] N spin_torque([[maybe_unused]] const N& t, const N& rate) const {
    const N friction = -rotor_.friction * rate;
    if constexpr (requires { N(rotor_.torque(t, rate)); }) {
      return rotor_.torque(t, rate) + friction;
    } else if constexpr (requires { N(rotor_.torque); }) {
      return rotor_.torque + friction;
    } else {
      return friction;
    }
  }

  /// The mass matrix of phi'', beta'', alpha''. In this order gimbal lock makes the last pivot 0.
  template <class N>
  [[nodiscard]] Symmetric3<N> mass_matrix(const detail::SinCos<N>& beta,
                                          const detail::SinCos<N>& phi) const {
    using Ring = detail::RingMotion<N>;
    // The columns of w: the axes C, B, A on those of the rotor and of the inner ring.
    const Vector3<N> x = Ring::back(1, beta, Vector3<N>::UnitX());
    const auto parts = [&](const Inertia<>& body, const Vector3<N>& b, const Vector3<N>& a) {
      const Symmetric3<N> T = detail::lifted<N>(body).tensor;
      const Vector3<N> of_b = T * b;
      const Vector3<N> of_a = T * a;
      return Symmetric3<N>{T.zz, b.dot(of_b), a.dot(of_a), of_b.z(), of_a.z(), a.dot(of_b)};
    };
    const Symmetric3<N> rotor =
        parts(bodies_.rotor, Ring::back(2, phi, Vector3<N>::UnitY()), Ring::back(2, phi, x));
    const Symmetric3<N> ring = parts(bodies_.inner_ring, Vector3<N>::UnitY(), x);
    return {rotor.xx, rotor.yy + ring.yy, rotor.zz + ring.zz + bodies_.outer_ring.tensor.xx,
            rotor.xy, rotor.xz,           rotor.yz + ring.yz};
  }

  template <class N>
  [[nodiscard]] static Vector3<N> solved(Symmetric3<N> mass, Vector3<N> force) {
    if constexpr (regulated) {  // phi'' = 0
      mass.xy = mass.xz = N(0);
      force[0] = N(0);
    }
    const detail::FactoredSymmetric3<N> factored(mass);
    for (int k = 0; k < 3; ++k) {
      constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
      const auto size = detail::number_in(k == 0 ? mass.xx : k == 1 ? mass.yy : mass.zz);
      if (detail::number_in(factored.pivots()[k]) > rounding * size) continue;
      throw ComputationFailed(
          "pendulous gyro: the mass matrix is singular: a ring without mass, or gimbal lock");
    }
    return factored.solve(force);
  }

  using Apparent = detail::ApparentField<true, detail::Components<double>, M, Loads...>;

  PendulousBodies bodies_;
  CardanBearings bearings_;
  M guide_;
  [[no_unique_address]] Rotor rotor_;
  std::tuple<Loads...> gravity_;
  Apparent apparent_;
};

static_assert(Scene<PendulousGyro<RestingFrame<>, FreeRotor, UniformGravity<Guide>>>);

}  // namespace kreisel
