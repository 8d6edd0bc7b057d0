#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/gimbal/cardan_parts.hpp>
#include <dynamics/gimbal/cardan_series.hpp>
#include <dynamics/guide/mean_motion.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/series.hpp>
#include <dynamics/inertia.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

namespace detail {

/// The constant u of a guide in steady motion.
template <class M>
[[nodiscard]] auto steady_rate(const M& guide) {
  if constexpr (SteadyGuide<M>) {
    return guide.steady().u;
  } else {
    return ZeroVector{};
  }
}
template <class M>
using SteadyRate = decltype(steady_rate(std::declval<const M&>()));

template <class Rotor>
inline constexpr bool is_driven = false;
template <class Torque>
inline constexpr bool is_driven<DrivenRotor<Torque>> = true;

/// True if the drive's torque is a function, not a constant.
template <class Rotor>
inline constexpr bool is_driven_otherwise =
    is_driven<Rotor> && !std::is_same_v<Rotor, DrivenRotor<double>>;

/// True if the drive's torque, if it is a function, accepts numbers of type S.
template <class Rotor, class S>
inline constexpr bool drive_takes = true;
template <class Rotor, class S>
requires is_driven_otherwise<Rotor>
inline constexpr bool drive_takes<Rotor, S> = requires(const Rotor& rotor, const S& x) {
  S(rotor.torque(x, x));
};

/// u and its rate on guide axes; G and V are numbers or StaticZero.
template <class G, class V>
struct Turning {
  Components<G> u = {};
  Components<V> du = {};
};

/// The rotor's tensor on the axes of the inner ring: A cos^2 phi + B sin^2 phi and so on. N is a
/// number, or StaticZero for a symmetric rotor, whose tensor is added to the ring's.
template <class N>
struct RotatedRotor {
  N P;  ///< about A_2
  N Q;  ///< about B_2
  N R;  ///< the product of inertia, + off the diagonal
  N W;  ///< P - Q without cancellation
};

/// The rates of the angles and, where they are given, their second derivatives.
template <class S, class D>
struct CardanMotion {
  S da, db, df;
  D dda = {}, ddb = {};
};

/// The rates of angular momentum of the three bodies without phi'', each on its ring's axes, the
/// rotor's on those of the inner ring. N is StaticZero if the rotor's tensor is added to the inner
/// ring's.
template <class S, class K, class N>
struct CardanRates {
  K outer_a, outer_b, outer_c;
  S inner_a, inner_b, inner_c;
  N rotor_a, rotor_b;
  S dz_2;   ///< of the angular velocity of the inner ring about C
  N twist;  ///< u_A L_B - u_B L_A of the rotor, which with C_1 (dz_2 + phi'') is its rate about C
};

}  // namespace detail

/// The gyro in Cardan's suspension: a rotor in an inner ring in an outer ring, all with mass, on a
/// guide in arbitrary motion. Exact, for all angles.
///
///   alpha about A (guide x), then beta about B, then phi about the spin axis C:
///   (p)_guide = R_x(alpha) R_y(beta) R_z(phi) (p)_rotor
///
/// All centres of mass lie where the axes meet. The motion therefore depends only on u and ou of
/// the guide, and gravity has no effect. The angles count whole turns; alpha and beta count from
/// the references of their bearings.
///
/// phi'' is eliminated by the rotor's own equation. The two equations for alpha'' and beta'' that
/// remain have the determinant
///
///   (A_3 + J sin^2 beta) (B_2 + Q) + cos^2 beta (A_2 (B_2 + Q) + B_2 P + A_1 B_1),
///
/// J = C_2, or C_1 + C_2 if the rotor is regulated. It is a sum of terms that are not negative, so
/// nothing cancels, however light the rings are. There is no division by cos beta. Only if A_3 + J
/// sin^2 beta = 0 are the equations singular at beta = 90 degrees.
///
/// Source : paper 002 (35)-(40) corrected: the rates of the rings are not those of the rotor,
///          u'_C2 = u'_A3 sin beta, u'_A3 = (u'_A cos phi - u'_B sin phi)/cos beta,
///          phi' = u'_C - u'_C2; in (40) sin beta for sin^2 beta. These and the printed ones:
///          tests/dynamics/gimbal/cardan_gyro_laws.cpp
/// Units  : rad/s, N m
/// Error  : of the accelerations <= 1e-14 of the greatest, including rings with 1e-8 of the mass at
///          1e-8 from 90 degrees (tests/dynamics/gimbal/cardan_gyro.cpp)
/// Cost   : guide at rest: one sine and cosine, two if the rotor is unsymmetric; moving guide: one
///          more; plus the terms of guide and rotor (ctest dynamics.study.pruning_cost)
/// Throws : InvalidInput if no body has such moments, the rotor's C is 0, the equations are
///          singular at every angle, or stiffness, damping or friction is below 0.
///          ComputationFailed from rates() and everything that needs accelerations, where they are
///          singular
///
/// Parameter : number type of moments and bearings: double, or a pack for several gyros side by
///             side
template <class M, class Rotor = FreeRotor, class Parameter = double>
class CardanGyro : public detail::CardanStates {
  static_assert(detail::is_guide<M>,
                "the guide of a gyro must return a FrameMotion<Guide, Inertial>");
  static_assert(std::is_same_v<Rotor, FreeRotor> || std::is_same_v<Rotor, FrictionlessRotor> ||
                    std::is_same_v<Rotor, RegulatedRotor> || detail::is_driven<Rotor>,
                "the rotor is a FreeRotor, FrictionlessRotor, DrivenRotor or RegulatedRotor");

