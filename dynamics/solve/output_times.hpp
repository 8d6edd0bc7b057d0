#pragma once

#include <cstddef>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// `count` numbers in equal distances, both ends among them exactly: output times of solve(), angles
/// of a scan.
///
///   {.output_times = linspace(0, 10, 101)}   0, 0.1, ... 10
///
/// Error  : <= 2^-50 of the greater end
/// Throws : InvalidInput if an end is not finite or the count is below 2
KREISEL_API [[nodiscard]] std::vector<double> linspace(double from, double to, std::size_t count);

}  // namespace kreisel
