#pragma once

#include <functional>
#include <vector>

#include <dynamics/sensor/increments.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// The increments of an inertial unit from begin to end, by adaptive steps.
///
/// readings : function of time
/// breaks   : times at which the readings jump
/// Error    : <= 1e-14 of the integrals of |w| and |f|
///            (tests/dynamics/study/increments: coning and sculling in closed form)
/// Cost     : 16 readings for each step of verner98
/// Throws   : ComputationFailed if the readings are not finite
KREISEL_API [[nodiscard]] Increments increments(
    const std::function<InertialReading(double t)>& readings, double begin, double end,
    const std::vector<double>& breaks = {});

}  // namespace kreisel
