#pragma once

#include <motor/frame.hpp>

namespace kreisel {

/// What is balanced over a whole system.
///
/// Frame  : momenta on guide axes about the guide's origin; value.reduced_at() takes them elsewhere
/// Units  : J; kg m/s, kg m^2/s
struct BodyBalance {
  double kinetic_energy = 0;           ///< sum of V.(T V)/2, absolute
  double relative_kinetic_energy = 0;  ///< sum of V'.(T V')/2
  double potential_energy = 0;         ///< of springs, gravity and the loads that have one

  /// Of all that moves without the rotors' spin: with A* + B^t A_R B of the regulated and A of the
  /// other ones, the paper's T2 and R2. Without rotors it is the kinetic energy.
  double carrier_energy = 0;

  Momentum<Guide> momentum = {};           ///< sum of T V
  Momentum<Guide> relative_momentum = {};  ///< sum of T V'
};

}  // namespace kreisel
