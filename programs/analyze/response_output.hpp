#pragma once

#include <filesystem>

#include <dynamics/json/analysis.hpp>

void print(const kreisel::scene_analysis::Response& response);

/// Writes the response as a table of frequency, amplitude and phase, in rad/s and radian.
void write_response(const kreisel::scene_analysis::Response& response,
                    const std::filesystem::path& path);

/// Writes the linear plant about the steady motion.
///
/// Throws : kreisel::ComputationFailed without a steady motion
void write_state_space(const kreisel::AnalysisResult& result, const std::filesystem::path& path);
