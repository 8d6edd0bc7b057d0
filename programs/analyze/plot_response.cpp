#include <fmt/core.h>
#include <fmt/ostream.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <sstream>
#include <vector>

#include "../shared/gnuplot.hpp"
#include "plot.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;

using gnuplot::quoted;

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                   "#e69f00", "#56b4e9", "#000000"};

/// A curve of a Bode picture.
struct BodeCurve {
  std::string name;
  std::vector<std::complex<double>> values = {};
  double shift = 0;  ///< added to the phases, in degrees: full turns

  /// The phases in degrees, without jumps of full turns between neighbours.
  [[nodiscard]] std::vector<double> phases() const {
    std::vector<double> result;
    double before = 0;
    for (const std::complex<double>& value : values) {
      const double phase = std::arg(value) * degrees_per_radian;
      before = result.empty() ? phase + shift : before + std::remainder(phase - before, 360);
      result.push_back(before);
    }
    return result;
  }
};

/// The value of a curve's phases at the frequency next to the given one.
double phase_next_to(const Response& response, const std::vector<double>& phases,
                     double frequency) {
  std::size_t nearest = 0;
  const auto away = [&](std::size_t i) {
    return std::abs(std::log(response.frequencies[i] / frequency));
  };
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (away(i) < away(nearest)) nearest = i;
  }
  return phases[nearest];
}

/// The open loop, by as many turns that its margins are next to -180 degrees.
BodeCurve open_loop(const Response& response) {
  BodeCurve loop{"open loop L", response.loop};
  const auto& margin = response.margins->phase ? response.margins->phase : response.margins->gain;
  if (margin) {
    const double phase = phase_next_to(response, loop.phases(), margin->frequency);
    loop.shift = -360 * std::round((phase + 180) / 360);
  }
  return loop;
}

std::vector<BodeCurve> curves_of(const Response& response) {
  if (response.margins) return {{"closed loop", response.values}, open_loop(response)};
  if (!response.harmonics) return {{response.output.name, response.values}};
  std::vector<BodeCurve> curves;
  for (int k = -HarmonicResponse::harmonics; k <= HarmonicResponse::harmonics; ++k) {
    curves.push_back({k == 0 ? "at w" : fmt::format("at w {:+d} W", k)});
    for (const auto& row : response.harmonics->values) {
      curves.back().values.push_back(*(row.begin() + HarmonicResponse::harmonics + k));
    }
  }
  return curves;
}

/// Harmonics below this part of the greatest value are rounding and not drawn.
constexpr double least_part = 1e-9;

bool is_shown(const BodeCurve& curve, double greatest) {
  double own = 0;
  for (const auto& value : curve.values) own = std::max(own, std::abs(value));
  return own > least_part * greatest;
}

/// Frequency, amplitude and phase of each curve.
void write_data(std::ostream& s, const Response& response, const std::vector<BodeCurve>& curves) {
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::vector<double> phases = curves[c].phases();
    fmt::print(s, "$curve{} << END\n", c);
    for (std::size_t i = 0; i < phases.size(); ++i) {
      fmt::print(s, "{:.9g} {:.9g} {:.6f}\n", response.frequencies[i],
                 std::abs(curves[c].values[i]), phases[i]);
    }
    s << "END\n";
  }
}

/// The commands that mark the margins in the panels of amplitude and of phase.
struct MarginMarks {
  std::string amplitude;
  std::string phase;

  explicit MarginMarks(const Response& response) {
    if (!response.margins) return;
    constexpr const char* dashes = "nohead dt 3 lw 1.6 lc rgb '#cc0000'";
    if (const auto& margin = response.margins->phase) {
      const double w = margin->frequency;
      const double degrees = margin->margin * degrees_per_radian;
      const double at = degrees - 180;
      amplitude +=
          fmt::format("set arrow from {0:.9g}, graph 0 to {0:.9g}, graph 1 {1}\n", w, dashes);
      phase += fmt::format(
          "set arrow from {0:.9g}, {1:.9g} to {0:.9g}, {2:.9g} heads size graph 0.01,20 lw 2 lc "
          "rgb '#cc0000'\nset label {3} at {0:.9g}, {4:.9g} offset 1,0 tc rgb '#cc0000'\n",
          w, at - degrees, at,
          quoted(fmt::format("phase margin {:.4g} deg at {:.4g} rad/s", degrees, w)),
          at - degrees / 2);
    }
    if (const auto& margin = response.margins->gain) {
      const double w = margin->frequency;
      phase += fmt::format("set arrow from {0:.9g}, graph 0 to {0:.9g}, graph 1 {1}\n", w, dashes);
      amplitude += fmt::format(
          "set arrow from {0:.9g}, {1:.9g} to {0:.9g}, 1 heads size graph 0.01,20 lw 2 lc rgb "
          "'#cc0000'\nset label {2} at {0:.9g}, {3:.9g} offset 1,0 tc rgb '#cc0000'\n",
          w, 1 / margin->margin,
          quoted(fmt::format("gain margin {:.4g} at {:.4g} rad/s", margin->margin, w)),
          1 / std::sqrt(margin->margin));
    }
  }
};

/// The clauses of all curves that are large enough to be seen. column : 2 amplitude, 3 phase
std::string clauses(const std::vector<BodeCurve>& curves, int column) {
  double greatest = 0;
  for (const auto& curve : curves) {
    for (const auto& value : curve.values) greatest = std::max(greatest, std::abs(value));
  }
  std::string list;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!is_shown(curves[c], greatest)) continue;
    list += fmt::format("{}$curve{} using 1:{} with lines lw 2 lc rgb '{}' title {}",
                        list.empty() ? "" : ", ", c, column, colours[c], quoted(curves[c].name));
  }
  return list;
}

}  // namespace

std::string response_script(const AnalysisResult& result, const Response& response) {
  const std::vector<BodeCurve> curves = curves_of(response);
  const MarginMarks marks(response);
  std::ostringstream s;
  write_data(s, response, curves);
  std::string title = response.output.name + " for " + response.input.name;
  if (response.harmonics) {
    title += fmt::format(", W = {:.6g} rad/s", 2 * std::numbers::pi / response.harmonics->period);
  }
  const std::string& unit = response.input.unit;
  const bool is_product = unit.find(' ') != std::string::npos;
  const std::string per = unit.empty() ? "" : " / " + (is_product ? "(" + unit + ")" : unit);
  s << gnuplot::style << "set multiplot layout 2,1 title " << title_of(result, title) << '\n'
    << "set logscale x\nset lmargin 12\nset grid xtics mxtics ytics lt 1 lc rgb '#dddddd'\n"
    << "set format '%g'\nset key outside right top width -2\nset rmargin 22\n";
  fmt::print(s, "set xrange [{:.9g}:{:.9g}]\n", response.frequencies.front(),
             response.frequencies.back());
  s << "set logscale y\nset ylabel " << quoted("amplitude [" + response.output.unit + per + "]")
    << '\n'
    << marks.amplitude << "plot " << clauses(curves, 2)
    << (response.margins ? ", 1 with lines dt 2 lc rgb '#555555' notitle" : "") << '\n'
    << "unset arrow\nunset label\nunset logscale y\nset ylabel 'phase [deg]'\n"
    << "set xlabel 'frequency [rad/s]'\nset ytics 90\n"
    << marks.phase << "plot " << clauses(curves, 3)
    << (response.margins ? ", -180 with lines dt 2 lc rgb '#555555' notitle" : "") << '\n'
    << "unset multiplot\nunset output\n";
  return s.str();
}
