#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/inertia.hpp>
#include <dynamics/load/analytic_load.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/signal/signal.hpp>
#include <dynamics/tree/joint/joint.hpp>
#include <dynamics/tree/time_function.hpp>

namespace kreisel {

/// A joint force along one rate, from its coordinate q:  constant + in_time(t) - stiffness (q -
/// rest) - damping q'.  A spherical or free joint has no springs, because no single coordinate
/// measures its displacement.
///
/// Units  : N m/rad and N m s/rad, or N/m and N s/m; rad or m; N m or N
struct JointForce {
  double stiffness = 0;
  double rest = 0;
  double damping = 0;
  double constant = 0;
  std::optional<Signal<double>> in_time = std::nullopt;
};

/// The rule for the motion in a joint.
enum class JointRule {
  forces,  ///< the forces on the bodies
  held,    ///< locked in its position; its rates count as 0
  driven   ///< single coordinates only: a motor prescribes the motion, with any force
};

/// The rule for the spin of a rotor.
enum class RotorMode {
  free,       ///< no torque about its axis: its cyclic momentum p = C (spin) is constant
  regulated,  ///< a motor on the carrier keeps the relative rate phi' as prescribed
  torque      ///< a motor exerts a torque, with its reaction on the carrier; dampers may brake it
};

/// A rotor: a body in a revolute joint that is balanced, symmetric about the joint's axis e and
/// carries no other body. The equations of motion do not depend on its angle.
///
/// For the motion of the other bodies it is welded to its carrier and adds the gyroscopic torque
/// -w x l e.  Cost and steps do not depend on its speed. Coordinate (all revolutions counted) and
/// rate, relative to the carrier, remain those of the joint.
///
/// Tensor about the origin: C e e^t + A (1 - e e^t), up to 64u of its trace; centre of mass on the
/// axis, up to 64u of a radius of gyration. A damper is allowed in the modes regulated, where the
/// motor overcomes it, and torque.
///
/// Source : paper 000 (2), (4), (8): l = C phi' if regulated, p = C (phi' + e.w) else
/// Units  : N m; rad/s^2
struct Rotor {
  RotorMode mode = RotorMode::free;

  /// Mode torque: motor torque on the rotor about the axis, added to the joint force. The joint
  /// force must have no spring.
  double torque = 0;

  /// Mode regulated: the prescribed phi''. The rate begins at the state's; null: 0.
  TimeFunction acceleration = {};
};

namespace detail {

/// A number and its derivative along one direction.
using AlongOne = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;

[[nodiscard]] inline AlongOne with_rate(double value, double rate) {
  return {value, AlongOne::DerType::Constant(rate)};
}

/// A situation in dual numbers, reduced to the k-th derivative.
///
/// One : AlongOne; a template parameter, so it is compiled only if called
template <class One, class Dual>
[[nodiscard]] LoadContext<One> along_one(const LoadContext<Dual>& s, Eigen::Index k) {
  const auto number = [k](const Dual& x) {
    One one(x.value());
    one.derivatives()[0] = x.derivatives()[k];
    return one;
  };
  const auto all = [&number](const auto& v) { return v.unaryExpr(number).eval(); };
  const auto motor = [&all](const Motor<Dual>& m) -> Motor<One> {
    return {all(m.resultant), all(m.moment)};
  };
  const auto pose = [&all](const Pose<Dual>& X) -> Pose<One> {
    return {all(X.rotation), all(X.translation)};
  };
  const Inertia<Dual>& T = s.inertia.value;
  const Symmetric3<Dual>& t = T.tensor;
  return {number(s.t),
          {pose(s.X.value)},
          {motor(s.V_rel.value)},
          {{pose(s.guide.X.value)}, {motor(s.guide.V.value)}, {motor(s.guide.dV.value)}},
          {{number(T.mass),
            all(T.first_moment),
            {number(t.xx), number(t.yy), number(t.zz), number(t.xy), number(t.xz), number(t.yz)}}}};
}

}  // namespace detail

/// Any Load, stored by value. Linear equations need loads in dual numbers: templates on the number
/// type of the situation. Other loads work in double alone.
///
/// A load may act on a rotor if it depends neither on a symmetric body's angle about its axis nor
/// on its spin, as gravitation. Such a load declares
///
///   static constexpr bool ignores_spin = true;
class BodyLoad {
 public:
  template <class L>
  requires(!std::same_as<L, BodyLoad> && Load<L>) BodyLoad(L load)
      : force_(load) {  // NOLINT: any load converts to a BodyLoad
    if constexpr (requires(const LoadContext<>& s) { load.potential(s); }) {
      potential_ = [load](const LoadContext<>& s) { return load.potential(s); };
    }
    if constexpr (requires { load.keeps_energy(); }) keeps_energy_ = load.keeps_energy();
    if constexpr (Load<L, detail::AlongOne>) along_ = load;
    if constexpr (requires { L::ignores_spin; }) ignores_spin_ = L::ignores_spin;
    if constexpr (requires { detail::analytic(load); }) {
      if (const auto analytic = detail::analytic(load)) {
        analytic_ = std::make_shared<const AnalyticLoad>(*analytic);
      }
    }
  }

