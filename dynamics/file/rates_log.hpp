#pragma once

#include <filesystem>
#include <vector>

#include <dynamics/file/log_file.hpp>
#include <dynamics/guide/rates.hpp>

namespace kreisel {

/// The columns of logged rates: wx, wy, wz and, if the origin is accelerated, ax, ay, az.
[[nodiscard]] std::vector<LogRequest> rates_log_columns();

/// Reads logged rates, all on the guide's own axes.
///
/// Units  : s, rad/s (degree by `options.degrees`), m/s^2
/// Throws : InvalidInput as read_log()
[[nodiscard]] RatesLog read_rates_log(const std::filesystem::path& path,
                                      const LogOptions& options = {});

}  // namespace kreisel