 public:
  CardanGyro(const CardanMoments& moments, const CardanBearings& bearings, M guide,
             Rotor rotor = {})
      : moments_(moments),
        bearings_(bearings),
        guide_(std::move(guide)),
        rotor_(std::move(rotor)),
        symmetric_(moments.rotor.x() == moments.rotor.y()),
        plain_(symmetric_ && bearings.outer.reference == 0 && bearings.inner.reference == 0),
        loose_(plain_ && is_loose(bearings.outer) && is_loose(bearings.inner)),
        singular_(singular()) {
    check_moments();
    check_bearing("outer", bearings.outer);
    check_bearing("inner", bearings.inner);
    require_not_negative("rotor friction", rotor_.friction, "N m s/rad");
    if constexpr (std::is_same_v<Rotor, DrivenRotor<double>>) {
      if (!std::isfinite(rotor_.torque)) refuse("torque of the drive = ", rotor_.torque, " N m");
    }
  }

  /// Several gyros, each in one lane of N. Nothing if only some are symmetric, or if the friction
  /// of their rotors differs.
  template <class N>
  requires(detail::is_resting<M> && !detail::is_driven<Rotor>)
      [[nodiscard]] static std::optional<CardanGyro<M, Rotor, N>> side_by_side(
          const std::array<const CardanGyro*, std::size_t(N::lanes)>& gyros) {
    for (const CardanGyro* gyro : gyros) {
      if (gyro->symmetric_ != gyros[0]->symmetric_ ||
          gyro->rotor_.friction != gyros[0]->rotor_.friction) {
        return {};
      }
    }
    return CardanGyro<M, Rotor, N>(gyros);
  }

  [[nodiscard]] const BasicCardanMoments<Parameter>& moments() const { return moments_; }
  [[nodiscard]] const BasicCardanBearings<Parameter>& bearings() const { return bearings_; }
  [[nodiscard]] const Rotor& rotor() const { return rotor_; }

  /// The vector field  y' = rates(t, y)  on  y = (alpha, beta, phi; their rates), for double, long
  /// double and dual numbers.
  ///
  /// With dual numbers the derivative with respect to t is exact if the guide accepts them too (a
  /// lambda of auto does). A guide of doubles gives the rate ou of u, but no rate of ou: that part
  /// is left out.
  template <class S>
  requires detail::drive_takes<Rotor, S>
  [[nodiscard]] Eigen::Matrix<S, 6, 1> rates(const std::type_identity_t<S>& t,
                                             const Eigen::Matrix<S, 6, 1>& y) const {
    if constexpr (std::is_same_v<S, double>) {
      if (loose_) return rates_of<detail::StaticZero, detail::StaticZero, detail::StaticZero>(t, y);
    }
    if (plain_) return rates_of<detail::StaticZero, detail::StaticZero, Parameter>(t, y);
    return less_plain_rates<S>(t, y);
  }
  [[nodiscard]] Vector rates(double t, const Vector& y) const { return rates<double>(t, y); }

  /// The Taylor series of the motion, for TaylorSteps. It exists if the guide rests or moves
  /// steadily or analytically, and the torque of the drive, if any, is constant. Formulas:
  /// gimbal/cardan_series.hpp.
  [[nodiscard]] auto series() const
      requires(std::is_same_v<Parameter, double> && !detail::is_driven_otherwise<Rotor> &&
               (detail::never_turns<M> || SteadyGuide<M> || AnalyticGuide<M>)) {
    const auto& [A_1, B_1, C_1] =
        std::array{moments_.rotor[0], moments_.rotor[1], moments_.rotor[2]};
    detail::CardanConstants gyro{
        .moments = moments_,
        .bearings = bearings_,
        .ring = {moments_.inner_ring, (A_1 + B_1) / 2, regulated ? C_1 : 0},
        .n = (A_1 - B_1) / 2,
        .singular = singular_,
        .regulated = regulated};
    if constexpr (std::is_same_v<Rotor, DrivenRotor<double>>) gyro.torque = rotor_.torque;
    if constexpr (!regulated) gyro.friction = rotor_.friction;
    if constexpr (detail::never_turns<M> || detail::is_resting<M>) {
      return detail::CardanSeries(gyro, detail::StaticZero{});
    } else if constexpr (SteadyGuide<M>) {
      return detail::CardanSeries(gyro, detail::components(detail::vector<double>(steady_)));
    } else {
      return detail::CardanSeries(
          gyro, detail::ApparentSeries(guide_, detail::ZeroVector{}, detail::ZeroVector{},
                                       detail::ZeroVector{}));
    }
  }
  [[nodiscard]] bool knows_series() const { return detail::has_series(guide_); }

