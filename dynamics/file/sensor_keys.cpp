#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <variant>

#include <dynamics/file/columns.hpp>
#include <dynamics/file/name_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/sensor_keys.hpp>

namespace kreisel::detail {

namespace {

constexpr double most_samples = 1e7;

class SensorReader {
 public:
  SensorReader(const SceneFile& scene, bool sound)
      : scene_(scene), bodies_(scene.bodies), points_(scene.points), sound_(sound) {
    for (const BodyDescription& body : bodies_) names_.push_back(body.name);
  }

  SceneSensor read(Section& section, const std::string& name) {
    SceneSensor sensor{.name = name};
    const std::string kind = section.required_choice(
        "kind", {"gyro", "accelerometer", "point", "attitude", "joint", "reaction", "azimuth"});
    if (section.peek("kind") != kind) {  // the other keys cannot be checked
      section.ignore_rest();
      return sensor;
    }
    if (kind == "gyro") sensor.kind = gyro(section);
    if (kind == "accelerometer") sensor.kind = accelerometer(section);
    if (kind == "point") sensor.kind = point(section);
    if (kind == "attitude") sensor.kind = attitude(section);
    if (kind == "joint") sensor.kind = joint(section);
    if (kind == "reaction" && section.has("element")) {
      sensor.kind = element(section, "element");
    } else if (kind == "reaction" && section.has("constraint")) {
      sensor.kind = element(section, "constraint");
    } else if (kind == "reaction") {
      sensor.kind = reaction(section);
    }
    if (kind == "azimuth") sensor.kind = azimuth(section);
    const bool is_instrument = kind == "gyro" || kind == "accelerometer";
    sensor.period = period(section);
    if (is_instrument) {
      sensor.increments = increments(section);
      sensor.errors =
          errors(section, kind == "gyro" ? dimension::angular_rate : dimension::acceleration,
                 sensor.increments != SensorIncrements::none);
    }
    return sensor;
  }

 private:
  double period(Section& section) const {
    const double result = section.number("period", dimension::time, Range::positive).value_or(0);
    if (result > 0 && scene_.duration() / result > most_samples) {
      section.refuse("period", "asks for more than ten million samples");
    }
    return result;
  }

  /// Reads the key `increments`.
  SensorIncrements increments(Section& section) const {
    const toml::node* const node = section.find("increments");
    if (node == nullptr) return SensorIncrements::none;
    SensorIncrements result = SensorIncrements::none;
    if (node->is_string()) {
      result = SensorIncrements::uncompensated;
      if (const std::string word = section.peek("increments"); word != "uncompensated") {
        section.refuse("increments",
                       "must be true, false or 'uncompensated', not " + in_quotes(word));
      }
    } else if (section.flag("increments")) {
      result = SensorIncrements::compensated;
    }
    if (result == SensorIncrements::none) return result;
    if (!section.has("period")) {
      section.refuse("increments", "needs 'period', over which the reading is integrated");
    }
    if (scene_.model != SceneModel::exact) {
      section.refuse("increments",
                     std::string("needs the model 'exact', not '") + name(scene_.model) + "'");
    }
    return result;
  }

  /// The body at a required key.
  int body(Section& section, const char* key) {
    if (!section.has(key)) section.refuse_missing(key);
    const auto name = section.text(key);
    return name ? index_of_name(section, key, *name, names_, "body") : 0;
  }

  SensorFrame frame(Section& section, const char* key) {
    const auto name = section.text(key);
    if (!name) return SensorFrame::guide();
    std::vector<std::string> words{"guide", "inertial"};
    words.insert(words.end(), names_.begin(), names_.end());
    const int found = index_of_name(section, key, *name, words, "frame");
    if (found == 0) return SensorFrame::guide();
    return found == 1 ? SensorFrame::inertial() : SensorFrame::of_body(found - 2);
  }

  /// A point of the body: coordinates, or a name.
  Vector3<double> at(Section& section, int body) {
    const toml::node* const node = section.find("at");
    if (node == nullptr) return Vector3<double>::Zero();
    if (!node->is_string())
      return section.vector("at", dimension::length).value_or(Vector3<double>::Zero());
    const auto own = static_cast<std::size_t>(body);
    return named_point(section, "at", section.peek("at"), points_[own], names_[own]);
  }

  static Eigen::Quaterniond axes(Section& section) {
    return quaternion(section, "axes").value_or(Eigen::Quaterniond::Identity());
  }

  /// A gyro reads the same at all points of its body.
  Gyro gyro(Section& section) {
    Gyro sensor{body(section, "body")};
    (void)at(section, sensor.body);
    sensor.axes = axes(section);
    return sensor;
  }

  Accelerometer accelerometer(Section& section) {
    Accelerometer sensor{body(section, "body")};
    sensor.at = at(section, sensor.body);
    sensor.axes = axes(section);
    return sensor;
  }

