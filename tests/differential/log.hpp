#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Logs of a guide's motion, each written in one of the ways that docs/scene_files.md allows.

namespace differential {

using Vector = Eigen::Vector3d;

/// Keys of the file, each with its value as text.
using Keys = std::vector<std::pair<std::string, std::string>>;

/// The columns in the file.
enum class LogHeader {
  usual,     ///< the names that the library expects
  named,     ///< other names, given by the key `columns`
  numbered,  ///< other names; the key `columns` gives numbers
  none
};

/// Spelling of a log.
struct Spelling {
  char separator = ',';
  bool says_separator = false;
  bool decimal_comma = false;
  std::string time_unit = "s";  ///< or ms, us, ns
  int lines_before = 0;         ///< the header
  int lines_after = 0;          ///< the header
  LogHeader header = LogHeader::usual;
  bool header_is_comment = false;
  bool columns_reversed = false;
  bool has_other_column = false;
  bool has_angles = false;      ///< instead of a quaternion
  bool in_degrees = false;      ///< angles and angular rates
  bool ends_with_cr = false;    ///< lines
  std::int64_t time_zero = 0;   ///< ns
  bool begins_at_zero = false;  ///< time_zero is the time of the first row
  bool has_window = false;
  std::string longest_gap = {};  ///< as in the file; empty: not given
  std::string duplicates = {};   ///< which of two rows of one time is right
  std::string sigma = {};        ///< as in the file; empty: not given
};

/// A logged motion: a fixed rotation `from` and one about a fixed axis by amplitude sin(frequency t
/// + phase). The origin shifts with the same sine.
struct Log {
  std::optional<Eigen::Vector4d> from = {};  ///< w, x, y, z
  Vector axis = Vector::UnitX();
  double amplitude = 0;
  Vector shift = Vector::Zero();
  double frequency = 1;
  double phase = 0;
  double step = 0.02;  ///< s
  Spelling spelling = {};
  // For a log of rates.
  bool is_kinematic = false;
  bool says_gravity = false;  ///< false: that of the scene
  Vector gravity = Vector::Zero();

  /// Attitude and position of the guide, and their rates on the guide's axes.
  struct Sample {
    Eigen::Quaterniond attitude;
    Vector place;
    Vector angular_velocity;
    Vector velocity;      ///< on inertial axes
    Vector acceleration;  ///< as the log has it
  };
  [[nodiscard]] Sample at(double t) const;

  /// The file's text, and the keys for reading it.
  [[nodiscard]] std::string csv(double t_end, bool of_rates) const;
  [[nodiscard]] Keys keys(const std::string& file, double t_end, bool of_rates) const;
};

/// The shortest digits that restore the number.
[[nodiscard]] std::string text(double x);

template <class Numbers>
[[nodiscard]] std::string list(const Numbers& numbers) {
  std::string result = "[";
  for (const double x : numbers) result += (result.size() > 1 ? ", " : "") + text(x);
  return result + "]";
}

}  // namespace differential
