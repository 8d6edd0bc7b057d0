#include <fmt/core.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/printable.hpp>
#include <dynamics/tree/joint/list.hpp>

#include "../shared/gnuplot.hpp"
#include "output.hpp"
#include "samples.hpp"
#include "shape.hpp"
#include "view.hpp"

using namespace kreisel;

using gnuplot::quoted;

namespace {

/// The maximum number of points that a picture can show.
constexpr std::size_t most_points = 4000;

/// Okabe and Ito's colours, suited to colour-blind readers, and dashes for prints without colours.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7"};
constexpr const char* dashes[] = {"solid", "(14,5)", "(4,4)", "(14,4,3,4)"};

using Series = std::vector<double>;

struct Curve {
  std::string name;
  Series values;
};

struct Panel {
  std::string title;
  std::string unit;
  std::vector<Curve> curves;
};

/// Curves of the columns of a row, beginning at `first`.
std::vector<Curve> curves(const std::vector<std::vector<double>>& rows, std::size_t first,
                          const std::vector<std::string>& names) {
  std::vector<Curve> result;
  for (std::size_t k = 0; k < names.size(); ++k) {
    Curve curve{names[k], {}};
    for (const auto& row : rows) curve.values.push_back(row[first + k]);
    result.push_back(std::move(curve));
  }
  return result;
}

const std::vector<std::string> xyz{"x", "y", "z"};

struct Panels {
  std::vector<Panel> coordinates;
  std::vector<Panel> rates;
  std::vector<Panel> reactions;
};

Panels panels(const Result& result, const std::vector<std::vector<double>>& rows) {
  Panels all;
  std::size_t at = 1;
  const auto take = [&rows, &at](std::vector<Panel>& to, const std::string& title,
                                 const std::string& unit, const std::vector<std::string>& names) {
    to.push_back({title, unit, curves(rows, at, names)});
    at += names.size();
  };
  for (const auto& body : result.scene.bodies) {
    const kreisel::JointType& type = kreisel::joint_type(body.joint.kind);
    const auto take_all = [&](std::vector<Panel>& to, const auto& quantities) {
      for (const kreisel::JointQuantity& quantity : quantities) {
        take(to, body.name + ", " + quantity.title, quantity.unit, quantity.curves);
      }
    };
    take_all(all.coordinates, type.coordinates);
    take_all(all.rates, type.rates);
  }
  at += static_cast<std::size_t>(result.model.memory());
  if (!result.reactions) return all;
  for (const auto& body : result.scene.bodies) {
    take(all.reactions, "force on " + body.name + ", body axes", "N", xyz);
    take(all.reactions, "torque on " + body.name + ", body axes", "N m", xyz);
    ++at;  // the drive's torque is part of it
  }
  return all;
}

/// The readings of sensors: a panel for each part, or for each unit in it.
std::vector<Panel> sensor_panels(const Result& result, const Samples& samples) {
  std::vector<Panel> panels;
  const auto rows = samples.readings();
  std::size_t at = 0;
  for (const kreisel::SceneSensor& sensor : result.scene.sensors) {
    for (const kreisel::SensorPart& part : parts(sensor, result.scene.bodies)) {
      const std::string what = part.name == "value" ? "" : ", " + part.name;
      for (std::size_t begin = 0, end = 0; begin < part.components.size(); begin = end) {
        while (end < part.components.size() && part.units[end] == part.units[begin]) ++end;
        const std::vector<std::string> names(part.components.begin() + static_cast<long>(begin),
                                             part.components.begin() + static_cast<long>(end));
        panels.push_back({sensor.name + what, part.units[begin], curves(rows, at, names)});
        at += names.size();
      }
    }
  }
  return panels;
}

std::vector<Panel> drifts(const Result& result, const Samples& samples) {
  std::vector<Panel> panels;
  const auto values = samples.all([&result](double t, const kreisel::JointState& state) {
    return result.model.conserved(t, state);
  });
  for (std::size_t k = 0; k < values.front().size(); ++k) {
    const std::string& name = values.front()[k].first;
    Panel panel{name + ", change since the start", "", {{"", {}}}};
    const bool turns =
        name.find("angular") != std::string::npos || name.find("cyclic") != std::string::npos;
    panel.unit = name.starts_with("energy") ? "J" : turns ? "kg m²/s" : "kg m/s";
    for (const auto& now : values) {
      panel.curves.front().values.push_back(now[k].second - values.front()[k].second);
    }
    panels.push_back(std::move(panel));
  }
  return panels;
}

void write_block(std::ostream& s, const char* name, const std::vector<Series>& series) {
  s << '$' << name << " << END\n";
  for (std::size_t i = 0; i < series.front().size(); ++i) {
    for (const Series& column : series) fmt::print(s, "{:.9g} ", column[i]);
    s << '\n';
  }
  s << "END\n";
}

/// The y range of a panel: automatic, or a margin about curves that are all constant and equal.
std::string y_range(const Panel& panel) {
  double least = panel.curves.front().values.front();
  double most = least;
  for (const Curve& curve : panel.curves) {
    const auto [low, high] = std::minmax_element(curve.values.begin(), curve.values.end());
    least = std::min(least, *low);
    most = std::max(most, *high);
  }
  if (least < most) return "set yrange [*:*]\n";
  const double room = least == 0 ? 1 : std::abs(least) / 2;
  return fmt::format("set yrange [{:.9g}:{:.9g}]\n", least - room, most + room);
}

/// Panels over time, one below another.
std::string over_time(const std::string& title, const Series& times,
                      const std::vector<Panel>& panels) {
  std::ostringstream s;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    std::vector<Series> block{times};
    for (const Curve& curve : panels[p].curves) block.push_back(curve.values);
    write_block(s, ("panel" + std::to_string(p)).c_str(), block);
  }
  s << gnuplot::style << "set xzeroaxis lc rgb '#888888'\nset autoscale xfix\n"
    << "set offsets 0, 0, graph 0.08, graph 0.08\n"
    << "set format y '%.5g'\n";
  const bool has_key = std::any_of(panels.begin(), panels.end(),
                                   [](const Panel& panel) { return panel.curves.size() > 1; });
  fmt::print(s,
             "set multiplot layout {},1 title {} margins char 13, char {}, char 4, char 4 "
             "spacing char 0, char 3\n",
             panels.size(), quoted(title), has_key ? 14 : 3);
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const Panel& panel = panels[p];
    s << "set title " << quoted(panel.title) << " offset 0,-0.6\nset ylabel "
      << quoted("[" + panel.unit + "]") << "\n"
      << (p + 1 == panels.size() ? "set xlabel 't [s]'\nset format x '%g'\n"
                                 : "unset xlabel\nset format x ''\n")
      << (panel.curves.size() > 1 ? "set key outside right top samplen 2\n" : "unset key\n")
      << y_range(panel) << "plot ";
    for (std::size_t k = 0; k < panel.curves.size(); ++k) {
      fmt::print(s, "{}$panel{} using 1:{} with lines lw 2 dt {} lc rgb '{}' title {}",
                 k > 0 ? ", " : "", p, k + 2, dashes[k], colours[k], quoted(panel.curves[k].name));
    }
    s << '\n';
  }
  s << "unset multiplot\nunset output\n";
  return s.str();
}

