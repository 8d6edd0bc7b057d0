#include <cstddef>
#include <sstream>

#include <dynamics/solve/outputs.hpp>

namespace kreisel::detail {

void cancel(RunReport& report, const char* who, double last_output) {
  report.status = RunStatus::cancelled;
  std::ostringstream text;
  text.precision(15);
  text << "stopped by " << who << "; the last output is that of t = " << last_output << " s";
  report.message = text.str();
}

/// Passes a state to on_output; true if the run continues.
[[nodiscard]] static bool show(const OnComponents& on_output, double t,
                               std::span<const double> state, RunReport& report) {
  if (!on_output || on_output(t, state) == OutputAction::proceed) return true;
  cancel(report, "on_output", t);
  return false;
}

bool output(Trajectory<double>& result, InvariantWatch& watch, const OnComponents& on_output,
            double t, std::span<const double> state, double error) {
  result.times.push_back(t);
  result.states.insert(result.states.end(), state.begin(), state.end());
  result.errors.push_back(error);
  watch.note(t, state);
  return show(on_output, t, state, result.report);
}

void show_all(Trajectory<double>& run, const OnComponents& on_output) {
  if (run.times.empty()) return;
  const std::size_t components = run.states.size() / run.times.size();
  const std::span<const double> all = run.states;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    if (show(on_output, run.times[i], all.subspan(i * components, components), run.report)) {
      continue;
    }
    run.times.resize(i + 1);
    run.states.resize((i + 1) * components);
    run.errors.resize(i + 1);
  }
}

}  // namespace kreisel::detail
