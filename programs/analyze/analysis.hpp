#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/steady_motions.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/spectrum.hpp>

#include "request.hpp"

enum class Verdict { stable, marginal, unstable };

/// The linear equations about a steady motion.
struct Linear {
  /// Slowest first; of two conjugate ones that with root.imag() > 0. Shapes in all directions.
  std::vector<kreisel::GyroscopicMode> modes;
  std::vector<std::string> names;     ///< of the directions
  std::vector<std::string> left_out;  ///< those on which nothing depends here, or that are given
  std::string frame;                  ///< from which the modes are seen: "against the guide", ..
  bool has_rotors = false;            ///< so that modes are of some kind
  Verdict verdict = Verdict::marginal;
};

/// Modes that belong together, one for each speed or none.
using Curve = std::vector<std::optional<kreisel::GyroscopicMode>>;

struct Campbell {
  std::string body;
  std::vector<double> speeds;
  bool has_rotors = false;
  std::vector<Curve> curves;
};

/// Of a motion that repeats itself.
struct Floquet {
  double period = 0;
  std::string reason;  ///< why there are no multipliers
  Eigen::VectorXd start;
  double residual = 0;                     ///< of the return
  std::vector<kreisel::Mode> multipliers;  ///< greatest first, of two conjugate ones both
  Verdict verdict = Verdict::marginal;
};

/// An equilibrium and the linear equations about it.
struct Rest {
  kreisel::steady_motion::Equilibrium equilibrium;
  Linear linear;

  /// By the roots; where they do not decide stable if the potential energy is least there.
  Verdict stability = Verdict::marginal;
  double distance = 0;  ///< of the coordinates from the file's start, greatest
};

struct Analysis {
  std::vector<Rest> equilibria;  ///< stable ones first, then by their distance from the start
  int starts = 0;                ///< states from which they were searched
  kreisel::Steady steady;
  std::optional<Linear> linear;
  std::optional<Campbell> campbell;
  std::optional<Floquet> floquet;
  kreisel::PrecessionCheck precession;
  std::vector<std::string> notes;  ///< on what is beyond this program
};

/// The system of a scene, its guide known as long as the analysis looks at it.
[[nodiscard]] kreisel::SceneFile with_longer_guide(kreisel::SceneFile scene,
                                                   const Request& request);

/// Throws : kreisel::InvalidInput for what is asked of a body or period that does not fit the
///          scene; kreisel::ComputationFailed where a sweep finds no steady motion
[[nodiscard]] Analysis analyze(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                               const Request& request);