/// The error of the states over time, and the tolerance.
std::string error_over_time(const std::string& title, const Series& times, const Series& errors,
                            double tolerance) {
  std::ostringstream s;
  write_block(s, "errors", {times, errors});
  s << gnuplot::style << "set logscale y\nset format y '%.0e'\nset autoscale xfix\n"
    << "set offsets 0, 0, graph 0.08, graph 0.08\nset key outside right top samplen 2\n"
    << "set title " << quoted(title) << "\nset xlabel 't [s]'\n"
    << "set ylabel '[rad or relative]'\n";
  fmt::print(s,
             "plot $errors using 1:($2 > 0 ? $2 : NaN) with lines lw 2 lc rgb '{}' title "
             "'estimated', {:.9g} with lines lw 2 dt {} lc rgb '{}' title 'asked for'\n",
             colours[0], tolerance, dashes[1], colours[1]);
  s << "unset output\n";
  return s.str();
}

/// Directions on the unit sphere, on the guide's axes; empty if nothing rotates.
std::vector<Eigen::Vector3d> path(const Result& result, const Samples& samples, std::string& what) {
  const int last = static_cast<int>(result.scene.bodies.size()) - 1;
  const auto& body = result.scene.bodies.back();
  const auto directions = [&](const Eigen::Vector3d& on_body) {
    return samples.all([&](double t, const kreisel::JointState& state) {
      return Eigen::Vector3d(result.model.pose(t, state, last).rotation * on_body);
    });
  };
  const auto moves = [](const std::vector<Eigen::Vector3d>& way) {
    return std::any_of(way.begin(), way.end(),
                       [&way](const auto& n) { return (n - way.front()).norm() > 1e-9; });
  };
  const Eigen::Vector3d centre = body.inertia.value.first_moment;
  const bool has_one_axis = kreisel::joint_type(body.joint.kind).rate_count() == 1;
  what = "axis of " + body.name;
  auto way = directions(last_axis(body));
  if (centre.norm() == 0 || (has_one_axis && moves(way))) {
    return moves(way) ? way : std::vector<Eigen::Vector3d>();
  }
  what = "from the joint of " + body.name + " to its centre of mass";
  way = directions(centre.normalized());
  return moves(way) ? way : std::vector<Eigen::Vector3d>();
}

