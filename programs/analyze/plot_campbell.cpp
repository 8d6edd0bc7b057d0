#include <fmt/core.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>
#include <sstream>

#include "../shared/gnuplot.hpp"
#include "plot.hpp"

using namespace kreisel;

using gnuplot::quoted;

namespace {

/// Okabe and Ito's colours and a mark for each sense of whirl.
struct WhirlLook {
  Whirl whirl;
  const char* name;
  const char* colour;
  int point;
};
constexpr WhirlLook whirl_looks[] = {{Whirl::forward, "forward whirl", "#0072b2", 7},
                                     {Whirl::backward, "backward whirl", "#d55e00", 5},
                                     {Whirl::mixed, "mixed whirl", "#cc79a7", 11},
                                     {Whirl::plane, "plane", "#009e73", 9},
                                     {Whirl::none, "no whirl", "#000000", 2}};

/// Calls `use` with speed and mode of every point.
template <class Use>
void for_each_point(const SceneSweep& sweep, const Use& use) {
  for (const ModeCurve& curve : sweep.curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (curve[i]) use(sweep.speeds[i], *curve[i]);
    }
  }
}

/// The curves as lines, interrupted where a mode is missing.
void write_lines(std::ostream& s, const SceneSweep& sweep) {
  s << "$lines << END\nNaN NaN\n";
  for (const ModeCurve& curve : sweep.curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (curve[i]) {
        fmt::print(s, "{:.9g} {:.9g}\n", sweep.speeds[i], curve[i]->frequency());
      } else {
        s << '\n';
      }
    }
    s << '\n';
  }
  s << "END\n";
}

/// A block of the points that are chosen. Returns true if there are any.
template <class Chosen>
bool write_points(std::ostream& s, const std::string& block, const SceneSweep& sweep,
                  const Chosen& chosen) {
  bool any = false;
  fmt::print(s, "${} << END\nNaN NaN\n", block);
  for_each_point(sweep, [&](double speed, const WhirlingMode& mode) {
    if (!chosen(mode)) return;
    any = true;
    fmt::print(s, "{:.9g} {:.9g}\n", speed, mode.frequency());
  });
  s << "END\n";
  return any;
}

/// The lines frequency = order speed, within the picture.
std::string order_lines(const SceneSweep& sweep) {
  std::set<double> orders{1};
  for (const CriticalSpeed& critical : sweep.critical) orders.insert(critical.order);
  std::string list;
  int dashes = 2;
  for (const double order : orders) {
    const std::string title =
        order == 1 ? "frequency = speed" : fmt::format("frequency = {:g} speed", order);
    list += fmt::format(", {:.9g}*abs(x) with lines dt {} lw 1.4 lc rgb '#555555' title {}", order,
                        dashes++, quoted(title));
  }
  return list;
}

}  // namespace

std::string campbell_script(const AnalysisResult& result, const SceneSweep& sweep) {
  std::ostringstream s;
  write_lines(s, sweep);
  std::string list = "$lines with lines lc rgb '#999999' notitle" + order_lines(sweep);
  if (write_points(s, "growing", sweep,
                   [](const WhirlingMode& mode) { return mode.root.real() > mode.error; })) {
    list += ", $growing with points pt 6 ps 1.6 lw 2 lc rgb '#cc0000' title 'grows'";
  }
  for (std::size_t k = 0; k < std::size(whirl_looks); ++k) {
    const auto is_so = [k](const WhirlingMode& mode) {
      return mode.whirl.sense == whirl_looks[k].whirl;
    };
    const std::string block = fmt::format("look{}", k);
    if (!write_points(s, block, sweep, is_so)) continue;
    list += fmt::format(", ${} with points pt {} ps 0.6 lc rgb '{}' title {}", block,
                        whirl_looks[k].point, whirl_looks[k].colour, quoted(whirl_looks[k].name));
  }
  if (!sweep.critical.empty()) {
    s << "$critical << END\n";
    for (const CriticalSpeed& one : sweep.critical) {
      fmt::print(s, "{:.9g} {:.9g} \"{:.5g}\"\n", one.speed, one.mode.frequency(), one.speed);
    }
    s << "END\n";
    list +=
        ", $critical using 1:2 with points pt 4 ps 1.8 lw 1.6 lc rgb '#000000' title 'critical "
        "speed'"
        ", $critical using 1:2:3 with labels left offset 1,-0.8 font ',10' notitle";
  }
  double top = 0;
  for_each_point(
      sweep, [&top](double, const WhirlingMode& mode) { top = std::max(top, mode.frequency()); });
  const auto [least, greatest] = std::minmax_element(sweep.speeds.begin(), sweep.speeds.end());
  s << gnuplot::style << "set key outside right top\nset format '%.4g'\n"
    << "set ylabel 'frequency against the guide [rad/s]'\n"
    << "set xlabel " << quoted("speed of " + sweep.body + " [rad/s]") << "\nset title "
    << title_of(result, "Campbell diagram") << '\n';
  fmt::print(s, "set xrange [{:.9g}:{:.9g}]\nset yrange [0:{:.9g}]\n", *least, *greatest,
             1.05 * top);
  s << "plot " << list << "\nunset output\n";
  return s.str();
}
