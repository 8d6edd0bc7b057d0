#pragma once

#include <Eigen/Geometry>

#include <array>
#include <tuple>
#include <utility>

#include <dynamics/scene/read_out.hpp>
#include <motor/attitude.hpp>

namespace kreisel {

/// A free rigid body watched from a moving guide: thrown, falling, floating, hung on springs.
///
/// Its origin O' and its centre of mass may differ. The state is attitude, place and velocity motor
/// V' against the guide; nothing depends on the quaternion's norm (see HeldBody).
///
/// Source : paper 002 (5)
/// Units  : metre, rad/s, m/s
/// Throws : InvalidInput where the inertia is none, ComputationFailed where it is singular
template <class M, class... Loads>
class FreeBody {
  static_assert(detail::is_guide<M>, "the guide of a body says how Guide moves against Inertial");
  static_assert(detail::are_loads<Loads...>, "a load takes a Situation and returns a Force<Body>");

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 13, 1>;

  struct State {
    Eigen::Quaternion<S> attitude = Eigen::Quaternion<S>::Identity();  ///< body to guide
    Vector3<S> position = Vector3<S>::Zero();                          ///< of O' in the guide
    Velocity<Body, Guide, Body, S> velocity = {};                      ///< V'
  };

  FreeBody(const InertiaTensor<Body, S>& inertia, M guide, Loads... loads)
      : inertia_(inertia),
        guide_(std::move(guide)),
        loads_(std::move(loads)...),
        factor_((check(inertia.value, Mass::positive, "free body"), inertia.value)) {}

  [[nodiscard]] Situation<S> situation(const S& t, const State& state) const {
    return {
        t, {Pose<S>::from(state.attitude, state.position)}, state.velocity, guide_(t), inertia_};
  }

  /// *V', from  T *V' = P - T (oF + [F V']) - [V (T V)].
  [[nodiscard]] Rate<Body, Velocity<Body, Guide, Body, S>> acceleration(
      const Situation<S>& s) const {
    const Force<Body, S> P =
        std::apply([&s](const auto&... loads) { return detail::total_load(s, loads...); }, loads_);
    return {factor_.solve((P - detail::without_acceleration(s)).value)};
  }

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; position; u'; v').
  [[nodiscard]] Vector rates(const S& t, const Vector& y) const {
    const State state = from_vector(y);
    const Situation<S> s = situation(t, state);
    const auto& [u, v] = state.velocity.value;
    const Motor<S> dV = acceleration(s).value;
    return (Vector() << attitude_rate(state.attitude, u), s.X.value.rotation * v, dV.resultant,
            dV.moment)
        .finished();
  }

  [[nodiscard]] ReadOut<S> read_out(const S& t, const State& state) const {
    const Situation<S> s = situation(t, state);
    return std::apply(
        [&](const auto&... loads) { return detail::read_out(s, acceleration(s), loads...); },
        loads_);
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 4> blocks = {4, 3, 3, 3};

  [[nodiscard]] static Vector to_vector(const State& state) {
    const auto& [u, v] = state.velocity.value;
    return (Vector() << state.attitude.coeffs(), state.position, u, v).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(Eigen::Vector4d(y.head<4>())),
            y.segment<3>(4),
            {{y.segment<3>(7), y.segment<3>(10)}}};
  }

 private:
  InertiaTensor<Body, S> inertia_;
  M guide_;
  std::tuple<Loads...> loads_;
  FactoredInertia<S> factor_;
};

}  // namespace kreisel
