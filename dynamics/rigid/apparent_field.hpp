#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/series.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/model/dual_numbers.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <motor/static_zero.hpp>

/// The apparent motion of the guide in a body's equations, on guide axes: angular velocity, angular
/// acceleration and apparent gravity. Only terms that are needed are computed; those of a steady
/// motion are computed once.

namespace kreisel::detail {

/// u and ou of the guide, and g' = g - a: uniform gravity less the inertial acceleration of a
/// guide-fixed point.
template <class U, class Du, class G>
struct Apparent {
  U u;
  Du du;
  G g;
};

template <class L>
inline constexpr bool is_without = false;
template <class Quantity, Axis... axes>
inline constexpr bool is_without<Without<Quantity, axes...>> = true;

/// True if a load is a field of gravity that is uniform in the guide or in the inertial frame.
template <class L>
inline constexpr bool is_field =
    std::is_same_v<L, UniformGravity<Guide>> || std::is_same_v<L, UniformGravity<Inertial>>;

/// True if a load is a function of a LoadContext.
template <class L>
inline constexpr bool is_force = !is_field<L> && !is_without<L>;

template <class L>
[[nodiscard]] constexpr bool reads_guide() {
  if constexpr (requires { L::ignores_guide; }) {
    return is_force<L> && !L::ignores_guide;
  } else {
    return is_force<L>;
  }
}

/// True if only uniform gravity acts on a body, and its guide moves steadily or analytically.
template <class M, class... Loads>
inline constexpr bool feels_analytically = (SteadyGuide<M> ||
                                            AnalyticGuide<M>)&&!(is_force<Loads> || ...);

template <class A, class... Loads>
inline constexpr bool has_field = (std::is_same_v<Loads, UniformGravity<A>> || ...);

/// The sum of the gravity fields that are uniform on the axes of A.
template <class A, class... Loads>
[[nodiscard]] auto field_on(const Loads&... loads) {
  if constexpr (has_field<A, Loads...>) {
    Vector3<double> sum = Vector3<double>::Zero();
    const auto add = [&sum](const auto& load) {
      if constexpr (std::is_same_v<std::decay_t<decltype(load)>, UniformGravity<A>>) sum += load.g;
    };
    (add(loads), ...);
    return components(sum);
  } else {
    return ZeroVector{};
  }
}

/// The inertial acceleration of the guide-fixed point r, where a is that of the guide's origin.
template <class U, class Du, class A, class R>
[[nodiscard]] auto carried_acceleration(const U& u, const Du& du, const A& a, const R& r) {
  return a + cross(du, r) + cross(u, cross(u, r));
}

/// u/|u|, or 0, also where squares would overflow or underflow. Eigen's function takes longer to
/// compile than the rest of this file.
[[nodiscard]] inline Components<double> direction(const Components<double>& u) {
  const double size = std::hypot(u.x, u.y, u.z);
  return size > 0 ? u / size : Components<double>{};
}

/// A vector at rest in the inertial frame, on the axes of a guide that turns steadily. With u = |u|
/// n:
///
///   exp(-u t) g = n n.g + cos(|u| t) (g - n n.g) + sin(|u| t) g x n
struct TurningField {
  Components<double> across;
  Components<double> aside;
  double rate;

  /// `along` is the component of g along u, which does not turn.
  TurningField(const Components<double>& g, const Components<double>& along,
               const Components<double>& u)
      : across(g - along), aside(cross(g, direction(u))), rate(std::hypot(u.x, u.y, u.z)) {}

  template <class N>
  [[nodiscard]] Components<N> at(const N& t) const {
    using std::cos, std::sin;
    const N angle = rate * t;
    return N(cos(angle)) * across + N(sin(angle)) * aside;
  }

  /// Adds the coefficients below `order`, in powers of (time - t)/h.
  void add_series(double t, double h, int order, GuideSeries::Coefficients& g) const {
    const double c = std::cos(rate * t);
    const double s = std::sin(rate * t);
    const double cycle[] = {c, -s, -c, s};
    double factor = 1;  // (|u| h)^n / n!
    for (int n = 0; n < order; ++n) {
      g[std::size_t(n)] = g[std::size_t(n)] + (factor * cycle[n % 4]) * across +
                          (factor * cycle[(n + 3) % 4]) * aside;
      factor *= rate * h / (n + 1);
    }
  }
};

/// The constants of g' and of the field that turns in the guide.
template <class U, class G, class Field>
struct Known {
  U u;
  G g;
  Field field;
};

/// The series of a field that turns in the guide.
template <class U, class G>
struct TurningSeries {
  Known<U, G, TurningField> known;

