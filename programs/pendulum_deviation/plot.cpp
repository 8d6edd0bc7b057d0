#include <fmt/core.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <dynamics/file/printable.hpp>

#include "../shared/gnuplot.hpp"
#include "request.hpp"

using gnuplot::quoted;

namespace {

double abscissa(const Request& request, const Row& row) {
  const auto& [latitude, azimuth, height, rate] = row.site.place;
  if (request.swept == "azimuth") return static_cast<double>(azimuth);
  if (request.swept == "height") return static_cast<double>(height);
  if (request.swept == "rotation-rate") return static_cast<double>(rate);
  return static_cast<double>(latitude);
}

std::string abscissa_title(const Request& request) {
  if (request.swept == "azimuth") return "azimuth of the pendulum axis [deg]";
  if (request.swept == "height") return "height above the ellipsoid [m]";
  if (request.swept == "rotation-rate") return "rotation rate [rad/s]";
  return "latitude [deg]";
}

/// One of the two panels: its quantity and the greatest power of ten, which is part of the label.
struct Panel {
  std::string title;
  std::string unit;
  const char* column;
  double power = 0;

  void take(double value) {
    if (std::isfinite(value) && value != 0) {
      power = std::max(power, std::pow(10, std::floor(std::log10(std::abs(value)))));
    }
  }

  [[nodiscard]] std::string axis() const {
    constexpr const char* raised[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string exponent;
    for (const char c : std::to_string(std::lround(std::log10(power)))) {
      exponent += c == '-' ? "⁻" : raised[c - '0'];
    }
    return "10" + exponent + unit;
  }
};

/// The length up to which a list has a named line for each site; longer ones are points over
/// latitude.
constexpr std::size_t most_names = 60;

std::string script(const Request& request, const std::vector<Row>& rows, bool svg) {
  const double arcsec = 180 * 3600 / std::acos(-1.0);
  const bool named = request.mode == Request::Mode::sites && rows.size() <= most_names;
  Panel deviation{"Deviation from the vertical", " arcsec", "2"};
  Panel change{"Relative change of the period", "", "3"};

  std::ostringstream s;
  s << "$rows << END\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    const double phi = arcsec * row.answer.equilibrium.exact.value;
    const auto& relative = row.answer.period.relative_change_exact;
    deviation.take(phi);
    if (relative) change.take(relative->value);
    // A quoted field of gnuplot must not contain quotes or control characters.
    std::string name = kreisel::printable(row.site.name);
    std::replace(name.begin(), name.end(), '"', '\'');
    fmt::print(s, "{:.17g} {:.17g} {} \"{}\"\n",
               named ? -static_cast<double>(i) : abscissa(request, row), phi,
               relative ? fmt::format("{:.17g}", relative->value) : "NaN", name);
  }
  s << "END\n";
  for (Panel* const panel : {&deviation, &change}) {
    if (panel->power == 0) panel->power = 1;  // all is 0
  }
  const std::size_t height = named ? 130 + 20 * rows.size() : 640;
  s << gnuplot::terminal(svg, height)
    << "set termoption noenhanced\nset grid lc rgb '#dddddd'\nunset key\n"
    << "set style line 1 lw 2 pt 7 ps 0.7 lc rgb '#0072b2'\n";

  if (named) {
    s << "set multiplot layout 1,2\nset zeroaxis lc rgb '#888888'\n"
         "set offsets graph 0.05, graph 0.05, 0, 0\nset tmargin 3\nset bmargin 4\n";
    fmt::print(s, "set yrange [{}:1]\n", -static_cast<double>(rows.size()));
  } else {
    s << "set multiplot layout 2,1\nset xzeroaxis lc rgb '#888888'\n"
         "set autoscale xfix\nset lmargin 12\nset offsets 0, 0, graph 0.08, graph 0.08\n";
    if (abscissa_title(request).find("deg") != std::string::npos) s << "set xtics 30\n";
  }
  for (const Panel& panel : {deviation, change}) {
    s << "set title " << quoted(panel.title) << '\n';
    if (named) {
      const bool left = panel.column == deviation.column;
      s << (left ? "set lmargin at screen 0.30\nset rmargin at screen 0.62\n"
                 : "set lmargin at screen 0.66\nset rmargin at screen 0.98\nset format y ''\n")
        << "set xlabel " << quoted(panel.axis()) << "\n";
      fmt::print(s, "plot $rows using (${}/{:e}):1{} ls 1 with points\n", panel.column, panel.power,
                 left ? ":ytic(4)" : "");
    } else {
      s << "set xlabel " << quoted(abscissa_title(request)) << "\nset ylabel "
        << quoted(panel.axis()) << "\n";
      fmt::print(s, "plot $rows using 1:(${}/{:e}) ls 1 with {}\n", panel.column, panel.power,
                 request.mode == Request::Mode::sites ? "points" : "lines");
    }
  }
  s << "unset multiplot\nunset output\n";
  return s.str();
}

}  // namespace

void draw(const Request& request, const std::vector<Row>& rows) {
  gnuplot::require_installed();
  const bool svg = request.plot->extension() == ".svg";
  gnuplot::draw_picture(*request.plot, script(request, rows, svg));
}
