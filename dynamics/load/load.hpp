#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

#include <dynamics/guide/motion.hpp>
#include <dynamics/inertia.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// Pose and motion of a body at one time: the arguments that a load may depend on.
template <class S = double>
struct LoadContext {
  S t = S(0);
  Displacement<Guide, Body, S> X = {};         ///< the body in the guide
  Velocity<Body, Guide, Body, S> V_rel = {};   ///< V'
  FrameMotion<Guide, Inertial, S> guide = {};  ///< F and oF, at the guide's origin
  InertiaTensor<Body, S> inertia = {};

  /// A vector given on the axes of A, on the body's axes.
  template <class A>
  [[nodiscard]] Vector3<S> on_body_axes(const Vector3<S>& v) const {
    const auto guide_to_body = X.value.rotation.transpose();
    if constexpr (std::is_same_v<A, Body>) return v;
    if constexpr (std::is_same_v<A, Guide>) return guide_to_body * v;
    if constexpr (std::is_same_v<A, Inertial>) {
      return guide_to_body * (guide.X.value.rotation.transpose() * v);
    }
  }

  /// The position of a point of the body in the frame A.
  template <class A>
  [[nodiscard]] Vector3<S> position(const Vector3<S>& p_Body) const {
    if constexpr (std::is_same_v<A, Body>) return p_Body;
    if constexpr (std::is_same_v<A, Guide>) return X.point(p_Body);
    if constexpr (std::is_same_v<A, Inertial>) return guide.X.point(X.point(p_Body));
  }

  /// The velocity of a point of the body against the guide, on body axes.
  [[nodiscard]] Vector3<S> velocity(const Vector3<S>& p_Body) const {
    return V_rel.value.reduced_at(p_Body).moment;
  }

  [[nodiscard]] Vector3<S> centre() const {
    return inertia.value.first_moment / inertia.value.mass;
  }
};

/// A load: a callable that takes a LoadContext and returns force and torque about the body's
/// origin, on body axes. A user's lambda is a load. A load with a potential declares it by a member
/// potential(context), which the outputs add up. A load that does not read LoadContext::guide
/// declares a static member ignores_guide = true: scenes then do not compute the guide. A static
/// member kind is the load's name in terms(). A load that may have a Taylor series has a member
/// analytic(), which returns an AnalyticLoad, or nothing.
///
/// Energy is listed as an invariant only if each load has a member keeps_energy() that returns
/// true. On a guide at rest the work of such a load is that of its potential(), which does not
/// depend on time. A load without this member counts as one that changes the energy.
///
/// The loads of this header accept contexts in any number type. Dual numbers differentiate their
/// forces.
template <class L, class S = double>
concept Load = requires(const L& load, const LoadContext<S>& s) {
  { load(s) } -> std::same_as<Force<Body, S>>;
};

namespace detail {

// A named concept would make the compiler's message twenty lines long.
template <class M>
inline constexpr bool is_guide = GuideMotion<M>;
template <class... Loads>
inline constexpr bool are_loads = (Load<Loads> && ...);

}  // namespace detail

/// Weight in a gravity field that is uniform on the axes of A.
///
/// A = Guide: the field turns with the guide. An example is a laboratory on the earth, if g is the
/// EFFECTIVE gravity and the guide's own motion is left out. A = Inertial: gravitation.
///
/// Units  : m/s^2
template <class A, class S = double>
struct UniformGravity {
  static constexpr const char* kind =
      std::is_same_v<A, Inertial> ? "gravity at rest inertially" : "gravity on guide axes";
  static constexpr bool ignores_spin = !std::is_same_v<A, Body>;
  static constexpr bool on_guide_axes = std::is_same_v<A, Guide>;

  Vector3<S> g = Vector3<S>::Zero();

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> g_Body = s.template on_body_axes<A>(g.template cast<N>());
    const Inertia<N>& T = s.inertia.value;
    return {{T.mass * g_Body, T.first_moment.cross(g_Body)}};
  }

  /// A field that turns with the body has no potential.
  [[nodiscard]] bool keeps_energy() const { return !std::is_same_v<A, Body>; }

  /// Zero where the centre of mass is at the origin of A.
  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    return -s.inertia.value.mass * g.dot(s.template position<A>(s.centre()));
  }
};

/// A force at a point of the body, and a torque, both constant on the axes of A.
///
/// Units  : N, N m, metre (point: body axes)
template <class A, class S = double>
struct ConstantLoad {
  static constexpr const char* kind = "constant load";
  static constexpr bool ignores_guide = !std::is_same_v<A, Inertial>;