/// Ranges of equal length that contain the points.
std::string square_range(const std::vector<Eigen::Vector2d>& points) {
  Eigen::Vector2d least = points.front();
  Eigen::Vector2d most = points.front();
  for (const auto& p : points) {
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  const Eigen::Vector2d middle = (least + most) / 2;
  const double half = 0.55 * (most - least).maxCoeff();
  return fmt::format("set xrange [{:.9g}:{:.9g}]\nset yrange [{:.9g}:{:.9g}]\n", middle.x() - half,
                     middle.x() + half, middle.y() - half, middle.y() + half);
}

/// The whole sphere, seen from the side of the path, and the path from above.
std::string on_sphere(const std::string& title, const std::string& what,
                      const std::vector<Eigen::Vector3d>& way) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& n : way) mean += n;
  if (mean.norm() < 1e-3 * static_cast<double>(way.size())) mean = way.front();
  mean.normalize();
  int across = 0;
  mean.cwiseAbs().minCoeff(&across);
  const Eigen::Vector3d aside = (Eigen::Vector3d::Unit(across) - mean[across] * mean).normalized();
  const Eigen::Vector3d up = mean.cross(aside);
  // The camera is off the mean direction, so that the path is not seen only from above.
  const Eigen::Vector3d eye = (mean - 0.45 * up + 0.3 * aside).normalized();
  const Eigen::Vector3d right = (aside - aside.dot(eye) * eye).normalized();
  const Eigen::Vector3d above = eye.cross(right);

  std::ostringstream s;
  const auto project = [&](const Eigen::Vector3d& p, bool front) {
    if ((p.dot(eye) >= 0) == front) {
      fmt::print(s, "{:.9g} {:.9g}\n", p.dot(right), p.dot(above));
    } else {
      s << '\n';
    }
  };
  s << "$grid << END\n";
  const double degree = std::acos(-1.0) / 180;
  const auto point = [degree](int longitude, int latitude) {
    const double l = longitude * degree;
    const double b = latitude * degree;
    return Eigen::Vector3d(std::cos(b) * std::cos(l), std::cos(b) * std::sin(l), std::sin(b));
  };
  for (int l = 0; l < 360; l += 30) {
    for (int b = -90; b <= 90; b += 3) project(point(l, b), true);
    s << '\n';
  }
  for (int b = -60; b <= 60; b += 30) {
    for (int l = 0; l <= 360; l += 3) project(point(l, b), true);
    s << '\n';
  }
  s << "END\n$front << END\n";
  for (const auto& n : way) project(n, true);
  s << "END\n$back << END\n0 0\n\n";
  for (const auto& n : way) project(n, false);
  s << "END\n$near << END\n";
  std::vector<Eigen::Vector2d> near(way.size());
  for (std::size_t i = 0; i < way.size(); ++i) {
    near[i] = {way[i].dot(aside), way[i].dot(up)};
    fmt::print(s, "{:.12g} {:.12g}\n", near[i].x(), near[i].y());
  }
  s << "END\n";
  const auto ends = [&s](const char* name, const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
    fmt::print(s, "${} << END\n{:.12g} {:.12g}\nEND\n", name, p.dot(a), p.dot(b));
  };
  ends("start", way.front(), right, above);
  ends("end", way.back(), right, above);
  ends("nearstart", way.front(), aside, up);
  ends("nearend", way.back(), aside, up);
  static constexpr const char* names[] = {"x", "y", "z"};
  const std::string marks =
      " with points pt 6 ps 1.3 lw 2 lc rgb '#d55e00' title 'start', ${}end with points pt 8 ps "
      "1.3 lw 2 lc rgb '#009e73' title 'end'\n";
  s << gnuplot::style << "set key outside bottom center horizontal\n";
  fmt::print(s, "set multiplot layout 1,2 title {}\n", quoted(title + ": " + what));
  s << "set size ratio -1\nunset border\nunset tics\nunset grid\nset title 'on the unit sphere, "
       "guide axes'\nset xrange [-1.15:1.15]\nset yrange [-1.15:1.15]\n"
    << "set object 1 circle at 0,0 size 1 fs empty border lc rgb '#888888'\n";
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d unit = 1.1 * Eigen::Vector3d::Unit(k);
    if (unit.dot(eye) > 0) {
      fmt::print(s, "set label {} '{}' at {:.4g},{:.4g} center front tc rgb '#222222'\n", k + 1,
                 names[k], unit.dot(right), unit.dot(above));
    }
  }
  s << "plot $grid with lines lc rgb '#cccccc' notitle, $back with lines dt (3,3) lc rgb "
       "'#6aa6cc' notitle, $front with lines lw 2 lc rgb '#0072b2' title 'path', $start"
    << fmt::format(fmt::runtime(marks), "");
  s << "unset object 1\nunset label\nset border 31 lc rgb '#555555'\nset tics tc rgb '#333333'\n"
       "set grid xtics ytics lt 1 lc rgb '#dddddd'\nunset key\nset title 'seen "
       "along its mean direction'\n"
       "set format '%.4g'\nset xtics norotate autofreq\n"
    << square_range(near);
  fmt::print(s, "set xlabel 'towards {} [rad for small angles]'\nset ylabel 'across'\n",
             names[across]);
  s << "plot $near with lines lw 1.5 lc rgb '#0072b2' title 'path', $nearstart"
    << fmt::format(fmt::runtime(marks), "near");
  s << "unset multiplot\nunset output\n";
  return s.str();
}

