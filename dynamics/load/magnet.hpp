#pragma once

#include <optional>

#include <dynamics/load/analytic_load.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/signal/signal.hpp>

namespace kreisel {

/// A magnet in a uniform field: the torque m x B. Its potential is -m.B, if the field is constant.
/// The user announces jumps of the field to the solver.
///
/// Units  : A m^2 (moment, on body axes), tesla (field, on guide axes); N m
struct Magnet {
  static constexpr const char* kind = "magnet";
  static constexpr bool ignores_guide = true;

  Vector3<double> moment = Vector3<double>::Zero();
  Signal<Vector3<double>> field = {};

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& s) const {
    const Vector3<N> B = s.template on_body_axes<Guide>(field(s.t));
    return {{Vector3<N>::Zero(), moment.template cast<N>().cross(B)}};
  }

  [[nodiscard]] std::optional<AnalyticLoad> analytic() const {
    return AnalyticLoad{.axes = LoadAxes::guide, .moment = moment, .field = field};
  }

  [[nodiscard]] bool keeps_energy() const { return field.is_constant(); }

  [[nodiscard]] double potential(const LoadContext<>& s) const {
    return keeps_energy() ? -moment.dot(s.on_body_axes<Guide>(field(s.t))) : 0;
  }
};

}  // namespace kreisel
