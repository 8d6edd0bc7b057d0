#include "output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include <dynamics/file/printable.hpp>

#include "../shared/joint_tables.hpp"
#include "modes_output.hpp"
#include "response_output.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;
using nlohmann::ordered_json;

namespace {

using ::print;

/// The coordinates of all joints with coordinates, in one line.
std::string coordinates_text(const ordered_json& joints) {
  std::string text;
  for (const auto& [body, values] : joints.items()) {
    for (const char* const key : {"coordinate", "attitude", "position"}) {
      if (!values.contains(key)) continue;
      text += fmt::format("{}{} {} {}", text.empty() ? "" : ", ", printable(body, 60), key,
                          joint_tables::text(values[key]));
    }
  }
  return text;
}

std::string roots_text(const LinearMotion& linear) {
  std::string text;
  for (const WhirlingMode& mode : linear.modes) {
    text += text.empty() ? "" : ", ";
    const std::complex<double> root = shown_root(mode);
    text += fmt::format("{:.8g}", root.real());
    if (root.imag() > 0) text += fmt::format(" +- {:.8g}i", root.imag());
  }
  return text.empty() ? "none" : text;
}

void print_equilibria(const AnalysisResult& result) {
  const Analysis& a = result.analysis;
  if (a.starts == 0) return;
  fmt::print("equilibria: {} found from {} start{}\n", a.equilibria.size(), a.starts,
             a.starts == 1 ? "" : "s");
  for (const Rest& rest : a.equilibria) {
    const std::string where =
        coordinates_text(json_of(rest, result, scale_of(result, rest.equilibrium.state))["joints"]);
    const int neutral = rest.equilibrium.neutral;
    const std::string family = neutral == 0 ? ""
                                            : fmt::format(", one of a family in {} direction{}",
                                                          neutral, neutral == 1 ? "" : "s");
    fmt::print("  {:9} {}{}\n            roots, 1/s, {}: {}\n", name(rest.stability), where, family,
               printable(rest.linear.frame), roots_text(rest.linear));
  }
  fmt::print("\n");
}

void print(const Steady& steady, const AnalysisResult& result) {
  if (!steady.exists()) {
    fmt::print("no equilibrium and no steady motion: {}\n", printable(steady.reason));
    return;
  }
  const char* const what = steady.turns ? "steady motion" : "equilibrium";
  if (steady.kind == Steady::Kind::start) {
    fmt::print("{}: the start of the file\n", what);
  } else {
    fmt::print("{}: not the start of the file but the one next to it, up to {:.3g} away\n", what,
               steady.distance);
  }
  const ordered_json table = json_of(steady, result, scale_of(result, steady.state));
  joint_tables::print("joints there", table["joints"]);
  joint_tables::print("reactions there, N and N m, on the body, its axes", table["reactions"]);
}

void print(const FloquetMotion& floquet, const AnalysisResult& result) {
  fmt::print("\nFloquet, period {:.9g} s: ", floquet.period);
  if (!floquet.reason.empty()) {
    fmt::print("none, {}\n", floquet.reason);
    return;
  }
  fmt::print("{}\n  {:>20} {:>20} {:>14} {:>10}\n", name(floquet.verdict), "multiplier", "", "size",
             "error");
  for (const Mode& m : floquet.multipliers) {
    const std::complex<double> root = shown_root(m);
    fmt::print("  {:20.12g} {:+20.12g} {:14.9g} {:10.1e}\n", root.real(), root.imag(),
               std::abs(m.root), m.error);
  }
  print(result.analysis.floquet_modes, floquet, result.system.tree().rates());
  const std::string title =
      fmt::format("the motion that repeats itself, at t = {:.9g}", result.system.begin());
  joint_tables::print(title.c_str(),
                      json_of(floquet, result, scale_of(result, floquet.start))["start"]);
}

void print(const PrecessionCheck& check, double t_end) {
  fmt::print("\nprecession equations: ");
  if (!check.beyond.empty()) {
    fmt::print("none, {}\n", check.beyond);
    return;
  }
  if (!check.not_tested.empty()) {
    fmt::print("not tested, {}\n", check.not_tested);
  } else {
    fmt::print("{}{}\n  G has rank {} of {}; slow roots are off by up to {:.2g} of their size\n",
               check.test.admissible ? "admissible" : "not admissible: ", check.test.reason,
               check.rank, check.velocities, check.test.greatest_shift);
    for (const auto& [technical, exact] : check.test.slow) {
      if (technical.imag() < 0) continue;
      const double size = std::abs(exact);
      fmt::print("  slow root {:.8g} {:+.8g}i, exact {:.8g} {:+.8g}i\n",
                 ::shown(technical.real(), size), ::shown(technical.imag(), size),
                 ::shown(exact.real(), size), ::shown(exact.imag(), size));
    }
  }
  if (!check.no_motion.empty()) {
    fmt::print("  no bound: {}\n", check.no_motion);
    return;
  }
  const auto& [end, bound, nutation, valid_until, slow] = check.motion;
  fmt::print(
      "  from the file's start off by at most {:.2g} in {:.6g} s, nutation {:.2g}, {} of {} "
      "accelerations kept\n",
      bound, end, nutation, check.kept, check.velocities);
  if (!slow) {
    fmt::print("  broken off there, before t_end = {:.6g} s: the motion is not slow\n", t_end);
  } else if (valid_until < end) {
    fmt::print("  below 0.01 until {:.6g} s\n", valid_until);
  }
}

}  // namespace

void print_summary(const AnalysisResult& result) {
  const Analysis& a = result.analysis;
  if (!result.scene.title.empty()) {
    fmt::print("{}\n\n", printable(result.scene.title));
  }
  print_equilibria(result);
  print(a.steady, result);
  if (a.linear) print(*a.linear);
  if (a.campbell) print(*a.campbell);
  if (a.floquet) print(*a.floquet, result);
  if (a.response) print(*a.response);
  print(a.precession, result.scene.t_end);
  for (const std::string& note : a.notes) fmt::print("\nnote: {}\n", note);
}
