#pragma once

#include <complex>
#include <functional>
#include <optional>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// The stability margins of an open loop L: the loop 1 + L = 0 is the closed one.
struct LoopMargins {
  /// A crossing: |L| = 1, or a phase of -180 degrees.
  struct Crossing {
    double frequency = 0;  ///< rad/s
    double margin = 0;     ///< the phase above -180 degrees, rad; or the factor 1/|L|
  };

  std::optional<Crossing> phase;  ///< the smallest phase margin; none if |L| does not cross 1
  std::optional<Crossing> gain;   ///< the gain margin nearest to 1; none without a crossing
};

/// The margins within a range of frequencies. Two crossings that lie closer than 2.3 % may be missed.
///
/// Error : of frequencies and margins, that of L at 1e-13 of the frequency
KREISEL_API [[nodiscard]] LoopMargins loop_margins(
    const std::function<std::complex<double>(double)>& loop,
    const std::vector<double>& frequencies);

/// The first frequency at which |H| falls through 1/sqrt(2) of its value at the first frequency;
/// nothing if it does not.
KREISEL_API [[nodiscard]] std::optional<double> bandwidth(
    const std::function<std::complex<double>(double)>& response,
    const std::vector<double>& frequencies);

}  // namespace kreisel
