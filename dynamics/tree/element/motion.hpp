#pragma once

#include <array>
#include <string>

#include <motor/motor.hpp>

namespace kreisel {

/// One end of an element: a point of a body or of the guide.
///
/// Units  : metre
struct ElementEnd {
  std::string body = "guide";                    ///< the guide frame, or the name of a body
  Vector3<double> at = Vector3<double>::Zero();  ///< on the body's axes, from its origin
};

/// The motion of the second body relative to the first, at the ends of an element.
///
/// Frame  : on the axes of the FIRST body, observed from it
/// Units  : metre, m/s, rad/s, s
template <class S = double>
struct ElementMotion {
  Vector3<S> reach = Vector3<S>::Zero();     ///< from the first end to the second
  Vector3<S> velocity = Vector3<S>::Zero();  ///< of the second end
  Matrix3<S> turn = Matrix3<S>::Identity();  ///< from the second body's axes to the first's
  Vector3<S> turning = Vector3<S>::Zero();   ///< angular velocity of the second body
  S t = S(0);                                ///< the time
};

}  // namespace kreisel
