#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <dynamics/file/analysis.hpp>
#include <dynamics/file/scale.hpp>

/// The results of an analysis as JSON objects, for the program analyze and the Python package.

namespace kreisel {

/// A complete analysis and its subject.
struct AnalysisResult {
  const SceneFile& scene;
  const StudySystem& system;
  const scene_analysis::Analysis& analysis;
};

/// Sizes from a state and from the reactions in this state.
[[nodiscard]] SceneScale scale_of(const AnalysisResult& result, const Eigen::VectorXd& state);

/// The object of  analyze --json.
[[nodiscard]] nlohmann::ordered_json to_json(const AnalysisResult& result);

/// Parts of this object; a scale hides rounding.
[[nodiscard]] nlohmann::ordered_json json_of(const Steady& steady, const AnalysisResult& result,
                                             const SceneScale& scale = {});
[[nodiscard]] nlohmann::ordered_json json_of(const scene_analysis::Rest& rest,
                                             const AnalysisResult& result,
                                             const SceneScale& scale = {});
[[nodiscard]] nlohmann::ordered_json json_of(const FloquetMotion& floquet,
                                             const AnalysisResult& result,
                                             const SceneScale& scale = {});
[[nodiscard]] nlohmann::ordered_json json_of(const scene_analysis::Response& response);

/// The linear plant about the steady motion: the object of  analyze --state-space.
///
/// Throws : ComputationFailed without a steady motion
[[nodiscard]] nlohmann::ordered_json state_space_json(const AnalysisResult& result);

}  // namespace kreisel
