#pragma once

#include <filesystem>

#include <dynamics/file/csv.hpp>
#include <dynamics/guide/tabulated.hpp>

namespace kreisel {

/// Reads a logged motion: columns t, qw, qx, qy, qz and, if the origin moves, x, y, z.
///
/// Attitude G to I, position of G's origin on I's axes; TabulatedFrame checks the motion itself.
///
/// Units  : second, metre
/// Throws : InvalidInput naming file, line and column
[[nodiscard]] inline MotionLog<double> read_motion_log(const std::filesystem::path& path) {
  const CsvTable table = CsvTable::read(path, {"t", "qw", "qx", "qy", "qz"});
  const bool moves = table.has("x") || table.has("y") || table.has("z");
  for (const char* const column : {"x", "y", "z"}) {
    if (moves && !table.has(column)) {
      throw InvalidInput(path.string() + ": a position needs x, y and z, but there is no column '" +
                         column + "'");
    }
  }
  MotionLog<double> log;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const auto number = [&](const char* column) { return table.number(i, column); };
    log.times.push_back(number("t"));
    log.attitudes.emplace_back(number("qw"), number("qx"), number("qy"), number("qz"));
    if (moves) log.positions.emplace_back(number("x"), number("y"), number("z"));
  }
  return log;
}

}  // namespace kreisel
