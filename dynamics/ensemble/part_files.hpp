#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/ensemble/pack.hpp>
#include <dynamics/file/atomic_file.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// Members of an ensemble from `first` on.
struct MemberRange {
  std::size_t first;
  std::size_t count;
};

/// The results of an ensemble, one row of text for each member, in parts with a file each. If a
/// program ends early, the existing parts need not be computed again. Several programs may write
/// different parts of one folder.
///
/// A file names its ensemble and appears whole or not at all.
class PartFiles {
 public:
  /// Number of members in a part: whole packs of any width.
  static constexpr std::size_t members = 256;
  static_assert(members % Pack::lanes == 0);

  /// `what` is one line that names seed, scene, options and all other inputs of the rows.
  ///
  /// Throws : InvalidInput if the folder cannot be made
  PartFiles(std::filesystem::path folder, std::string what, std::size_t count)
      : folder_(std::move(folder)), what_(std::move(what)), count_(count) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw InvalidInput(folder_.string() + ": " + error.message());
  }

  [[nodiscard]] std::size_t size() const { return (count_ + members - 1) / members; }

  [[nodiscard]] MemberRange range(std::size_t part) const {
    return {part * members, std::min(members, count_ - part * members)};
  }

  [[nodiscard]] bool has(std::size_t part) const { return std::filesystem::exists(path(part)); }

  /// The parts that have no file yet.
  [[nodiscard]] std::vector<std::size_t> missing() const {
    std::vector<std::size_t> parts;
    for (std::size_t part = 0; part < size(); ++part) {
      if (!has(part)) parts.push_back(part);
    }
    return parts;
  }

  /// Throws : ComputationFailed or InvalidInput if the file cannot be written
  void write(std::size_t part, const std::vector<std::string>& rows) const {
    AtomicFile file(path(part));
    file.stream() << heading() << '\n';
    for (const std::string& row : rows) file.stream() << row << '\n';
    file.commit();
  }

  /// Throws : InvalidInput if the file cannot be read or belongs to another ensemble
  [[nodiscard]] std::vector<std::string> read(std::size_t part) const {
    std::ifstream file(path(part));
    std::string line;
    if (!std::getline(file, line)) throw InvalidInput(path(part).string() + ": cannot be read");
    if (line != heading()) {
      throw InvalidInput(path(part).string() + ": belongs to another ensemble: " + line);
    }
    std::vector<std::string> rows;
    while (std::getline(file, line)) rows.push_back(line);
    if (file.bad() || rows.size() != range(part).count) {
      throw InvalidInput(path(part).string() + ": must have one row for each member");
    }
    return rows;
  }

 private:
  [[nodiscard]] std::filesystem::path path(std::size_t part) const {
    return folder_ / ("members-" + std::to_string(part * members) + ".csv");
  }

  [[nodiscard]] std::string heading() const {
    return "# " + what_ + ", lanes " + std::to_string(Pack::lanes) + ", members " +
           std::to_string(count_);
  }

  std::filesystem::path folder_;
  std::string what_;
  std::size_t count_;
};

}  // namespace kreisel