  [[nodiscard]] GuideSeries at(double t, double h, int order) const {
    GuideSeries s;
    s.u[0] = components(vector<double>(known.u));
    s.g[0] = components(vector<double>(known.g));
    known.field.add_series(t, h, order, s.g);
    return s;
  }
};
template <class U, class G>
TurningSeries(Known<U, G, TurningField>) -> TurningSeries<U, G>;

struct Nothing {};

template <class... Loads>
inline constexpr bool restricts_apparent_gravity = (vanishes<ApparentGravity, Axis::x, Loads...> ||
                                                    vanishes<ApparentGravity, Axis::y, Loads...> ||
                                                    vanishes<ApparentGravity, Axis::z, Loads...>);

template <class... Loads>
inline constexpr bool restricts_guide_rate = (vanishes<GuideRate, Axis::x, Loads...> ||
                                              vanishes<GuideRate, Axis::y, Loads...> ||
                                              vanishes<GuideRate, Axis::z, Loads...>);

/// Throws : InvalidInput if components that Without<> declares zero are not zero
template <bool gravity, class P, class M, class... Loads>
[[nodiscard]] auto known_motion(const P& r, const M& guide, const std::string& what,
                                const Loads&... loads) {
  if constexpr (!SteadyGuide<M>) {
    static_assert(!restricts_guide_rate<Loads...> && !restricts_apparent_gravity<Loads...>,
                  "Without<GuideRate> and Without<ApparentGravity> take a guide in steady motion");
    return Nothing{};
  } else {
    const auto motion = guide.steady();
    check_vanishing<GuideRate, Loads...>(vector<double>(motion.u), what + ", rate of the guide");
    const auto u = without<GuideRate, Loads...>(motion.u);
    using U = std::remove_const_t<decltype(u)>;
    if constexpr (!gravity) {
      return Known<U, ZeroVector, Nothing>{u, {}, {}};
    } else {
      const auto carried = carried_acceleration(u, ZeroVector{}, motion.origin_acceleration, r);
      const auto in_guide = field_on<Guide>(loads...) - carried;
      const auto inertial = rotated_back(Rotation<double>::from(guide(0).X.value.rotation),
                                         field_on<Inertial>(loads...));
      if constexpr (has_field<Inertial, Loads...> && !U::static_zero) {
        static_assert(!restricts_apparent_gravity<Loads...>,
                      "gravity that rests in the inertial frame turns in this guide");
        const Components<double> n = direction(components(vector<double>(u)));
        const Components<double> all = components(vector<double>(inertial));
        const bool turns = n.x != 0 || n.y != 0 || n.z != 0;
        const Components<double> along =
            turns ? (all.x * n.x + all.y * n.y + all.z * n.z) * n : all;
        return Known<U, Components<double>, TurningField>{
            u, in_guide + along, TurningField(all, along, components(vector<double>(u)))};
      } else {
        const auto all = in_guide + inertial;
        check_vanishing<ApparentGravity, Loads...>(vector<double>(all),
                                                   what + ", apparent gravity");
        const auto g = without<ApparentGravity, Loads...>(all);
        return Known<U, std::remove_const_t<decltype(g)>, Nothing>{u, g, {}};
      }
    }
  }
}

/// The Taylor series of u and g' of an analytic guide.
///
/// A guide mostly moves more slowly than the bodies on it. One series of its motion therefore
/// serves several steps of the body, shifted to the begin of each step.
template <class M, class P, class InGuide, class InInertial>
class ApparentSeries {
 public:
  ApparentSeries(const M& guide, const P& r, const InGuide& field, const InInertial& inertial_field)
      : guide_(guide), r_(r), field_(field), inertial_field_(inertial_field) {}

  [[nodiscard]] GuideSeries at(double t, double h, int order) {
    // In a much shorter unit the coefficients underflow, and the factors that shift them overflow.
    constexpr double farthest = 1e4;  // to the power of most_series_order it is finite
    const double ahead = std::abs(t - begin_) + 1.25 * std::abs(h);
    if (!(ahead < reach_) || std::abs(h) > farthest * unit_) expand(t, h);
    return shifted(series_, (t - begin_) / unit_, h / unit_, order);
  }

