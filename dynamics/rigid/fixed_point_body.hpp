#pragma once

#include <Eigen/Geometry>

#include <array>
#include <limits>
#include <optional>
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
#include <dynamics/rigid/attitude_series.hpp>
#include <dynamics/rigid/body_outputs.hpp>
#include <dynamics/rigid/jacobi_integral.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

/// The state of a fixed-point body.
struct FixedPointBodyState {
  Eigen::Quaternion<double> attitude = Eigen::Quaternion<double>::Identity();  ///< body to guide
  Vector3<double> angular_velocity = Vector3<double>::Zero();                  ///< u', on body axes
};

/// A rigid body whose origin O' is fixed to a point of a moving guide. Examples: a pendulum in a
/// ball joint on a ship, a top on a turntable, an instrument on gimbals without mass.
///
/// Its centre of mass may be anywhere and its inertia general. With the guide at rest it is Euler's
/// top. Without loads and with the centre of mass at O' the guide has no effect.
///
/// The state is the attitude in the guide and the angular velocity u' against the guide. Nothing
/// depends on the quaternion's norm, which drifts only by the error of the steps and is never
/// corrected. The attitude computed from the quaternion is always a rotation to rounding, however
/// long the run.
///
/// Source : paper 002 (5), (18)-(19), with V' = (u'; 0) at O'
/// Units  : metre, rad/s
/// Throws : InvalidInput if the inertia is invalid or the tensor about O' is singular (a needle
///          along a line through O', all mass in O')
template <class M, class... Loads>
class FixedPointBody {
  static_assert(detail::is_guide<M>,
                "the guide of a body must return a FrameMotion<Guide, Inertial>");
  static_assert(detail::are_loads<Loads...>,
                "a load must take a LoadContext and return a Force<Body>");

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 7, 1>;

  using State = FixedPointBodyState;

  /// `point` is the position of the fixed point in the guide.
  FixedPointBody(const InertiaTensor<Body, S>& inertia, const Vector3<S>& point, M guide,
                 Loads... loads)
      : inertia_(inertia),
        point_(point),
        guide_(std::move(guide)),
        loads_(std::move(loads)...),
        first_moment_(
            detail::without<FirstMoment, Loads...>(detail::components(inertia.value.first_moment))),
        tensor_(detail::tensor_of<Loads...>(inertia.value.tensor, "fixed-point body")),
        apparent_(std::apply(
            [this](const Loads&... all) {
              return Apparent(detail::components(point_), guide_, "fixed-point body", all...);
            },
            loads_)) {
    check(inertia.value, Mass::positive, "fixed-point body");
    detail::check_vanishing<FirstMoment, Loads...>(inertia.value.first_moment,
                                                   "fixed-point body, first moment");
    if (!(point - point).isZero(0)) throw InvalidInput("fixed-point body: the point is not finite");
    const auto moments = detail::principal_moments(inertia.value.tensor);
    if (!(moments[0] > std::numeric_limits<S>::epsilon() * moments[2])) {
      throw InvalidInput(
          "fixed-point body: the inertia about an axis through the fixed point is 0 (a needle, or "
          "all mass "
          "in that point): the rotation about it is not determined by the torque");
    }
  }

  [[nodiscard]] LoadContext<S> situation(const S& t, const State& state) const {
    LoadContext<S> s =
        situation_in<S>(t, Pose<S>::from(state.attitude).rotation, state.angular_velocity);
    s.guide = detail::guide_at<S>(guide_, t);
    return s;
  }

