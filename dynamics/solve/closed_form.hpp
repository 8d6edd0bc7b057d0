#pragma once

#include <optional>

#include <dynamics/compiled.hpp>
#include <dynamics/scene/closed_form.hpp>
#include <dynamics/scene/euler_top.hpp>

namespace kreisel {

/// The closed form of a top, where it has one: free of torque, Lagrange's, or a
/// gyrostat whose rotor lies on a principal axis.
///
/// Error  : the estimate is the rounding of two quaternions, the answer and what it is compared with,
///          2^-63 of each radian turned through, and 2^-60 of those that Lagrange's top takes off
///                               (tests/dynamics/solve/solve, tests/dynamics/exact/lagrange_top)
KREISEL_DECLARED [[nodiscard]] std::optional<ClosedForm<EulerTop::State>> closed_form(
    const EulerTop& top, double begin, const EulerTop::State& start);

}  // namespace kreisel

#ifndef KREISEL_COMPILED
#include <dynamics/solve/closed_form_defined.hpp>
#endif
