#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <dynamics/file/scene_file.hpp>

#include "row_file.hpp"

/// A number that differs between runs whose steps differ: it depends on the version of the program,
/// the texts of the scene and of its tables, end, tolerance, method, output times and columns.
[[nodiscard]] std::uint64_t identity(std::string_view scene_text, const kreisel::SceneFile& scene);

/// A place in a run from which it goes on to the same last bit.
struct Checkpoint {
  double begin = 0;   ///< of the run: 0, or the time of the row that it was begun from
  double t = 0;       ///< of the last row
  RowFile::Mark row;  ///< the end of that row
  std::vector<double> numbers;
};

/// The checkpoint of a run, in a file beside its CSV file: FILE.resume.
class ResumeFile {
 public:
  ResumeFile(const std::filesystem::path& csv, std::uint64_t run);

  [[nodiscard]] const std::filesystem::path& place() const { return place_; }

  /// Nothing where there is none of this run that is whole; `why_not` says then why.
  [[nodiscard]] std::optional<Checkpoint> read(std::string& why_not) const;

  /// Where the file cannot be written the one before stays, which serves as well.
  void write(const Checkpoint& checkpoint) const;

  void remove() const;

 private:
  std::filesystem::path place_;
  std::uint64_t run_;
};