  /// True if friction or damping can make the equations stiff.
  [[nodiscard]] bool may_be_stiff() const {
    return bearings_.outer.damping != 0 || bearings_.inner.damping != 0 || rotor_.friction != 0;
  }

  /// The same gyro with its springs perturbed by a unit in the last place, if it has any. Such is
  /// the rounding of the sums of moments that balance the springs, and it grows with each radian of
  /// their oscillation. For estimates of the effect of rounding.
  [[nodiscard]] std::optional<CardanGyro> perturbed_by_ulps() const
      requires(std::is_same_v<Parameter, double>) {
    if (bearings_.outer.stiffness == 0 && bearings_.inner.stiffness == 0) return std::nullopt;
    CardanGyro other = *this;
    for (CardanBearing* bearing : {&other.bearings_.outer, &other.bearings_.inner}) {
      bearing->stiffness *= 1 + std::numeric_limits<double>::epsilon();
    }
    return other;
  }

  /// The moments in the bearings.
  ///
  /// Error  : <= 1e-13 of the largest; the moments about the bearings' axes are exact, as sums of
  ///          spring, friction and drive
  [[nodiscard]] CardanReactions reactions(double t, const State& state) const {
    const Vector dy = rates(t, to_vector(state));
    const auto [sa, ca] = detail::sin_cos(bearings_.outer.reference, state.alpha);
    const auto [sb, cb] = detail::sin_cos(bearings_.inner.reference, state.beta);
    const auto k = momentum_rates<double, double, double, double, double>(
        turning_at<double>(t), {sa, ca}, {sb, cb}, rotated_rotor<double>(state.phi),
        detail::RingMoments<double>(moments_.inner_ring, 0, 0),
        {state.alpha_rate, state.beta_rate, state.phi_rate, dy[3], dy[4]});
    const double friction = rotor_.friction * state.phi_rate;
    const double on_rotor = regulated ? moments_.rotor.z() * k.dz_2 + k.twist  // phi'' = 0
                                      : spin_torque<double>(t, state.phi_rate);
    const double N_a = k.rotor_a + k.inner_a;
    const double N_c = on_rotor + k.inner_c;
    const double on_outer = -resistance(bearings_.outer, state.alpha, state.alpha_rate);
    const double on_inner = -resistance(bearings_.inner, state.beta, state.beta_rate);
    const double motor = on_rotor + friction;
    return {{-k.rotor_a, -k.rotor_b, -on_rotor},
            {-(cb * N_a + sb * N_c), -on_inner, sb * N_a - cb * N_c},
            {on_outer, k.outer_b + on_inner, k.outer_c - sb * N_a + cb * N_c},
            motor,
            motor * state.phi_rate};
  }

  [[nodiscard]] CardanBalance balance(double t, const State& state) const {
    const auto& [A_1, B_1, C_1] =
        std::array{moments_.rotor[0], moments_.rotor[1], moments_.rotor[2]};
    const auto& J_2 = moments_.inner_ring;
    const auto& J_3 = moments_.outer_ring;
    const auto [sa, ca] = detail::sin_cos(bearings_.outer.reference, state.alpha);
    const auto [sb, cb] = detail::sin_cos(bearings_.inner.reference, state.beta);
    const auto [P, Q, R, W] = rotated_rotor<double>(state.phi);
    const auto [u, du] = turning_at<double>(t);
    const Vector3<double> w_3(state.alpha_rate + u.x, u.y * ca + u.z * sa, u.z * ca - u.y * sa);
    const Vector3<double> w_2(w_3.x() * cb - w_3.z() * sb, w_3.y() + state.beta_rate,
                              w_3.x() * sb + w_3.z() * cb);
    const double spin = w_2.z() + state.phi_rate;
    const Vector3<double> L_1(P * w_2.x() + R * w_2.y(), R * w_2.x() + Q * w_2.y(), C_1 * spin);
    const Vector3<double> L_21 = J_2.cwiseProduct(w_2) + L_1;
    const Vector3<double> L_321 =
        J_3.cwiseProduct(w_3) +
        Vector3<double>(cb * L_21.x() + sb * L_21.z(), L_21.y(), cb * L_21.z() - sb * L_21.x());
    const double kinetic = w_3.dot(J_3.cwiseProduct(w_3)) + w_2.dot(J_2.cwiseProduct(w_2)) +
                           w_2.x() * L_1.x() + w_2.y() * L_1.y() + spin * L_1.z();
    return {
        kinetic / 2, spring_energy(state),
        L_321.x(),   L_21.y(),
        L_1.z(),     {L_321.x(), ca * L_321.y() - sa * L_321.z(), sa * L_321.y() + ca * L_321.z()}};
  }

