#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "reference_guide.hpp"
#include "toml.hpp"

namespace differential {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

}  // namespace

double Angle::radian() const { return degrees ? value * degree : value; }

bool Signal::empty() const {
  return series.constant.isZero(0) && series.terms.empty() && rate.isZero(0) && jumps.times.empty();
}

std::vector<double> Scene::jumps() const {
  std::vector<double> times;
  for (const Signal* const s : signals()) {
    times.insert(times.end(), s->jumps.times.begin(), s->jumps.times.end());
  }
  for (const Servo& servo : servos) {
    for (int k = 0; servo.period > 0 && t_begin + k * servo.period <= t_end; ++k) {
      times.push_back(t_begin + k * servo.period);
      if (servo.rest() > 0) times.push_back(t_begin + servo.rest() + k * servo.period);
    }
  }
  std::sort(times.begin(), times.end());
  const auto is_same = [](double a, double b) { return b - a < 1e-13 * std::abs(b); };
  times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
  return times;
}

int Servo::whole_periods() const { return static_cast<int>(std::floor(delay / period + 1e-9)); }

double Servo::rest() const {
  const double left = delay - whole_periods() * period;
  return left > 1e-9 * period ? left : 0;
}

std::vector<const Signal*> Scene::signals() const {
  std::vector<const Signal*> result;
  for (const Link& link : guide) {
    const Vehicle& v = link.vehicle;
    result.insert(result.end(), {&v.turn_rate, &v.acceleration, &v.climb, &v.bank});
  }
  for (const Body& body : bodies) {
    result.push_back(&body.force_in_time);
    result.push_back(&body.motion);
    if (body.rotor) result.push_back(&body.rotor->torque_in_time);
    for (const Load& load : body.loads) {
      result.insert(result.end(), {&load.force_in_time, &load.field});
    }
  }
  for (const Element& element : elements) result.push_back(&element.length_in_time);
  return result;
}

bool Scene::has_log() const {
  const std::vector<const Signal*> all = signals();
  if (std::any_of(all.begin(), all.end(), [](const Signal* s) { return !s->file.empty(); })) {
    return true;
  }
  return std::any_of(guide.begin(), guide.end(), [](const Link& link) { return link.is_logged(); });
}

Vector radian(const Vector& v, bool degrees) { return degrees ? Vector(v * degree) : v; }

std::vector<double> Scene::times() const {
  std::vector<double> result;
  for (int i = 1; i < outputs; ++i) {
    result.push_back(t_begin + i * ((t_end - t_begin) / outputs));
  }
  result.push_back(t_end);
  return result;
}

int single_coordinates(JointKind kind) {
  const kreisel::JointType& type = kreisel::joint_type(kind);
  return type.has_single_coordinates() ? type.rate_count() : 0;
}

std::vector<int> blocks(JointKind kind) {
  const kreisel::JointType& type = kreisel::joint_type(kind);
  std::vector<int> result;
  for (const auto* const quantities : {&type.coordinates, &type.rates}) {
    for (const auto& quantity : *quantities) {
      const int count = quantity.count();
      const bool single = type.has_single_coordinates();
      result.insert(result.end(), single ? std::size_t(count) : 1, single ? 1 : count);
    }
  }
  return result;
}

bool slides(JointKind kind) {
  const auto& coordinates = kreisel::joint_type(kind).coordinates;
  return single_coordinates(kind) > 0 &&
         std::any_of(coordinates.begin(), coordinates.end(),
                     [](const auto& quantity) { return quantity.unit == "m"; });
}

Scene nearer(Scene scene) {
  const bool by_speed = scene.model == "precession";
  for (Body& body : scene.bodies) {
    if (body.rotor && by_speed) body.rotor->speed.value *= 2;
    if (body.rotor || body.drive || by_speed) continue;
    for (auto* const list : {&body.angle, &body.rate}) {
      for (Angle& angle : *list) angle.value /= 2;
    }
  }
  return scene;
}

/// Samples a hundred times per radian, from before the run to after it.
std::string samples(const Signal& signal, double t_end) {
  double fastest = 1;
  for (const Series::Term& term : signal.series.terms) {
    fastest = std::max(fastest, term.frequency.radian());
  }
  const double step = 0.01 / fastest;
  constexpr long outside = 16;
  std::string result = "t,value,x,y,z\n";
  for (long i = -outside; static_cast<double>(i - outside) * step <= t_end; ++i) {
    const double t = static_cast<double>(i) * step;
    const Vector v = reference::course_of(signal, t, t).value.cast<double>();
    result += text(t);
    for (const double x : {v.x(), v.x(), v.y(), v.z()}) result.append(",").append(text(x));
    result += "\n";
  }
  return result;
}

void write_logs(const Scene& scene, const std::filesystem::path& folder) {
  for (const Signal* const s : scene.signals()) {
    if (!s->file.empty()) std::ofstream(folder / s->file) << samples(*s, scene.t_end);
  }
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    const Link& link = scene.guide[i];
    if (!link.is_logged()) continue;
    std::ofstream(folder / log_name(i)) << link.log.csv(scene.t_end, link.kind == LinkKind::rates);
  }
}

std::string to_toml(const Scene& scene) {
  std::string result = scene.title.empty() ? "" : "title = \"" + scene.title + "\"\n";
  result += guide(scene) + gravity(scene);
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) result += body(scene, i);
  for (std::size_t i = 0; i < scene.elements.size(); ++i) result += element(scene.elements[i], i);
  for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
    result += constraint(scene.constraints[i], i);
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (scene.bodies[i].loose) result += constraint(scene.bodies[i], static_cast<int>(i));
  }
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) result += sensor(scene.sensors[i], i);
  for (std::size_t i = 0; i < scene.servos.size(); ++i) result += servo(scene.servos[i], scene, i);
  result +=
      "[solve]\nt_end = " + text(scene.t_end) + "\ntolerance = " + text(scene.tolerance) + "\n";
  if (scene.t_begin != 0) result += "t_begin = " + text(scene.t_begin) + "\n";
  if (!scene.model.empty()) result += "model = \"" + scene.model + "\"\n";
  if (!scene.method.empty()) result += "method = \"" + scene.method + "\"\n";
  return result +
         (scene.outputs < 3
              ? "output_times = " + list(scene.times())
              : "output_step = " + text((scene.t_end - scene.t_begin) / scene.outputs)) +
         "\n" +
         (scene.reports ? "[report]\nreactions = true\nelements = true\nconstraints = true\n"
                          "terms = true\n"
                        : "");
}

}  // namespace differential
