// The results as CSV, as tables and as pictures of drift.

#include "output.hpp"

#include <fmt/os.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <motor/error.hpp>

namespace stability {

namespace {

std::string replaced(std::string text, char from, char to) {
  std::replace(text.begin(), text.end(), from, to);
  return text;
}

std::string shown(double x) { return std::isnan(x) ? "" : fmt::format("{:.2g}", x); }

std::size_t count(const std::vector<Finding>& findings, Verdict verdict) {
  std::size_t sum = 0;
  for (const Finding& f : findings) {
    for (const Row& r : f.rows) sum += r.verdict == verdict ? 1 : 0;
  }
  return sum;
}

void write_row(fmt::ostream& out, const std::string& first, const Row& r) {
  out.print("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", first,
            replaced(r.variant, '|', '/'), r.method, name(r.verdict), shown(r.error),
            shown(r.estimate), shown(r.drift), shown(r.steps), shown(r.seconds),
            replaced(r.note, '|', '/'));
}

constexpr const char* head =
    "| case | run | method | result | true error | estimate | drift | steps | s | |\n"
    "|---|---|---|---|---|---|---|---|---|---|\n";

void draw_one(const std::string& directory, const Finding& finding) {
  std::map<std::string, std::vector<DriftPoint>> series;
  for (const DriftPoint& p : finding.drift) series[p.series].push_back(p);
  const std::string picture = directory + "/drift-" + finding.name;
  const std::string script = picture + ".gp";
  {
    fmt::ostream out = fmt::output_file(script);
    std::string curves;
    std::size_t i = 0;
    for (const auto& [name, points] : series) {
      out.print("$d{} << END\n", i);
      for (const DriftPoint& p : points) {
        out.print("{:.6e} {:.6e}\n", p.t, std::max(std::abs(p.value), 1e-18));
      }
      out.print("END\n");
      curves +=
          fmt::format("{}$d{} using 1:2 with linespoints lw 2 pt {} ps 0.6 title '{}'",
                      curves.empty() ? "plot " : ", \\\n  ", i, i + 4, replaced(name, '\'', ' '));
      ++i;
    }
    out.print(
        "set terminal svg size 800,560 font 'Helvetica,13' background 'white'\n"
        "set output '{}.svg'\nset logscale xy\nset format x '10^{{%T}}'\nset format y "
        "'10^{{%T}}'\nset xlabel 't, s'\nset ylabel 'drift, relative, or error, rad'\n"
        "set title '{}: {}' noenhanced\nset grid lc rgb '#dddddd'\nset key outside bottom center "
        "noenhanced\n{}\n",
        picture, finding.name, replaced(finding.extreme, '\'', ' '), curves);
  }
  if (std::system(("gnuplot '" + script + "'").c_str()) != 0) {
    throw kreisel::ComputationFailed("gnuplot failed on " + script);
  }
  std::filesystem::remove(script);
}

}  // namespace

void write_csv(const std::string& path, const std::vector<Finding>& findings) {
  fmt::ostream out = fmt::output_file(path);
  out.print(
      "case,extreme,run,method,result,true_error,estimate,drift,steps,evaluations,seconds,note\n");
  for (const Finding& f : findings) {
    for (const Row& r : f.rows) {
      out.print("{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.0f},{:.0f},{:.4g},{}\n", f.name,
                replaced(f.extreme, ',', ';'), replaced(r.variant, ',', ';'), r.method,
                name(r.verdict), r.error, r.estimate, r.drift, r.steps, r.evaluations, r.seconds,
                replaced(r.note, ',', ';'));
    }
  }
}

void write_tables(const std::string& path, const std::vector<Finding>& findings) {
  fmt::ostream out = fmt::output_file(path);
  out.print("## Stiff and extreme cases\n\n{} cases:", findings.size());
  for (const Verdict v :
       {Verdict::accurate, Verdict::reported, Verdict::refused, Verdict::failed}) {
    out.print(" {} {}{}", count(findings, v), name(v), v == Verdict::failed ? ".\n" : ",");
  }
  out.print(
      "\nErrors as in RunReport::error_estimate: attitudes in rad, the rest relative. An estimate "
      "in a row\nwhose run makes none is the bound it is held to.\n");
  if (count(findings, Verdict::failed) > 0) {
    out.print("\n### Failed\n\n{}", head);
    for (const Finding& f : findings) {
      for (const Row& r : f.rows) {
        if (r.verdict == Verdict::failed) write_row(out, f.name, r);
      }
    }
  }
  out.print("\n### All\n\n{}", head);
  for (const Finding& f : findings) {
    std::string first = fmt::format("**{}**: {}", f.name, replaced(f.extreme, '|', '/'));
    for (const Row& r : f.rows) {
      write_row(out, first, r);
      first.clear();
    }
  }
}

void draw(const std::string& directory, const std::vector<Finding>& findings) {
  for (const Finding& f : findings) {
    if (!f.drift.empty()) draw_one(directory, f);
  }
}

}  // namespace stability