 private:
  void expand(double t, double h) {
    begin_ = t;
    unit_ = std::abs(h);
    series_ =
        guide_.series(t, unit_, most_series_order, components(vector<double>(inertial_field_)));
    series_.g[0] = series_.g[0] + field_;
    if constexpr (!P::static_zero) take_off_carried();
    reach_ = unit_ * std::min(reached(series_.u, most_series_order),
                              reached(series_.g, most_series_order - 1));
  }

  /// Subtracts the acceleration of r relative to the guide's origin.
  void take_off_carried() {
    GuideSeries::Coefficients around;  // u x r
    for (std::size_t k = 0; k < around.size(); ++k) around[k] = cross(series_.u[k], r_);
    for (std::size_t k = 0; k + 1 < around.size(); ++k) {
      Components<double> carried = (double(k + 1) / unit_) * around[k + 1];
      for (std::size_t i = 0; i <= k; ++i) carried = carried + cross(series_.u[i], around[k - i]);
      series_.g[k] = series_.g[k] - carried;
    }
    series_.g.back() = {};
  }

  M guide_;
  P r_;
  InGuide field_;
  InInertial inertial_field_;
  GuideSeries series_ = {};
  double begin_ = 0;
  double unit_ = 1;
  double reach_ = 0;  ///< s, of the series from where it begins
};

/// The apparent motion of a guide M at the guide-fixed point r, for a body with these loads.
///
/// P is ZeroVector if r is the guide's origin. Without `gravity` g' is StaticZero: it has no effect
/// on a body whose fixed point is its centre of mass.
template <bool gravity, class P, class M, class... Loads>
class ApparentField {
 public:
  ApparentField(const P& r, const M& guide, const std::string& what, const Loads&... loads)
      : r_(r), known_(known_motion<gravity>(r, guide, what, loads...)) {}

  /// The whole apparent motion of a guide that moves steadily or analytically, for AttitudeSeries.
  [[nodiscard]] auto whole(const M& guide, const Loads&... loads) const {
    if constexpr (requires { known_.field.at(0.0); }) {
      return TurningSeries{known_};
    } else if constexpr (SteadyGuide<M>) {
      return known_;
    } else {
      const auto in_guide = field_on<Guide>(loads...);
      const auto inertial = field_on<Inertial>(loads...);
      return ApparentSeries(guide, r_, in_guide, inertial);
    }
  }

  template <class N>
  [[nodiscard]] auto at(const M& guide, const N& t, const Loads&... loads) const {
    if constexpr (requires { known_.field.at(t); }) {
      return apparent(known_.u, ZeroVector{}, known_.g + known_.field.at(t));
    } else if constexpr (SteadyGuide<M>) {
      return apparent(known_.u, ZeroVector{}, known_.g);
    } else if constexpr (!gravity && never_turns<M>) {
      return apparent(ZeroVector{}, ZeroVector{}, ZeroVector{});
    } else if constexpr (!gravity && std::is_same_v<N, double>) {
      const FrameTurning<N> now = turning(guide, t);
      return apparent(components(now.u), components(now.du), ZeroVector{});
    } else {
      return in(guide_at<N>(guide, t), loads...);
    }
  }

  /// The apparent motion from the whole motion of the guide.
  template <class N>
  [[nodiscard]] auto in(const FrameMotion<Guide, Inertial, N>& now, const Loads&... loads) const {
    if constexpr (never_turns<M>) {
      return in(now, ZeroVector{}, ZeroVector{}, Vector3<N>(now.dV.value.moment), loads...);
    } else {
      return in(now, components(now.V.value.resultant), components(now.dV.value.resultant),
                now.origin_acceleration(), loads...);
    }
  }

 private:
  using KnownMotion =
      decltype(known_motion<gravity>(std::declval<const P&>(), std::declval<const M&>(),
                                     std::string(), std::declval<const Loads&>()...));

