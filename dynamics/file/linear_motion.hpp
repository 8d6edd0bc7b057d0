#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include <dynamics/file/study_system.hpp>
#include <dynamics/study/rotor_sweep.hpp>

namespace kreisel {

enum class Verdict { stable, marginal, unstable };

/// The linear equations about a steady motion.
struct LinearMotion {
  /// Slowest first; of two conjugate modes the one with root.imag() > 0. Shapes have all
  /// directions.
  std::vector<WhirlingMode> modes;
  std::vector<std::string> names;      ///< of the directions
  std::vector<std::string> left_out;   ///< directions that are given or on which nothing depends
  std::vector<std::string> dependent;  ///< directions that follow from the others by constraints
  int rates = 0;                       ///< number of rates: directions of coordinates come first
  double sample_period = 0;            ///< s, common to all controllers; 0: none is sampled
  int dead_beats = 0;                  ///< number of roots that die within it
  std::string frame;                   ///< in which the modes are observed: "against the guide", ..
  bool has_rotors = false;             ///< so that modes have a kind
  Verdict verdict = Verdict::marginal;
};

/// The linear equations about a steady state, with their roots.
///
/// Error  : of the roots as spectrum(), reported for each
/// Throws : as linearize() and spectrum()
[[nodiscard]] LinearMotion linear_motion(const StudySystem& system, const Eigen::VectorXd& state);

/// The verdict from the growth of modes above the border of stability. Each mode has an `error`.
template <class Modes, class Growth>
[[nodiscard]] Verdict verdict(const Modes& modes, bool all_directions, const Growth& growth) {
  Verdict result = all_directions ? Verdict::stable : Verdict::marginal;
  for (const auto& mode : modes) {
    if (growth(mode) > mode.error) return Verdict::unstable;
    if (growth(mode) >= -mode.error) result = Verdict::marginal;
  }
  return result;
}

}  // namespace kreisel
