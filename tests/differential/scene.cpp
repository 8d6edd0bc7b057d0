#include "scene.hpp"

#include <Eigen/Geometry>
#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

using namespace kreisel;

namespace differential {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

/// The fewest digits that give the number back.
std::string text(double x) {
  char buffer[32];
  const auto end = std::to_chars(std::begin(buffer), std::end(buffer), x).ptr;
  return {std::begin(buffer), end};
}

template <class Numbers>
std::string list(const Numbers& numbers) {
  std::string result = "[";
  for (const double x : numbers) result += (result.size() > 1 ? ", " : "") + text(x);
  return result + "]";
}

/// A number where there is one, else a list.
std::string one_or_list(const std::vector<double>& numbers) {
  return numbers.size() == 1 ? text(numbers.front()) : list(numbers);
}

/// `key = value` of what is there, after a comma but for the first.
class Inline {
 public:
  void add(const std::string& key, const std::string& value) {
    inside_ += (inside_.empty() ? "" : ", ") + key + " = " + value;
  }
  void add_vector(const std::string& key, const Vector& v) {
    if (!v.isZero(0)) add(key, list(v));
  }
  [[nodiscard]] bool empty() const { return inside_.empty(); }
  [[nodiscard]] std::string text() const { return "{ " + inside_ + " }"; }

 private:
  std::string inside_;
};

void add_angles(Inline& table, const std::string& key, const std::vector<Angle>& angles) {
  if (angles.empty()) return;
  std::vector<double> values;
  for (const Angle& angle : angles) {
    values.push_back(angles.front().degrees == angle.degrees ? angle.value : angle.radian());
  }
  table.add(angles.front().degrees ? key + "_deg" : key, one_or_list(values));
}

std::string series(const Series& s) {
  Inline table;
  table.add_vector("constant", s.constant);
  std::string terms;
  for (const Series::Term& term : s.terms) {
    Inline one;
    one.add("amplitude", list(term.amplitude));
    one.add("frequency", text(term.frequency));
    add_angles(one, "phase", {term.phase});
    terms += (terms.empty() ? "" : ", ") + one.text();
  }
  if (!terms.empty() || table.empty()) table.add("terms", "[" + terms + "]");
  return table.text();
}

/// The keys of a guide frame, each with its value.
std::vector<std::pair<std::string, std::string>> table_keys(const Spelling& spelling,
                                                            std::size_t index) {
  std::vector<std::pair<std::string, std::string>> result{{"kind", "\"table\""},
                                                          {"file", "\"" + log_name(index) + "\""}};
  if (spelling.time_unit != "s") result.emplace_back("time_unit", "\"" + spelling.time_unit + "\"");
  if (spelling.decimal_comma) result.emplace_back("decimal", "\",\"");
  if (spelling.lines_before > 0) result.emplace_back("skip", std::to_string(spelling.lines_before));
  return result;
}

std::vector<std::pair<std::string, std::string>> keys(const Link& link, std::size_t index) {
  switch (link.kind) {
    case LinkKind::inertial: return {{"kind", "\"inertial\""}};
    case LinkKind::rotating:
      return {{"kind", "\"rotating\""},
              {"angular_velocity", list(link.angular_velocity)},
              {"origin_acceleration", list(link.origin_acceleration)}};
    case LinkKind::harmonic:
      return {{"kind", "\"harmonic\""},
              {"angular_velocity", series(link.turning)},
              {"origin_acceleration", series(link.pushing)}};
    case LinkKind::table: return table_keys(link.log.spelling, index);
    case LinkKind::earth: break;
  }
  std::vector<std::pair<std::string, std::string>> result{{"kind", "\"earth\""},
                                                          {"latitude_deg", text(link.latitude)},
                                                          {"height", text(link.height)},
                                                          {"azimuth_deg", text(link.azimuth)}};
  if (link.rate) result.emplace_back("rate", text(*link.rate));
  if (!link.gravity.empty()) result.emplace_back("gravity", link.gravity);
  return result;
}

std::string guide(const Scene& scene) {
  if (scene.guide.empty()) return {};
  std::string result = "[guide]\n";
  if (scene.guide.size() == 1) {
    for (const auto& [key, value] : keys(scene.guide.front(), 0)) {
      result += key + " = " + value + "\n";
    }
    return result;
  }
  result += "kind = \"chain\"\nlinks = [\n";
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    Inline table;
    for (const auto& [key, value] : keys(scene.guide[i], i)) table.add(key, value);
    result += "  " + table.text() + ",\n";
  }
  return result + "]\n";
}

