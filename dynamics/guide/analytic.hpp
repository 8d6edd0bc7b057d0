#pragma once

#include <utility>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/power_series.hpp>
#include <dynamics/guide/series.hpp>

namespace kreisel {

/// A frame whose pose is an analytic function of time that the user writes, as for PosedFrame.
///
/// The user promises that the function is analytic at all times and changes no faster than the
/// bodies on the guide. It has no distinction of cases and no short pulse. solve() then uses the
/// Taylor series of the function and the motion together. Such a series evaluates the function only
/// where a step begins.
///
/// The function is also called with PowerSeries, for which sine, cosine, tangent, exponential,
/// hyperbolic functions, logarithm, roots and powers are defined.
///
/// Source : R^t R' = skew(u);  R^t (g - x'') is the apparent gravity of a body at the origin
/// Units  : metre, rad/s, m/s^2, second
/// Error  : as PosedFrame; of the summed series <= 40u * 10 m/s^2 (tests/dynamics/guide/analytic)
template <class Function, class G = Guide, class I = Inertial>
class AnalyticFrame {
 public:
  explicit AnalyticFrame(Function pose) : posed_(std::move(pose)) {}

  [[nodiscard]] FrameMotion<G, I> operator()(double t) const { return posed_(t); }

  /// The series that the concept AnalyticGuide requires.
  [[nodiscard]] GuideSeries series(double t, double h, int order,
                                   const detail::Components<double>& g) const {
    const Pose<PowerSeries> pose = posed_.function()(PowerSeries::time(t, h, order + 1));
    const auto rotated_back = [&pose](int k, const auto& x, const auto& y, const auto& z) {
      const Matrix3<PowerSeries>& R = pose.rotation;
      return R(0, k) * x + R(1, k) * y + R(2, k) * z;
    };
    const auto turning = [&](int k, int i) {
      const Matrix3<PowerSeries>& R = pose.rotation;
      return rotated_back(k, R(0, i).derivative(h), R(1, i).derivative(h), R(2, i).derivative(h));
    };
    const PowerSeries u[] = {turning(2, 1), turning(0, 2), turning(1, 0)};
    const auto apparent = [&](double along, int i) {
      return along - pose.translation[i].derivative(h).derivative(h);
    };
    const PowerSeries x = apparent(g.x, 0), y = apparent(g.y, 1), z = apparent(g.z, 2);
    const PowerSeries f[] = {rotated_back(0, x, y, z), rotated_back(1, x, y, z),
                             rotated_back(2, x, y, z)};
    GuideSeries result;
    for (int k = 0; k <= order; ++k) {
      const auto at = static_cast<std::size_t>(k);
      result.u[at] = {u[0][k], u[1][k], u[2][k]};
      result.g[at] = {f[0][k], f[1][k], f[2][k]};
    }
    return result;
  }

 private:
  PosedFrame<Function, G, I> posed_;
};

/// The frame G whose pose in I is the given analytic function.
template <class G = Guide, class I = Inertial, class Function>
[[nodiscard]] AnalyticFrame<Function, G, I> analytic(Function pose) {
  return AnalyticFrame<Function, G, I>(std::move(pose));
}

}  // namespace kreisel
