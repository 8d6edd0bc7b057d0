#include "modes_output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <numbers>

#include <dynamics/file/printable.hpp>

using namespace kreisel;

namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) {
    all += all.empty() ? "" : ", ";
    all += name;
  }
  return all;
}

/// "+2" for 2, "" for 0.
std::string signed_text(int k) { return k == 0 ? "" : fmt::format("{:+d}", k); }

bool grows(const WhirlingMode& mode) { return mode.root.real() > mode.error; }

/// Prints a table of one number for each speed and curve; `cell` makes its text.
template <class Cell>
void print_curves(const SceneSweep& sweep, const Cell& cell) {
  fmt::print("  {:>12}", "speed");
  for (std::size_t c = 0; c < sweep.curves.size(); ++c) fmt::print(" {:>17}", c + 1);
  fmt::print("\n");
  for (std::size_t i = 0; i < sweep.speeds.size(); ++i) {
    fmt::print("  {:12.6g}", sweep.speeds[i]);
    for (const ModeCurve& curve : sweep.curves) {
      fmt::print(" {:>17}", curve[i] ? cell(*curve[i]) : "-");
    }
    fmt::print("\n");
  }
}

/// The frequency against the guide, the first letter of the whirl, and * if the mode grows.
std::string frequency_cell(const SceneSweep& sweep, const WhirlingMode& mode) {
  const double w = mode.frequency() > mode.error ? mode.frequency() : 0;
  const std::string whirl = sense(mode);
  const std::string k = sweep.is_periodic ? signed_text(mode.harmonic) : "";
  return fmt::format("{:.8g}{} {}{}", w, k.empty() ? "" : "(" + k + ")",
                     whirl.empty() ? ' ' : whirl[0], grows(mode) ? '*' : ' ');
}

bool any_growth(const SceneSweep& sweep) {
  for (const ModeCurve& curve : sweep.curves) {
    for (const auto& mode : curve) {
      if (mode && shown_root(*mode).real() != 0) return true;
    }
  }
  return false;
}

void print_critical(const SceneSweep& sweep) {
  if (sweep.critical.empty()) {
    fmt::print("  no critical speed in this range\n");
    return;
  }
  fmt::print("  critical speeds, where a frequency is a multiple of the speed\n");
  fmt::print("  {:>16} {:>8} {:>18} {:>14} {:>6}  {}\n", "speed, rad/s", "order",
             "frequency, rad/s", "growth, 1/s", "curve", "whirl");
  for (const CriticalSpeed& critical : sweep.critical) {
    fmt::print("  {:16.10g} {:8g} {:18.10g} {:14.6g} {:6}  {}\n", critical.speed, critical.order,
               critical.mode.frequency(), shown_root(critical.mode).real(), critical.curve + 1,
               name(critical.mode.whirl.sense));
  }
}

void print_limits(const SceneSweep& sweep) {
  for (const StabilityLimit& limit : sweep.limits) {
    fmt::print("  motions {} at {:.10g} rad/s, with {:.10g} rad/s\n",
               limit.begins ? "begin to grow" : "cease to grow", limit.speed,
               limit.mode.frequency());
  }
}

}  // namespace

void print(const LinearMotion& linear) {
  fmt::print("\nlinear equations there: {}\n", name(linear.verdict));
  if (!linear.modes.empty()) {
    fmt::print("  roots as seen {}\n  {:>16} {:>18} {:>14} {:>12}  {:12} {:9} {}\n",
               printable(linear.frame), "growth, 1/s", "frequency, rad/s", "Hz", "damping", "kind",
               "whirl", "mostly");
  }
  for (const WhirlingMode& mode : linear.modes) {
    const std::complex<double> root = shown_root(mode);
    fmt::print("  {:16.8g} {:18.10g} {:14.6g} {:12.4g}  {:12} {:9} {}\n", root.real(), root.imag(),
               root.imag() / (2 * std::numbers::pi), damping_ratio(root),
               kind(mode, linear.has_rotors), sense(mode),
               mostly(mode, linear.names, linear.rates));
  }
  if (linear.sample_period > 0) {
    fmt::print(
        "  of the sampled loop, from its transition over {:.9g} s; roots that die within it: {}\n",
        linear.sample_period, linear.dead_beats);
  }
  if (!linear.left_out.empty()) {
    fmt::print("  without roots, given or such that nothing depends on it: {}\n",
               joined(linear.left_out));
  }
  if (!linear.dependent.empty()) {
    fmt::print("  follow from the others by constraints: {}\n", joined(linear.dependent));
  }
}

void print(const SceneSweep& sweep) {
  fmt::print("\nfrequencies against the guide, rad/s, over the speed of {}, rad/s\n",
             printable(sweep.body));
  fmt::print("  f forward, b backward, p plane, m mixed whirl; * grows\n");
  if (sweep.is_periodic) {
    fmt::print("  (+k): reduced by k times the angular frequency of the coefficients\n");
  }
  print_curves(sweep, [&](const WhirlingMode& mode) { return frequency_cell(sweep, mode); });
  if (any_growth(sweep)) {
    fmt::print("  growth, 1/s, of roots as seen {}\n", printable(sweep.frame));
    print_curves(sweep, [](const WhirlingMode& mode) {
      return fmt::format("{:.6g}", shown_root(mode).real());
    });
  }
  print_critical(sweep);
  print_limits(sweep);
}

void print(const std::vector<WhirlingMode>& modes, const FloquetMotion& motion, int rates) {
  const double W = 2 * std::numbers::pi / motion.period;
  fmt::print(
      "  modes: exp((growth + i frequency) t) times a function of the period; k: the "
      "amplitude is greatest at frequency + k {:.9g} rad/s\n",
      W);
  fmt::print("  {:>16} {:>18} {:>4} {:>18}  {:9} {}\n", "growth, 1/s", "frequency, rad/s", "k",
             "greatest, rad/s", "whirl", "mostly");
  for (const WhirlingMode& mode : modes) {
    const std::complex<double> root = shown_root(mode);
    fmt::print("  {:16.8g} {:18.10g} {:>4} {:18.10g}  {:9} {}\n", root.real(), root.imag(),
               signed_text(mode.harmonic), mode.frequency(), sense(mode),
               mostly(mode, motion.names, rates));
  }
}
