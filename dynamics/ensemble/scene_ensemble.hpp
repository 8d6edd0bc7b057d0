#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/ensemble/variation.hpp>
#include <dynamics/ensemble/workers.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/solve/report.hpp>

/// Ensembles of a scene file: many runs that differ in some numbers of the file.

namespace kreisel {

struct EnsembleRequest {
  SolveRequest solve = {};
  std::vector<Variation> variations = {};
  std::size_t members = 1000;
  std::uint64_t seed = 1;  ///< of all that is drawn
};

struct SceneMember {
  RunStatus status = RunStatus::cancelled;
  std::string message;         ///< of a failed member
  std::vector<double> varied;  ///< in the order of SceneEnsemble::keys
  std::vector<double> end;     ///< in the order of SceneEnsemble::columns; empty if it failed
  double error = 0;            ///< RunReport::error_estimate
  bool tolerance_kept = false;
};

/// A scene whose numbers vary, and the columns common to all members.
class SceneEnsemble {
 public:
  /// The text of a scene file, and its path for messages and for logs beside it.
  ///
  /// Throws : SceneMistakes; InvalidInput if a variation adds to, or multiplies, what the file lacks
  SceneEnsemble(std::string text, std::filesystem::path path, EnsembleRequest request);

  [[nodiscard]] const EnsembleRequest& request() const { return request_; }
  [[nodiscard]] const SceneFile& scene() const { return scene_; }
  /// The keys of the varied numbers.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  /// Joints and sensors, in the order of the rows of a run.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }

  /// Runs a member, to the last bit as a run of the file with the numbers drawn. An exception is
  /// the message of a failed member.
  ///
  /// Cost : one run of the scene
  [[nodiscard]] SceneMember member(std::size_t index, const std::stop_token& stop) const;

  /// Runs all members in several threads. The results do not depend on the number of threads.
  /// Members that a stop prevents have the status `cancelled`.
  [[nodiscard]] std::vector<SceneMember> compute(const Workers& workers) const;

 private:
  [[nodiscard]] std::vector<double> varied(std::size_t index) const;
  [[nodiscard]] SolveRequest with(const std::vector<double>& numbers) const;

  std::string text_;
  std::filesystem::path path_;
  EnsembleRequest request_;
  SceneFile scene_;
  std::vector<std::string> keys_;
  std::vector<std::optional<double>> given_;  ///< the numbers of the file at the keys
  std::vector<std::string> columns_;
};

/// The statistics of a column, summed in the order of members.
struct ColumnSpread {
  std::string name;
  double count = 0, mean = 0, squares = 0;
  double least = std::numeric_limits<double>::infinity();
  double greatest = -std::numeric_limits<double>::infinity();

  void add(double x);
  /// The standard deviation, of count - 1 degrees of freedom.
  [[nodiscard]] double deviation() const;
};

/// The number of members of each kind, and the spread of the complete ones.
struct EnsembleSummary {
  std::size_t complete = 0, failed = 0, off = 0;  ///< off: the tolerance was not reached
  double error = 0;                               ///< the greatest
  std::string message;                            ///< of the first failed member
  std::vector<ColumnSpread> columns;
};

[[nodiscard]] EnsembleSummary summary(const SceneEnsemble& ensemble,
                                      const std::vector<SceneMember>& members);

}  // namespace kreisel
