#pragma once

#include <functional>
#include <string>

namespace kreisel {

/// A motion in closed form: the state at any time, and its error.
///
/// A scene with a closed form offers it by a function
///
///   std::optional<ClosedForm<State>> closed_form(const Scene&, double begin, const State& start)
///
/// which returns nothing for parameters without one. solve() tries it before any steps.
template <class State>
struct ClosedForm {
  std::string name;
  std::function<State(double)> at;
  /// error(t, smallest): the error at output times, which must be given in order, by the measure of
  /// RunReport::error_estimate. `smallest` is the absolute scale of the SolveOptions.
  std::function<double(double, double)> error;
};

}  // namespace kreisel
