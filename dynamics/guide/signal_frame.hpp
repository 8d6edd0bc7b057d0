#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <type_traits>
#include <utility>

#include <dynamics/guide/analytic.hpp>
#include <dynamics/signal/signal.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace detail {

/// The value of a signal at a time in double, in dual numbers, or as a series.
template <class Value, class T>
[[nodiscard]] SignalValue<Value, T> value_at(const Signal<Value>& signal, const T& t) {
  if constexpr (std::is_same_v<T, PowerSeries>) {
    std::array<Value, PowerSeries::most_order + 1> c;
    const auto places = static_cast<std::size_t>(t.order()) + 1;
    signal.coefficients(t[0], t[1], std::span(c).first(places));
    if constexpr (std::is_same_v<Value, double>) {
      return PowerSeries::of(t.order(), [&c](std::size_t k) { return c[k]; });
    } else {
      Vector3<PowerSeries> result;
      for (int i = 0; i < 3; ++i) {
        result[i] = PowerSeries::of(t.order(), [&c, i](std::size_t k) { return c[k][i]; });
      }
      return result;
    }
  } else {
    return signal(t);
  }
}

}  // namespace detail

/// Position and attitude as signals: a rotation about z by the yaw, about the new y by the pitch,
/// about the new x by the roll.
///
/// Frame  : position of the origin on the axes of the parent frame
/// Units  : metre, radian
struct PoseSignals {
  Signal<Vector3<double>> position = {};
  Signal<double> yaw = {};
  Signal<double> pitch = {};
  Signal<double> roll = {};

  [[nodiscard]] bool is_constant() const {
    return position.is_constant() && yaw.is_constant() && pitch.is_constant() && roll.is_constant();
  }

  /// True if no value and no rate jumps.
  [[nodiscard]] bool is_smooth() const {
    return position.is_smooth() && yaw.is_smooth() && pitch.is_smooth() && roll.is_smooth();
  }

  /// True if the Taylor series hold at all times.
  [[nodiscard]] bool is_analytic() const {
    return position.is_analytic() && yaw.is_analytic() && pitch.is_analytic() && roll.is_analytic();
  }

  template <class T>
  [[nodiscard]] Pose<T> operator()(const T& t) const {
    using detail::value_at;
    const YawPitchRoll<T> angles{value_at(yaw, t), value_at(pitch, t), value_at(roll, t)};
    return {angles.rotation(), value_at(position, t)};
  }
};

/// A frame whose pose is a function of time. Velocity and acceleration are exact derivatives, and
/// the Taylor series is available.
///
/// No rate of a signal may jump: a jump needs an infinite force, and bodies on the frame would get
/// an impulse.
///
/// Source : R^t R' = skew(u), as AnalyticFrame
/// Units  : metre, rad/s, m/s^2, second
/// Error  : as PosedFrame and Signal
/// Throws : InvalidInput if a signal or its rate jumps
template <class G = Guide, class I = Inertial>
class SignalFrame {
 public:
  explicit SignalFrame(PoseSignals pose) : pose_(std::move(pose)) {
    if (pose_.is_smooth()) return;
    throw InvalidInput(
        "signal frame: the velocity of position or angles jumps, which takes an infinite force");
  }

  /// The motion in double, or in dual numbers.
  template <class S>
  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    return PosedFrame<Pointed, G, I, S>(std::cref(pose_))(t);
  }

  /// The series of u and g', as AnalyticGuide requires. The pose must be analytic.
  [[nodiscard]] GuideSeries series(double t, double h, int order,
                                   const detail::Components<double>& g) const {
    return AnalyticFrame<Pointed, G, I>(std::cref(pose_)).series(t, h, order, g);
  }

 private:
  using Pointed = std::reference_wrapper<const PoseSignals>;

  PoseSignals pose_;
};

}  // namespace kreisel
