#pragma once

#include <functional>
#include <sstream>
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

/// What is asked of a run.
struct SolveOptions {
  double begin = 0;
  std::vector<double>
      output_times;  ///< of output, in order, forwards or backwards; the last is the end
  std::vector<double> discontinuities = {};  ///< when guide or loads jump: steps end there
  double tolerance = 1e-10;                  ///< of the global error; see RunReport::error_estimate

  Method method = Method::automatic;

  /// A part of the state smaller than this (SI) counts as being so large.
  double absolute_scale = 1e-3;

  /// Evaluations of the field after which each run of adaptive steps gives up.
  double max_evaluations = 1e8;

  /// Called at every output with the time; false cancels the run. What was computed is kept.
  std::function<bool(double t)> progress = nullptr;

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

}  // namespace detail

}  // namespace kreisel
