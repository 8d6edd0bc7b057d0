#pragma once

#include <vector>

#include "point.hpp"

namespace work_precision {

/// Each function adds its runs.
using AddRuns = void (*)(std::vector<Run>&, const Thoroughness&);

void dzhanibekov(std::vector<Run>& runs, const Thoroughness& thoroughness);
void fast_top(std::vector<Run>& runs, const Thoroughness& thoroughness);
void slow_top(std::vector<Run>& runs, const Thoroughness& thoroughness);
void fast_top_axis(std::vector<Run>& runs, const Thoroughness& thoroughness);
void pendulum(std::vector<Run>& runs, const Thoroughness& thoroughness);
void earth_pendulum(std::vector<Run>& runs, const Thoroughness& thoroughness);
void earth_ball(std::vector<Run>& runs, const Thoroughness& thoroughness);
void ship(std::vector<Run>& runs, const Thoroughness& thoroughness);

void cardan_free(std::vector<Run>& runs, const Thoroughness& thoroughness);
void cardan_on_base(std::vector<Run>& runs, const Thoroughness& thoroughness);
void cardan_blades(std::vector<Run>& runs, const Thoroughness& thoroughness);
void satellite(std::vector<Run>& runs, const Thoroughness& thoroughness);

/// Bearings of 1e3, 1e6, 1e9 N m/rad, of 1e6 without damping, of 1e12, and of 1e12 with the
/// bearing's deviation to ten digits.
void bearing_1e3(std::vector<Run>& runs, const Thoroughness& thoroughness);
void bearing_1e6(std::vector<Run>& runs, const Thoroughness& thoroughness);
void bearing_1e9(std::vector<Run>& runs, const Thoroughness& thoroughness);
void bearing_undamped(std::vector<Run>& runs, const Thoroughness& thoroughness);
void bearing_1e12(std::vector<Run>& runs, const Thoroughness& thoroughness);
void bearing_deviation(std::vector<Run>& runs, const Thoroughness& thoroughness);

}  // namespace work_precision
