#pragma once

#include <Eigen/Core>

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/periodic_response.hpp>
#include <dynamics/file/scene_sweep.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/margins.hpp>
#include <dynamics/study/spectrum.hpp>

/// Studies of the steady motions of a scene file.

namespace kreisel::scene_analysis {

/// A rotor whose speed is swept.
struct Sweep {
  std::string body;
  std::vector<double> speeds;        ///< rad/s, against its carrier
  std::vector<double> orders = {1};  ///< of critical speeds: frequency/speed
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
  /// Called with about the share of the work that is done, in [0, 1].
  std::function<void(double share)> progress = {};
};

/// The response of an output to an input, at increasing frequencies.
struct Response {
  kreisel::PlantInput input;
  kreisel::PlantOutput output;
  std::vector<double> frequencies;           ///< rad/s
  std::vector<std::complex<double>> values;  ///< output per input
  std::optional<double> bandwidth;
  std::optional<kreisel::LoopMargins> margins;  ///< of a loop that is open at this joint force
  std::vector<std::complex<double>> loop;       ///< gain of the open loop, if there are margins
  std::optional<kreisel::HarmonicResponse>
      harmonics;                   ///< about a periodic motion; `values` are those of w
  bool is_first_harmonic = false;  ///< a controller is sampled
};

/// An equilibrium and the linear equations about it.
struct Rest {
  kreisel::steady_motion::Equilibrium equilibrium;
  kreisel::LinearMotion linear;

  /// The verdict by the roots; if they do not decide, stable if the potential energy has a minimum.
  kreisel::Verdict stability = kreisel::Verdict::marginal;
  double distance = 0;  ///< greatest distance of a coordinate from the file's start
};

struct Analysis {
  std::vector<Rest> equilibria;  ///< stable ones first, then by their distance from the start
  int starts = 0;                ///< number of starts of the search
  kreisel::Steady steady;
  std::optional<kreisel::LinearMotion> linear;
  std::optional<kreisel::SceneSweep> campbell;
  std::optional<kreisel::FloquetMotion> floquet;
  std::vector<kreisel::WhirlingMode> floquet_modes;
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
