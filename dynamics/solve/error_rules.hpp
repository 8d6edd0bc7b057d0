#pragma once

#include <limits>

/// The numbers of the error estimate (docs/site/errors.md).

namespace kreisel::detail::rules {

// Two runs of different accuracy.

/// The ratio of the errors of the two runs of a pair. For verner98, of order 9, ten costs 1.29 times
/// the steps. The coarser run's error is then 10/9 of the difference. In 95 % of 835 runs at 1e-6 to
/// 1e-2 it was 0.84 to 1.23 times that, at finer ones 0.94 to 1.07 times.
inline constexpr double times_finer = 30;
inline constexpr double times_finer_verner98 = 10;

/// Covers runs that are not so much finer, as where stability limits explicit steps.
inline constexpr double caution = 1.5;

/// The first accuracy is the tolerance divided by this. For taylor finer steps cost a tenth more; a
/// second try would double them.
inline constexpr double first_below_tolerance = 10;
inline constexpr double first_below_tolerance_taylor = 30;

/// A pair below this accuracy would differ by little more than rounding.
inline constexpr double near_rounding = 4e-16;

/// The accuracy beyond which rounding leaves nothing to gain, even in a long run. For taylor 1e-18
/// costs a tenth more than 4e-16, and its error over 1e5 s is up to 200 times smaller.
inline constexpr double finest_verner98 = 1e-16;
inline constexpr double finest_taylor = 1e-18;
inline constexpr double finest_radau13 = 4e-16;

/// The error of coarser steps may decrease more slowly than their accuracy, without rounding.
inline constexpr double follows_its_order = 1e-9;

// Rounding.

/// The rounding error of one step, in units of 2^-53, without growth. For radau13 with the end of
/// Newton's iterations and stiff springs. For verner98 half is enough at tolerances of 1e-13 and
/// finer, but too little over 1e5 periods at 1e-9.
inline constexpr double rounding_of_step = 2.5;
inline constexpr double rounding_of_verner98_at_last_digits = 1.25;
inline constexpr double rounding_of_radau13 = 24;

/// The effect of n steps on the state, in last digits, is this times sqrt(n), and times the factor of
/// the method: longer steps round more.
inline constexpr double digits_per_root_of_steps = 0.02;

/// The perturbation, in last digits, of the runs that show the growth of rounding: far above the
/// rounding of steps, far below their error. Rounding changes a step by 0.2 to 0.7 digits.
inline constexpr double perturbed_digits = 1000;
inline constexpr double digits_rounded = 0.5;

/// The length of a step across a corner, as a part of the steps before it: the order of the steps is
/// lost on it. The runs that show the growth of rounding cross corners in the same steps, although
/// their corners differ by the perturbation.
inline constexpr double corner_width = 1e-12;
inline constexpr double corner_width_perturbed = 1e-8;

/// The greatest error of these runs. Coarse steps cost little and take about the same path.
inline constexpr double error_of_cheap_runs = 1e-2;
inline constexpr double coarsest_cheap_accuracy = 1e-3;

/// The estimate of growth and rounding itself are both random: one may be 12 times the other.
inline constexpr double growth_uncertainty = 12;
inline constexpr double no_growth = 1e-13;

/// Growth is estimated at tolerances below this. At greater ones it would cost most, and the estimate
/// is hardly ever wrong without it.
inline constexpr double greatest_tolerance_of_growth = 1e-7;

/// A pair must agree to this part of the tolerance, else the growth of rounding is estimated.
inline constexpr double agrees_well = 1.0 / 8;

/// Steps finer than the tolerance by this factor that still miss it amplify their errors.
inline constexpr double amplifies = 50;

// Tries.

/// The first error is extrapolated to the end in proportion to time, at most by this factor.
inline constexpr double greatest_forecast = 10;
/// A try ends if the error at the end is expected to exceed the tolerance by this factor.
inline constexpr double hopeless = 4;
/// Bounds of the ratio of accuracies between one try and the next.
inline constexpr double least_tightening = 0.2;
inline constexpr double greatest_tightening = 1e-4;
/// The same for the lengths of equal steps.
inline constexpr double least_shortening = 0.9;
inline constexpr double greatest_shortening = 0.2;
/// The error of implicit steps falls faster than their accuracy where they begin to resolve a motion
/// that coarser ones damp. The power was up to this, in rods between springs of gears.
inline constexpr double power_of_implicit_steps = 1.6;
/// The accuracy of implicit steps changes by this to confirm an error that is far below the expected.
inline constexpr double confirms = 1e-2;
/// An error that departs from the expected one by more than this factor is rounding.
inline constexpr double departs = 10;

}  // namespace kreisel::detail::rules
