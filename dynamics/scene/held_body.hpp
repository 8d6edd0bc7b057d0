#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <array>
#include <limits>
#include <tuple>
#include <utility>

#include <dynamics/scene/read_out.hpp>
#include <motor/attitude.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A rigid body held at one of its points, its origin O', at a point of a moving guide: a pendulum
/// in a ball joint on a ship, a top on a turntable, an instrument on gimbals without mass.
///
/// Its centre of mass may be anywhere and its inertia general. With the guide at rest this is
/// Euler's top; without loads and centre of mass at O' the guide does not matter at all.
///
/// The state is the attitude in the guide and the angular velocity u' against it. Nothing depends
/// on the quaternion's norm, which drifts by the steps' error only and is never corrected:
/// the attitude read from it is a rotation to rounding always, however long the run.
///
/// Source : paper 002 (5), (18)-(19), with V' = (u'; 0) at O'
/// Units  : metre, rad/s
/// Throws : InvalidInput where the inertia is none or the tensor about O' is singular (a needle
///          along a line through O', all mass in O')
template <class M, class... Loads>
class HeldBody {
  static_assert(detail::is_guide<M>, "the guide of a body says how Guide moves against Inertial");
  static_assert(detail::are_loads<Loads...>, "a load takes a Situation and returns a Force<Body>");

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 7, 1>;

  struct State {
    Eigen::Quaternion<S> attitude = Eigen::Quaternion<S>::Identity();  ///< body to guide
    Vector3<S> angular_velocity = Vector3<S>::Zero();                  ///< u', on body axes
  };

  /// `point` is where in the guide the body is held.
  HeldBody(const InertiaTensor<Body, S>& inertia, const Vector3<S>& point, M guide, Loads... loads)
      : inertia_(inertia),
        point_(point),
        guide_(std::move(guide)),
        loads_(std::move(loads)...),
        tensor_(inertia.value.tensor.matrix()) {
    check(inertia.value, Mass::positive, "held body");
    if (!(point - point).isZero(0)) throw InvalidInput("held body: the point is not finite");
    const Eigen::SelfAdjointEigenSolver<Matrix3<S>> eigen(inertia.value.tensor.matrix(),
                                                          Eigen::EigenvaluesOnly);
    const Vector3<S>& moments = eigen.eigenvalues();
    if (!(moments[0] > std::numeric_limits<S>::epsilon() * moments[2])) {
      throw InvalidInput(
          "held body: the inertia about an axis through the held point is 0 (a needle, or all mass "
          "in "
          "that point): the rotation about it is not determined by the torque");
    }
  }

  [[nodiscard]] Situation<S> situation(const S& t, const State& state) const {
    return {t,
            {Pose<S>::from(state.attitude, point_)},
            {{state.angular_velocity, Vector3<S>::Zero()}},
            guide_(t),
            inertia_};
  }

  /// *u', the rate of the angular velocity on body axes.
  ///
  ///   Theta *u' = M - (moment of  T (oF + [F V']) + [V (T V)]  at O')
  [[nodiscard]] Vector3<S> acceleration(const Situation<S>& s) const {
    const Force<Body, S> P = load(s);
    return tensor_.solve(P.value.moment - detail::without_acceleration(s).value.moment);
  }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; u').
  [[nodiscard]] Vector rates(const S& t, const Vector& y) const {
    const State state = from_vector(y);
    const Eigen::Vector4d dq = attitude_rate(state.attitude, state.angular_velocity);
    const Vector3<S> du = acceleration(situation(t, state));
    return Vector(dq[0], dq[1], dq[2], dq[3], du[0], du[1], du[2]);
  }

  [[nodiscard]] ReadOut<S> read_out(const S& t, const State& state) const {
    const Situation<S> s = situation(t, state);
    return std::apply(
        [&](const auto&... loads) {
          return detail::read_out(s, {{acceleration(s), Vector3<S>::Zero()}}, loads...);
        },
        loads_);
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {4, 3};

  [[nodiscard]] static Vector to_vector(const State& state) {
    return (Vector() << state.attitude.coeffs(), state.angular_velocity).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(Eigen::Vector4d(y.head<4>())), y.tail<3>()};
  }

 private:
  [[nodiscard]] Force<Body, S> load(const Situation<S>& s) const {
    return std::apply([&s](const auto&... loads) { return detail::total_load(s, loads...); },
                      loads_);
  }

  InertiaTensor<Body, S> inertia_;
  Vector3<S> point_;
  M guide_;
  std::tuple<Loads...> loads_;
  Eigen::LDLT<Matrix3<S>> tensor_;
};

}  // namespace kreisel
