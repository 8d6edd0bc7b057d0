#pragma once

#include <string>

#include "output.hpp"

/// The title of a picture as a gnuplot string.
[[nodiscard]] std::string title_of(const kreisel::AnalysisResult& result, const std::string& what);

/// Scripts for gnuplot, without terminal.
[[nodiscard]] std::string campbell_script(const kreisel::AnalysisResult& result,
                                          const kreisel::SceneSweep& sweep);
[[nodiscard]] std::string response_script(const kreisel::AnalysisResult& result,
                                          const kreisel::scene_analysis::Response& response);
