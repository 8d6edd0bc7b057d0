#pragma once

namespace kreisel {

/// A function of time and state whose sign changes where the field of a scene has a corner, and its
/// derivatives.
struct Corner {
  double value = 0;
  double rate = 0;          ///< along the motion
  double rate_in_time = 0;  ///< at the same state
  double rounding = 0;      ///< smaller values have no sign
};

}  // namespace kreisel