  /// *u', the rate of the angular velocity on body axes:
  ///
  ///   Theta .w = M + s x R^t g' - w x (Theta w),   w = u' + R^t u,   *u' = .w - R^t ou + u' x R^t u
  ///
  /// g' is the apparent uniform gravity at O', M the moment of all other loads.
  template <class N>
  [[nodiscard]] Vector3<N> acceleration(const LoadContext<N>& s) const {
    const auto turn = detail::Rotation<N>::from(s.X.value.rotation);
    const auto u = detail::components(s.V_rel.value.resultant);
    return std::apply(
        [&](const Loads&... all) -> Vector3<N> {
          return detail::vector<N>(
              acceleration_of(turn, u, apparent_.in(s.guide, all...), torque(s)));
        },
        loads_);
  }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; u'), for double and, if
  /// the loads accept them, dual numbers. detail::guide_at states the derivatives of the guide that
  /// are used.
  template <class N>
  requires(Load<Loads, N>&&...)
      [[nodiscard]] Eigen::Matrix<N, 7, 1> rates(const std::type_identity_t<N>& t,
                                                 const Eigen::Matrix<N, 7, 1>& y) const {
    const Eigen::Quaternion<N> q(y[3], y[0], y[1], y[2]);
    const Vector3<N> u(y[4], y[5], y[6]);
    const auto turn = detail::Rotation<N>::from(q);
    const auto du = std::apply(
        [&](const Loads&... all) {
          if constexpr (!has_forces) {
            return acceleration_of(turn, detail::components(u), apparent_.at(guide_, N(t), all...),
                                   detail::ZeroVector{});
          } else {
            LoadContext<N> s = situation_in<N>(t, turn.matrix(), u);
            if constexpr (guide_is_read) s.guide = detail::guide_at<N>(guide_, t);
            if constexpr (guide_is_read && !SteadyGuide<M>) {
              return acceleration_of(turn, detail::components(u), apparent_.in(s.guide, all...),
                                     torque(s));
            } else {
              return acceleration_of(turn, detail::components(u),
                                     apparent_.at(guide_, N(t), all...), torque(s));
            }
          }
        },
        loads_);
    const Eigen::Matrix<N, 4, 1> dq = attitude_rate(q, u);
    return detail::gathered<N>(dq[0], dq[1], dq[2], dq[3], du.x, du.y, du.z);
  }
  [[nodiscard]] Vector rates(S t, const Vector& y) const { return rates<S>(t, y); }

  /// The Taylor series of the motion, for TaylorSteps. It exists if only uniform gravity acts and
  /// the guide moves steadily or analytically. Formulas: rigid/attitude_series.hpp.
  [[nodiscard]] auto series() const requires(detail::feels_analytically<M, Loads...>) {
    return series_on<detail::RateAxes::body>();
  }
  [[nodiscard]] bool knows_series() const requires(detail::feels_analytically<M, Loads...>) {
    return detail::has_series(guide_);
  }

  [[nodiscard]] BodyOutputs<S> body_outputs(const S& t, const State& state) const {
    const LoadContext<S> s = situation(t, state);
    return std::apply(
        [&](const auto&... loads) {
          return detail::body_outputs(s, {{acceleration(s), Vector3<S>::Zero()}}, loads...);
        },
        loads_);
  }