  PointSensor point(Section& section) {
    PointSensor sensor{body(section, "body")};
    sensor.at = at(section, sensor.body);
    sensor.against = frame(section, "against");
    sensor.axes = section.has("axes") ? frame(section, "axes") : sensor.against;
    return sensor;
  }

  scene_sensor::Attitude attitude(Section& section) {
    const int own = body(section, "body");
    return {{own, frame(section, "against")},
            section.choice("as", {"quaternion", "yaw pitch roll"}) == "yaw pitch roll"};
  }

  scene_sensor::Joint joint(Section& section) {
    const int own = body(section, "joint");
    const BodyDescription& described = bodies_[static_cast<std::size_t>(own)];
    const bool is_it = sound_ && section.peek("joint") == described.name;
    if (is_it && described.joint.kind == JointKind::fixed) {
      section.refuse("joint", in_quotes(described.name) + " is fixed and has no coordinate");
    }
    return {own};
  }

  ReactionSensor reaction(Section& section) {
    ReactionSensor sensor{body(section, "joint")};
    sensor.at = at(section, sensor.body);
    set_axes(section, sensor);
    return sensor;
  }

  /// The reaction of an element or of a constraint, as the key says.
  ElementSensor element(Section& section, const char* key) {
    ElementSensor sensor;
    for (const char* const other : {"joint", "element", "constraint"}) {
      if (std::string(other) != key && section.has(other)) {
        section.refuse(other, "and '" + std::string(key) + "' exclude each other");
      }
    }
    const bool is_element = std::string(key) == "element";
    std::vector<std::string> words;
    std::vector<std::string> seconds;
    for (const Element& element : scene_.elements) {
      if (is_element) words.push_back(name(element));
      seconds.push_back(second_of(element));
    }
    for (const Constraint& constraint : scene_.constraints) {
      if (!is_element) words.push_back(constraint.name);
      seconds.push_back(constraint.second);
    }
    const auto word = section.text(key);
    if (!word || !sound_) {
      section.ignore_rest();
      return sensor;
    }
    sensor.element = index_of_name(section, key, *word, words, key);
    if (!is_element) sensor.element += static_cast<int>(scene_.elements.size());
    const bool is_known = static_cast<std::size_t>(sensor.element) < seconds.size();
    const auto found = std::find(names_.begin(), names_.end(),
                                 is_known ? seconds[std::size_t(sensor.element)] : "");
    const auto second = found == names_.end() ? 0 : found - names_.begin();
    if (section.has("at")) sensor.at = at(section, static_cast<int>(second));
    set_axes(section, sensor);
    return sensor;
  }

  /// Reads `axes`: the name of a frame, or a quaternion.
  template <class Sensor>
  void set_axes(Section& section, Sensor& sensor) {
    const toml::node* const node = section.find("axes");
    if (node != nullptr && node->is_string()) {
      sensor.frame = frame(section, "axes");
    } else {
      sensor.axes = axes(section);
    }
  }

  /// The pivot of a pendulum is the joint of its first body on the guide.
  AzimuthSensor azimuth(Section& section) {
    AzimuthSensor sensor{body(section, "body")};
    sensor.at = at(section, sensor.body);
    sensor.pivot = pivot(sensor.body);
    if (const auto* const earth = std::get_if<scene_guide::Earth>(&scene_.guide.front())) {
      sensor.reference = earth->site.azimuth * (std::numbers::pi / 180);
    }
    if (std::holds_alternative<scene_gravity::None>(scene_.gravity)) {
      section.refuse("kind", "'azimuth' needs [gravity], which gives the vertical");
    }
    return sensor;
  }

  Vector3<double> pivot(int body) const {
    const BodyDescription* link = &bodies_[static_cast<std::size_t>(body)];
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const auto parent = std::find(names_.begin(), names_.end(), link->parent);
      if (parent == names_.end()) break;
      link = &bodies_[static_cast<std::size_t>(parent - names_.begin())];
    }
    return link->joint.position;
  }

  static Vector3<double> three(const std::optional<std::vector<double>>& numbers) {
    if (!numbers) return Vector3<double>::Zero();
    return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  }

  /// One number for all axes, or three numbers.
  static Vector3<double> numbers(Section& section, const std::string& key, const Dimension& of) {
    return three(of.angle != 0 ? section.angle_or_list(key, 3, of)
                               : section.number_or_list(key, 3, of));
  }

  /// Reads standard deviations and densities.
  static Vector3<double> size(Section& section, const std::string& key, const Dimension& of) {
    Vector3<double> result = numbers(section, key, of);
    if (result.minCoeff() < 0) section.refuse(key, "must not be below 0");
    return result;
  }

  static double limit(Section& section, const std::string& key, const Dimension& of) {
    const auto value = of.angle != 0 ? section.angle(key, of) : section.number(key, of);
    if (value && !(*value > 0)) section.refuse(key, "must be above 0");
    return value.value_or(0);
  }

