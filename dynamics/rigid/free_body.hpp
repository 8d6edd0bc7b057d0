#pragma once

#include <Eigen/Geometry>

#include <array>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/mean_motion.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <dynamics/rigid/body_outputs.hpp>
#include <dynamics/rigid/jacobi_integral.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

/// The state of a free body.
struct FreeBodyState {
  Eigen::Quaternion<double> attitude = Eigen::Quaternion<double>::Identity();  ///< body to guide
  Vector3<double> position = Vector3<double>::Zero();  ///< of O' in the guide
  Velocity<Body, Guide, Body> velocity = {};           ///< V'
};

/// A free rigid body watched from a moving guide: thrown, falling, floating, hung on springs.
///
/// Its origin O' and its centre of mass may differ. The state is the attitude, the position and the
/// velocity motor (twist) V' against the guide. Nothing depends on the quaternion's norm (see
/// FixedPointBody).
///
/// Source : paper 002 (5)
/// Units  : metre, rad/s, m/s
/// Throws : InvalidInput if the inertia is invalid, ComputationFailed if it is singular
template <class M, class... Loads>
class FreeBody {
  static_assert(detail::is_guide<M>,
                "the guide of a body must return a FrameMotion<Guide, Inertial>");
  static_assert(detail::are_loads<Loads...>,
                "a load must take a LoadContext and return a Force<Body>");

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 13, 1>;

  using State = FreeBodyState;

  FreeBody(const InertiaTensor<Body, S>& inertia, M guide, Loads... loads)
      : inertia_(inertia),
        guide_(std::move(guide)),
        loads_(std::move(loads)...),
        centre_(detail::without<FirstMoment, Loads...>(
            detail::components(checked_centre(inertia.value)))),
        tensor_(detail::tensor_of<Loads...>(about_centre(inertia.value), "free body")),
        apparent_(std::apply(
            [this](const Loads&... all) {
              return Apparent(detail::ZeroVector{}, guide_, "free body", all...);
            },
            loads_)) {
    detail::check_vanishing<FirstMoment, Loads...>(inertia.value.first_moment,
                                                   "free body, first moment");
  }

  [[nodiscard]] LoadContext<S> situation(const S& t, const State& state) const {
    LoadContext<S> s = situation_in<S>(t, Pose<S>::from(state.attitude).rotation, state.position,
                                       state.velocity.value);
    s.guide = detail::guide_at<S>(guide_, t);
    return s;
  }

