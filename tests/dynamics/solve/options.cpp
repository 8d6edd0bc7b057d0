#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve.hpp>

using namespace kreisel;

namespace {

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

/// Tops that every method applies to: the first but for splitting, which takes the second.
const EulerTop top({1, 2, 2.5});
const EulerTop fast({3e-4, 3e-4, 1e-4}, {0, 0, 0.049});
const EulerTop::State start{tilted, {1, 2, 3}};

/// An oscillator of 1 rad/s that requests a stop in one evaluation and counts the evaluations after it.
struct Oscillator {
  struct State {
    double x = 0, v = 0;
  };
  using Vector = Eigen::Vector2d;
  static constexpr std::array<int, 2> blocks = {1, 1};

  int stops_at;
  std::stop_source& source;
  int& evaluations;

  [[nodiscard]] Vector rates(double /*t*/, const Vector& y) const {
    if (++evaluations == stops_at) source.request_stop();
    return {y[1], -y[0]};
  }
  [[nodiscard]] static Vector to_vector(const State& s) { return {s.x, s.v}; }
  [[nodiscard]] static State from_vector(const Vector& y) { return {y[0], y[1]}; }
};

std::string refusal(const SolveOptions& options) {
  try {
    (void)solve(top, start, options);
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "none";
}

}  // namespace

BOOST_AUTO_TEST_SUITE(options)

BOOST_AUTO_TEST_CASE(watcher_sees_the_states_returned) {
  std::vector<double> times;
  std::vector<EulerTop::State> states;
  const auto watch = [&](double t, const EulerTop::State& state) {
    if (!times.empty() && t <= times.back()) {  // the run began again
      times.clear();
      states.clear();
    }
    times.push_back(t);
    states.push_back(state);
  };
  for (const double tolerance : {1e-6, 1e-10, 1e-14}) {
    times.clear();
    states.clear();
    const auto run =
        solve(top, start, {.t_end = 20, .output_step = 1, .tolerance = tolerance}, watch);
    BOOST_TEST((run.report.status == RunStatus::complete));
    BOOST_TEST(times == run.times);
    for (std::size_t i = 0; i < states.size(); ++i) {
      BOOST_TEST((states[i].attitude.coeffs() == run.states[i].attitude.coeffs()));
      BOOST_TEST((states[i].angular_velocity == run.states[i].angular_velocity));
    }
  }
}

BOOST_AUTO_TEST_CASE(watcher_changes_no_number) {
  for (const Method method :
       {Method::closed_form, Method::verner98, Method::taylor, Method::gauss16, Method::radau13}) {
    BOOST_TEST_CONTEXT(kreisel::name(method)) {
      const SolveOptions options{.output_times = {1, 2}, .tolerance = 1e-8, .method = method};
      const auto plain = solve(top, start, options);
      const auto watched = solve(top, start, options, [](double, const EulerTop::State&) {});
      BOOST_TEST(
          (plain.states.back().attitude.coeffs() == watched.states.back().attitude.coeffs()));
      BOOST_TEST(plain.report.error_estimate == watched.report.error_estimate);
    }
  }
}

BOOST_AUTO_TEST_CASE(watcher_ends_a_run) {
  for (const Method method : {Method::closed_form, Method::verner98, Method::taylor,
                              Method::gauss16, Method::radau13, Method::automatic}) {
    BOOST_TEST_CONTEXT(kreisel::name(method)) {
      const auto run =
          solve(top, start, {.t_end = 100, .output_step = 1, .tolerance = 1e-6, .method = method},
                [](double t, const EulerTop::State&) {
                  return t < 30 ? OutputAction::proceed : OutputAction::stop;
                });
      BOOST_TEST((run.report.status == RunStatus::cancelled));
      BOOST_TEST(run.report.message == "stopped by on_output; the last output is that of t = 30 s");
      BOOST_TEST(run.times.back() == 30);
      BOOST_TEST(run.states.size() == 31U);
    }
  }
}

// The way to the second output takes minutes, but for closed forms.
BOOST_AUTO_TEST_CASE(token_ends_a_run_between_outputs) {
  for (const Method method : {Method::closed_form, Method::verner98, Method::taylor,
                              Method::gauss16, Method::radau13, Method::splitting}) {
    BOOST_TEST_CONTEXT(kreisel::name(method)) {
      std::stop_source source;
      const bool splits = method == Method::splitting;
      const auto run =
          solve(splits ? fast : top, splits ? EulerTop::State{tilted, {0, 0, 3000}} : start,
                {.output_times = {1, 1e6},
                 .tolerance = 1e-4,
                 .method = method,
                 .stop = source.get_token()},
                [&](double, const EulerTop::State&) { source.request_stop(); });
      BOOST_TEST((run.report.status == RunStatus::cancelled));
      BOOST_TEST(run.report.message == "stopped by request; the last output is that of t = 1 s");
      BOOST_TEST(run.times == std::vector<double>{1});
      BOOST_TEST(run.states.size() == 1U);
    }
  }
}

// A step of verner98 takes 16 evaluations, one of gauss16 eight for each of up to 14 iterations. Each
// of the two runs that have begun takes one more to find the length of its first step.
BOOST_AUTO_TEST_CASE(token_ends_a_run_within_a_step) {
  const std::vector<std::pair<Method, int>> methods = {{Method::verner98, 16},
                                                       {Method::gauss16, 112}};
  for (const auto& [method, a_step] : methods) {
    for (const int stops_at : {1, 100, 1000, 3000}) {
      std::stop_source source;
      int evaluations = 0;
      const Oscillator oscillator{stops_at, source, evaluations};
      const auto run = solve(oscillator, {1, 0},
                             {.output_times = {1e3}, .method = method, .stop = source.get_token()});
      BOOST_TEST((run.report.status == RunStatus::cancelled));
      BOOST_TEST(run.report.message == "stopped by request; the last output is that of t = 0 s");
      BOOST_TEST(evaluations - stops_at <= a_step + 2);
    }
  }
}

BOOST_AUTO_TEST_CASE(token_asked_before_computes_nothing) {
  std::stop_source source;
  source.request_stop();
  int evaluations = 0;
  const Oscillator oscillator{0, source, evaluations};
  const auto run = solve(oscillator, {1, 0}, {.t_end = 1, .stop = source.get_token()});
  BOOST_TEST((run.report.status == RunStatus::cancelled));
  BOOST_TEST(run.times.empty());
  BOOST_TEST(evaluations <= 2);  // for the lengths of first steps
}

BOOST_AUTO_TEST_CASE(spans_output_times_by_end_and_step) {
  const auto times = [](const SolveOptions& options) { return solve(top, start, options).times; };
  using Times = std::vector<double>;
  BOOST_TEST(times({.t_end = 1, .output_step = 0.25}) == Times({0, 0.25, 0.5, 0.75, 1}));
  BOOST_TEST(times({.t_end = 1, .output_step = 0.3}) == Times({0, 0.3, 2 * 0.3, 3 * 0.3, 1}));
  BOOST_TEST(times({.t_end = 1, .output_step = 5}) == Times({0, 1}));
  BOOST_TEST(times({.t_end = 1}) == Times({1}));
  BOOST_TEST(times({.begin = 2, .t_end = 1, .output_step = 0.5}) == Times({2, 1.5, 1}));
  BOOST_TEST(times({.begin = 1, .t_end = 1, .output_step = 0.5}) == Times({1}));
  // 3 * 0.1 lies above 0.3, ten thousand times 0.1 lies 1e-13 off 1000: no time is double.
  BOOST_TEST(times({.t_end = 0.3, .output_step = 0.1}) == Times({0, 0.1, 0.2, 0.3}));
  const Times many = times({.t_end = 1000, .output_step = 0.1});
  BOOST_TEST(many.size() == 10001U);
  BOOST_TEST(many.back() == 1000);
}

BOOST_AUTO_TEST_CASE(refuses_output_times_that_are_none) {
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<SolveOptions, std::string>> refused = {
      {{}, "no output times are given: set output_times or t_end"},
      {{.output_step = 1}, "output_step is given without t_end"},
      {{.output_times = {1}, .t_end = 2}, "output_times are given beside t_end: "},
      {{.output_times = {1}, .output_step = 2}, "output_times are given beside output_step: "},
      {{.t_end = inf}, "an output time is not finite"},
      {{.t_end = nan, .output_step = 1}, "t_end = nan is not finite"},
      {{.t_end = 1, .output_step = 0}, "output_step = 0 must be finite and above 0"},
      {{.t_end = 1, .output_step = -0.1}, "output_step = -0.1"},
      {{.t_end = 1, .output_step = nan}, "output_step = nan must be finite"},
      {{.t_end = 1, .output_step = 1e-8},
       "output_step = 1e-08 makes more than ten million outputs"},
      {{.t_end = 1, .output_step = 1e-320}, "more than ten million outputs"},
      {{.begin = nan, .t_end = 1, .output_step = 1}, "the time of the beginning is not finite"}};
  for (const auto& [options, words] : refused) {
    const std::string told = refusal(options);
    BOOST_TEST(told.find(words) != std::string::npos, told << " has not: " << words);
  }
}

BOOST_AUTO_TEST_CASE(report_prints_a_line_for_each_fact) {
  RunReport report;
  report.method = "radau13";
  report.effort = {.steps = 1234567, .rejected = 2, .evaluations = 8901};
  report.all_evaluations = 20469;
  report.tolerance = 1e-10;
  report.error_estimate = 3.14e-11;
  report.tolerance_kept = true;
  const auto printed = [&] {
    std::ostringstream out;
    out.precision(3);
    out << report << 1.23456;  // what was set for other numbers stays
    return out.str();
  };
  BOOST_TEST(printed() ==
             "method       radau13\n"
             "status       complete\n"
             "steps        1234567, 2 more rejected\n"
             "evaluations  8901, 20469 with those for the error\n"
             "error        3.1e-11, estimated\n"
             "tolerance    1.0e-10, reached\n"
             "1.23");
  report.changes = "taylor to t = 0.5 s, then radau13";
  report.status = RunStatus::failed;
  report.tolerance_kept = false;
  report.message = "no more";
  const std::string text = printed();
  for (const char* const words :
       {"method       taylor to t = 0.5 s, then radau13\n", "status       failed\n",
        "tolerance    1.0e-10, not reached\n", "message      no more\n"}) {
    BOOST_TEST(text.find(words) != std::string::npos, text << " has not: " << words);
  }
}

BOOST_AUTO_TEST_CASE(spaces_numbers_equally) {
  BOOST_TEST(linspace(0, 1, 11) ==
             std::vector<double>({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1}));
  BOOST_TEST(linspace(3, -1, 3) == std::vector<double>({3, 1, -1}));
  BOOST_TEST(linspace(2, 2, 2) == std::vector<double>({2, 2}));
  for (const double end : {0.1, 1e308, -1e-300}) {
    const std::vector<double> numbers = linspace(-end / 3, end, 1000);
    BOOST_TEST(numbers.front() == -end / 3);
    BOOST_TEST(numbers.back() == end);
    const long double step = (static_cast<long double>(end) + end / 3) / 999;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const long double exact = -end / 3 + static_cast<long double>(i) * step;
      BOOST_TEST(std::abs(numbers[i] - exact) <= 0x1p-50L * std::abs(end));
    }
  }
  BOOST_CHECK_THROW((void)linspace(0, 1, 1), InvalidInput);
  BOOST_CHECK_THROW((void)linspace(0, std::numeric_limits<double>::infinity(), 2), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