  /// The conserved quantities of the balance, by name.
  ///
  ///     energy             guide at rest, free rotor, no friction
  ///     energy of rings    guide at rest, regulated symmetric rotor, no friction in the rings:
  ///                        kinetic energy without what phi' adds to it, and springs
  ///     alpha momentum     guide at rest, outer bearing without spring and friction
  ///     rotor momentum     free symmetric rotor without friction, any guide
  ///     Jacobi integral    guide in steady motion, no friction in the rings, rotor free without
  ///                        friction or symmetric and regulated:  T_2 - T_0 + potential
  [[nodiscard]] std::vector<std::pair<const char*, double>> conserved(double t,
                                                                      const State& state) const {
    const CardanBalance all = balance(t, state);
    const auto& [outer, inner] = bearings_;
    const bool rings_free = outer.damping == 0 && inner.damping == 0;
    const bool rotor_free = (std::is_same_v<Rotor, FreeRotor> ||
                             std::is_same_v<Rotor, FrictionlessRotor>)&&rotor_.friction == 0;
    std::vector<std::pair<const char*, double>> kept;
    if constexpr (detail::is_resting<M>) {
      if (rings_free && rotor_free) {
        kept.emplace_back("energy", all.kinetic_energy + all.potential_energy);
      }
      if (rings_free && regulated && symmetric_) {
        State without_spin = state;
        without_spin.phi_rate = 0;
        kept.emplace_back("energy of rings",
                          balance(t, without_spin).kinetic_energy + all.potential_energy);
      }
      if (outer.stiffness == 0 && outer.damping == 0) {
        kept.emplace_back("alpha momentum", all.alpha_momentum);
      }
    }
    if constexpr (SteadyGuide<M> && !detail::is_resting<M>) {
      // T_2 - T_0: the terms quadratic in the rates less the terms without rates.
      if (rings_free && (rotor_free || (regulated && symmetric_))) {
        State back = state, still = state;
        back.alpha_rate = -state.alpha_rate;
        back.beta_rate = -state.beta_rate;
        still.alpha_rate = still.beta_rate = 0;
        if (!regulated) {
          back.phi_rate = -state.phi_rate;
          still.phi_rate = 0;
        }
        const double both = all.kinetic_energy + balance(t, back).kinetic_energy;
        kept.emplace_back("Jacobi integral",
                          both / 2 - 2 * balance(t, still).kinetic_energy + all.potential_energy);
      }
    }
    if (rotor_free && symmetric_) kept.emplace_back("rotor momentum", all.rotor_momentum);
    return kept;
  }

  /// The terms of rates(): see kreisel::terms. H = C_1 u_C1 is the momentum of the spin, i numbers
  /// the bodies.
  [[nodiscard]] Terms terms() const {
    using Apparent =
        decltype(std::declval<const CardanGyro&>().template apparent_turning<double>(0.0));
    constexpr bool turns = !decltype(Apparent::u)::static_zero;
    constexpr bool turns_unsteadily = !decltype(Apparent::du)::static_zero;
    constexpr bool spun = !detail::is_static_zero<
        decltype(std::declval<const CardanGyro&>().template spin_torque<double>(0.0, 0.0))>;
    const std::string of_turning = turns ? "" : "the guide does not turn";
    const std::string of_steadiness = turns && !turns_unsteadily ? "the guide moves steadily" : "";
    const std::string of_drive = regulated ? "the motor keeps phi'" : "FrictionlessRotor";
    Terms list;
    list.add("relative", "u' x (Theta_i u') of rings and rotor, H of the spin in it");
    list.add("relative", "A_1 - B_1, which turns with phi", !symmetric_,
             symmetric_ ? "the rotor is symmetric" : "");
    list.add("guide", "u x (Theta_i u)", turns, of_turning);
    list.add("guide", "Theta_i ou", turns_unsteadily, turns ? of_steadiness : of_turning);
    list.add("guide", "gravity, a of the guide", false,
             "every centre of mass lies where the axes meet");
    list.add("Coriolis", "u' x (Theta_i u) + u x (Theta_i u') + Theta_i (u x u')", turns,
             of_turning);
    list.add("load", "springs and friction of the rings' bearings", !loose_,
             loose_ ? "stiffness and damping are 0" : "");
    list.add("load", "references of the bearings", !plain_,
             plain_ ? "both are 0, and the rotor is symmetric" : "");
    list.add("load", "drive and friction of the rotor", spun && !regulated,
             spun && !regulated ? "" : of_drive);
    return list;
  }

