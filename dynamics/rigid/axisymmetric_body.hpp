#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <motor/attitude.hpp>
#include <motor/simd.hpp>

namespace kreisel {

/// A body of revolution that is fixed at a point of its axis to a point of a moving guide.
/// Examples: a top or a gyro on a ship, at any spin rate.
///
/// The motion is that of FixedPointBody, written on axes that follow the body's axis but not its
/// spin (Resal's axes). On these axes nothing turns with the spin, only with the nutation, so steps
/// need not resolve the spin. The angle of spin is integrated as well, for the body's own axes.
///
///   q' = q (0, (u'_x, u'_y, 0)/2),   du'/dt = *u' + (0, 0, u'_z) x u',   spin' = u'_z
///
/// Loads must not depend on the spin angle: weight, drag and springs on the axis do not.
///
/// Source : H. Resal, Traite de cinematique pure (1862); paper 002 (5) for *u'
/// Frame  : z is the axis of the body; State on Resal's axes
/// Units  : kg, metre, kg m^2, rad/s
/// Error  : top of 3000 rad/s, 1 s: 29 000 evaluations where FixedPointBody takes 125 000, at 1e-12
///          (tests/dynamics/rigid/axisymmetric_body.cpp)
/// Throws : InvalidInput if no body has these moments or one of them is 0
template <class M, class... Loads>
class AxisymmetricBody {
  using Held = FixedPointBody<M, Loads..., Without<ProductsOfInertia>,
                              Without<FirstMoment, Axis::x, Axis::y>>;

 public:
  using S = double;
  using Vector = Eigen::Matrix<S, 8, 1>;

  struct State {
    Eigen::Quaternion<S> attitude = Eigen::Quaternion<S>::Identity();  ///< Resal's axes to guide
    Vector3<S> angular_velocity = Vector3<S>::Zero();  ///< u' of the body, on Resal's axes
    S spin = 0;                                        ///< rad, of the body against Resal's axes
  };

  /// Mass, position of the centre of mass on the axis, and the moments A across and C along the
  /// axis, all from the fixed point. `point` is the position of the fixed point in the guide.
  AxisymmetricBody(S mass, S arm, S A, S C, const Vector3<S>& point, M guide, Loads... loads)
      : body_({{mass, Vector3<S>(0, 0, mass * arm), {A, A, C}}}, point, std::move(guide),
              std::move(loads)..., Without<ProductsOfInertia>{},
              Without<FirstMoment, Axis::x, Axis::y>{}) {}

  /// The vector field  y' = rates(t, y)  on  y = (quaternion x, y, z, w; u'; spin), for double and,
  /// if the loads accept them, dual numbers.
  template <class N>
  requires(Load<Loads, N>&&...)
      [[nodiscard]] Eigen::Matrix<N, 8, 1> rates(const std::type_identity_t<N>& t,
                                                 const Eigen::Matrix<N, 8, 1>& y) const {
    const N &x = y[4], &z = y[6];
    const Eigen::Matrix<N, 7, 1> as_body =
        body_.template rates<N>(t, Eigen::Matrix<N, 7, 1>(y.template head<7>()));
    const Eigen::Matrix<N, 4, 1> dq =
        attitude_rate(Eigen::Quaternion<N>(y[3], y[0], y[1], y[2]), Vector3<N>(x, y[5], N(0)));
    return detail::gathered<N>(dq[0], dq[1], dq[2], dq[3], as_body[4] - z * y[5],
                               as_body[5] + z * x, as_body[6], z);
  }
  [[nodiscard]] Vector rates(S t, const Vector& y) const { return rates<S>(t, y); }

  /// The Taylor series of the motion, for TaylorSteps. It exists if only uniform gravity acts and
  /// the guide moves steadily or analytically. Formulas: rigid/attitude_series.hpp.
  [[nodiscard]] auto series() const requires(detail::feels_analytically<M, Loads...>) {
    const auto body = body_.template series_on<detail::RateAxes::resal>();
    return Series<std::remove_const_t<decltype(body)>>{body};
  }
  [[nodiscard]] bool knows_series() const requires(detail::feels_analytically<M, Loads...>) {
    return body_.knows_series();
  }

  /// The terms of FixedPointBody, on axes that do not spin. See kreisel::terms.
  [[nodiscard]] Terms terms() const {
    Terms list = body_.terms();
    list.add("relative", "u'_z e_z x u', for Resal's axes do not spin");
    list.add("relative", "angle of the spin", false,
             "no effect on a body of revolution; integrated for output");
    return list;
  }

  /// The same state on the body's own axes.
  [[nodiscard]] static typename Held::State on_body_axes(const State& state) {
    const Eigen::Quaternion<S> turn(std::cos(state.spin / 2), 0, 0, std::sin(state.spin / 2));
    return {state.attitude * turn, turn.conjugate() * state.angular_velocity};
  }

  /// The outputs of the body, motors (screws) on the body's own axes.
  [[nodiscard]] BodyOutputs<S> body_outputs(const S& t, const State& state) const {
    return body_.body_outputs(t, on_body_axes(state));
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 3> blocks = {4, 3, 1};

  [[nodiscard]] static constexpr std::array<int, 1> quaternions() { return {0}; }
  static constexpr std::array names = {"q_x", "q_y", "q_z", "q_w", "u'_x", "u'_y", "u'_z", "spin"};

  [[nodiscard]] static Vector to_vector(const State& state) {
    return (Vector() << state.attitude.coeffs(), state.angular_velocity, state.spin).finished();
  }

  [[nodiscard]] static State from_vector(const Vector& y) {
    return {Eigen::Quaternion<S>(y[3], y[0], y[1], y[2]), {y[4], y[5], y[6]}, y[7]};
  }

 private:
  /// The series of the body, with the spin angle.
  template <class BodySeries>
  struct Series {
    BodySeries body;

    static constexpr int most_order = BodySeries::most_order;

    template <class Coefficients>
    void operator()(double t, double h, int order, Coefficients& c) {
      body(t, h, order, c);
      for (int k = 0; k < order; ++k) c(7, k + 1) = h * c(6, k) / (k + 1);
    }
  };

  Held body_;
};

static_assert(Scene<AxisymmetricBody<RestingFrame<>>>);

}  // namespace kreisel