  /// *V', from the motion of the centre of mass c and the rotation of the body about it, w = u' +
  /// R^t u:
  ///
  ///   Theta_c .w = M - c x P - w x (Theta_c w),      *u' = .w - R^t ou + u' x R^t u
  ///   *v' = P/m + R^t (g' - ou x r - u x (u x r)) - .w x c - w x (w x c) - (2 R^t u + u') x v'
  ///
  /// g' is the apparent uniform gravity at the guide's origin, r the position of O' in the guide, P
  /// and M all other loads.
  template <class N>
  [[nodiscard]] Rate<Body, Velocity<Body, Guide, Body, N>> acceleration(
      const LoadContext<N>& s) const {
    return std::apply(
        [&](const Loads&... all) -> Rate<Body, Velocity<Body, Guide, Body, N>> {
          return {acceleration_of(detail::Rotation<N>::from(s.X.value.rotation),
                                  s.X.value.translation, s.V_rel.value,
                                  apparent_.in(s.guide, all...), force(s))
                      .motor()};
        },
        loads_);
  }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; position; u'; v'), for
  /// double and, if the loads accept them, dual numbers. detail::guide_at states the derivatives of
  /// the guide that are used.
  template <class N>
  requires(Load<Loads, N>&&...)
      [[nodiscard]] Eigen::Matrix<N, 13, 1> rates(const std::type_identity_t<N>& t,
                                                  const Eigen::Matrix<N, 13, 1>& y) const {
    const Eigen::Quaternion<N> q(y[3], y[0], y[1], y[2]);
    const Vector3<N> r(y[4], y[5], y[6]);
    const Vector3<N> u(y[7], y[8], y[9]);
    const Vector3<N> v(y[10], y[11], y[12]);
    const auto turn = detail::Rotation<N>::from(q);
    const Eigen::Matrix<N, 4, 1> dq = attitude_rate(q, u);
    const auto dr = rotated(turn, detail::components(v));
    const auto rate = [&](const Acceleration<N>& dV) {
      return detail::gathered<N>(dq[0], dq[1], dq[2], dq[3], dr.x, dr.y, dr.z, dV.angular.x,
                                 dV.angular.y, dV.angular.z, dV.linear.x, dV.linear.y, dV.linear.z);
    };
    return std::apply(
        [&](const Loads&... all) {
          if constexpr (!has_forces) {
            return rate(
                acceleration_of(turn, r, {u, v}, apparent_.at(guide_, N(t), all...), NoForce{}));
          } else {
            LoadContext<N> s = situation_in<N>(t, turn.matrix(), r, {u, v});
            if constexpr (guide_is_read) s.guide = detail::guide_at<N>(guide_, t);
            if constexpr (guide_is_read && !SteadyGuide<M>) {
              return rate(
                  acceleration_of(turn, r, {u, v}, apparent_.in(s.guide, all...), force(s)));
            } else {
              return rate(
                  acceleration_of(turn, r, {u, v}, apparent_.at(guide_, N(t), all...), force(s)));
            }
          }
        },
        loads_);
  }
  [[nodiscard]] Vector rates(S t, const Vector& y) const { return rates<S>(t, y); }

  [[nodiscard]] BodyOutputs<S> body_outputs(const S& t, const State& state) const {
    const LoadContext<S> s = situation(t, state);
    return std::apply(
        [&](const auto&... loads) { return detail::body_outputs(s, acceleration(s), loads...); },
        loads_);
  }

  /// The terms of acceleration() that are computed: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    using Now = detail::ApparentTerms<ApparentNow, M, Loads...>;
    const std::string of_centre = detail::reason_for<FirstMoment, Loads...>();
    const std::string of_centrifugal = detail::reason_for<CentrifugalForce, Loads...>();
    Terms list;
    list.add("relative", "u' x (Theta_c u')");
    list.add("relative", "products of inertia in Theta_c", !detail::principal<Loads...>,
             detail::reason_for<ProductsOfInertia, Loads...>());
    list.add("relative", "c apart from O'", !CentreKept::static_zero, of_centre);
    list.add("guide", "u x (Theta_c u)", Now::turns, Now::of_turning());
    list.add("guide", "Theta_c ou", Now::turns_unsteadily, Now::of_unsteadiness());
    list.add("guide", "m g'", Now::pulled, Now::of_gravity());
    list.add("guide", "m u x (u x r)", Now::turns && of_centrifugal.empty(),
             Now::turns ? of_centrifugal : Now::of_turning());
    list.add("guide", "m ou x r", Now::turns_unsteadily, Now::of_unsteadiness());
    list.add("Coriolis", "u' x (Theta_c u) + u x (Theta_c u') + Theta_c (u x u')", Now::turns,
             Now::of_turning());
    list.add("Coriolis", "2 m u x v'", Now::turns, Now::of_turning());
    Now::add_loads(list, Now::pulled, Now::of_gravity());
    return list;
  }

  /// This body with one simplification, for prune(). GuideUnsteadiness: the guide moves in its mean
  /// steady motion between two times. GuideRate: the guide rests in its pose at their middle, and
  /// the acceleration of its origin remains as gravity. The others: zero products of inertia, no
  /// loads of one type, no centrifugal force.
  [[nodiscard]] auto without(GuideUnsteadiness /*what*/, double begin, double end) const
      requires(!SteadyGuide<M>) {
    const auto on_mean = remade(inertia_, mean_motion(guide_, begin, end), loads_);
    if constexpr (detail::never_turns<M>) {
      return on_mean.without(GuideRate{}, begin, end);
    } else {
      return on_mean;
    }
  }
  [[nodiscard]] auto without(GuideRate what, double begin, double end) const
      requires(detail::turns<M>()) {
    if constexpr (SteadyGuide<M>) {
      const auto motion = guide_.steady();
      const Vector3<S> carried = detail::vector<S>(motion.origin_acceleration);
      return remade(inertia_, RestingFrame<>{guide_((begin + end) / 2).X},
                    std::tuple_cat(loads_, std::tuple(UniformGravity<Guide>{-carried})));
    } else {
      return without(GuideUnsteadiness{}, begin, end).without(what, begin, end);
    }
  }
  [[nodiscard]] auto without(CentrifugalForce /*what*/, double /*begin*/, double /*end*/) const
      requires(detail::turns<M>() && !detail::vanishes<CentrifugalForce, Axis::x, Loads...>) {
    return remade(inertia_, guide_,
                  std::tuple_cat(loads_, std::tuple(Without<CentrifugalForce>{})));
  }
  [[nodiscard]] auto without(ProductsOfInertia /*what*/, double /*begin*/, double /*end*/) const
      requires(!detail::principal<Loads...>) {
    // Products of inertia that come from the offset of the centre of mass stay, to the last bit.
    InertiaTensor<Body, S> straight = inertia_;
    const Symmetric3<S> offset = offset_of_centre(inertia_.value);
    Symmetric3<S>& T = straight.value.tensor;
    T.xy = offset.xy;
    T.xz = offset.xz;
    T.yz = offset.yz;
    return remade(straight, guide_,
                  std::tuple_cat(loads_, std::tuple(Without<ProductsOfInertia>{})));
  }
  template <class L>
  [[nodiscard]] auto without(LoadOf<L> /*what*/, double /*begin*/, double /*end*/) const
      requires((std::is_same_v<L, Loads> || ...)) {
    return remade(inertia_, guide_, detail::other_loads<L>(loads_));
  }

  /// Invariants, by name. Jacobi's integral in a guide that moves steadily (the energy in a guide
  /// at rest), if loads do work only by a potential. Momenta in a guide at rest on which uniform
  /// gravity is the only load.
  [[nodiscard]] std::vector<std::pair<const char*, S>> conserved(const S& t,
                                                                 const State& state) const {
    return std::apply(
        [&](const Loads&... all) {
          const LoadContext<S> s = situation(t, state);
          auto kept = detail::kept_energy(guide_, s, all...);
          detail::add_kept_momenta<M>(kept, s, Vector3<double>::Zero(), true, all...);
          return kept;
        },
        loads_);
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 4> blocks = {4, 3, 3, 3};

  /// For linear equations: the first component of each quaternion, and the kinds of components.
  [[nodiscard]] static constexpr std::array<int, 1> quaternions() { return {0}; }
  static constexpr std::array names = {"q_x",  "q_y",  "q_z",  "q_w",  "x",    "y",   "z",
                                       "u'_x", "u'_y", "u'_z", "v'_x", "v'_y", "v'_z"};

  [[nodiscard]] static Vector to_vector(const State& state) {
    const Eigen::Quaternion<S>& q = state.attitude;
    const Vector3<S>& r = state.position;
    const auto& [u, v] = state.velocity.value;
    return Vector{{q.x(), q.y(), q.z(), q.w(), r.x(), r.y(), r.z(), u.x(), u.y(), u.z(), v.x(),
                   v.y(), v.z()}};
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(y[3], y[0], y[1], y[2]),
            {y[4], y[5], y[6]},
            {{{y[7], y[8], y[9]}, {y[10], y[11], y[12]}}}};
  }

 private:
  template <class OtherGuide, class... Others>
  [[nodiscard]] FreeBody<OtherGuide, Others...> remade(const InertiaTensor<Body, S>& inertia,
                                                       const OtherGuide& guide,
                                                       const std::tuple<Others...>& loads) const {
    return std::apply(
        [&](const Others&... all) {
          return FreeBody<OtherGuide, Others...>(inertia, guide, all...);
        },
        loads);
  }

  /// The acceleration for a given apparent motion of the guide.
  template <class N>
  [[nodiscard]] LoadContext<N> situation_in(const N& t, const Matrix3<N>& attitude,
                                            const Vector3<N>& position, const Motor<N>& V) const {
    return {t, {{attitude, position}}, {V}, {}, {detail::lifted<N>(inertia_.value)}};
  }

  template <class P, class T>
  struct Wrench {
    P force;
    T torque;
  };
  using NoForce = Wrench<detail::ZeroVector, detail::ZeroVector>;

  static constexpr bool has_forces = (detail::is_force<Loads> || ...);
  static constexpr bool guide_is_read = (detail::reads_guide<Loads>() || ...);

  /// The force of the loads that are not uniform gravity.
  template <class N>
  [[nodiscard]] auto force(const LoadContext<N>& s) const {
    if constexpr (has_forces) {
      return std::apply(
          [&s](const Loads&... all) {
            const Motor<N> sum = detail::forces(s, all...).value;
            return Wrench<detail::Components<N>, detail::Components<N>>{
                detail::components(sum.resultant), detail::components(sum.moment)};
          },
          loads_);
    } else {
      return NoForce{};
    }
  }

  template <class N>
  struct Acceleration {
    detail::Components<N> angular;
    detail::Components<N> linear;

    [[nodiscard]] Motor<N> motor() const {
      return {detail::vector<N>(angular), detail::vector<N>(linear)};
    }
  };

  template <class N, class U, class F>
  [[nodiscard]] Acceleration<N> acceleration_of(const detail::Rotation<N>& R,
                                                const Vector3<N>& position, const Motor<N>& V,
                                                const U& guide, const F& load) const {
    const auto u_rel = detail::components(V.resultant);
    const auto v_rel = detail::components(V.moment);
    const auto r = detail::components(position);
    const auto u = rotated_back(R, guide.u);
    const auto w = u_rel + u;
    const auto dw =
        tensor_.solve(tensor_.gyroscopic_torque(w) + load.torque - cross(centre_, load.force));
    const auto u_centrifugal = detail::without<CentrifugalForce, Loads...>(guide.u);
    const auto g = rotated_back(R, guide.g - detail::carried_acceleration(u_centrifugal, guide.du,
                                                                          detail::ZeroVector{}, r));
    const auto du = dw - rotated_back(R, guide.du) + cross(u_rel, u);
    const auto dv = load.force / inertia_.value.mass + g - cross(dw, centre_) -
                    cross(w, cross(w, centre_)) - cross(w + u, v_rel);
    return {du, dv};
  }

  [[nodiscard]] static Vector3<S> checked_centre(const Inertia<S>& T) {
    check(T, Mass::positive, "free body");
    const Symmetric3<S>& t = T.tensor;
    const auto moments = detail::principal_moments(about_centre(T));
    if (!(moments[0] > std::numeric_limits<S>::epsilon() * (t.xx + t.yy + t.zz))) {
      throw ComputationFailed(
          "free body: a moment of inertia about the centre of mass is 0 (a point or a needle): the "
          "rotation about that axis is not determined by the force");
    }
    return T.first_moment / T.mass;
  }

  /// The part of the tensor about O' that comes from the offset of the centre of mass.
  [[nodiscard]] static Symmetric3<S> offset_of_centre(const Inertia<S>& T) {
    const Vector3<S> c = T.first_moment / T.mass;
    return offset_product(c, Vector3<S>(T.first_moment / S(2)));
  }

  [[nodiscard]] static Symmetric3<S> about_centre(const Inertia<S>& T) {
    return T.tensor - offset_of_centre(T);
  }

  using CentreKept = detail::Kept<FirstMoment, S, Loads...>;
  using Apparent = detail::ApparentField<true, detail::ZeroVector, M, Loads...>;

  using ApparentNow = decltype(std::declval<const Apparent&>().at(std::declval<const M&>(), S(0),
                                                                  std::declval<const Loads&>()...));

  InertiaTensor<Body, S> inertia_;
  M guide_;
  std::tuple<Loads...> loads_;
  CentreKept centre_;
  detail::TensorOf<Loads...> tensor_;
  Apparent apparent_;
};

static_assert(Scene<FreeBody<RestingFrame<>>>);

}  // namespace kreisel
