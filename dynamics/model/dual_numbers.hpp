#pragma once

#include <Eigen/Core>

#include <type_traits>

#include <dynamics/guide/motion.hpp>
#include <dynamics/inertia.hpp>
#include <dynamics/load/load.hpp>
#include <motor/error.hpp>
#include <motor/lanes.hpp>

/// The functions that run a scene of doubles on other numbers: dual numbers (Eigen's
/// AutoDiffScalar) and packs.

namespace kreisel::detail {

template <class S>
[[nodiscard]] Inertia<S> lifted(const Inertia<>& T) {
  const Symmetric3<>& t = T.tensor;
  return {S(T.mass),
          T.first_moment.template cast<S>(),
          {S(t.xx), S(t.yy), S(t.zz), S(t.xy), S(t.xz), S(t.yz)}};
}

/// The derivative of a function of time by differences of step h. The differences are central, or
/// one-sided at the end of the interval in which the function is defined. Their error is up to h^4
/// / 5 of the fifth derivative, plus rounding, u/h of the value.
///
/// Throws : the function's exception, where it is defined on neither side
template <class F>
[[nodiscard]] auto slope_in_time(const F& f, double t) {
  using Value = std::decay_t<decltype(f(t))>;
  constexpr double h = 0x1p-10;
  const auto off = [&](double step) { return Value(f(t + step) - f(t - step)); };
  const auto ahead = [&](double step) {
    const Value begin = f(t);
    const auto away = [&](int steps) { return Value(f(t + steps * step) - begin); };
    const Value odd = 48 * away(1) + 16 * away(3);
    return Value((odd - (36 * away(2) + 3 * away(4))) / (12 * step));
  };
  try {
    return Value((8 * off(h) - off(2 * h)) / (12 * h));
  } catch (const InvalidInput&) {  // outside of its time
  }
  try {
    return ahead(h);
  } catch (const InvalidInput&) {
  }
  return ahead(-h);
}

/// The motion of a guide at a dual time. If the guide takes only doubles, pose and velocity are
/// exact to first order. The rates of ou and of the acceleration of the origin, on the guide's own
/// axes, are then differences if the time has a derivative.
template <class S, class M>
[[nodiscard]] FrameMotion<Guide, Inertial, S> guide_at(const M& guide, const S& t) {
  if constexpr (GuideMotion<M, Guide, Inertial, S>) {
    return guide(t);
  } else {
    const double time = number_in(t);
    const FrameMotion<Guide, Inertial> now = guide(time);
    const S later = t - time;  // 0 but for its derivatives
    const Matrix3<double>& R = now.X.value.rotation;
    const Matrix3<double> turning = R * skew(now.V.value.resultant);
    Motor<> jerk;
    if constexpr (!is_pack<S>) {  // whose lanes share the time
      if (!later.derivatives().isZero(0)) {
        const auto accelerations = [&guide](double at) -> Motor<> {
          const FrameMotion<Guide, Inertial> then = guide(at);
          return {then.dV.value.resultant, then.origin_acceleration()};
        };
        jerk = slope_in_time(accelerations, time);
      }
    }
    const auto moved = [&later](const auto& value, const auto& rate) {
      return (value.template cast<S>() + later * rate.template cast<S>()).eval();
    };
    const Vector3<double> shift = R * now.V.value.moment;
    FrameMotion<Guide, Inertial, S> result;
    result.X.value = {moved(R, turning), moved(now.X.value.translation, shift)};
    result.V.value = {moved(now.V.value.resultant, now.dV.value.resultant),
                      moved(now.V.value.moment, now.dV.value.moment)};
    const auto& [u, v] = result.V.value;
    result.dV.value = {moved(now.dV.value.resultant, jerk.resultant),
                       moved(now.origin_acceleration(), jerk.moment) - u.cross(v)};
    return result;
  }
}

/// The linear map of doubles `map`, applied to a vector of other numbers.
template <class Map, class S, int n>
[[nodiscard]] Eigen::Matrix<S, n, 1> mapped(const Map& map, const Eigen::Matrix<S, n, 1>& x) {
  using Numbers = Eigen::Matrix<double, n, 1>;
  if constexpr (std::is_same_v<S, double>) {
    return map(x);
  } else if constexpr (is_pack<S>) {
    Eigen::Matrix<S, n, 1> result;
    for (int k = 0; k < S::lanes; ++k) {
      Numbers part;
      for (int i = 0; i < n; ++i) part[i] = x[i].lane(k);
      const Numbers image = map(part);
      for (int i = 0; i < n; ++i) result[i].set_lane(k, image[i]);
    }
    return result;
  } else {
    Numbers part;
    for (int i = 0; i < n; ++i) part[i] = x[i].value();
    Eigen::Matrix<S, n, 1> result = Numbers(map(part)).template cast<S>();
    for (Eigen::Index k = 0; k < x[0].derivatives().size(); ++k) {
      for (int i = 0; i < n; ++i) part[i] = x[i].derivatives()[k];
      const Numbers along = map(part);
      for (int i = 0; i < n; ++i) result[i].derivatives()[k] = along[i];
    }
    return result;
  }
}

}  // namespace kreisel::detail
