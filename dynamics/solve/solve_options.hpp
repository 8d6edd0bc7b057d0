#pragma once

#include <functional>
#include <optional>
#include <sstream>
#include <stop_token>
#include <vector>

#include <motor/api.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The method of a run.
enum class Method {
  /// The closed form if the scene has one; splitting for a fast top; taylor if the scene has
  /// series(); else verner98. Taylor and verner98 change to radau13 where the field proves stiff,
  /// and to gauss16 where a long run needs it.
  automatic,
  closed_form,  ///< of the scene; see closed_form.hpp
  verner98,     ///< ExplicitRungeKutta, adaptive
  gauss16,      ///< GaussIRK, fixed: the last digits of 1e4 periods and more
  radau13,      ///< RadauSteps, adaptive: for stiff fields
  splitting,    ///< SplittingSteps, fixed: for a symmetric top whose spin dominates its weight
  taylor        ///< TaylorSteps, adaptive: for scenes with series()
};

[[nodiscard]] constexpr const char* name(Method method) {
  switch (method) {
    case Method::automatic: return "automatic";
    case Method::closed_form: return "closed form";
    case Method::verner98: return "verner98";
    case Method::gauss16: return "gauss16";
    case Method::radau13: return "radau13";
    case Method::splitting: return "splitting";
    case Method::taylor: return "taylor";
  }
  return "none";
}

/// The outputs, the tolerance and the method of a run. The type is the same for all scenes: on_output,
/// which depends on the type of the state, is an argument of solve().
struct SolveOptions {
  double begin = 0;

  /// Times of output in order, forwards or backwards; the last is the end.
  std::vector<double> output_times = {};

  /// The end, instead of output_times. Output times are then begin, begin + output_step, ... and
  /// t_end, or t_end alone without output_step. The step is positive also for runs backwards.
  std::optional<double> t_end = std::nullopt;
  std::optional<double> output_step = std::nullopt;

  std::vector<double> discontinuities = {};  ///< when guide or loads jump: steps end there
  double tolerance = 1e-10;                  ///< of the global error; see RunReport::error_estimate

  Method method = Method::automatic;

  /// A part of the state smaller than this (SI) counts as this large.
  double absolute_scale = 1e-3;

  /// Evaluations of the field after which each run of adaptive steps gives up.
  double max_evaluations = 1e8;

  /// Ends the run before its next step if a stop is requested. The outputs so far are kept, and the
  /// status is RunStatus::cancelled.
  std::stop_token stop = {};

  /// Called after every output but the last, with a function that returns a checkpoint. Verner98,
  /// taylor, gauss16 and radau13 have checkpoints; closed forms and splitting need none.
  std::function<void(const std::function<std::vector<double>()>& checkpoint)> offer_checkpoint =
      nullptr;

  /// A checkpoint. The run continues after the output of the checkpoint, identical to the last bit.
  /// Scene, start and the other options must be the same. The trajectory is only the new part, or
  /// all of it if the run begins again with shorter steps. The report covers the whole run.
  std::vector<double> checkpoint = {};
};

namespace detail {

template <class... Words>
[[noreturn]] void refuse_task(const Words&... words) {
  std::ostringstream text;
  text.precision(17);
  (text << ... << words);
  throw InvalidInput(text.str());
}

/// The perturbation of the comparison run's start, in last digits. It is 0 for a tolerance in the
/// last digits, which takes the start as exact.
[[nodiscard]] inline double digits_off(const SolveOptions& options) {
  return options.tolerance > 1e-11 ? 1 : 0;
}

KREISEL_API void check(const SolveOptions& options);

/// The options with output_times in place of t_end and output_step.
///
/// Throws : InvalidInput if both output_times and t_end are given, or none, or no grid of output times
KREISEL_API [[nodiscard]] SolveOptions with_output_times(const SolveOptions& options);

/// begin, begin + step, ... and end, forwards or backwards. A last step shorter than a billionth of the
/// others is rounding and makes no output.
KREISEL_API [[nodiscard]] std::vector<double> output_grid(double begin, double end, double step);

}  // namespace detail

}  // namespace kreisel
