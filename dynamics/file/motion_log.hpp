#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/guide/tabulated.hpp>

namespace kreisel {

/// A logged motion with the line numbers and the spacing of its numbers in the file.
struct LoggedMotion {
  MotionLog<double> motion;
  std::vector<std::size_t> lines = {};  ///< the line of each sample, from 1
  double time_resolution = 0;           ///< s, spacing of the numbers as they were written
  double attitude_resolution = 0;       ///< spacing of the quaternion's components
  double position_resolution = 0;       ///< m
};

/// The columns of a logged motion: qw, qx, qy, qz or yaw, pitch, roll; x, y, z if the origin moves.
[[nodiscard]] std::vector<LogRequest> motion_log_columns();

/// Reads a logged motion.
///
/// The attitude is that of G relative to I, the position that of G's origin on I's axes. Angles are
/// a rotation by yaw about z, then by pitch about the new y, then by roll about the new x.
///
/// Units  : second, metre, radian (degree by `options.degrees`)
/// Throws : InvalidInput as read_log(), and if the attitude rotates by more than 90 degrees from
///          one row to the next
[[nodiscard]] LoggedMotion read_motion_log(const std::filesystem::path& path,
                                           const LogOptions& options = {});

}  // namespace kreisel
