#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <dynamics/file/scene_file.hpp>

/// What tells one run from another: the texts of the scene and of its tables, what is asked of them
/// and which columns are written.
[[nodiscard]] std::uint64_t identity(const std::filesystem::path& scene_file,
                                     const kreisel::SceneFile& scene);

/// A bookmark of a run, in a file beside its CSV file: FILE.resume.
class ResumeFile {
 public:
  struct Bookmark {
    double t = 0;
    long long bytes = 0;  ///< of the CSV file, up to the row of t
    std::vector<double> numbers;
  };

  ResumeFile(const std::filesystem::path& csv, std::uint64_t run);

  /// Nothing where there is none of this run.
  [[nodiscard]] std::optional<Bookmark> read() const;

  /// Where the file cannot be written the one before stays, which serves as well.
  void write(const Bookmark& bookmark) const;

  void remove() const;

 private:
  std::filesystem::path place_;
  std::uint64_t run_;
};
