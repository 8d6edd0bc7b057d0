#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <type_traits>
#include <utility>

#include <dynamics/guide/motion.hpp>

namespace kreisel {

/// A frame whose pose is a function of time that the user writes. Velocity and acceleration are its
/// exact derivatives (forward differentiation, no difference quotient).
///
/// The library calls the function with a number type T and expects a Pose<T>, rotation G to I and
/// position of G's origin on I's axes:
///
///   auto rolling = posed<Ship, Earth>([](const auto& t) {
///     using std::sin;
///     using T = std::decay_t<decltype(t)>;
///     const T roll = 0.2 * sin(0.9 * t);
///     return Pose<T>{YawPitchRoll<T>{T(0), T(0), roll}.rotation(), Vector3<T>(5 * t, T(0), T(0))};
///   });
///
/// Error  : the error of the user's formula; u and ou 4u * sum of |terms| more
template <class Function, class G = Guide, class I = Inertial, class S = double>
class PosedFrame {
  using First = Eigen::AutoDiffScalar<Eigen::Matrix<S, 1, 1>>;
  using Second = Eigen::AutoDiffScalar<Eigen::Matrix<First, 1, 1>>;

 public:
  explicit PosedFrame(Function pose) : pose_(std::move(pose)) {}

  /// The user's function.
  [[nodiscard]] const Function& function() const { return pose_; }

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    First now;
    now.value() = t;
    now.derivatives()[0] = S(1);
    Second time;
    time.value() = now;
    time.derivatives()[0] = First(S(1));
    const Pose<Second> pose = pose_(time);

    const auto value = [](const Second& x) { return x.value().value(); };
    const auto first = [](const Second& x) { return x.derivatives()[0].value(); };
    const auto second = [](const Second& x) { return x.derivatives()[0].derivatives()[0]; };
    const Matrix3<S> R = pose.rotation.unaryExpr(value);
    const Matrix3<S> to_guide = R.transpose();
    // R^t R' = skew(u) and R^t R'' = skew(ou) + skew(u)^2, where skew(u)^2 is symmetric.
    const Vector3<S> u = skew_part(to_guide * pose.rotation.unaryExpr(first));
    const Vector3<S> du = skew_part(to_guide * pose.rotation.unaryExpr(second));
    const Vector3<S> v = to_guide * pose.translation.unaryExpr(first);
    FrameMotion<G, I, S> motion;
    motion.X.value = {R, pose.translation.unaryExpr(value)};
    motion.V.value = {u, v};
    motion.dV.value = {du, to_guide * pose.translation.unaryExpr(second) - u.cross(v)};
    return motion;
  }

 private:
  /// The vector of the skew part of a matrix.
  [[nodiscard]] static Vector3<S> skew_part(const Matrix3<S>& m) {
    return Vector3<S>(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)) / S(2);
  }

  Function pose_;
};

/// The frame G whose pose in I is the given function.
template <class G = Guide, class I = Inertial, class S = double, class Function>
[[nodiscard]] PosedFrame<Function, G, I, S> posed(Function pose) {
  return PosedFrame<Function, G, I, S>(std::move(pose));
}

}  // namespace kreisel