  Vector3<S> force = Vector3<S>::Zero();
  Vector3<S> torque = Vector3<S>::Zero();
  Vector3<S> point = Vector3<S>::Zero();

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> f = s.template on_body_axes<A>(force.template cast<N>());
    return {{f, s.template on_body_axes<A>(torque.template cast<N>()) +
                    point.template cast<N>().cross(f)}};
  }
};

/// Drag of a medium that moves with the guide: force -k v', torque -d u'.
///
/// Units  : N s/m, N m s
template <class S = double>
struct ViscousDrag {
  static constexpr const char* kind = "viscous drag";
  static constexpr bool ignores_guide = true;

  S torque_per_rate = S(0);     ///< d
  S force_per_velocity = S(0);  ///< k, at the body's origin

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    return {{N(-force_per_velocity) * s.V_rel.value.moment,
             N(-torque_per_rate) * s.V_rel.value.resultant}};
  }
};

/// A coil spring with a damper in line, between a point of the guide and a point of the body. Both
/// ends are hinged. Its length may become 0 only if its rest length is 0.
///
/// Units  : metre, N/m, N s/m
/// Throws : ComputationFailed where both ends meet and a rest length above 0 leaves no direction
template <class S = double>
struct Spring {
  static constexpr const char* kind = "spring";
  static constexpr bool ignores_guide = true;

  Vector3<S> guide_end = Vector3<S>::Zero();
  Vector3<S> body_end = Vector3<S>::Zero();
  S stiffness = S(0);
  S rest_length = S(0);
  S damping = S(0);

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> end = body_end.template cast<N>();
    const Vector3<N> reach = s.template on_body_axes<Guide>(s.template position<Guide>(end) -
                                                            guide_end.template cast<N>());
    const N length = reach.norm();
    if (length == N(0) && rest_length == S(0)) return {};
    if (length == N(0))
      throw ComputationFailed("Spring: both ends meet, its force has no direction");
    const Vector3<N> along = reach / length;
    const N pull = stiffness * (length - rest_length) + damping * along.dot(s.velocity(end));
    const Vector3<N> f = -pull * along;
    return {{f, end.cross(f)}};
  }

  [[nodiscard]] bool keeps_energy() const { return damping == S(0); }

  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    const S stretch = (s.template position<Guide>(body_end) - guide_end).norm() - rest_length;
    return stiffness * stretch * stretch / S(2);
  }
};

/// A rubber mount: a restoring force in all directions between a point of the body and a point of
/// the guide. The mount is unloaded if both points meet. Its matrices are on guide axes.
///
/// Units  : metre, N/m, N s/m, N
template <class S = double>
struct ElasticMount {
  static constexpr const char* kind = "elastic mount";
  static constexpr bool ignores_guide = true;

  Vector3<S> guide_end = Vector3<S>::Zero();
  Vector3<S> body_end = Vector3<S>::Zero();
  Matrix3<S> stiffness = Matrix3<S>::Zero();
  Matrix3<S> damping = Matrix3<S>::Zero();
  Vector3<S> preload = Vector3<S>::Zero();  ///< on the body, on guide axes, when both ends meet

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> end = body_end.template cast<N>();
    const Vector3<N> deflection = s.template position<Guide>(end) - guide_end.template cast<N>();
    const Vector3<N> rate = s.X.value.rotation * s.velocity(end);
    const Vector3<N> pull = stiffness.template cast<N>() * deflection +
                            damping.template cast<N>() * rate - preload.template cast<N>();
    const Vector3<N> f = s.template on_body_axes<Guide>(Vector3<N>(-pull));
    return {{f, end.cross(f)}};
  }

  /// A stiffness that is not symmetric has no potential. Rounding is tolerated: K = R D R^t in
  /// double is symmetric up to 12u of its norm. The norm is at most three times the greatest
  /// element.
  [[nodiscard]] bool keeps_energy() const {
    using std::abs;
    S greatest(0);
    S apart(0);
    bool is_damped = false;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        greatest = std::max(greatest, S(abs(stiffness(i, k))));
        apart = std::max(apart, S(abs(stiffness(i, k) - stiffness(k, i))));
        is_damped = is_damped || damping(i, k) != S(0);
      }
    }
    return !is_damped && apart <= S(18) * std::numeric_limits<S>::epsilon() * greatest;
  }

  [[nodiscard]] S potential(const LoadContext<S>& s) const {
    const Vector3<S> deflection = s.template position<Guide>(body_end) - guide_end;
    return deflection.dot(stiffness * deflection) / S(2) - preload.dot(deflection);
  }
};

}  // namespace kreisel
