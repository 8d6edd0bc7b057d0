#pragma once

#include <nlohmann/json.hpp>

#include <complex>
#include <string>
#include <vector>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/scene_sweep.hpp>

/// Modes of linear equations: their words, and their JSON objects.

namespace kreisel {

/// "stable", "marginal" or "unstable".
[[nodiscard]] const char* name(Verdict verdict);

/// "nutation", "precession" or "oscillation"; "" without rotors or without oscillation.
[[nodiscard]] const char* kind(const GyroscopicMode& mode, bool has_rotors);

/// The root for display: parts that are no larger than its error are 0.
[[nodiscard]] std::complex<double> shown_root(const Mode& mode);

[[nodiscard]] double damping_ratio(const std::complex<double>& root);

/// The direction of the coordinate or rate with the greatest amplitude.
[[nodiscard]] std::string mostly(const WhirlingMode& mode, const std::vector<std::string>& names,
                                 int rates);

/// The sense of an oscillation; "" for other roots.
[[nodiscard]] const char* sense(const WhirlingMode& mode);

[[nodiscard]] nlohmann::ordered_json json_of(const WhirlingMode& mode, bool has_rotors);
[[nodiscard]] nlohmann::ordered_json roots_json(const LinearMotion& linear);
[[nodiscard]] nlohmann::ordered_json json_of(const LinearMotion& linear);
[[nodiscard]] nlohmann::ordered_json json_of(const SceneSweep& sweep);

}  // namespace kreisel