std::string gravity(const Scene& scene) {
  switch (scene.gravity) {
    case GravityKind::not_given: return {};
    case GravityKind::none: return "[gravity]\nkind = \"none\"\n";
    case GravityKind::earth: return "[gravity]\nkind = \"earth\"\n";
    case GravityKind::uniform:
      return "[gravity]\nkind = \"uniform\"\nvector = " + list(scene.gravity_vector) + "\n";
    case GravityKind::inertial: break;
  }
  return "[gravity]\nkind = \"inertial\"\nvector = " + list(scene.gravity_vector) + "\n";
}

std::string body_name(int index) { return index < 0 ? "guide" : fmt::format("b{}", index); }

std::string joint(const Body& body) {
  static const char* const names[] = {"fixed",     "revolute",  "prismatic",
                                      "universal", "spherical", "free"};
  Inline table;
  table.add("kind", std::string("\"") + names[static_cast<int>(body.kind)] + "\"");
  if (single_coordinates(body.kind) > 0) table.add("axis", list(body.axis));
  if (body.kind == JointKind::universal) table.add("second_axis", list(body.second_axis));
  table.add_vector("position", body.position);
  if (body.orientation) table.add("orientation", list(*body.orientation));
  return table.text();
}

std::string initial(const Body& body) {
  Inline table;
  if (body.kind == JointKind::prismatic) {
    if (body.displacement != 0) table.add("displacement", text(body.displacement));
  } else {
    add_angles(table, "angle", body.angle);
  }
  if (!body.rate.empty()) table.add("rate", one_or_list(body.rate));
  if (body.attitude) table.add("attitude", list(*body.attitude));
  table.add_vector("angular_velocity", body.angular_velocity);
  if (body.place) table.add("position", list(*body.place));
  table.add_vector("velocity", body.velocity);
  return table.empty() ? "" : "initial = " + table.text() + "\n";
}

std::string forces(const Body& body) {
  std::string result;
  if (!body.stiffness.empty()) {
    Inline spring;
    spring.add("stiffness", one_or_list(body.stiffness));
    if (!body.rest.empty()) spring.add("rest", one_or_list(body.rest));
    result += "spring = " + spring.text() + "\n";
  }
  if (!body.damping.empty()) result += "damping = " + one_or_list(body.damping) + "\n";
  if (!body.force.empty()) result += "force = " + one_or_list(body.force) + "\n";
  return result;
}

std::string rotor(const Rotor& rotor) {
  static const char* const modes[] = {"free", "regulated", "torque"};
  Inline table;
  table.add("mode", std::string("\"") + modes[static_cast<int>(rotor.mode)] + "\"");
  table.add("speed", text(rotor.speed));
  if (rotor.mode == RotorMode::torque) table.add("torque", text(rotor.torque));
  return "rotor = " + table.text() + "\n";
}

std::string loads(const Body& body) {
  static const char* const axes[] = {"body", "guide", "inertial"};
  std::string all;
  for (const Load& load : body.loads) {
    Inline table;
    table.add("force", list(load.force));
    table.add_vector("torque", load.torque);
    table.add_vector("point", load.point);
    table.add("axes", std::string("\"") + axes[static_cast<int>(load.axes)] + "\"");
    all += (all.empty() ? "" : ", ") + table.text();
  }
  if (all.empty()) return {};
  return "load = " + (body.loads.size() == 1 ? all : "[" + all + "]") + "\n";
}