  /// The terms of acceleration() that are computed: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    using Now = detail::ApparentTerms<ApparentNow, M, Loads...>;
    constexpr bool heavy = !FirstMomentKept::static_zero && Now::pulled;
    const std::string of_weight = FirstMomentKept::static_zero || Now::of_gravity().empty()
                                      ? detail::reason_for<FirstMoment, Loads...>()
                                      : Now::of_gravity();
    Terms list;
    list.add("relative", "u' x (Theta u')");
    list.add("relative", "products of inertia in Theta", !detail::principal<Loads...>,
             detail::reason_for<ProductsOfInertia, Loads...>());
    list.add("guide", "u x (Theta u)", Now::turns, Now::of_turning());
    list.add("guide", "Theta ou", Now::turns_unsteadily, Now::of_unsteadiness());
    list.add("guide", "s x g'", heavy, of_weight);
    list.add("Coriolis", "u' x (Theta u) + u x (Theta u') + Theta (u x u')", Now::turns,
             Now::of_turning());
    Now::add_loads(list, heavy, of_weight);
    return list;
  }

  /// This body with one simplification, for prune(). GuideUnsteadiness: the guide moves in its mean
  /// steady motion between two times. GuideRate: the guide rests in its pose at their middle, and
  /// its acceleration remains as gravity. The others: zero products of inertia, and no loads of one
  /// type.
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
      const Vector3<S> carried = detail::vector<S>(detail::carried_acceleration(
          motion.u, detail::ZeroVector{}, motion.origin_acceleration, detail::components(point_)));
      return remade(inertia_, RestingFrame<>{guide_((begin + end) / 2).X},
                    std::tuple_cat(loads_, std::tuple(UniformGravity<Guide>{-carried})));
    } else {
      return without(GuideUnsteadiness{}, begin, end).without(what, begin, end);
    }
  }
  [[nodiscard]] auto without(ProductsOfInertia /*what*/, double /*begin*/, double /*end*/) const
      requires(!detail::principal<Loads...>) {
    InertiaTensor<Body, S> straight = inertia_;
    Symmetric3<S>& T = straight.value.tensor;
    T.xy = T.xz = T.yz = 0;
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
          detail::add_kept_momenta<M>(kept, s, s.X.value.translation, false, all...);
          return kept;
        },
        loads_);
  }

  /// The same body with its tensor perturbed by units in the last place, if the motion amplifies
  /// them. For estimates of the effect of rounding.
  [[nodiscard]] std::optional<FixedPointBody> perturbed_by_ulps() const {
    if constexpr (detail::principal<Loads...>) {
      return std::nullopt;
    } else {
      if (!tensor_.is_nearly_singular()) return std::nullopt;
      FixedPointBody other = *this;
      other.tensor_ = tensor_.perturbed_by_ulps();
      return other;
    }
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {4, 3};

  /// For linear equations: the first component of each quaternion, and the kinds of components.
  [[nodiscard]] static constexpr std::array<int, 1> quaternions() { return {0}; }
  static constexpr std::array names = {"q_x", "q_y", "q_z", "q_w", "u'_x", "u'_y", "u'_z"};

  [[nodiscard]] static Vector to_vector(const State& state) {
    const Eigen::Quaternion<S>& q = state.attitude;
    const Vector3<S>& u = state.angular_velocity;
    return Vector(q.x(), q.y(), q.z(), q.w(), u.x(), u.y(), u.z());
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(y[3], y[0], y[1], y[2]), {y[4], y[5], y[6]}};
  }

 private:
  template <class OtherGuide, class... Others>
  friend class AxisymmetricBody;

  template <detail::RateAxes axes>
  [[nodiscard]] auto series_on() const {
    const auto apparent =
        std::apply([&](const Loads&... all) { return apparent_.whole(guide_, all...); }, loads_);
    using ApparentWhole = std::remove_const_t<decltype(apparent)>;
    return detail::AttitudeSeries<detail::TensorOf<Loads...>, FirstMomentKept, ApparentWhole, axes>(
        tensor_, first_moment_, apparent);
  }

  template <class OtherGuide, class... Others>
  [[nodiscard]] FixedPointBody<OtherGuide, Others...> remade(
      const InertiaTensor<Body, S>& inertia, const OtherGuide& guide,
      const std::tuple<Others...>& loads) const {
    return std::apply(
        [&](const Others&... all) {
          return FixedPointBody<OtherGuide, Others...>(inertia, point_, guide, all...);
        },
        loads);
  }

  /// The acceleration for a given apparent motion of the guide.
  template <class N>
  [[nodiscard]] LoadContext<N> situation_in(const N& t, const Matrix3<N>& attitude,
                                            const Vector3<N>& u) const {
    return {t,
            {{attitude, point_.template cast<N>()}},
            {{u, Vector3<N>::Zero()}},
            {},
            {detail::lifted<N>(inertia_.value)}};
  }

  template <class N, class U, class T>
  [[nodiscard]] detail::Components<N> acceleration_of(const detail::Rotation<N>& R,
                                                      const detail::Components<N>& u_rel,
                                                      const U& guide, const T& torque) const {
    const auto u = rotated_back(R, guide.u);
    const auto w = u_rel + u;
    const auto moment =
        tensor_.gyroscopic_torque(w) + cross(first_moment_, rotated_back(R, guide.g)) + torque;
    return tensor_.solve(moment) - rotated_back(R, guide.du) + cross(u_rel, u);
  }

  static constexpr bool has_forces = (detail::is_force<Loads> || ...);
  static constexpr bool guide_is_read = (detail::reads_guide<Loads>() || ...);

  /// The torque of the loads that are not uniform gravity.
  template <class N>
  [[nodiscard]] auto torque(const LoadContext<N>& s) const {
    if constexpr (has_forces) {
      return std::apply(
          [&s](const Loads&... all) {
            return detail::components(detail::forces(s, all...).value.moment);
          },
          loads_);
    } else {
      return detail::ZeroVector{};
    }
  }

  using FirstMomentKept = detail::Kept<FirstMoment, S, Loads...>;
  using Apparent =
      detail::ApparentField<!FirstMomentKept::static_zero, detail::Components<S>, M, Loads...>;

  using ApparentNow = decltype(std::declval<const Apparent&>().at(std::declval<const M&>(), S(0),
                                                                  std::declval<const Loads&>()...));

  InertiaTensor<Body, S> inertia_;
  Vector3<S> point_;
  M guide_;
  std::tuple<Loads...> loads_;
  FirstMomentKept first_moment_;
  detail::TensorOf<Loads...> tensor_;
  Apparent apparent_;
};

static_assert(Scene<FixedPointBody<RestingFrame<>>> && HasSeries<FixedPointBody<RestingFrame<>>>);

}  // namespace kreisel
