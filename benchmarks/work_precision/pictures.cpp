// Work-precision pictures, by gnuplot.

#include <fmt/os.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <utility>

#include <motor/error.hpp>

#include "output.hpp"

namespace work_precision {

namespace {

/// A method looks the same in every picture. The colours are those of Okabe and Ito, which
/// colour-blind people can distinguish; methods of one colour differ in their marks. Ours are drawn
/// thick.
struct Look {
  const char* method;
  const char* colour;
  int mark;
};
constexpr const char* black = "#000000";
constexpr const char* orange = "#e69f00";
constexpr const char* sky = "#56b4e9";
constexpr const char* green = "#009e73";
constexpr const char* blue = "#0072b2";
constexpr const char* vermilion = "#d55e00";
constexpr const char* purple = "#cc79a7";
constexpr const char* grey = "#888888";
constexpr Look looks[] = {
    {"auto", black, 7},         {"closed form", black, 3}, {"Verner98", blue, 5},
    {"Taylor", vermilion, 9},   {"Gauss 16", green, 9},    {"Strang", purple, 4},
    {"Blanes864", purple, 11},  {"KahanLi8", purple, 13},  {"Radau 9", vermilion, 4},
    {"Radau 13", vermilion, 5}, {"GSL rkf45", orange, 1},  {"GSL rk8pd", orange, 6},
    {"GSL msadams", orange, 8}, {"GSL bsimp", orange, 12}, {"GSL msbdf", orange, 2},
    {"Odeint dopri5", sky, 1},  {"Odeint rkf78", sky, 6},  {"Odeint Bulirsch-Stoer", sky, 8},
    {"CVODE Adams", grey, 8},   {"CVODE BDF", grey, 2}};

/// The quantity on the vertical axis, and its name in the file's name.
struct Axis {
  const char* file;
  const char* label;
  int column;
};

void draw_one(const std::string& directory, const std::string& scene, const Axis& axis,
              const std::map<std::string, std::vector<Point>>& methods) {
  const std::string script = fmt::format("{}/{}-{}.gp", directory, scene, axis.file);
  {
    fmt::ostream out = fmt::output_file(script);
    std::string curves;
    for (std::size_t i = 0; i < std::size(looks); ++i) {
      const Look& look = looks[i];
      const auto found = methods.find(look.method);
      if (found == methods.end()) continue;
      out.print("$m{} << END\n", i);
      for (const Point& p : found->second) {
        const double error = std::max(p.error, 1e-16);  // drawn at the margin
        out.print("{:.4e} {:.4e} {:.0f}\n", error, 1e3 * p.seconds, p.evaluations);
      }
      out.print("END\n");
      const bool library = of_a_library(look.method);
      curves += fmt::format(
          "{}$m{} using 1:{} with linespoints lw {} dt {} lc rgb '{}' pt {} ps {} title '{}'",
          curves.empty() ? "plot " : ", \\\n  ", i, axis.column, library ? 1.5 : 2.5,
          library ? 2 : 1, look.colour, look.mark, library ? 0.7 : 0.9, look.method);
    }
    out.print(
        "set terminal svg size 800,640 font 'Helvetica,13' background 'white'\n"
        "set output '{}/{}-{}.svg'\nset logscale xy\nset xrange [1e-16:1]\nunset mxtics\n"
        "set format x '10^{{%T}}'\nset format y '10^{{%T}}'\nset xtics 1e-16,100,1\n"
        "set xlabel 'error (rad, or relative)'\nset ylabel '{}'\nset title '{}: left and down is "
        "better' noenhanced\n"
        "set grid lc rgb '#dddddd'\nset bmargin 9\nset key at screen 0.5,0.01 center bottom "
        "maxrows 5 samplen 4 width -4\n{}\n",
        directory, scene, axis.file, axis.label, scene, curves);
  }
  if (std::system(("gnuplot '" + script + "'").c_str()) != 0) {
    throw kreisel::ComputationFailed("gnuplot failed on " + script);
  }
  std::filesystem::remove(script);
}

}  // namespace

void draw(const std::string& directory, const std::vector<Point>& points) {
  std::map<std::string, std::map<std::string, std::vector<Point>>> all;
  for (const Point& p : points) {
    if (p.status == ok) all[p.scene][p.method].push_back(p);
  }
  for (auto& [scene, methods] : all) {
    draw_one(directory, scene, {"time", "CPU time, ms", 2}, methods);
    methods.erase(closed_form);  // it evaluates nothing
    std::erase_if(methods["auto"], [](const Point& p) { return p.evaluations == 0; });
    if (methods["auto"].empty()) methods.erase(automatic);
    draw_one(directory, scene, {"evaluations", "evaluations of the field", 3}, methods);
  }
}

}  // namespace work_precision