std::string body(const Scene& scene, int index) {
  const Body& b = scene.bodies[static_cast<std::size_t>(index)];
  std::string result = "[[body]]\nname = \"" + body_name(index) + "\"\n";
  if (b.parent >= 0) result += "parent = \"" + body_name(b.parent) + "\"\n";
  result += "joint = " + joint(b) + "\n";
  result += "mass = " + text(b.mass) + "\n";
  if (!b.centre.isZero(0)) result += "centre = " + list(b.centre) + "\n";
  result += "inertia = " + list(b.inertia) + "\n";
  result += initial(b) + forces(b);
  if (b.rotor) result += rotor(*b.rotor);
  if (b.drive) result += "drive = \"constant-rate\"\n";
  if (b.hold) result += "hold = true\n";
  return result + loads(b);
}

}  // namespace

double Angle::radian() const { return degrees ? value * degree : value; }

std::string Log::csv(double t_end) const {
  const std::string end = spelling.ends_with_cr ? "\r\n" : "\n";
  const double unit = spelling.time_unit == "us" ? 1e6 : spelling.time_unit == "ms" ? 1e3 : 1;
  const auto line = [&](const std::vector<std::string>& fields) {
    std::string all;
    for (const std::string& field : fields) {
      if (!all.empty()) all += spelling.separator;
      all += field;
    }
    return all + end;
  };
  const auto number = [&](double x) {
    std::string digits = text(x);
    if (spelling.decimal_comma) std::replace(digits.begin(), digits.end(), '.', ',');
    return digits;
  };
  std::string result;
  for (int i = 0; i < spelling.lines_before; ++i) result += "a line before the header" + end;
  if (spelling.header_is_comment) result += "# ";
  result += line(spelling.scalar_comes_last
                     ? std::vector<std::string>{"t", "x", "y", "z", "qx", "qy", "qz", "qw"}
                     : std::vector<std::string>{"t", "qw", "qx", "qy", "qz", "x", "y", "z"});
  const long before = 16;  // rows on either side, so that no end of the spline lies in the run
  const long rows = static_cast<long>(std::ceil(t_end / step)) + 2 * before;
  for (long i = 0; i <= rows; ++i) {
    const double t = static_cast<double>(i - before) * step;
    const double s = std::sin(frequency * t + phase);
    const Eigen::Quaterniond q(Eigen::AngleAxisd(amplitude * s, axis.normalized()));
    const Vector x = s * shift;
    std::vector<double> values{q.w(), q.x(), q.y(), q.z(), x.x(), x.y(), x.z()};
    if (spelling.scalar_comes_last) {
      values = {x.x(), x.y(), x.z(), q.x(), q.y(), q.z(), q.w()};
    }
    std::vector<std::string> fields{number(t * unit)};
    for (const double value : values) fields.push_back(number(value));
    result += line(fields);
  }
  return result;
}

bool Scene::has_log() const {
  for (const Link& link : guide) {
    if (link.kind == LinkKind::table) return true;
  }
  return false;
}

std::vector<double> Scene::times() const {
  std::vector<double> result;
  for (int i = 1; i < outputs; ++i) result.push_back(i * (t_end / outputs));
  result.push_back(t_end);
  return result;
}

int single_coordinates(JointKind kind) {
  if (kind == JointKind::revolute || kind == JointKind::prismatic) return 1;
  return kind == JointKind::universal ? 2 : 0;
}

std::string log_name(std::size_t link) { return fmt::format("log{}.csv", link); }

std::string to_toml(const Scene& scene) {
  std::string result = guide(scene) + gravity(scene);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) result += body(scene, i);
  result +=
      "[solve]\nt_end = " + text(scene.t_end) + "\ntolerance = " + text(scene.tolerance) + "\n";
  return result +
         (scene.outputs < 3 ? "output_times = " + list(scene.times())
                            : "output_step = " + text(scene.t_end / scene.outputs)) +
         "\n";
}

}  // namespace differential
