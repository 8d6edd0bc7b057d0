#pragma once

#include <concepts>
#include <optional>
#include <utility>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/guide/any_guide.hpp>
#include <dynamics/rigid/apparent_field.hpp>

namespace kreisel {

/// A guide motion whose kind is chosen by a file. Steady kinds have series, too.
class SceneGuide : public AnyGuide {
 public:
  template <GuideMotion M>
  requires(!std::derived_from<M, AnyGuide>)
      SceneGuide(M motion)  // NOLINT: implicit, any kind is accepted
      : AnyGuide(with_series(std::move(motion))) {}

 private:
  template <class M>
  [[nodiscard]] static AnyGuide with_series(M motion) {
    if constexpr (SteadyGuide<M> && !AnalyticGuide<M>) {
      const auto series = [motion](double t, double h, int order,
                                   const detail::Components<double>& g) {
        return detail::series_of(motion, t, h, order, g);
      };
      return {motion, series};
    } else {
      return motion;
    }
  }
};

/// The guide motion of a scene, for times in [t_begin, t_end].
///
/// Cost   : one link costs as much as its kind, a chain one product of motions more for each link
/// Throws : InvalidInput as the kinds do, for values that are not checked in the file
[[nodiscard]] SceneGuide make_guide(const SceneFile& scene);

/// True if make_guide_of_equations() differs from make_guide().
[[nodiscard]] bool has_guide_of_equations(const SceneFile& scene);

/// The guide motion for a system with the bodies of bodies_in_gravity(). It equals make_guide()
/// except for gravity of kind orbit, and on a course for gravity given as a number. Then the motion
/// is relative to a frame that moves with the guide's origin and does not rotate. The origin's
/// acceleration, or on a course its centrifugal part, is part of the gravity.
[[nodiscard]] SceneGuide make_guide_of_equations(const SceneFile& scene);

/// The bodies of a scene for BodySystem. Gravity that is not uniform is one of their loads.
struct SceneBodies {
  std::vector<BodyDescription> bodies;
  Gravity gravity;
  std::vector<Element> elements = {};
  std::vector<Constraint> constraints = {};
  std::optional<BodyLoad> gravitation = {};  ///< the load on all bodies that represents gravity
};

[[nodiscard]] SceneBodies bodies_in_gravity(const SceneFile& scene);

}  // namespace kreisel