  [[nodiscard]] Force<Body> operator()(const LoadContext<>& s) const { return force_(s); }

  /// The force in dual numbers, one derivative at a time. Needs takes_dual_numbers().
  template <class Dual>
  [[nodiscard]] Force<Body, Dual> operator()(const LoadContext<Dual>& s) const {
    Force<Body, Dual> result;
    for (Eigen::Index k = 0; k < s.t.derivatives().size(); ++k) {
      const auto P = along_(detail::along_one<detail::AlongOne>(s, k)).value;
      for (int i = 0; i < 3; ++i) {
        const auto set = [k](Dual& to, const auto& from) {
          to.value() = from.value();
          to.derivatives()[k] = from.derivatives()[0];
        };
        set(result.value.resultant[i], P.resultant[i]);
        set(result.value.moment[i], P.moment[i]);
      }
    }
    return result;
  }
  [[nodiscard]] bool takes_dual_numbers() const { return static_cast<bool>(along_); }

  /// True if its work on a guide at rest is that of its potential alone: see Load.
  [[nodiscard]] bool keeps_energy() const { return keeps_energy_; }
  [[nodiscard]] double potential(const LoadContext<>& s) const {
    return potential_ ? potential_(s) : 0;
  }
  [[nodiscard]] bool ignores_spin() const { return ignores_spin_; }

  /// The load in the form that has a Taylor series; null if it has none.
  [[nodiscard]] const AnalyticLoad* analytic() const { return analytic_.get(); }

 private:
  std::function<Force<Body>(const LoadContext<>&)> force_;
  std::function<double(const LoadContext<>&)> potential_;
  std::function<Force<Body, detail::AlongOne>(const LoadContext<detail::AlongOne>&)> along_;
  bool keeps_energy_ = false;
  bool ignores_spin_ = false;
  std::shared_ptr<const AnalyticLoad> analytic_ = nullptr;
};

/// One body of a system and the joint that holds it to its parent.
struct BodyDescription {
  std::string name;
  std::string parent = "guide";  ///< the guide frame, or the name of a body earlier in the list
  Joint joint = {};
  InertiaTensor<Body> inertia = {};     ///< about the body's origin, which lies in the joint
  std::vector<JointForce> forces = {};  ///< one for each rate of the joint, or none
  JointRule rule = JointRule::forces;
  /// Second derivative of the coordinate under JointRule::driven; empty: 0, a constant rate.
  TimeFunction acceleration = {};
  std::vector<BodyLoad> loads = {};
  std::optional<Rotor> rotor = std::nullopt;
};

/// The uniform gravity on all bodies of a system. Gravity that is not uniform is a load.
using Gravity = std::variant<std::monostate, UniformGravity<Guide>, UniformGravity<Inertial>>;

}  // namespace kreisel
