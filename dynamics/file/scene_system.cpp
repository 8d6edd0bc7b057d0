#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include <dynamics/file/overloaded.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/guide/course.hpp>
#include <dynamics/guide/earth_frame.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/signal_frame.hpp>
#include <dynamics/load/earth_gravitation.hpp>
#include <dynamics/load/orbit_gravitation.hpp>
#include <dynamics/model/dual_numbers.hpp>

namespace kreisel {

namespace {

struct Outer;  // the frame of all links up to one

using Motion = FrameMotion<Guide, Inertial>;

/// Steps that end at t_end may evaluate the guide a rounding error later.
double just_after(double end) { return end + 1e-12 * std::abs(end); }

Displacement<Inertial, Guide> pose(const scene_guide::Start& start) {
  return {Pose<>::from(start.attitude, start.origin_position)};
}

/// A guide from a frame that is defined up to its end: slightly later times are set to the end.
template <class Frame>
SceneGuide within(Frame known) {
  const auto frame = std::make_shared<const Frame>(std::move(known));
  return [frame](double t) {
    return (*frame)(t > frame->end() && t <= just_after(frame->end()) ? frame->end() : t);
  };
}

SceneGuide make_link(const scene_guide::Link& link, double t_end) {
  return std::visit(
      detail::Overloaded{
          [](const scene_guide::Resting&) -> SceneGuide { return RestingFrame<>{}; },
          [](const scene_guide::Rotating& kind) -> SceneGuide {
            return RotatingFrame<>{kind.angular_velocity, kind.origin_acceleration,
                                   pose(kind.start), kind.start.origin_velocity};
          },
          [t_end](const scene_guide::Harmonic& kind) -> SceneGuide {
            return HarmonicFrame<>(kind.angular_velocity, kind.origin_acceleration, 0,
                                   just_after(t_end), pose(kind.start), kind.start.origin_velocity);
          },
          [](const scene_guide::Earth& kind) -> SceneGuide {
            // The number includes the centrifugal part at the origin.
            if (kind.gravity) return RotatingFrame<>{earth_rotation(kind.site)};
            return earth_frame(kind.site);
          },
          [](const scene_guide::Table& kind) -> SceneGuide {
            return within(TabulatedFrame<>(kind.log, kind.spline));
          },
          [](const scene_guide::Rates& kind) -> SceneGuide {
            return within(RatesFrame<>(kind.log, kind.start, kind.spline));
          },
          [](const scene_guide::Motion& kind) -> SceneGuide {
            const SignalFrame<> frame(kind.pose);
            if (kind.pose.is_analytic()) return frame;
            return [frame](double t) { return frame(t); };  // without a Taylor series
          },
          [](const scene_guide::Orbit& kind) -> SceneGuide { return OrbitFrame<>(kind.elements); },
          [t_end](const scene_guide::Course& kind) -> SceneGuide {
            return within(CourseFrame<>(kind.plan, t_end));
          }},
      link);
}

/// A weight in gravity that is uniform on the axes of the first link of a chain.
struct SiteWeight {
  static constexpr bool ignores_spin = true;

  SceneGuide site;
  double magnitude;

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> g(N(magnitude), N(0), N(0));
    return UniformGravity<Inertial, N>{detail::guide_at<N>(site, s.t).X.value.rotation * g}(s);
  }
};

std::vector<SceneGuide> make_links(const SceneFile& scene) {
  std::vector<SceneGuide> links;
  for (const scene_guide::Link& link : scene.guide) links.push_back(make_link(link, scene.t_end));
  return links;
}

SceneGuide chained(std::vector<SceneGuide> links) {
  if (links.size() == 1) return links.front();
  return [links = std::move(links)](double t) {
    Motion whole = links.front()(t);
    for (std::size_t i = 1; i < links.size(); ++i) {
      const FrameMotion<Outer, Inertial> outer{{whole.X.value}, {whole.V.value}, {whole.dV.value}};
      const Motion own = links[i](t);
      whole = outer * FrameMotion<Guide, Outer>{{own.X.value}, {own.V.value}, {own.dV.value}};
    }
    return whole;
  };
}

/// The course of a vehicle whose gravity is a number; null for other scenes.
const CoursePlan* course_in_given_gravity(const SceneFile& scene) {
  const auto* const course = std::get_if<scene_guide::Course>(&scene.guide.front());
  const bool given = std::holds_alternative<scene_gravity::AtSite>(scene.gravity);
  return course != nullptr && given ? &course->plan : nullptr;
}

/// The frame whose x axis is along an effective gravity that is given as a number.
SceneGuide level_frame(const SceneFile& scene) {
  const CoursePlan* const course = course_in_given_gravity(scene);
  if (course == nullptr) return make_link(scene.guide.front(), scene.t_end);
  CoursePlan level = *course;
  level.bank = {};
  level.is_coordinated = false;
  return make_link(scene_guide::Course{std::move(level)}, scene.t_end);
}

const OrbitElements<>& orbit_of(const SceneFile& scene) {
  return std::get<scene_guide::Orbit>(scene.guide.front()).elements;
}

}  // namespace

bool has_guide_of_equations(const SceneFile& scene) {
  return std::holds_alternative<scene_gravity::OnOrbit>(scene.gravity) ||
         course_in_given_gravity(scene) != nullptr;
}

SceneGuide make_guide(const SceneFile& scene) { return chained(make_links(scene)); }

SceneGuide make_guide_of_equations(const SceneFile& scene) {
  std::vector<SceneGuide> links = make_links(scene);
  if (std::holds_alternative<scene_gravity::OnOrbit>(scene.gravity)) {
    links.front() = OrbitAxes<>(orbit_of(scene));
  }
  if (const CoursePlan* const course = course_in_given_gravity(scene)) {
    links.front() = within(CourseAxes<>(*course, scene.t_end));
  }
  return chained(std::move(links));
}

SceneBodies bodies_in_gravity(const SceneFile& scene) {
  SceneBodies result{scene.bodies, {}, scene.elements, scene.constraints};
  const auto add_to_all = [&result](const auto& load) {
    result.gravitation = load;
    for (BodyDescription& body : result.bodies) {
      if (body.inertia.value.mass > 0) body.loads.emplace_back(load);
    }
  };
  std::visit(detail::Overloaded{
                 [](const scene_gravity::None&) {},
                 [&result](const UniformGravity<Guide>& g) { result.gravity = g; },
                 [&result](const UniformGravity<Inertial>& g) { result.gravity = g; },
                 [&](const scene_gravity::Ellipsoid&) { add_to_all(EarthGravitation{}); },
                 [&](const OblateGravitation<>& planet) { add_to_all(planet); },
                 [&](const scene_gravity::OnOrbit& orbit) {
                   add_to_all(OrbitGravitation<>(orbit_of(scene), orbit.gradient));
                 },
                 [&](const scene_gravity::AtSite& site) {
                   const Vector3<double> g(site.magnitude, 0, 0);
                   if (scene.guide.size() == 1 && course_in_given_gravity(scene) == nullptr) {
                     result.gravity = UniformGravity<Guide>{g};
                   } else {
                     add_to_all(SiteWeight{level_frame(scene), site.magnitude});
                   }
                 }},
             scene.gravity);
  return result;
}

}  // namespace kreisel