  /// This gyro with one simplification, for prune(). GuideUnsteadiness: the guide moves in its mean
  /// steady motion between two times. GuideRate: the guide is at rest, in any pose. The others: the
  /// mean of A_1 and B_1 for both, and rings without mass.
  [[nodiscard]] CardanGyro<RotatingFrame<>, Rotor> without(GuideUnsteadiness /*what*/, double begin,
                                                           double end) const
      requires(!SteadyGuide<M> && !detail::never_turns<M>) {
    return {moments_, bearings_, mean_motion(guide_, begin, end), rotor_};
  }
  [[nodiscard]] CardanGyro<RestingFrame<>, Rotor> without(GuideRate /*what*/, double /*begin*/,
                                                          double /*end*/) const
      requires(!detail::is_resting<M> && !detail::never_turns<M>) {
    return {moments_, bearings_, RestingFrame<>{}, rotor_};
  }
  [[nodiscard]] CardanGyro without(RotorAsymmetry /*what*/, double /*begin*/,
                                   double /*end*/) const {
    CardanMoments round = moments_;
    round.rotor.x() = round.rotor.y() = (moments_.rotor.x() + moments_.rotor.y()) / 2;
    return {round, bearings_, guide_, rotor_};
  }
  [[nodiscard]] CardanGyro without(RingInertia /*what*/, double /*begin*/, double /*end*/) const {
    return {{moments_.rotor}, bearings_, guide_, rotor_};
  }

 private:
  template <class, class, class>
  friend class CardanGyro;

  using One = CardanGyro<M, Rotor, double>;

  using Gyros = std::array<const One*, std::size_t(detail::lanes_of<Parameter>)>;

  explicit CardanGyro(const Gyros& gyros)
      : moments_{gathered(gyros, [](const One& g) { return g.moments_.rotor; }),
                 gathered(gyros, [](const One& g) { return g.moments_.inner_ring; }),
                 gathered(gyros, [](const One& g) { return g.moments_.outer_ring; })},
        bearings_{gathered_bearing(gyros, &CardanBearings::outer),
                  gathered_bearing(gyros, &CardanBearings::inner)},
        guide_(gyros[0]->guide_),
        rotor_(gyros[0]->rotor_),
        symmetric_(gyros[0]->symmetric_),
        plain_(std::all_of(gyros.begin(), gyros.end(), [](const One* g) { return g->plain_; })),
        loose_(std::all_of(gyros.begin(), gyros.end(), [](const One* g) { return g->loose_; })),
        singular_(gathered(gyros, [](const One& g) { return g.singular_; })) {}

  template <class Get>
  [[nodiscard]] static auto gathered(const Gyros& gyros, const Get& get) {
    return detail::gathered<Parameter>(gyros, get);
  }

  [[nodiscard]] static BasicCardanBearing<Parameter> gathered_bearing(
      const Gyros& gyros, CardanBearing CardanBearings::*which) {
    return {gathered(gyros, [&](const One& g) { return (g.bearings_.*which).stiffness; }),
            gathered(gyros, [&](const One& g) { return (g.bearings_.*which).damping; }),
            gathered(gyros, [&](const One& g) { return (g.bearings_.*which).reference; })};
  }

  static constexpr bool regulated = std::is_same_v<Rotor, RegulatedRotor>;

  template <class... Words>
  [[noreturn]] static void refuse(const Words&... words) {
    std::ostringstream text;
    text.precision(10);
    text << "Cardan gyro: ";
    (text << ... << words);
    throw InvalidInput(text.str());
  }

  static void require_not_negative(const char* what, double value, const char* unit) {
    if (!(value >= 0 && std::isfinite(value))) {
      refuse(what, " = ", value, ' ', unit, " is not a finite number >= 0");
    }
  }

  static void check_bearing(const std::string& name, const CardanBearing& bearing) {
    require_not_negative((name + " bearing: stiffness").c_str(), bearing.stiffness, "N m/rad");
    require_not_negative((name + " bearing: damping").c_str(), bearing.damping, "N m s/rad");
    if (!std::isfinite(bearing.reference)) {
      refuse(name, " bearing: reference = ", bearing.reference, " rad is not finite");
    }
  }

