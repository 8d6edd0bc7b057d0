#pragma once

#include <nlohmann/json.hpp>

#include <complex>
#include <string>
#include <vector>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/scene_sweep.hpp>

/// "stable", "marginal" or "unstable".
[[nodiscard]] const char* name(kreisel::Verdict verdict);

/// "nutation", "precession" or "oscillation"; "" without rotors or without oscillation.
[[nodiscard]] const char* kind(const kreisel::GyroscopicMode& mode, bool has_rotors);

/// The root for display: parts that are no larger than its error are 0.
[[nodiscard]] std::complex<double> shown_root(const kreisel::Mode& mode);

[[nodiscard]] nlohmann::ordered_json json(const kreisel::WhirlingMode& mode, bool has_rotors);
[[nodiscard]] nlohmann::ordered_json roots_json(const kreisel::LinearMotion& linear);
[[nodiscard]] nlohmann::ordered_json json(const kreisel::LinearMotion& linear);
[[nodiscard]] nlohmann::ordered_json json(const kreisel::SceneSweep& sweep);

void print(const kreisel::LinearMotion& linear);
void print(const kreisel::SceneSweep& sweep);
/// The modes of a periodic motion.
void print(const std::vector<kreisel::WhirlingMode>& modes, const kreisel::FloquetMotion& motion,
           int rates);
