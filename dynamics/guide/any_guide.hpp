#pragma once

#include <concepts>
#include <functional>
#include <memory>
#include <utility>

#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/series.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A guide motion of any kind that is chosen at run time. The value can be a member, an element of a
/// container, and can be assigned another motion.
///
///   struct Vehicle {
///     AnyGuide guide = RestingFrame<>{};
///   };
///   vehicle.guide = RotatingFrame<>{.angular_velocity = {0, 0, 0.1}};
///   const BodySystem system(vehicle.guide, bodies);
///
/// Results equal those of the motion itself to the last bit. Copies share the motion, which is const.
///
/// Series : the series of an AnalyticGuide, or the function given with the motion
/// Limits : its type is neither a guide at rest nor a SteadyGuide, so no terms are left out. It takes
///          doubles; dual numbers go through detail::guide_at
/// Cost   : 15 instructions in each evaluation beside those of the motion; a RotatingFrame has 818
///          (g++ 12 -O2, callgrind)
class AnyGuide {
 public:
  using Series = std::function<GuideSeries(double t, double h, int order,
                                           const detail::Components<double>& g)>;

  template <GuideMotion M>
  requires(!std::derived_from<M, AnyGuide>)
      AnyGuide(M motion)  // NOLINT: implicit, any kind is accepted
      : AnyGuide(std::make_shared<const M>(std::move(motion))) {}

  /// A motion with the series of AnalyticGuide given as a function.
  template <GuideMotion M>
  AnyGuide(M motion, Series series) : AnyGuide(std::move(motion)) {
    series_ = std::move(series);
  }

  [[nodiscard]] FrameMotion<Guide, Inertial> operator()(double t) const { return motion_(t); }

  /// True if this motion has series().
  [[nodiscard]] bool knows_series() const { return static_cast<bool>(series_); }

  /// The series required by AnalyticGuide.
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