  void check_moments() const {
    const auto check_body = [](const char* name, const Vector3<double>& m) {
      check(Inertia<double>{0, Vector3<double>::Zero(), {m.x(), m.y(), m.z()}}, Mass::zero_allowed,
            name);
    };
    check_body("Cardan gyro, rotor", moments_.rotor);
    check_body("Cardan gyro, inner ring", moments_.inner_ring);
    check_body("Cardan gyro, outer ring", moments_.outer_ring);
    if (!(moments_.rotor.z() > 0)) {
      refuse("C of the rotor = ", moments_.rotor.z(),
             " kg m^2: its rotation about the spin axis is not determined");
    }
    const bool needle = moments_.rotor.x() == 0 || moments_.rotor.y() == 0;
    if (needle && !regulated && moments_.outer_ring.x() == 0 && moments_.inner_ring.isZero(0)) {
      refuse(
          "a rotor with A or B = 0 in rings without mass: the mass matrix is singular at every "
          "angle");
    }
  }

  [[nodiscard]] double spring_energy(const State& s) const {
    return (bearings_.outer.stiffness * s.alpha * s.alpha +
            bearings_.inner.stiffness * s.beta * s.beta) /
           2;
  }

  [[nodiscard]] static bool is_loose(const CardanBearing& bearing) {
    return bearing.stiffness == 0 && bearing.damping == 0;
  }

  /// The resistance of spring and friction; the torque is its negative.
  template <class S>
  [[nodiscard]] static S resistance(const BasicCardanBearing<Parameter>& bearing, const S& q,
                                    const S& dq) {
    return bearing.stiffness * q + bearing.damping * dq;
  }

  /// The torque about C on a rotor that is not regulated: drive and friction.
  template <class S>
  [[nodiscard]] auto spin_torque([[maybe_unused]] const S& t, [[maybe_unused]] const S& df) const {
    if constexpr (std::is_same_v<Rotor, FrictionlessRotor>) {
      return detail::StaticZero{};
    } else if constexpr (std::is_same_v<Rotor, DrivenRotor<double>>) {
      return S(rotor_.torque - S(rotor_.friction * df));
    } else if constexpr (detail::is_driven<Rotor>) {
      return S(rotor_.torque(t, df) - S(rotor_.friction * df));
    } else {
      return S(-S(rotor_.friction * df));
    }
  }

  /// True if the guide itself accepts numbers of type S.
  template <class S>
  static constexpr bool guide_takes = GuideMotion<M, Guide, Inertial, S>;

  template <class S>
  [[nodiscard]] detail::Turning<S, S> turning_at(const S& t) const {
    const auto lifted = [](const auto& turning) {
      return detail::Turning<S, S>{{S(turning.u.x()), S(turning.u.y()), S(turning.u.z())},
                                   {S(turning.du.x()), S(turning.du.y()), S(turning.du.z())}};
    };
    if constexpr (guide_takes<S>) {
      return lifted(turning(guide_, t));
    } else {
      const double time = static_cast<double>(detail::number_in(t));
      detail::Turning<S, S> result = lifted(turning(guide_, time));
      // First order in t - time, which is 0 but for its derivatives.
      const S later = t - time;
      result.u = result.u + later * result.du;
      return result;
    }
  }

  /// The angular velocity and acceleration of the guide that enter the equations: no rate for a
  /// steady guide, nothing for a guide at rest.
  template <class S>
  [[nodiscard]] auto apparent_turning(const S& t) const {
    if constexpr (detail::is_resting<M> || detail::never_turns<M>) {
      return detail::Turning<detail::StaticZero, detail::StaticZero>{};
    } else if constexpr (SteadyGuide<M>) {
      return detail::Turning<S, detail::StaticZero>{{S(steady_.x), S(steady_.y), S(steady_.z)}, {}};
    } else {
      return turning_at<S>(t);
    }
  }

  template <class N, class S>
  [[nodiscard]] detail::RotatedRotor<N> rotated_rotor([[maybe_unused]] const S& phi) const {
    if constexpr (detail::is_static_zero<N>) {
      return {};
    } else {
      using std::cos, std::sin;
      const Parameter A = moments_.rotor.x();
      const Parameter B = moments_.rotor.y();
      const S s = sin(phi);
      const S c = cos(phi);
      const S ss = s * s;
      const S cc = c * c;
      return {S(A * cc + B * ss), S(A * ss + B * cc), S((A - B) * (s * c)),
              S((A - B) * ((c - s) * (c + s)))};
    }
  }

