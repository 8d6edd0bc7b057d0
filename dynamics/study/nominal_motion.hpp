#pragma once

#include <Eigen/Core>

#include <utility>

#include <dynamics/study/body_states.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/motion_samples.hpp>
#include <dynamics/study/tangent.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A motion with constant rates, about which equations are linearised:  y(t) = moved(y0, (t - t0) v).
///
/// v : on the tangent at y0 (study/tangent.hpp); its components for rates and memory are 0
class NominalMotion {
 public:
  NominalMotion(double begin, Eigen::VectorXd state, Eigen::VectorXd rate, Tangent tangent)
      : begin_(begin),
        state_(std::move(state)),
        rate_(std::move(rate)),
        tangent_(std::move(tangent)) {}

  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] const Eigen::VectorXd& rate() const { return rate_; }
  [[nodiscard]] const Tangent& tangent() const { return tangent_; }
  [[nodiscard]] Eigen::VectorXd at(double t) const {
    return tangent_.moved(state_, Eigen::VectorXd((t - begin_) * rate_));
  }

 private:
  double begin_;
  Eigen::VectorXd state_;
  Eigen::VectorXd rate_;
  Tangent tangent_;
};

namespace detail {

/// The components of rates that a nominal motion keeps: those of rotors and drives, and of spins.
///
/// A coordinate spins if the accelerations do not depend on its angle in the nominal position. A
/// turning body spins about its angular velocity or the axis with most of it, if the accelerations
/// turn with the body at most.
///
/// y : coordinates of the nominal motion, and rates of the start
class Spins {
 public:
  KREISEL_API Spins(const Tangent& tangent, TangentField field, double t, Eigen::VectorXd y,
                    Eigen::Index first_rate, Eigen::Index rates);

  /// The kept rates, others 0.
  [[nodiscard]] KREISEL_API Eigen::VectorXd kept(const RuledDirections& ruled) const;

 private:
  [[nodiscard]] Eigen::VectorXd with_rates(const Eigen::VectorXd& rates) const;
  [[nodiscard]] bool spins(const Eigen::VectorXd& rates, const Eigen::VectorXd& axis,
                           int attitude) const;

  Tangent tangent_;
  TangentField field_;
  double t_;
  Eigen::VectorXd y_;
  Eigen::Index first_rate_;
  Eigen::Index rates_;
};

}  // namespace detail

/// The nominal motion of a system of bodies at a state. Coordinates are constant, but rotors, drives
/// and spins keep their rates; all other rates are 0. Controllers keep their memory.
///
/// A body spins about an axis if the accelerations do not depend on the angle about it: a rotor
/// without the key `rotor`, a symmetric top.
///
/// Throws : as linearize()
template <class System>
[[nodiscard]] NominalMotion nominal_motion(const System& system, double t,
                                           const Eigen::VectorXd& y) {
  const Tangent tangent = detail::tangent_of(system, y.size(), {});
  const auto ruled = RuledDirections::of(system.tree());
  const Eigen::Index coordinates = system.tree().coordinates();
  const Eigen::Index rates = system.tree().rates();
  const TangentField field = tangent_field(system, tangent);
  const detail::Spins spins(tangent, field, t, y, coordinates, rates);
  Eigen::VectorXd still = y;
  still.segment(coordinates, rates) = spins.kept(ruled);
  Eigen::VectorXd rate = field(t, still);
  rate.tail(rate.size() - rates).setZero();
  return {t, std::move(still), std::move(rate), tangent};
}

}  // namespace kreisel
