#pragma once

#include <functional>
#include <optional>
#include <sstream>
#include <stop_token>
#include <vector>

#include <motor/api.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// How a run is computed.
enum class Method {
  /// The closed form where the scene has one; splitting for a fast top; taylor where the scene knows
  /// its series; else verner98. Both give way to radau13 where the field proves stiff, and to gauss16
  /// where a long run asks for it.
  automatic,
  closed_form,  ///< of the scene; see closed_form.hpp
  verner98,     ///< ExplicitRungeKutta, adaptive
  gauss16,      ///< GaussIRK, fixed: the last digits of 1e4 periods and more
  radau13,      ///< RadauSteps, adaptive: for stiff fields
  splitting,    ///< SplittingSteps, fixed: for a symmetric top whose spin commands its weight
  taylor        ///< TaylorSteps, adaptive: for scenes that know their series()
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

/// What is asked of a run. Options are of one type for all scenes; what depends on the scene's state,
/// the function that watches the outputs, is an argument of solve().
struct SolveOptions {
  double begin = 0;

  /// Times of output in order, forwards or backwards; the last is the end.
  std::vector<double> output_times = {};

  /// The end, in place of output_times. Output times are then begin, begin + output_step, ... and
  /// t_end; without an output_step t_end alone. The step is positive also for runs backwards.
  std::optional<double> t_end = std::nullopt;
  std::optional<double> output_step = std::nullopt;

  std::vector<double> discontinuities = {};  ///< when guide or loads jump: steps end there
  double tolerance = 1e-10;                  ///< of the global error; see RunReport::error_estimate

  Method method = Method::automatic;

  /// A part of the state smaller than this (SI) counts as being so large.
  double absolute_scale = 1e-3;

  /// Evaluations of the field after which each run of adaptive steps gives up.
  double max_evaluations = 1e8;

  /// Ends the run when another thread asks its source to stop: before the next step, with
  /// RunStatus::cancelled. Outputs up to there are kept.
  std::stop_token stop = {};

  /// Called after every output but the last with what gives a checkpoint, for whoever wants to keep
  /// one. Verner98, taylor, gauss16 and radau13 have them, closed forms and splitting need none.
  std::function<void(const std::function<std::vector<double>()>& checkpoint)> offer_checkpoint =
      nullptr;

  /// The run goes on behind the output after which this was taken, as it did then to the last bit:
  /// scene, start and the other options have to be the same. The trajectory is the part that is
  /// new, or all of it where the run begins again with shorter steps; the report is of the whole.
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

/// By how many last digits the start of the run beside is off. Who asks for the last digits of the
/// result takes those of the start for exact.
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
