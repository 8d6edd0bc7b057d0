#pragma once

#include <vector>

#include <dynamics/rigid/euler_top.hpp>

namespace stability {

/// A top whose weight, if any, pulls along body z, in 50 digits: its states at given times.
///
/// It shares no formula with the library (tests/support/top_truth.hpp).
std::vector<kreisel::EulerTop::State> top_in_50_digits(const kreisel::EulerTop& top,
                                                       const kreisel::EulerTop::State& start,
                                                       const std::vector<double>& times);

/// A symmetric top without torque in 50 digits, by two rotations, at any time.
kreisel::EulerTop::State symmetric_in_50_digits(const kreisel::EulerTop& top,
                                                const kreisel::EulerTop::State& start, double time);

}  // namespace stability
