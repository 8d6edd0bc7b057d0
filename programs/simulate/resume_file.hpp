#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/scene_file.hpp>

#include "row_file.hpp"

/// A number that differs between runs with different steps. It depends on the version of the
/// program, the texts of the scene and its tables, end, tolerance, method, output times and
/// columns.
[[nodiscard]] std::uint64_t identity(std::string_view scene_text, const kreisel::SceneFile& scene);

/// A point of a run from which the run continues exactly, to the last bit.
struct Checkpoint {
  double begin = 0;   ///< of the run: 0, or the time of the row from which it started
  double t = 0;       ///< of the last row
  RowFile::Mark row;  ///< the end of that row
  std::vector<double> numbers;
};

/// The checkpoint of a run, in a file beside its CSV file: FILE.resume.
class ResumeFile {
 public:
  ResumeFile(const std::filesystem::path& csv, std::uint64_t run);

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// Reads the checkpoint; nothing if there is no valid one of this run. `why_not` then has the
  /// reason.
  [[nodiscard]] std::optional<Checkpoint> read(std::string& why_not) const;

  /// Writes the checkpoint. If the file cannot be written, the previous checkpoint stays and is
  /// valid.
  void write(const Checkpoint& checkpoint) const;

  void remove() const;

 private:
  std::filesystem::path place_;
  std::uint64_t run_;
};
