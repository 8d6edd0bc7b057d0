#pragma once

#include <Eigen/Geometry>

#include "scene.hpp"

/// Guides and gravity of the independent integrator, from the definitions in docs/scene_files.md,
/// without any code of dynamics/.

namespace differential::reference {

using Real = long double;
using Vec = Eigen::Matrix<Real, 3, 1>;
using Mat = Eigen::Matrix<Real, 3, 3>;
using Quat = Eigen::Quaternion<Real>;
using State = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// The guide's motion relative to the inertial frame, all on inertial axes.
struct Motion {
  Mat R = Mat::Identity();  ///< guide to inertial
  Vec w = Vec::Zero();
  Vec dw = Vec::Zero();
  Vec x = Vec::Zero();  ///< the guide's origin
  Vec v = Vec::Zero();
  Vec a = Vec::Zero();
  Vec down = Vec::Zero();  ///< of a course: the normal of the ellipsoid
};

inline constexpr Real equator = 6378137;
inline constexpr Real flattening = 1 / 298.257223563L;
inline constexpr Real earth_rate = Real(7.292115e-5);  // as double, like the site's

/// A frame that turns about an axis from an angle on.
[[nodiscard]] Motion turning(const Vec& axis, Real angle, Real rate, Real rate_of_rate = 0);

/// A motion relative to a frame that moves itself.
[[nodiscard]] Motion on(const Motion& base, const Motion& own);

/// A vehicle relative to the inertial frame. y: latitude, longitude, heading, height, speed; their
/// rates are written to `rates`.
[[nodiscard]] Motion along_course(const Link& link, Real t, Real within, const Real* y,
                                  Real* rates);

/// The guide of a scene. Links without a closed form are integrated with the state. Each rotating
/// or harmonic link adds ten numbers: attitude, position and velocity relative to the link before. A
/// course adds latitude, longitude, heading, height and speed.
class Guide {
 public:
  explicit Guide(const Scene& scene);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  void start(State& y) const;

  /// Motion and rates of the state's first size() numbers.
  [[nodiscard]] Motion at(Real t, const State& y, State& rates) const;

  /// Takes functions of time on the pieces that contain t.
  void stay_within(Real t) { within_ = t; }

  /// Normalises the attitude quaternions.
  void project(State& y) const;

  /// Gravity on inertial axes, at a position on inertial axes from the guide's origin.
  [[nodiscard]] Vec gravity(Real t, const Motion& motion, const Vec& place) const;

  /// True if gravity acts on all parts of a body, not on its centre of mass alone.
  [[nodiscard]] bool has_gradient() const;

  /// The distance to the zero of gravity's potential, over which gravity has about its strength.
  [[nodiscard]] Real depth(const Motion& motion, const Vec& place) const;

 private:
  [[nodiscard]] Motion own(const Link& link, Real t, const Real* y, Real* rates) const;

  const Scene& scene_;
  Eigen::Index size_ = 0;
  Real within_ = 0;
};

/// A function of time with its first three rates, on the piece that contains `within`.
struct Course {
  Vec value = Vec::Zero();
  Vec rate = Vec::Zero();
  Vec second_rate = Vec::Zero();
  Vec third_rate = Vec::Zero();
};
[[nodiscard]] Course course_of(const Signal& signal, Real t, Real within);

/// A quaternion w, x, y, z of the file, rounded as in the library; the identity if absent.
[[nodiscard]] Quat unit_quaternion(const std::optional<Eigen::Vector4d>& q);

/// The gravitation of the WGS84 ellipsoid without its rotation, at a position from the earth's
/// centre, z to the pole.
///
/// Source : W. Heiskanen, H. Moritz, Physical Geodesy (1967), (2-66) to (2-68), in spheroidal
///          coordinates
[[nodiscard]] Vec ellipsoid_gravitation(const Vec& place);

}  // namespace differential::reference
