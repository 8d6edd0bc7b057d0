#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <dynamics/study/spectrum.hpp>
#include <dynamics/study/whirl.hpp>
#include <motor/api.hpp>

/// Modes of a rotating system over the speed of a rotor: curves, critical speeds, stability limits.

namespace kreisel {

/// A mode of a system with spinning bodies.
struct WhirlingMode : GyroscopicMode {
  WhirlOfMode whirl = {};

  /// With coefficients of the period 2 pi/W the mode has the frequencies root.imag() + k W for all
  /// integers k, and root.imag() is reduced to at most W/2 in size. This is the k of the greatest
  /// amplitude.
  int harmonic = 0;

  /// The frequency of the greatest amplitude against the guide.
  [[nodiscard]] double frequency() const { return std::abs(whirl.frequency); }
};

/// Modes that form a curve, one or none for each speed.
using ModeCurve = std::vector<std::optional<WhirlingMode>>;

/// A speed at which the frequency of a mode against the guide is a multiple of the speed. An
/// unbalance (order 1) or another force of the rotor then excites the mode in resonance.
struct CriticalSpeed {
  double speed = 0;
  double order = 1;  ///< frequency/speed
  WhirlingMode mode;
  std::size_t curve = 0;
};

/// A speed at which motions begin to grow, or cease to.
struct StabilityLimit {
  double speed = 0;
  bool begins = true;  ///< motions grow above the speed
  WhirlingMode mode;   ///< that grows
};

/// The modes over the speed of a rotor.
///
/// Units : rad/s
struct RotorSweep {
  std::vector<double> speeds;
  std::vector<ModeCurve> curves;  ///< of oscillations
  std::vector<CriticalSpeed> critical;
  std::vector<StabilityLimit> limits;
};

struct SweepOptions {
  std::vector<double> orders = {1};  ///< of critical speeds
  double accuracy = 1e-10;           ///< relative, of critical speeds and stability limits
};

/// All modes at a speed; of two conjugate ones that with root.imag() >= 0.
using ModesAt = std::function<std::vector<WhirlingMode>(double speed)>;

/// Follows the modes over the speeds. Modes at neighbouring speeds are connected by their likeness
/// |x.y|, so that curves may cross. Where a curve crosses the line of an order, or where motions
/// begin to grow between two speeds, the speed is found by root finding.
///
/// Error  : of critical speeds and limits `accuracy` of them, and the error of the roots by the
///          slope of their curve. Pairs of crossings between neighbouring speeds are missed
/// Throws : InvalidInput if an order is not above 0 or speeds are not in order; as `modes`
KREISEL_API [[nodiscard]] RotorSweep rotor_sweep(const ModesAt& modes, std::vector<double> speeds,
                                                 const SweepOptions& options = {});

}  // namespace kreisel
