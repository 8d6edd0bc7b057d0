// The measured points as CSV, and their tables.

#include <fmt/os.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

#include "output.hpp"

namespace work_precision {

namespace {

/// The names in the order of their first point.
template <class Get>
std::vector<std::string> names(const std::vector<Point>& points, const Get& get) {
  std::vector<std::string> all;
  for (const Point& p : points) {
    const std::string name = get(p);
    if (!name.empty() && std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  }
  return all;
}

std::vector<std::string> scenes(const std::vector<Point>& points) {
  return names(points, [](const Point& p) { return p.scene; });
}

std::vector<std::string> methods(const std::vector<Point>& points, const std::string& scene) {
  return names(points, [&](const Point& p) { return p.scene == scene ? p.method : ""; });
}

/// The fastest method for an error: a run that reaches it, and the time; null if none does.
struct Fastest {
  const Point* point = nullptr;
  double seconds = 0;
};

/// The time for exactly this error, as a power of the error between this run and the one before, at
/// a coarser setting. Otherwise the method would win whose setting happens to fit.
double time_to(const std::vector<Point>& points, std::size_t i, double error) {
  const Point& p = points[i];
  if (i == 0 || !(p.error > 0)) return p.seconds;
  const Point& coarser = points[i - 1];
  const bool between = coarser.scene == p.scene && coarser.method == p.method &&
                       coarser.status == ok && coarser.error > error && coarser.seconds < p.seconds;
  if (!between) return p.seconds;
  const double part = std::log(coarser.error / error) / std::log(coarser.error / p.error);
  return coarser.seconds * std::pow(p.seconds / coarser.seconds, part);
}

template <class Fits>
Fastest fastest(const std::vector<Point>& points, double error, const Fits& fits) {
  Fastest best;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    if (p.status != ok || !(p.error <= error) || !fits(p)) continue;
    const double seconds = time_to(points, i, error);
    if (!best.point || seconds < best.seconds) best = {&p, seconds};
  }
  return best;
}

std::string ms(const Fastest& p) { return p.point ? fmt::format("{:.3g}", 1e3 * p.seconds) : "-"; }

std::string ratio(const Fastest& p, const Fastest& q) {
  return p.point && q.point ? fmt::format("{:.2g}", p.seconds / q.seconds) : "-";
}

/// The greatest of some ratios, and its case.
struct Worst {
  double ratio = 0;
  std::string where = "-";

