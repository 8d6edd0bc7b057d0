#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/steady_motions.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/margins.hpp>
#include <dynamics/study/spectrum.hpp>

/// Studies of the steady motions of a scene file.

namespace kreisel::scene_analysis {

/// A rotor whose speed is swept.
struct Sweep {
  std::string body;
  std::vector<double> speeds;  ///< rad/s, against its carrier
};

/// A response that is requested.
struct ResponseRequest {
  std::string input;                ///< as plant_input() has it
  std::string output;               ///< as plant_output() has it
  std::vector<double> frequencies;  ///< rad/s, rising
};

struct AnalysisRequest {
  std::optional<Sweep> campbell = {};
  std::optional<ResponseRequest> response = {};
  std::optional<double> period = {};  ///< s, of the coefficients
};

enum class Verdict { stable, marginal, unstable };

/// The linear equations about a steady motion.
struct Linear {
  /// Slowest first; of two conjugate modes the one with root.imag() > 0. Shapes have all
  /// directions.
  std::vector<kreisel::GyroscopicMode> modes;
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

/// Modes that form a curve, one or none for each speed.
using Curve = std::vector<std::optional<kreisel::GyroscopicMode>>;

struct Campbell {
  std::string body;
  std::vector<double> speeds;
  bool has_rotors = false;
  std::vector<Curve> curves;
};

/// The stability of a periodic motion.
struct Floquet {
  double period = 0;
  std::string reason;  ///< why there are no multipliers
  Eigen::VectorXd start;
  double residual = 0;                     ///< of the return after a period
  std::vector<kreisel::Mode> multipliers;  ///< greatest first; both of two conjugate ones
  Verdict verdict = Verdict::marginal;
};

/// The response of an output to an input, at increasing frequencies.
struct Response {
  kreisel::PlantInput input;
  kreisel::PlantOutput output;
  std::vector<double> frequencies;           ///< rad/s
  std::vector<std::complex<double>> values;  ///< output per input
  std::optional<double> bandwidth;
  std::optional<kreisel::LoopMargins> margins;  ///< of a loop that is open at this joint force
  bool is_first_harmonic = false;               ///< a controller is sampled
};

/// An equilibrium and the linear equations about it.
struct Rest {
  kreisel::steady_motion::Equilibrium equilibrium;
  Linear linear;

  /// The verdict by the roots; if they do not decide, stable if the potential energy has a minimum.
  Verdict stability = Verdict::marginal;
  double distance = 0;  ///< greatest distance of a coordinate from the file's start
};

struct Analysis {
  std::vector<Rest> equilibria;  ///< stable ones first, then by their distance from the start
  int starts = 0;                ///< number of starts of the search
  kreisel::Steady steady;
  std::optional<Linear> linear;
  std::optional<Campbell> campbell;
  std::optional<Floquet> floquet;
  std::optional<Response> response;
  kreisel::PrecessionCheck precession;
  std::vector<std::string> notes;  ///< on the limits of this program
};

/// The scene with a guide that is defined for as long as the analysis needs it.
[[nodiscard]] kreisel::SceneFile with_longer_guide(kreisel::SceneFile scene,
                                                   const AnalysisRequest& request);

/// Throws : kreisel::InvalidInput if a requested body or period does not fit the scene;
///          kreisel::ComputationFailed if a sweep finds no steady motion
[[nodiscard]] Analysis analyze(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                               const AnalysisRequest& request);

}  // namespace kreisel::scene_analysis
