#include "plot.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "../shared/gnuplot.hpp"
#include "modes_output.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;
using namespace kreisel::scene_analysis;

using gnuplot::quoted;

namespace {

/// Okabe and Ito's colours and a mark each for nutations, precessions and other modes.
struct Look {
  const char* kind;
  const char* name;
  const char* colour;
  int point;
};
constexpr Look looks[] = {{"nutation", "nutation", "#0072b2", 7},
                          {"precession", "precession", "#d55e00", 5},
                          {"oscillation", "oscillation", "#009e73", 9},
                          {"", "root", "#000000", 2}};

/// Writes a block of gnuplot's data for each look, never an empty one; `rows` writes those of the
/// k-th.
template <class Rows>
void write_blocks(std::ostream& s, const Rows& rows) {
  for (std::size_t k = 0; k < std::size(looks); ++k) {
    fmt::print(s, "$look{} << END\nNaN NaN\n", k);
    rows(k);
    s << "END\n";
  }
}

bool looks_so(const GyroscopicMode& mode, bool has_rotors, std::size_t k) {
  return std::string(looks[k].kind) == kind(mode, has_rotors);
}

/// The gnuplot clauses of all blocks with data.
std::string points(const std::vector<bool>& shown, double size) {
  std::string list;
  for (std::size_t k = 0; k < std::size(looks); ++k) {
    if (!shown[k]) continue;
    list += fmt::format("{}$look{} with points pt {} ps {} lc rgb '{}' title {}",
                        list.empty() ? "" : ", ", k, looks[k].point, size, looks[k].colour,
                        quoted(looks[k].name));
  }
  return list;
}

std::string roots(const AnalysisResult& result, const LinearMotion& linear) {
  std::ostringstream s;
  std::vector<bool> shown(std::size(looks), false);
  write_blocks(s, [&](std::size_t k) {
    for (const GyroscopicMode& mode : linear.modes) {
      if (!looks_so(mode, linear.has_rotors, k)) continue;
      shown[k] = true;
      fmt::print(s, "{:.9g} {:.9g}\n", mode.root.real(), mode.root.imag());
      if (mode.root.imag() > 0) {
        fmt::print(s, "{:.9g} {:.9g}\n", mode.root.real(), -mode.root.imag());
      }
    }
  });
  double growth = 0;
  double size = 0;
  for (const GyroscopicMode& mode : linear.modes) {
    growth = std::max(growth, std::abs(mode.root.real()));
    size = std::max(size, std::abs(mode.root));
  }
  s << gnuplot::style << "set zeroaxis lc rgb '#555555'\nset key outside right top\n"
    << "set format '%.4g'\nset xlabel 'growth rate [1/s]'\nset ylabel 'frequency [rad/s]'\n"
    << "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\n"
    << "set title " << title_of(result, "roots of the linear equations, seen " + linear.frame)
    << '\n';
  // Growth below rounding is not shown.
  if (growth < 1e-9 * size) fmt::print(s, "set xrange [{:.3g}:{:.3g}]\n", -0.1 * size, 0.1 * size);
  s << "plot " << points(shown, 1.4) << "\nunset output\n";
  return s.str();
}

std::string multipliers(const AnalysisResult& result, const FloquetMotion& floquet) {
  std::ostringstream s;
  s << "$multipliers << END\n";
  for (const Mode& m : floquet.multipliers) {
    fmt::print(s, "{:.9g} {:.9g}\n", m.root.real(), m.root.imag());
  }
  s << "END\n"
    << gnuplot::style << "set zeroaxis lc rgb '#555555'\nset size ratio -1\nunset key\n"
    << "set format '%.4g'\nset xlabel 'real part'\nset ylabel 'imaginary part'\n"
    << "set parametric\nset trange [0:2*pi]\nset samples 361\n"
    << "set offsets graph 0.05, graph 0.05, graph 0.05, graph 0.05\nset title "
    << title_of(result, fmt::format("multipliers over {:.6g} s", floquet.period)) << '\n'
    << "plot cos(t), sin(t) with lines lc rgb '#999999', $multipliers with points pt 7 ps 1.4 lc "
       "rgb '#0072b2'\nunset output\n";
  return s.str();
}

}  // namespace

std::string title_of(const AnalysisResult& result, const std::string& what) {
  const std::string& title = result.scene.title;
  return quoted(title.empty() ? what : title + ": " + what);
}

void draw(const AnalysisResult& result, const std::filesystem::path& folder) {
  gnuplot::require_installed();
  gnuplot::open_folder(folder);
  const Analysis& a = result.analysis;
  const bool has_roots = a.linear && !a.linear->modes.empty();
  const bool has_curves = a.campbell && !a.campbell->curves.empty();
  const bool has_multipliers = a.floquet && !a.floquet->multipliers.empty();
  if (has_roots) gnuplot::draw(folder / "roots", 560, roots(result, *a.linear));
  if (has_curves) gnuplot::draw(folder / "campbell", 560, campbell_script(result, *a.campbell));
  if (a.response) gnuplot::draw(folder / "response", 720, response_script(result, *a.response));
  if (has_multipliers) {
    gnuplot::draw(folder / "multipliers", 640, multipliers(result, *a.floquet));
  }
  if (!has_roots && !has_curves && !a.response && !has_multipliers) {
    fmt::print(stderr,
               "analyze: no picture: there are no roots, sweeps, responses or multipliers\n");
  }
}
