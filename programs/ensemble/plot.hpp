#pragma once

#include <filesystem>
#include <vector>

#include <dynamics/ensemble/scene_ensemble.hpp>

/// Draws the members at the end over the numbers that were drawn, into `folder`.
///
/// Throws : kreisel::ComputationFailed as gnuplot::draw_picture()
void draw(const kreisel::SceneEnsemble& ensemble, const std::vector<kreisel::SceneMember>& members,
          const kreisel::EnsembleSummary& all, const std::filesystem::path& folder);