  /// The left sides of the equations of motion.
  ///
  /// Each of G, V, N, D is S or StaticZero. They stand for a guide that turns, a guide that turns
  /// unsteadily, a rotor not added to the inner ring, and given angular accelerations.
  template <class S, class G, class V, class N, class D>
  [[nodiscard]] auto momentum_rates(const detail::Turning<G, V>& guide,
                                    const detail::SinCos<G>& alpha, const detail::SinCos<S>& beta,
                                    const detail::RotatedRotor<N>& rotor,
                                    const detail::RingMoments<Parameter>& inner,
                                    const detail::CardanMotion<S, D>& motion) const {
    using K = detail::Total<G, D>;
    using E = detail::Total<V, D>;
    const auto& [ux, uy, uz] = guide.u;
    const auto& [vx, vy, vz] = guide.du;
    const auto& [sa, ca] = alpha;
    const auto& [sb, cb] = beta;
    const auto& [P, Q, R, W] = rotor;
    const auto& [da, db, df, dda, ddb] = motion;
    const auto& J_3 = moments_.outer_ring;

    // Absolute angular velocities of outer (3) and inner ring (2) on their own axes, and rates. fx
    // and fz are without the contribution of beta' to dx2 and dz2.
    const S x3 = da + ux;
    const G y3 = uy * ca + uz * sa;
    const G z3 = uz * ca - uy * sa;
    const E dx3 = dda + vx;
    const G dy3 = da * z3 + V(vy * ca + vz * sa);
    const G dz3 = V(vz * ca - vy * sa) - da * y3;
    const S x2 = x3 * cb - z3 * sb;
    const S y2 = y3 + db;
    const S z2 = x3 * sb + z3 * cb;
    const K fx = dx3 * cb - dz3 * sb;
    const K fz = dx3 * sb + dz3 * cb;
    const K dy2 = dy3 + ddb;
    const S dz2 = fz + db * x2;

    // A symmetric rotor that is added to the ring leaves only the momentum of its spin. If C is
    // added as well, only the momentum against the ring is left.
    constexpr bool counted = detail::is_static_zero<N>;
    using Spin = std::conditional_t<counted, S, detail::StaticZero>;
    const S L_c = moments_.rotor.z() * S(counted && regulated ? df : S(z2 + df));
    const Spin H = detail::kept<Spin>(L_c);
    detail::CardanRates<S, K, N> k;
    k.outer_a = J_3.x() * dx3 + outer_[0] * G(y3 * z3);
    k.outer_b = J_3.y() * dy3 + outer_[1] * G(z3 * x3);
    k.outer_c = J_3.z() * dz3 + outer_[2] * G(x3 * y3);
    k.inner_a = inner.a * K(fx + y3 * z2) + y2 * S(inner.c_less_ab * z2 + H);
    k.inner_b = inner.b * dy2 + x2 * S(inner.a_less_c * z2 - H);
    k.inner_c = inner.c * K(fz - y3 * x2) + inner.bc_less_a * S(x2 * y2);
    if constexpr (!counted) {
      const S dx2 = fx - db * z2;
      const S L_a = P * x2 + R * y2;
      const S L_b = Q * y2 + R * x2;
      k.rotor_a = P * dx2 + R * dy2 + df * (W * y2 - 2.0 * (R * x2)) + (y2 * L_c - z2 * L_b);
      k.rotor_b = Q * dy2 + R * dx2 + df * (W * x2 + 2.0 * (R * y2)) + (z2 * L_a - x2 * L_c);
      k.twist = R * S((x2 - y2) * (x2 + y2)) - W * S(x2 * y2);
    }
    k.dz_2 = dz2;
    return k;
  }

