#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/study_system.hpp>

/// Motions of scenes whose equations repeat after a period.

namespace kreisel {

/// The period of a scene's equations.
struct FoundPeriod {
  double period = 0;     ///< s; 0: none is found
  std::string reason;    ///< why there is none
  bool is_only = false;  ///< it is that of all parts: no common multiple of several
};

/// The period that follows from the scene: the shortest common multiple of all periods in it. They
/// are those of functions of time, of harmonic guides, and of joints at a constant rate on whose angle
/// the equations depend.
///
/// y : a state with the rates of the joints
[[nodiscard]] FoundPeriod find_period(const StudySystem& system, const SceneFile& scene,
                                      const Eigen::VectorXd& y);

/// A period before the system is made: all joints at a constant rate count.
[[nodiscard]] FoundPeriod find_period(const SceneFile& scene);

/// The relative change of the field after a period, at three moments of the motion.
[[nodiscard]] double field_misses(const StudySystem& system, const Eigen::VectorXd& start,
                                  double period);

/// The stability of a periodic motion.
struct FloquetMotion {
  double period = 0;
  std::string reason;  ///< why there are no multipliers
  Eigen::VectorXd start;
  double residual = 0;             ///< of the return after a period
  std::vector<Mode> multipliers;   ///< greatest first; both of two conjugate ones
  std::vector<int> kept;           ///< directions of the multipliers' shapes
  std::vector<std::string> names;  ///< of all directions
  Verdict verdict = Verdict::marginal;

  [[nodiscard]] bool exists() const { return reason.empty(); }
};

/// The periodic motion next to a state, by shooting, and its multipliers.
[[nodiscard]] FloquetMotion floquet_motion(const StudySystem& system, const Eigen::VectorXd& start,
                                           double period);

/// The states of a periodic motion at equal parts of its period, from the start on.
[[nodiscard]] std::vector<Eigen::VectorXd> states_of(const StudySystem& system,
                                                     const FloquetMotion& motion, int parts);

/// The multipliers as modes exp(s t) p(t), where p has the period T = 2 pi/W.
///
///   s = ln(multiplier)/T,  determined up to multiples of i W;  |root.imag()| <= W/2
///
/// `harmonic` is the k with the greatest amplitude of p. The mode oscillates mostly with the frequency
/// root.imag() + k W >= 0. Its shape and whirl are those of this harmonic.
///
/// Error  : of the roots that of the multipliers, by their size and T
[[nodiscard]] std::vector<WhirlingMode> floquet_modes(const StudySystem& system,
                                                      const FloquetMotion& motion);

}  // namespace kreisel
