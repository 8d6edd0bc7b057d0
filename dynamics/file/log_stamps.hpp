#pragma once

#include <optional>
#include <vector>

#include <dynamics/file/log_file.hpp>

namespace kreisel::detail {

/// The times of a regular rate of which the stamps of a log are rounded, as 0, 3, 7, 10 ms at
/// 300 Hz. Stamps may be missing. The first and the last stamp remain, so the times are early or
/// late by at most half a unit.
///
/// Nothing if the stamps are regular themselves or too few to tell, or if one is further than its
/// rounding from a regular time. Nothing also if the values are not twice as smooth over regular
/// times: they may have been taken at the stamps.
///
/// columns : t, then the values
/// unit    : s, spacing of the stamps as they were written
[[nodiscard]] std::optional<std::vector<double>> regular_times(
    const std::vector<LogColumn>& columns, double unit);

}  // namespace kreisel::detail
