#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <type_traits>
#include <vector>

#include <motor/displacement.hpp>
#include <motor/frame.hpp>
#include <motor/motor.hpp>

#include <support/sample.hpp>

/// The motion of a guide and a body in it at one time: the truth for tests of motors and laws. It
/// follows from their poses as functions of time and the positions of point masses.
///
/// Nothing here calls the library's products, reductions or rates. All results on body axes, moments
/// at the body's origin O'. Computed in 50 digits.

namespace kreisel::test {

using Digits50 = boost::multiprecision::cpp_bin_float_50;

/// c0 + c1 t + c2 t^2 + A sin(w t + p).
struct Wave {
  Digits50 c0 = 0, c1 = 0, c2 = 0, A = 0, w = 0, p = 0;

  /// The same, constant at its value at the time t.
  [[nodiscard]] Wave still(const Digits50& t) const;
};

/// The pose of one frame in another as a function of time: Rz(yaw) Ry(pitch) Rx(roll), then (x, y, z).
struct Motion {
  Wave yaw, pitch, roll, x, y, z;

  /// The same, at rest in the pose of the time t.
  [[nodiscard]] Motion still(const Digits50& t) const;
};

/// One motor differentiated by the three observers.
struct Derivatives {
  Motor<Digits50> body, guide, inertial;

  template <class Observer>
  [[nodiscard]] const Motor<Digits50>& by() const {
    if constexpr (std::is_same_v<Observer, Body>) return body;
    if constexpr (std::is_same_v<Observer, Guide>) return guide;
    if constexpr (std::is_same_v<Observer, Inertial>) return inertial;
  }
};

/// A motor at one time: itself, and T and P of equations (12)-(17) for each observer.
struct Differentiated {
  Motor<Digits50> value;
  Derivatives T;  ///< its coordinates in the observer's frame differentiated, rewritten at O'
  Derivatives P;  ///< its two vectors at the moving O', differentiated on the observer's axes
};

struct Truth {
  Pose<Digits50> X_GB, X_IG;
  Differentiated V_rel, F;
  Differentiated J, J_f;      ///< momentum of the relative and of the guide motion
  Motor<Digits50> force;      ///< the rate of the momentum of the point masses
  Vector3<Digits50> r_G;      ///< O' in the guide, on guide axes
  Motor<Digits50> F_G, dF_G;  ///< F at the guide's origin on guide axes, and its rate in the guide
};

/// All quantities at time t for masses fixed in the body.
[[nodiscard]] Truth truth(const Motion& guide, const Motion& relative, const Digits50& t,
                          const std::vector<PointMass>& masses);

/// A random motion; sometimes parts of it are at rest.
[[nodiscard]] Motion motion(Sample& sample);

/// Random guide and body, at time 0 (the waves have phases), with the given masses.
[[nodiscard]] Truth truth(Sample& sample, const std::vector<PointMass>& masses);

}  // namespace kreisel::test