  void note(double r, const std::string& place) {
    if (r > ratio) ratio = r, where = place;
  }
};

void winners(fmt::ostream& out, const std::vector<Point>& points) {
  out.print(
      "### Fastest methods\n\n"
      "The least time to an error, in ms, interpolated between settings as a power of the error; "
      "\"-\" where no\nmethod reaches it. \"auto\" is solve() with its error estimate. \"fixed\" "
      "is solve() with the best fixed\nmethod and the same estimate. \"bare\" is the best stepper, "
      "ours or a library's, without an estimate.\n\n"
      "| scene | error | best stepper of ours | ms | best library | ms | library / ours | closed "
      "form, ms | auto | ms | fixed | ms | auto / fixed | auto / bare |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  Worst behind_library;
  Worst behind_fixed;
  Worst behind_best;
  int compared = 0;
  int lost = 0;
  for (const std::string& scene : scenes(points)) {
    for (const double error : {1e-4, 1e-8, 1e-10, 1e-12}) {
      const auto of = [&](const auto& fits) {
        return fastest(points, error,
                       [&](const Point& p) { return p.scene == scene && fits(p.method); });
      };
      const Fastest own = of(is_stepper);
      const Fastest library = of([](const std::string& m) { return of_a_library(m); });
      const Fastest closed = of([](const std::string& m) { return m == closed_form; });
      const Fastest by_auto = of([](const std::string& m) { return m == automatic; });
      const Fastest fixed = of([](const std::string& m) { return m.find(fixed_choice) == 0; });
      const bool library_wins = library.point && (!own.point || library.seconds < own.seconds);
      const Fastest& best = library_wins ? library : own;
      out.print("| {} | {:.0e} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                scene, error, own.point ? own.point->method : "none", ms(own),
                library.point ? library.point->method : "none", ms(library), ratio(library, own),
                ms(closed), by_auto.point ? by_auto.point->promise->method : "none", ms(by_auto),
                fixed.point ? fixed.point->promise->method : "none", ms(fixed),
                ratio(by_auto, fixed), ratio(by_auto, best));
      const std::string place = fmt::format("{} at {:.0e}", scene, error);
      if (own.point && library.point) {
        compared += 1;
        if (library_wins) lost += 1;
        behind_library.note(own.seconds / library.seconds, place);
      }
      if (by_auto.point && fixed.point) {
        behind_fixed.note(by_auto.seconds / fixed.seconds, place);
      }
      if (by_auto.point && best.point) {
        behind_best.note(by_auto.seconds / best.seconds, place);
      }
    }
  }
  out.print(
      "\nA library is faster in {} of the {} cases where both reach the error, at most {:.2g} "
      "times "
      "({}).\nauto takes at most {:.2g} times what solve() takes with the best fixed method ({}), "
      "and at "
      "most {:.2g} times\nwhat the best bare stepper takes ({}).\n\n",
      lost, compared, behind_library.ratio, behind_library.where, behind_fixed.ratio,
      behind_fixed.where, behind_best.ratio, behind_best.where);
}

void least_errors(fmt::ostream& out, const std::vector<Point>& points) {
  out.print(
      "### The least error\n\n"
      "| scene | of ours | | of a library | | closed form | auto |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const std::string& scene : scenes(points)) {
    const auto least = [&](const auto& fits) {
      const Point* best = nullptr;
      for (const Point& p : points) {
        if (p.scene != scene || p.status != ok || !fits(p.method)) continue;
        if (!best || p.error < best->error) best = &p;
      }
      return std::pair<std::string, std::string>(best ? fmt::format("{:.1e}", best->error) : "-",
                                                 best ? best->method : "none");
    };
    const auto own = least(is_stepper);
    const auto library = least([](const std::string& m) { return of_a_library(m); });
    const auto closed = least([](const std::string& m) { return m == closed_form; });
    const auto by_auto = least([](const std::string& m) { return m == automatic; });
    out.print("| {} | {} | {} | {} | {} | {} | {} |\n", scene, own.first, own.second, library.first,
              library.second, closed.first, by_auto.first);
  }
  out.print("\n");
}

void honesty(fmt::ostream& out, const std::vector<Point>& points) {
  out.print(
      "### Error estimates of solve()\n\n"
      "True error over error estimate, both by the measure of RunReport. \"kept\": the true error "
      "is within the\ntolerance; \"no, reported\": it is not, and the report does not claim "
      "it.\n\n"
      "| scene | tolerance | method | true error | estimate | true / estimate | kept |\n"
      "|---|---|---|---|---|---|---|\n");
  struct Count {
    int all = 0;
    int within = 0;
    int broken = 0;
    Worst worst;
  };
  Count by_steps;
  Count closed;
  int failed = 0;
  int left_out = 0;
  for (const Point& p : points) {
    if (p.method != automatic) continue;
    if (!p.promise) {
      const bool tried = p.status != not_tried;
      (tried ? failed : left_out) += 1;
      out.print("| {} | {:.0e} | {} | - | - | - | {} |\n", p.scene, p.setting,
                tried ? "failed" : "none", p.status);
      continue;
    }
    const auto& [method, error, estimate, kept] = *p.promise;
    const double share = error / estimate;
    const bool broken = error > p.setting && kept;
    out.print("| {} | {:.0e} | {} | {:.2e} | {:.2e} | {:.2g} | {} |\n", p.scene, p.setting, method,
              error, estimate, share,
              error <= p.setting ? "yes"
              : broken           ? "**no**"
                                 : "no, reported");
    Count& count = p.evaluations > 0 ? by_steps : closed;
    count.all += 1;
    count.within += share >= 0.1 && share <= 1 ? 1 : 0;
    count.broken += broken ? 1 : 0;
    count.worst.note(share, fmt::format("{} at {:.0e}", p.scene, p.setting));
  }
  out.print(
      "\n| | runs | true / estimate in [0.1, 1] | greatest | where | promises broken |\n"
      "|---|---|---|---|---|---|\n");
  for (const auto& [name, c] : {std::pair("by steps", by_steps), {"closed form", closed}}) {
    if (c.all == 0) continue;
    out.print("| {} | {} | {:.0f} % | {:.2g} | {} | {} |\n", name, c.all, 100.0 * c.within / c.all,
              c.worst.ratio, c.worst.where, c.broken);
  }
  out.print("\n{} runs of auto failed, {} were not tried.\n\n", failed, left_out);
}

void failures(fmt::ostream& out, const std::vector<Point>& points) {
  out.print(
      "### Failures\n\n"
      "| scene | method | runs | failed | not tried after a slow one | the first to fail |\n"
      "|---|---|---|---|---|---|\n");
  for (const std::string& scene : scenes(points)) {
    for (const std::string& method : methods(points, scene)) {
      int all = 0;
      int failed = 0;
      int left_out = 0;
      std::string first = "-";
      for (const Point& p : points) {
        if (p.scene != scene || p.method != method) continue;
        all += 1;
        if (p.status == ok) continue;
        if (p.status == not_tried) {
          left_out += 1;
          continue;
        }
        if (failed == 0) first = fmt::format("{:.1e}: {}", p.setting, p.status);
        failed += 1;
      }
      if (failed + left_out == 0) continue;
      out.print("| {} | {} | {} | {} | {} | {} |\n", scene, method, all, failed, left_out, first);
    }
  }
}

}  // namespace

bool of_a_library(const std::string& method) {
  return method.find("GSL") == 0 || method.find("Odeint") == 0 || method.find("CVODE") == 0;
}

bool is_stepper(const std::string& method) {
  return method != automatic && method != closed_form && method.find(fixed_choice) != 0 &&
         !of_a_library(method);
}

void write_csv(const std::string& path, const std::vector<Point>& points) {
  fmt::ostream out = fmt::output_file(path);
  out.print(
      "scene,method,setting,error,cpu_s,evaluations,status,chosen,reported_error,"
      "error_estimate,tolerance_kept\n");
  for (const Point& p : points) {
    out.print("{},{},{:.3e},{:.3e},{:.4e},{:.0f},{},", p.scene, p.method, p.setting, p.error,
              p.seconds, p.evaluations, p.status);
    if (p.promise) {
      out.print("\"{}\",{:.3e},{:.3e},{:d}\n", p.promise->method, p.promise->error,
                p.promise->estimate, p.promise->kept);
    } else {
      out.print(",,,\n");
    }
  }
}

void write_tables(const std::string& path, const std::vector<Point>& points) {
  fmt::ostream out = fmt::output_file(path);
  if (interrupted()) out.print("Stopped before the end: what is missing was not measured.\n\n");
  winners(out, points);
  least_errors(out, points);
  honesty(out, points);
  failures(out, points);
}

}  // namespace work_precision
