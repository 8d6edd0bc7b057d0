#pragma once

#include <chrono>
#include <cmath>
#include <cstddef>
#include <exception>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include <dynamics/solve/solve.hpp>
#include <motor/error.hpp>

#include "catalogue.hpp"
#include <tests/support/worst.hpp>

namespace stability {

/// A scene for solve(), with the truth at every time.
template <class Scene>
struct Trial {
  std::string variant;
  const Scene& scene;
  typename Scene::State start;
  kreisel::SolveOptions options;
  std::function<typename Scene::State(double)> truth;
  double truth_error = 0;    ///< how far that may itself be off
  bool must_answer = true;   ///< or may refuse: then with a clear error
  std::string picture = "";  ///< the series of the picture of drift, if there is one
};

/// The relative rounding uncertainty of an angle of rotation of the truth.
inline constexpr double rounding_of_angle = 2e-16;

[[nodiscard]] inline std::vector<double> every(double step, double end, double begin = 0) {
  const auto n = static_cast<int>(std::lround((end - begin) / step));
  std::vector<double> times;
  for (int i = 1; i <= n; ++i) times.push_back(i == n ? end : begin + i * step);
  return times;
}

/// True if a message says what is wrong: not empty, and more than a name.
[[nodiscard]] inline bool says_something(const std::string& message) { return message.size() > 20; }

/// The greatest relative drift.
[[nodiscard]] inline double drift(const kreisel::RunReport& report) {
  double worst = NAN;
  for (const auto& d : report.invariants) {
    const double relative = d.largest / (d.start == 0 ? 1 : std::abs(d.start));
    if (!(relative <= worst)) worst = relative;
  }
  return worst;
}

/// Compares a trajectory with the truth.
template <class Scene>
void weigh(const Recorder& out, const Trial<Scene>& trial,
           const kreisel::Trajectory<typename Scene::State>& found, Row& row) {
  const kreisel::RunReport& report = found.report;
  row.estimate = report.error_estimate;
  row.steps = report.effort.steps;
  row.evaluations = report.all_evaluations;
  row.drift = drift(report);
  row.error = 0;
  kreisel::ErrorMeasure<Scene> distance(trial.scene, trial.options.absolute_scale);
  distance.note_sizes(report.sizes);
  for (std::size_t i = 0; i < found.times.size(); ++i) {
    const auto y = trial.scene.to_vector(found.states[i]);
    const double off = (y - y).isZero(0)
                           ? distance(y, trial.scene.to_vector(trial.truth(found.times[i])))
                           : double(NAN);
    row.error = kreisel::test::worst_of(row.error, off);
    if (!trial.picture.empty() && found.times[i] != trial.options.begin) {
      out.drift(trial.picture + ", " + row.method, found.times[i] - trial.options.begin, off);
    }
  }
  // The truth is rounded to doubles, too.
  const double allowed = trial.truth_error + 4e-16;
  const bool as_estimated = row.error <= row.estimate + allowed;
  const bool as_promised = report.tolerance_kept && row.error <= trial.options.tolerance + allowed;
  const bool right = as_estimated || as_promised;
  const bool whole = found.times.size() == trial.options.output_times.size();
  if (!right) {
    row.note = std::isnan(row.error) ? "returned a NaN as success"
                                     : "beyond the estimate: a silently wrong number";
    if (!whole) row.note += ", before it stopped: " + report.message;
  } else if (report.status == kreisel::RunStatus::failed) {
    const bool clear = report.message.find("t = ") != std::string::npos;
    row.verdict = clear ? Verdict::refused : Verdict::failed;
    row.note = report.message + (clear ? "" : " (names no time)");
  } else if (!whole) {
    row.note = "output times are missing without a message";
  } else {
    row.verdict = report.tolerance_kept ? Verdict::accurate : Verdict::reported;
    if (row.method == name(kreisel::Method::automatic)) row.note = "by " + report.method;
    if (!as_estimated) row.note += " (beyond the estimate, within the tolerance it says is kept)";
  }
}

/// Solves by a method, if it applies to the scene.
template <class Scene>
Row attempt(const Recorder& out, const Trial<Scene>& trial, kreisel::Method method) {
  kreisel::SolveOptions options = trial.options;
  options.method = method;
  Row row;
  row.variant = trial.variant;
  row.method = name(method);
  out.begin(row.variant, row.method);
  const auto begin = std::chrono::steady_clock::now();
  try {
    const auto found = kreisel::solve(trial.scene, trial.start, options);
    row.seconds = seconds_since(begin);
    weigh(out, trial, found, row);
  } catch (const kreisel::Error& error) {
    row.seconds = seconds_since(begin);
    row.note = error.what();
    if (row.note.find("does not apply") != std::string::npos) return row;
    row.verdict = says_something(row.note) ? Verdict::refused : Verdict::failed;
  } catch (const std::exception& error) {
    row.seconds = seconds_since(begin);
    row.note = std::string("an exception that is none of the library's: ") + error.what();
  }
  const bool automatic = method == kreisel::Method::automatic;
  if (row.verdict == Verdict::refused && automatic && trial.must_answer) {
    row.verdict = Verdict::failed;
    row.note = "refused what is legal: " + row.note;
  }
  out.add(row);
  return row;
}

using Methods = std::initializer_list<kreisel::Method>;

inline constexpr Methods all_methods = {kreisel::Method::automatic, kreisel::Method::verner98,
                                        kreisel::Method::gauss16, kreisel::Method::radau13,
                                        kreisel::Method::splitting};

template <class Scene>
void attempt_all(const Recorder& out, const Trial<Scene>& trial, Methods methods = all_methods) {
  for (const kreisel::Method method : methods) attempt(out, trial, method);
}

/// Compares a number with a bound.
inline void expect_below(const Recorder& out, const std::string& variant, const std::string& method,
                         double error, double bound, const std::string& note = "") {
  Row row;
  row.variant = variant;
  row.method = method;
  row.error = error;
  row.estimate = bound;
  row.note = note;
  row.verdict = error <= bound ? Verdict::accurate : Verdict::failed;
  out.add(row);
}

/// An end without a result: right if its message gives the reason.
inline void add_refusal(const Recorder& out, const std::string& variant, const std::string& method,
                        const std::string& words) {
  Row row;
  row.variant = variant;
  row.method = method;
  row.note = words;
  row.verdict = says_something(words) ? Verdict::refused : Verdict::failed;
  out.add(row);
}

/// An input that must be refused with a clear error that contains all the words.
template <class Do>
void expect_refusal(const Recorder& out, const std::string& variant, const std::string& method,
                    const Do& act, std::initializer_list<const char*> words = {}) {
  Row row;
  row.variant = variant;
  row.method = method;
  out.begin(variant, method);
  try {
    act();
    row.note = "accepted in silence";
  } catch (const kreisel::Error& error) {
    row.note = error.what();
    row.verdict = says_something(row.note) ? Verdict::refused : Verdict::failed;
    for (const char* word : words) {
      if (row.note.find(word) != std::string::npos) continue;
      row.verdict = Verdict::failed;
      row.note += std::string(" (does not say '") + word + "')";
    }
  } catch (const std::exception& error) {
    row.note = std::string("an exception that is none of the library's: ") + error.what();
  }
  out.add(row);
}

}  // namespace stability
