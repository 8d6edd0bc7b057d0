#pragma once

#include <motor/frame.hpp>

namespace kreisel {

/// Energies and momenta of a whole system.
///
/// Frame  : momenta on guide axes about the guide's origin; value.reduced_at() for another point
/// Units  : J; kg m/s, kg m^2/s
struct BodyBalance {
  double kinetic_energy = 0;           ///< sum of V.(T V)/2, absolute
  double relative_kinetic_energy = 0;  ///< sum of V'.(T V')/2
  double potential_energy = 0;         ///< of springs, gravity and loads with a potential

  /// Kinetic energy without the rotors' spin: the paper's T2 and R2, with A* + B^t A_R B for
  /// regulated rotors and A for the others. Without rotors it is the kinetic energy.
  double carrier_energy = 0;

  Momentum<Guide> momentum = {};           ///< sum of T V
  Momentum<Guide> relative_momentum = {};  ///< sum of T V'
};

}  // namespace kreisel
