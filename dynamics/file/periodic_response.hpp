#pragma once

#include <complex>
#include <vector>

#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/study_system.hpp>

namespace kreisel {

/// The response about a periodic motion: an input e^(i w t), t from the start on, causes an output
/// sum_k H_k e^(i (w + k W) t), W = 2 pi/period.
struct HarmonicResponse {
  static constexpr int harmonics = 3;

  double period = 0;
  std::vector<std::vector<std::complex<double>>> values;  ///< for each w: H_-3, .., H_3
  double error = 0;  ///< of all values, relative to the greatest: their change for half the samples
};

/// Joints whose motion is prescribed have no response and no equations.
///
/// frequencies : w, rad/s
/// Error       : reported; the samples are doubled from 16 to at most 128 until it is below 1e-9
/// Throws      : InvalidInput, as PeriodicPlant, or if constraints leave no coordinate free all along
///               the motion; ComputationFailed at an undamped resonance
[[nodiscard]] HarmonicResponse harmonic_response(const StudySystem& system,
                                                 const FloquetMotion& motion,
                                                 const PlantInput& input, const PlantOutput& output,
                                                 const std::vector<double>& frequencies);

}  // namespace kreisel
