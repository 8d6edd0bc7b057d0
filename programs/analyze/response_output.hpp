#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>

#include <dynamics/file/analysis.hpp>

#include "output.hpp"

[[nodiscard]] nlohmann::ordered_json json(const kreisel::scene_analysis::Response& response);
void print(const kreisel::scene_analysis::Response& response);

/// Writes the response as a table of frequency, amplitude and phase, in rad/s and radian.
void write_response(const kreisel::scene_analysis::Response& response,
                    const std::filesystem::path& path);

/// The linear plant about the steady motion: the object of --state-space.
///
/// Throws : kreisel::ComputationFailed without a steady motion
[[nodiscard]] nlohmann::ordered_json state_space_json(const Result& result);
void write_state_space(const Result& result, const std::filesystem::path& path);
