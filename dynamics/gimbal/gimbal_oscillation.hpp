#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include <dynamics/model/terms.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The common part of linear equations of a gyro in two rings. It has small angles alpha and beta
/// with their rates, a rotor at constant speed, and the gyro of the exact equations.
///
/// ExactGyro : a CardanGyro
template <class ExactGyro>
class GimbalOscillation {
 public:
  using Vector = Eigen::Vector4d;
  using Exact = ExactGyro;

  struct State {
    double alpha = 0;  ///< of the outer ring, about the guide's x
    double beta = 0;   ///< of the inner ring, about y
    double alpha_rate = 0;
    double beta_rate = 0;
  };

  /// The speed of the rotor against the inner ring.
  [[nodiscard]] double speed() const { return speed_; }

  /// The same gyro with the exact equations.
  [[nodiscard]] const Exact& exact() const { return exact_; }

  /// The exact gyro's state at t = 0 that corresponds to this state, and back.
  [[nodiscard]] typename Exact::State exact_state(const State& s) const {
    return {s.alpha, s.beta, 0, s.alpha_rate, s.beta_rate, speed_};
  }
  [[nodiscard]] static State approximated(const typename Exact::State& s) {
    return {s.alpha, s.beta, s.alpha_rate, s.beta_rate};
  }

  /// For integrators: components that share unit and size.
  static constexpr std::array<int, 2> blocks = {2, 2};

  static constexpr std::array names = {"alpha", "beta", "alpha'", "beta'"};

  [[nodiscard]] static Vector to_vector(const State& s) {
    return {s.alpha, s.beta, s.alpha_rate, s.beta_rate};
  }
  [[nodiscard]] static State from_vector(const Vector& y) { return {y[0], y[1], y[2], y[3]}; }

 protected:
  /// The terms that all such equations have and those that none has: see kreisel::terms.
  [[nodiscard]] static Terms linear_terms() {
    Terms list;
    list.add("relative", "moments of inertia times alpha'', beta''");
    list.add("relative", "H alpha', H beta' of the spin H = C_1 phi'");
    list.add("relative", "products of angles and rates", false, "linear in alpha, beta and rates");
    list.add("relative", "phi''", false, "the speed is constant; of a free rotor, to second order");
    list.add("load", "springs and friction of the rings' bearings");
    return list;
  }

  /// The terms of the equations on a guide at rest.
  [[nodiscard]] static Terms linear_terms_at_rest() {
    Terms list = linear_terms();
    list.add("relative", "moments of inertia of both rings");
    for (const char* part : {"guide", "Coriolis"}) {
      list.add(part, "u of the guide", false, "the guide does not turn");
    }
    return list;
  }

  /// `equations` is the name of the equations in error messages.
  GimbalOscillation(Exact exact, double speed, const std::string& equations)
      : exact_(std::move(exact)), speed_(speed) {
    if (!std::isfinite(speed)) throw InvalidInput(equations + ": the speed is not finite");
    const auto& [outer, inner] = exact_.bearings();
    if (outer.reference != 0 || inner.reference != 0) {
      throw InvalidInput(equations +
                         ": they hold about alpha = beta = 0 only, and a bearing's reference is "
                         "another");
    }
  }

 private:
  Exact exact_;
  double speed_;
};

}  // namespace kreisel