/// Prints a warning for each body that turns by more than a radian between drawn instants.
void warn_of_coarse_curves(const Result& result, const Samples& samples, const Series& times) {
  const kreisel::BodyTree& tree = result.model.tree();
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    if (!kreisel::joint_type(tree.body(i).joint.kind).has_attitude()) continue;
    const int v = tree.place(i).v;
    const Series turning = samples.all(
        [v](double, const kreisel::JointState& state) { return state.rates.segment<3>(v).norm(); });
    double most = 0;
    for (std::size_t k = 1; k < times.size(); ++k) {
      most = std::max(most, turning[k] * (times[k] - times[k - 1]));
    }
    if (most <= 1) continue;
    fmt::print(stderr,
               "simulate: {} turns by up to {:.3g} rad between the drawn instants: curves of its "
               "attitude are too coarse, give a smaller output_step\n",
               kreisel::printable(tree.body(i).name, 60), most);
  }
}

}  // namespace

void draw(const Result& result, const std::filesystem::path& folder) {
  gnuplot::open_folder(folder);
  write_view(result, folder / "view.html");
  gnuplot::wrote(folder / "view.html");
  if (!gnuplot::is_installed()) {
    fmt::print(stderr, "simulate: gnuplot is not installed: there are no other pictures\n");
    return;
  }
  const Samples samples(result, most_points);
  const Series times = samples.all([](double t, const kreisel::JointState&) { return t; });
  warn_of_coarse_curves(result, samples, times);
  const kreisel::SceneScale scale = scale_of(result);
  const auto rows = samples.all([&](double t, const kreisel::JointState& state) {
    return shown_row(result.model, row(result.model, t, state, {result.reactions}), scale);
  });
  const std::string& title = result.scene.title;
  const auto over = [&](const char* name, const char* what, const std::vector<Panel>& panels) {
    if (panels.empty()) return;
    gnuplot::draw(folder / name, 110 + 170 * panels.size(),
                  over_time(title.empty() ? what : title + ": " + what, times, panels));
  };
  const Panels all = panels(result, rows);
  over("coordinates", "coordinates", all.coordinates);
  over("rates", "rates", all.rates);
  over("reactions", "reactions", all.reactions);
  if (!result.scene.sensors.empty()) over("sensors", "sensors", sensor_panels(result, samples));
  over("invariants", "what should not change", drifts(result, samples));
  const Series errors = samples.of(result.run.errors);
  if (std::any_of(errors.begin(), errors.end(), [](double error) { return error > 0; })) {
    const std::string what = "error of coordinates and rates";
    gnuplot::draw(folder / "error", 300,
                  error_over_time(title.empty() ? what : title + ": " + what, times, errors,
                                  result.scene.tolerance));
  }
  std::string what;
  const auto way = path(result, samples, what);
  if (!way.empty()) gnuplot::draw(folder / "axis", 500, on_sphere(title, what, way));
}
