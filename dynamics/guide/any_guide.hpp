#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <utility>

#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/series.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A guide motion of any kind, which is chosen at run time: a value that can be a plain member, stand in
/// a container, and be given another motion.
///
///   struct Vehicle {
///     AnyGuide guide = RestingFrame<>{};
///   };
///   vehicle.guide = RotatingFrame<>{.angular_velocity = {0, 0, 0.1}};
///   const BodySystem system(vehicle.guide, bodies);
///
/// Numbers are those of the motion itself to the last bit. Copies share the motion, which is const.
///
/// Series : those of the motion, if it is an AnalyticGuide; or the function given beside it
/// Limits : by type it is no guide at rest, and no SteadyGuide, so that no term is left out for that; in
///          dual numbers it is known as a guide that takes doubles alone (detail::guide_at)
/// Cost   : 15 instructions each evaluation besides those of the motion, of which a RotatingFrame takes 818
///          (g++ 12 -O2, callgrind)
class AnyGuide {
 public:
  using Series = std::function<GuideSeries(double t, double h, int order,
                                           const detail::Components<double>& g)>;

  template <GuideMotion M>
  requires(!std::derived_from<M, AnyGuide>) AnyGuide(M motion)  // NOLINT: any kind is one
      : AnyGuide(std::make_shared<const M>(std::move(motion))) {}

  /// A motion whose series, as AnalyticGuide asks for them, are not its own.
  template <GuideMotion M>
  AnyGuide(M motion, Series series) : AnyGuide(std::move(motion)) {
    series_ = std::move(series);
  }

  [[nodiscard]] FrameMotion<Guide, Inertial> operator()(double t) const { return motion_(t); }

  /// Whether there are series() of this motion.
  [[nodiscard]] bool knows_series() const { return static_cast<bool>(series_); }

  /// As AnalyticGuide asks for.
  ///
  /// Throws : InvalidInput if there are none
  [[nodiscard]] GuideSeries series(double t, double h, int order,
                                   const detail::Components<double>& g) const {
    if (!series_) throw InvalidInput("this guide has no series: its motion is not analytic");
    return series_(t, h, order, g);
  }

 private:
  template <class M>
  explicit AnyGuide(std::shared_ptr<const M> motion)
      : motion_([motion](double t) { return (*motion)(t); }) {
    if constexpr (AnalyticGuide<M>) {
      series_ = [motion = std::move(motion)](double t, double h, int order,
                                             const detail::Components<double>& g) {
        return motion->series(t, h, order, g);
      };
    }
  }

  std::function<FrameMotion<Guide, Inertial>(double t)> motion_;
  Series series_;
};

static_assert(GuideMotion<AnyGuide> && AnalyticGuide<AnyGuide>);

}  // namespace kreisel