  /// N is S, or StaticZero if the rotor is symmetric. Reference is StaticZero if the bearings have
  /// no references, Torque if they have neither springs nor friction.
  template <class N, class Reference, class Torque, class S>
  [[nodiscard]] Eigen::Matrix<S, 6, 1> rates_of(const S& t, const Eigen::Matrix<S, 6, 1>& y) const {
    constexpr bool round = detail::is_static_zero<N>;
    const Parameter A_1 = moments_.rotor.x();
    const Parameter B_1 = moments_.rotor.y();
    const Parameter C_1 = moments_.rotor.z();
    const Parameter A_3 = moments_.outer_ring.x();
    const detail::RingMoments<Parameter>& inner = round ? counted_ring_ : bare_ring_;

    const auto guide = apparent_turning<S>(t);
    using G = std::decay_t<decltype(guide.u.x)>;
    using V = std::decay_t<decltype(guide.du.x)>;
    detail::SinCos<G> alpha;
    if constexpr (!detail::is_static_zero<G>) {
      alpha = detail::sin_cos(detail::kept<Reference>(bearings_.outer.reference), y[0]);
    }
    const detail::SinCos<S> beta =
        detail::sin_cos(detail::kept<Reference>(bearings_.inner.reference), y[1]);
    const auto& [sb, cb] = beta;
    const detail::RotatedRotor<N> rotor = rotated_rotor<N>(y[2]);
    const auto& [P, Q, R, W] = rotor;
    const auto k = momentum_rates<S, G, V, N, detail::StaticZero>(guide, alpha, beta, rotor, inner,
                                                                  {y[3], y[4], y[5]});

    // The rotor's torque about C replaces C_1 (dz_2 + phi''), or phi'' = 0 does.
    const auto on_rotor = [&] {
      if constexpr (!regulated) {
        return spin_torque<S>(t, y[5]);
      } else if constexpr (round) {
        return detail::StaticZero{};
      } else {
        return S(C_1 * k.dz_2 + k.twist);
      }
    }();
    const auto resisted = [](const auto& bearing, const S& q, const S& dq) {
      if constexpr (detail::is_static_zero<Torque>) {
        return detail::StaticZero{};
      } else {
        return resistance(bearing, q, dq);
      }
    };
    const S left_a = resisted(bearings_.outer, y[0], y[3]) +
                     S(S(cb * S(k.rotor_a + k.inner_a) + sb * S(on_rotor + k.inner_c)) + k.outer_a);
    const S left_b = resisted(bearings_.inner, y[1], y[4]) + S(k.rotor_b + k.inner_b);
    const S across = A_3 + carried_ * S(sb * sb);
    const S cc = cb * cb;
    using detail::any;  // lanes of a pack stop together
    const auto stop = [&] {
      detail::stop_where_singular(moments_, regulated, bearings_.inner.reference, y[1]);
    };
    S dda;
    S ddb;
    if constexpr (round) {
      const S M_aa = across + cc * inner.a;
      if (any(M_aa <= singular_)) stop();
      dda = -left_a / M_aa;
      ddb = -left_b / inner.b;
    } else {
      const S M_aa = across + cc * S(inner.a + P);
      const S M_bb = inner.b + Q;
      const S det = across * M_bb + cc * S(inner.a * M_bb + inner.b * P + A_1 * B_1);
      if (any(det <= singular_)) stop();
      const S M_ab = R * cb;
      dda = (M_ab * left_b - M_bb * left_a) / det;
      ddb = (M_ab * left_a - M_aa * left_b) / det;
    }
    S ddf(0);
    if constexpr (!regulated) ddf = (on_rotor - k.twist) / C_1 - S(k.dz_2 + sb * dda);
    return detail::gathered<S>(y[3], y[4], y[5], dda, ddb, ddf);
  }

  /// Out of line, so that the plain cases can be inlined.
  template <class S>
  [[nodiscard]] EIGEN_DONT_INLINE Eigen::Matrix<S, 6, 1> less_plain_rates(
      const S& t, const Eigen::Matrix<S, 6, 1>& y) const {
    if (symmetric_) return rates_of<detail::StaticZero, Parameter, Parameter>(t, y);
    return rates_of<S, Parameter, Parameter>(t, y);
  }

  /// The bound below which the determinant (for a symmetric rotor: its factor M_aa) counts as 0.
  /// Its only error is rounding. It becomes meaningless through the rounding of beta, where cos^2
  /// beta alone keeps it from 0. NaN is not below the bound; steps become shorter at NaN.
  [[nodiscard]] double singular() const {
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const auto& [rotor, inner, outer] = moments_;
    const double most = std::max(rotor.x(), rotor.y());
    const double about_a = outer.x() + inner.x() + most;  // C_2 <= A_2 + B_2
    return 64 * eps * eps * about_a * (symmetric_ ? 1 : inner.y() + most);
  }

  /// The moment of inertia that turns with the inner ring about C.
  [[nodiscard]] Parameter carried() const {
    if constexpr (regulated) return moments_.inner_ring.z() + moments_.rotor.z();
    return moments_.inner_ring.z();
  }

  BasicCardanMoments<Parameter> moments_;
  BasicCardanBearings<Parameter> bearings_;
  M guide_;
  [[no_unique_address]] Rotor rotor_;
  bool symmetric_;
  bool plain_;  ///< symmetric, and no reference of a bearing but 0
  bool loose_;  ///< and neither springs nor friction in the rings' bearings
  Parameter carried_ = carried();
  detail::RingMoments<Parameter> bare_ring_{moments_.inner_ring, Parameter(0), Parameter(0)};
  detail::RingMoments<Parameter> counted_ring_{moments_.inner_ring, moments_.rotor.x(),
                                               regulated ? moments_.rotor.z() : Parameter(0)};
  Vector3<Parameter> outer_{moments_.outer_ring.z() - moments_.outer_ring.y(),
                            moments_.outer_ring.x() - moments_.outer_ring.z(),
                            moments_.outer_ring.y() - moments_.outer_ring.x()};
  Parameter singular_;
  detail::SteadyRate<M> steady_ = detail::steady_rate(guide_);
};

static_assert(Scene<CardanGyro<RestingFrame<>>> && HasStiffness<CardanGyro<RestingFrame<>>>);

}  // namespace kreisel
