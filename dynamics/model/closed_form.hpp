#pragma once

#include <functional>
#include <string>

namespace kreisel {

/// A motion known in closed form: the state at any time, and how far it is off.
///
/// A scene that has one offers it by a function
///
///   std::optional<ClosedForm<State>> closed_form(const Scene&, double begin, const State& start)
///
/// which gives nothing where it has none; solve() takes it before any steps.
template <class State>
struct ClosedForm {
  std::string name;
  std::function<State(double)> at;
  /// By the measure of RunReport::error_estimate at output times, given in turn: error(t, smallest),
  /// `smallest` that of the SolveOptions.
  std::function<double(double, double)> error;
};

}  // namespace kreisel
