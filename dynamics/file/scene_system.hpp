#pragma once

#include <concepts>
#include <optional>
#include <utility>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/guide/any_guide.hpp>
#include <dynamics/rigid/apparent_field.hpp>

namespace kreisel {

/// A guide motion whose kind a file has named: a steady one too has its series.
class SceneGuide : public AnyGuide {
 public:
  template <GuideMotion M>
  requires(!std::derived_from<M, AnyGuide>)
      SceneGuide(M motion)  // NOLINT: any kind is meant where one is taken
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

/// The guide motion of a scene, for times in [0, t_end].
///
/// Cost   : of one link that of its kind, of a chain one product of motions more for each link
/// Throws : InvalidInput as the kinds do, where what each of them takes was not checked in the file
[[nodiscard]] SceneGuide make_guide(const SceneFile& scene);

/// The guide motion that goes with bodies_in_gravity() into a system of bodies. It is that of
/// make_guide(), but for gravity of kind orbit: then it is against the frame that goes along with the
/// orbit's origin and does not turn, and the acceleration of that origin is in the gravity.
[[nodiscard]] SceneGuide make_guide_of_equations(const SceneFile& scene);

/// What a BodySystem takes: the bodies, with the gravity that is not uniform among their loads.
struct SceneBodies {
  std::vector<BodyDescription> bodies;
  Gravity gravity;
  std::optional<BodyLoad> gravitation = {};  ///< the load on all bodies that stands for gravity
};

[[nodiscard]] SceneBodies bodies_in_gravity(const SceneFile& scene);

}  // namespace kreisel