  /// `a` is the inertial acceleration of the guide's origin.
  template <class N, class U>
  [[nodiscard]] auto in(const FrameMotion<Guide, Inertial, N>& now, const U& u, const U& du,
                        const Vector3<N>& a, const Loads&... loads) const {
    if constexpr (gravity) {
      const auto g =
          field_on<Guide>(loads...) +
          rotated_back(Rotation<N>::from(now.X.value.rotation), field_on<Inertial>(loads...)) -
          carried_acceleration(u, du, components(a), r_);
      return apparent(u, du, g);
    } else {
      return apparent(u, du, ZeroVector{});
    }
  }

  template <class U, class Du, class G>
  [[nodiscard]] static Apparent<U, Du, G> apparent(const U& u, const Du& du, const G& g) {
    return {u, du, g};
  }

  P r_;
  KnownMotion known_;
};

/// The series of the apparent motion at the origin of a guide that moves steadily or analytically,
/// as the concept AnalyticGuide requires it.
template <class M>
[[nodiscard]] GuideSeries series_of(const M& guide, double t, double h, int order,
                                    const Components<double>& g) {
  if constexpr (AnalyticGuide<M>) {
    return guide.series(t, h, order, g);
  } else {
    const UniformGravity<Inertial> field{vector<double>(g)};
    const ApparentField<true, ZeroVector, M, UniformGravity<Inertial>> apparent({}, guide, "guide",
                                                                                field);
    const auto whole = apparent.whole(guide, field);
    if constexpr (requires { whole.at(t, h, order); }) {
      return whole.at(t, h, order);
    } else {
      GuideSeries steady;
      steady.u[0] = components(vector<double>(whole.u));
      steady.g[0] = components(vector<double>(whole.g));
      return steady;
    }
  }
}

/// The sum of the loads that are neither a gravity field nor a Without<>.
template <class N, class... Loads>
[[nodiscard]] Force<Body, N> forces(const LoadContext<N>& s, const Loads&... loads) {
  Force<Body, N> sum;
  const auto add = [&](const auto& load) {
    if constexpr (is_force<std::decay_t<decltype(load)>>) sum = sum + load(s);
  };
  (add(loads), ...);
  return sum;
}

/// The loads that are not of the type L.
template <class L, class... Loads>
[[nodiscard]] auto other_loads(const std::tuple<Loads...>& all) {
  const auto other = [](const auto& load) {
    if constexpr (std::is_same_v<std::decay_t<decltype(load)>, L>) {
      return std::tuple();
    } else {
      return std::tuple(load);
    }
  };
  return std::apply([&](const auto&... loads) { return std::tuple_cat(other(loads)...); }, all);
}

/// True if a guide turns, as far as its type shows.
template <class M>
[[nodiscard]] constexpr bool turns() {
  if constexpr (SteadyGuide<M>) {
    return !decltype(std::declval<const M&>().steady().u)::static_zero;
  } else {
    return !never_turns<M>;
  }
}

template <class L>
[[nodiscard]] const char* kind_of() {
  if constexpr (requires { L::kind; }) {
    return L::kind;
  } else {
    return "load";
  }
}

/// The terms of the guide in a body's equations: turning, angular acceleration and g'. The type of
/// the apparent motion decides; missing terms have a reason.
template <class Now, class M, class... Loads>
struct ApparentTerms {
  static constexpr bool turns = !decltype(Now::u)::static_zero;
  static constexpr bool turns_unsteadily = !decltype(Now::du)::static_zero;
  static constexpr bool pulled = !decltype(Now::g)::static_zero;

  [[nodiscard]] static std::string of_turning() {
    const std::string said = reason_for<GuideRate, Loads...>();
    return turns || !said.empty() ? said : "the guide does not turn";
  }

  [[nodiscard]] static std::string of_unsteadiness() {
    if (turns_unsteadily) return {};
    return turns ? "the guide moves steadily" : of_turning();
  }

  [[nodiscard]] static std::string of_gravity() {
    const std::string said = reason_for<ApparentGravity, Loads...>();
    return pulled || !said.empty() ? said : "no gravity, and the guide does not accelerate";
  }

  /// Adds the loads to the terms; uniform gravity counts only if `gravity_matters`.
  static void add_loads(Terms& terms, bool gravity_matters, const std::string& why) {
    [[maybe_unused]] const auto add = [&](const char* kind, bool force, bool field) {
      if (force) terms.add("load", kind);
      if (field) terms.add("load", kind, gravity_matters, why);
    };
    (add(kind_of<Loads>(), is_force<Loads>, is_field<Loads>), ...);
  }
};

}  // namespace kreisel::detail
