#include "plot.hpp"

#include <fmt/core.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include <dynamics/file/printable.hpp>

#include "../shared/gnuplot.hpp"

using namespace kreisel;

using gnuplot::quoted;

namespace {

// A picture of this many panels can be read.
constexpr std::size_t most_keys = 4;
constexpr std::size_t most_columns = 12;

/// The columns whose values at the end differ between members; the keys come before them.
std::vector<std::size_t> spread_columns(const EnsembleSummary& all, std::size_t keys) {
  std::vector<std::size_t> result;
  for (std::size_t k = keys; k < all.columns.size(); ++k) {
    const ColumnSpread& column = all.columns[k];
    if (column.count > 0 && column.least < column.greatest) result.push_back(k);
  }
  return result;
}

/// A line for each complete member, with the columns of the summary.
void write_points(std::ostream& s, const std::vector<SceneMember>& members) {
  s << "$members << END\n";
  for (const SceneMember& member : members) {
    if (member.status != RunStatus::complete) continue;
    for (const double x : member.varied) fmt::print(s, "{:.9g} ", x);
    for (const double x : member.end) fmt::print(s, "{:.9g} ", x);
    s << '\n';
  }
  s << "END\n";
}

/// 1, 2 or 5 times a power of ten: at most five of them in the range of a column.
double tics(const ColumnSpread& column) {
  const double least = (column.greatest - column.least) / 4;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= least) return step * power;
  }
  return 10 * power;
}

std::string ends_over_keys(const SceneEnsemble& ensemble, const std::vector<SceneMember>& members,
                           const EnsembleSummary& all, std::size_t keys,
                           const std::vector<std::size_t>& columns) {
  std::ostringstream s;
  write_points(s, members);
  s << gnuplot::style << "unset key\nset offsets graph 0.05, graph 0.05, graph 0.08, graph 0.08\n";
  const std::string& title = ensemble.scene().title;
  fmt::print(s,
             "set multiplot layout {},{} title {} margins char 13, char 4, char 5, char 4 "
             "spacing char 6, char 2\n",
             columns.size(), keys,
             quoted(fmt::format("{}{} members at the end", title.empty() ? "" : title + ": ",
                                members.size())));
  for (const std::size_t column : columns) {
    const bool is_last = column == columns.back();
    fmt::print(s, "set ytics {:.9g}\n", tics(all.columns[column]));
    for (std::size_t key = 0; key < keys; ++key) {
      const ColumnSpread& drawn = all.columns[key];
      s << (drawn.least < drawn.greatest ? fmt::format("set xtics {:.9g}\n", tics(drawn))
                                         : "set xtics autofreq\n");
      s << (is_last ? "set xlabel " + quoted(ensemble.keys()[key]) + "\nset format x '%.5g'\n"
                    : "unset xlabel\nset format x ''\n")
        << (key == 0 ? "set ylabel " + quoted(all.columns[column].name) + "\nset format y '%.5g'\n"
                     : "unset ylabel\nset format y ''\n");
      fmt::print(s, "plot $members using {}:{} with points pt 7 ps 0.4 lc rgb '#0072b2'\n", key + 1,
                 column + 1);
    }
  }
  s << "unset multiplot\nunset output\n";
  return s.str();
}

}  // namespace

void draw(const SceneEnsemble& ensemble, const std::vector<SceneMember>& members,
          const EnsembleSummary& all, const std::filesystem::path& folder) {
  std::vector<std::size_t> columns = spread_columns(all, ensemble.keys().size());
  if (columns.empty()) {
    fmt::print(stderr, "ensemble: nothing to draw: no two complete members end apart\n");
    return;
  }
  const std::size_t keys = std::min(ensemble.keys().size(), most_keys);
  if (keys < ensemble.keys().size() || columns.size() > most_columns) {
    fmt::print(stderr, "ensemble: the picture has the first {} of {} keys, {} of {} columns\n",
               keys, ensemble.keys().size(), std::min(columns.size(), most_columns),
               columns.size());
    columns.resize(std::min(columns.size(), most_columns));
  }
  gnuplot::draw(folder / "members", 110 + 150 * columns.size(),
                ends_over_keys(ensemble, members, all, keys, columns));
}
