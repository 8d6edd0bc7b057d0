#pragma once

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Logs of a guide's motion, each written down in one of the ways that docs/scene_files.md allows.

namespace differential {

using Vector = Eigen::Vector3d;

/// Keys of the file, each with its value as text.
using Keys = std::vector<std::pair<std::string, std::string>>;

/// How the file has the columns.
enum class LogHeader {
  usual,     ///< by the names that are looked for
  named,     ///< by other names, which the key `columns` gives
  numbered,  ///< by other names, the key `columns` gives numbers
  none
};

/// How a log is written down.
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
  bool begins_at_zero = false;  ///< time_zero is that of the first row
  bool has_window = false;
  std::string longest_gap = {};  ///< as in the file; empty: not given
  std::string duplicates = {};   ///< which of two rows of one time is right
  std::string sigma = {};        ///< as in the file; empty: not given
};

/// A motion that is logged: a turn by `from` after one about a fixed axis by
/// amplitude sin(frequency t + phase), and a shift of the origin by the same sine.
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
  bool says_gravity = false;  ///< else it is that of the scene
  Vector gravity = Vector::Zero();

  /// Attitude and place of the guide, and the rates of both on the guide's axes.
  struct Sample {
    Eigen::Quaterniond attitude;
    Vector place;
    Vector angular_velocity;
    Vector velocity;      ///< on inertial axes
    Vector acceleration;  ///< as the log has it
  };
  [[nodiscard]] Sample at(double t) const;

  /// The file's text, and the keys that say how to read it.
  [[nodiscard]] std::string csv(double t_end, bool of_rates) const;
  [[nodiscard]] Keys keys(const std::string& file, double t_end, bool of_rates) const;
};

/// The fewest digits that give the number back.
[[nodiscard]] std::string text(double x);

template <class Numbers>
[[nodiscard]] std::string list(const Numbers& numbers) {
  std::string result = "[";
  for (const double x : numbers) result += (result.size() > 1 ? ", " : "") + text(x);
  return result + "]";
}

}  // namespace differential
