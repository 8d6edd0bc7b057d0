#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/study/precession.hpp>

namespace kreisel {

/// A Cardan gyro with a fast symmetric rotor, free or regulated, as a model for
/// precession_motion(). Positions and displacements are (alpha, beta), as in its state; u are their
/// rates.
///
///   G = l cos(beta) (0 1; -1 0),   l = C phi' if regulated, else p = C (phi' + e.w)
///
/// Source : paper 000 (14) with B = (sin beta, 0)
/// Throws : InvalidInput for a rotor that is not symmetric or has friction
template <class M, class Rotor>
class PrecessionGimbals final : public PrecessionModel {
  static_assert(std::is_same_v<Rotor, FreeRotor> || std::is_same_v<Rotor, RegulatedRotor>,
                "a driven rotor has no constant momentum");

 public:
  using Gyro = CardanGyro<M, Rotor>;

  /// The rotor has the speed of this state.
  PrecessionGimbals(CardanGyro<M, Rotor> gyro, double t,
                    const typename CardanGyro<M, Rotor>::State& start)
      : gyro_(std::move(gyro)) {
    const auto& rotor = gyro_.moments().rotor;
    if (rotor.x() != rotor.y() || gyro_.rotor().friction != 0) {
      throw InvalidInput(
          "precession equations of a Cardan gyro: the rotor is not symmetric, or it "
          "has friction");
    }
    momentum_ = regulated ? rotor.z() * start.phi_rate : gyro_.balance(t, start).rotor_momentum;
  }

  [[nodiscard]] const Gyro& gyro() const { return gyro_; }

  [[nodiscard]] GyroForces forces(double t, const Eigen::VectorXd& position) const override {
    const auto& [rotor, inner, outer] = gyro_.moments();
    const auto& [about_a, about_b] = gyro_.bearings();
    const double sb = std::sin(about_b.reference + position[1]);
    const double cb = std::cos(about_b.reference + position[1]);
    const double along = inner.z() + (regulated ? rotor.z() : 0.0);
    GyroForces f;
    f.A = Eigen::Vector2d(outer.x() + (inner.x() + rotor.x()) * cb * cb + along * sb * sb,
                          inner.y() + rotor.x())
              .asDiagonal();
    f.G.resize(2, 2);
    f.G << 0, momentum_ * cb, -momentum_ * cb, 0;
    f.D = Eigen::Vector2d(about_a.damping, about_b.damping).asDiagonal();
    f.Q = f.A * acceleration(t, position, Eigen::VectorXd::Zero(2));
    return f;
  }

  [[nodiscard]] Eigen::VectorXd motion_forces(double t, const Eigen::VectorXd& position,
                                              const Eigen::VectorXd& u) const override {
    const GyroForces f = forces(t, position);
    return f.Q - (f.G + f.D) * u - f.A * acceleration(t, position, u);
  }

  [[nodiscard]] std::vector<int> blocks() const override { return {1, 1}; }

 private:
  static constexpr bool regulated = std::is_same_v<Rotor, RegulatedRotor>;

  [[nodiscard]] Eigen::Vector2d acceleration(double t, const Eigen::VectorXd& position,
                                             const Eigen::VectorXd& u) const {
    typename Gyro::State s{position[0], position[1], 0, u[0], u[1], 0};
    const double C = gyro_.moments().rotor.z();
    const double turning = regulated ? 0.0 : gyro_.balance(t, s).rotor_momentum;
    s.phi_rate = (momentum_ - turning) / C;
    return gyro_.rates(t, gyro_.to_vector(s)).template segment<2>(3);
  }

  Gyro gyro_;
  double momentum_ = 0;
};

}  // namespace kreisel