  static bool has_errors(Section& section) {
    const std::vector<std::string> known{"misalignment", "scale",      "bias",  "noise", "drift",
                                         "correlation",  "resolution", "range", "seed"};
    return std::any_of(known.begin(), known.end(), [&section](const std::string& key) {
      return section.has(key) || section.has(key + "_deg");
    });
  }

  static std::uint64_t seed(Section& section) {
    const toml::node* const node = section.find("seed");
    if (node == nullptr) return 0;
    const auto* const number = node->as_integer();
    if (number != nullptr && number->get() >= 0) return static_cast<std::uint64_t>(number->get());
    section.refuse("seed", "must be a whole number, not below 0");
    return 0;
  }

  /// Reads the errors of a sensor whose readings have the dimension `of`. Those of an angular rate
  /// may be in degrees.
  static std::optional<SensorErrors> errors(Section& section, const Dimension& of,
                                            bool integrates) {
    if (!has_errors(section)) return std::nullopt;
    SensorErrors result;
    result.misalignment = three(section.angles("misalignment", 3, dimension::angle));
    result.scale = three(section.number_or_list("scale", 3, dimension::number));
    result.bias = numbers(section, "bias", of);
    result.noise = size(section, "noise", of * to_power(dimension::time, 0.5));
    result.drift = size(section, "drift", of / to_power(dimension::time, 0.5));
    if (auto correlation = section.section("correlation")) {
      if (!correlation->has("sigma") && !correlation->has("sigma_deg")) {
        correlation->refuse_missing("sigma");
      }
      result.correlation = {size(*correlation, "sigma", of),
                            correlation->required_number("time", dimension::time, Range::positive)};
      correlation->finish();
    }
    result.resolution = limit(section, "resolution", integrates ? of * dimension::time : of);
    result.range = limit(section, "range", of);
    result.seed = seed(section);
    return result;
  }

  const SceneFile& scene_;
  const std::vector<BodyDescription>& bodies_;
  const std::vector<NamedPoints>& points_;
  bool sound_;
  std::vector<std::string> names_;
};

/// Refuses columns of a sensor that exist already.
void check_columns(Section& section, const SceneSensor& sensor,
                   const std::vector<BodyDescription>& bodies, std::set<std::string>& taken) {
  for (const std::string& column : columns(sensor, bodies)) {
    if (taken.insert(column).second) continue;
    section.refuse("name", "would make a second column " + in_quotes(column) +
                               "; choose another name for the sensor");
    return;
  }
}

}  // namespace

NamedPoints read_points(Section& body) {
  NamedPoints points;
  auto section = body.section("points");
  if (!section) return points;
  for (const std::string& name : section->keys()) {
    if (name.empty()) section->refuse(name, "is a point without a name");
    points[name] = section->vector(name, dimension::length).value_or(Vector3<double>::Zero());
  }
  return points;
}

std::vector<SceneSensor> read_sensors(Section& root, const SceneFile& scene, bool sound) {
  const std::vector<BodyDescription>& bodies = scene.bodies;
  std::vector<SceneSensor> result;
  if (!root.has("sensor") || bodies.empty()) return result;
  SensorReader reader(scene, sound);
  std::set<std::string> names;
  const std::vector<std::string> of_bodies = columns(bodies, true);
  const std::vector<std::string> of_elements = columns(scene.elements);
  std::set<std::string> taken(of_bodies.begin(), of_bodies.end());
  const std::vector<std::string> of_constraints = columns(scene.constraints);
  taken.insert(of_elements.begin(), of_elements.end());
  taken.insert(of_constraints.begin(), of_constraints.end());
  for (Section& section : root.sections("sensor")) {
    const std::string name = section.required_text("name");
    if (section.has("name") && section.find("name")->is_string() && name.empty()) {
      section.refuse("name", "is empty");
    }
    if (!name.empty()) section.rename("sensor '" + name + "'");
    result.push_back(reader.read(section, name));
    section.finish();
    if (name.empty()) continue;
    if (!names.insert(name).second) {
      section.refuse("name", "is used by an earlier sensor");
    } else {
      check_columns(section, result.back(), bodies, taken);
    }
  }
  return result;
}

std::vector<std::string> read_output(Section& root, const std::vector<std::string>& known) {
  auto output = root.section("output");
  if (!output) return {};
  std::vector<std::string> words = output->texts("columns");
  for (const std::string& word : words) {
    const bool is_known = std::any_of(known.begin() + 1, known.end(), [&word](const auto& column) {
      return names_column(word, column);
    });
    if (is_known) continue;
    output->refuse("columns", in_quotes(word) + " is no column" + did_you_mean(word, known) +
                                  "; write NAME of a body or a sensor, or NAME.quantity");
  }
  if (!output->has("columns")) output->refuse_missing("columns");
  output->finish();
  return words;
}

}  // namespace kreisel::detail
