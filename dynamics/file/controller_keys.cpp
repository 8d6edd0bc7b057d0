#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <dynamics/control/loop.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/controller_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/scene_signal.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/file/sensor_numbers.hpp>
#include <motor/error.hpp>

namespace kreisel::detail {

namespace {

constexpr double most_samples = 1e7;

/// The message of an error without the name of the controller before it.
std::string without_name(const std::string& text, const std::string& name) {
  const std::string before = "controller '" + name + "': ";
  return text.rfind(before, 0) == 0 ? text.substr(before.size()) : text;
}

/// The tree of a scene, unless its elements or constraints do not fit it.
std::optional<BodyTree> tree_of(const SceneFile& scene) {
  try {
    return BodyTree(scene.bodies, scene.elements, scene.constraints);
  } catch (const InvalidInput&) {
    return std::nullopt;
  }
}

class ControllerReader {
 public:
  ControllerReader(const SceneFile& scene, bool sound) : scene_(scene) {
    for (const SceneSensor& sensor : scene.sensors) {
      const auto names = columns(sensor, scene.bodies);
      columns_.insert(columns_.end(), names.begin(), names.end());
    }
    if (sound) tree_ = tree_of(scene);
  }

  Controller read(Section& section, const std::string& name) {
    Controller result{.name = name};
    result.first = scene_.t_begin;
    result.period = section.number("period", dimension::time, Range::positive).value_or(0);
    if (result.period > 0 && scene_.duration() / result.period > most_samples) {
      section.refuse("period", "asks for more than ten million samples");
    }
    result.delay = section.number("delay", dimension::time, Range::not_negative).value_or(0);
    is_sampled_ = result.period > 0;
    const std::string kind = peek_law(section);
    read_inputs(section, kind, result);
    result.drives = drives(section, name);
    read_law(section, kind, result);
    std::vector<Dimension> of_inputs;
    for (const SensorNumber& input : inputs_) of_inputs.push_back(dimension_of(input.unit));
    if (!of_inputs.empty()) result.reference = read_signals(section, "reference", of_inputs);
    (void)section.has("reference");
    if (!actuators_.empty()) {
      result.limit = section.number_or_list("limit", units()).value_or(std::vector<double>());
    }
    (void)section.has("limit");
    return result;
  }

  /// The forces that the outputs of the controller that was read last are.
  [[nodiscard]] const std::vector<Actuator>& outputs() const { return actuators_; }

 private:
  /// The dimensions of the outputs.
  [[nodiscard]] std::vector<Dimension> units() const {
    std::vector<Dimension> result;
    for (const Actuator& one : actuators_) result.push_back(dimension_of(one.unit));
    return result;
  }

  static std::string peek_law(Section& section) {
    auto law = section.section("law");
    return law ? law->peek("kind") : "";
  }

  void read_inputs(Section& section, const std::string& kind, Controller& controller) {
    inputs_.clear();
    if (!section.has("reads")) section.refuse_missing("reads");
    const std::vector<std::string> words = section.texts("reads");
    if (section.has("reads") && words.empty()) section.refuse("reads", "must name a sensor");
    for (const std::string& word : words) {
      const SceneSensor* const sensor = sensor_of(word);
      if (sensor == nullptr) {
        section.refuse("reads", in_quotes(word) + " is no sensor and no column of a sensor" +
                                    did_you_mean(word, columns_) +
                                    "; add a [[sensor]] and write its NAME or NAME.component");
        continue;
      }
      add_inputs(section, word, *sensor, kind, controller.period);
    }
    for (const SensorNumber& input : inputs_) controller.reads.push_back(input.reading);
  }

  [[nodiscard]] const SceneSensor* sensor_of(const std::string& word) const {
    for (const SceneSensor& sensor : scene_.sensors) {
      if (word == sensor.name) return &sensor;
      for (const std::string& column : columns(sensor, scene_.bodies)) {
        if (word == column) return &sensor;
      }
    }
    return nullptr;
  }

  void add_inputs(Section& section, const std::string& word, const SceneSensor& sensor,
                  const std::string& kind, double period) {
    if (const std::string why = obstacle_to_reading(sensor); !why.empty()) {
      section.refuse("reads", "sensor " + in_quotes(sensor.name) + " " + why);
      return;
    }
    const double ratio = sensor.period > 0 ? period / sensor.period : 1;
    if (sensor.period > 0 && !(ratio > 0.5 && std::abs(ratio - std::round(ratio)) < 1e-9)) {
      section.refuse("reads", "sensor " + in_quotes(sensor.name) +
                                  " has a 'period': give the controller a multiple of it");
      return;
    }
    const auto names = columns(sensor, scene_.bodies);
    const std::vector<SensorNumber> inputs = numbers_of(sensor, scene_.bodies);
    const bool is_whole = word == sensor.name;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (!is_whole && names[k] != word) continue;
      if (sensor.errors && names[k].find(".true ") == std::string::npos) {
        section.refuse("reads", in_quotes(word) +
                                    " has errors of the instrument, which "
                                    "controllers cannot read: write " +
                                    in_quotes(sensor.name + ".true " +
                                              names[k].substr(sensor.name.size() + 1)));
        return;
      }
      if (is_whole && skips(inputs[k], kind)) continue;
      inputs_.push_back(inputs[k]);
    }
  }

  /// True for numbers that a pid leaves out if a sensor is named alone: rates of joints, velocities
  /// and accelerations of points.
  [[nodiscard]] static bool skips(const SensorNumber& input, const std::string& kind) {
    if (kind != "pid") return false;
    const auto* const joint = std::get_if<JointSensor>(&input.reading.sensor);
    const bool is_point = std::holds_alternative<PointSensor>(input.reading.sensor);
    return (joint != nullptr && joint->is_rate) || (is_point && input.reading.component >= 3);
  }

  /// Reads `drives` and notes the forces that the outputs are.
  std::vector<std::string> drives(Section& section, const std::string& name) {
    actuators_.clear();
    if (!section.has("drives")) section.refuse_missing("drives");
    const std::vector<std::string> words = section.texts("drives");
    if (section.has("drives") && words.empty()) {
      section.refuse("drives", "must name a body, a joint, a load or a rope");
    }
    if (!tree_) return words;
    std::vector<std::string> known;
    for (const BodyDescription& body : tree_->bodies()) known.push_back(body.name);
    for (const Actuator& one : winches(*tree_)) known.push_back(short_name(one));
    for (const Actuator& one : actuators(*tree_)) known.push_back(one.name);
    for (const std::string& word : words) {
      if (std::find(known.begin(), known.end(), word) != known.end()) continue;
      section.refuse("drives", in_quotes(word) +
                                   " is no body, no rope, no joint (joint.BODY) and no load "
                                   "(load.BODY.torque.x)" +
                                   did_you_mean(word, known));
      return {};
    }
    try {
      actuators_ = actuators({.name = name, .drives = words}, *tree_);
    } catch (const InvalidInput& error) {
      section.refuse("drives", without_name(error.what(), name));
    }
    return words;
  }

  void read_law(Section& section, const std::string& kind, Controller& controller) {
    auto law = section.required_section("law");
    if (!law) return;
    (void)law->required_choice("kind", {"pid", "state-space"});
    if (kind == "pid") controller.law = pid(*law);
    if (kind == "state-space") controller.law = state_space(*law);
    if (kind != "pid" && kind != "state-space") law->ignore_rest();
    law->finish();
  }

  PidLaw pid(Section& law) const {
    KeyDimension gain;
    if (!inputs_.empty() && !actuators_.empty()) {
      gain = units().front() / dimension_of(inputs_.front().unit);
    }
    const KeyDimension rate = gain ? KeyDimension(*gain / dimension::time) : std::nullopt;
    const KeyDimension damping = gain ? KeyDimension(*gain * dimension::time) : std::nullopt;
    if (!law.has("proportional") && !law.has("integral") && !law.has("derivative")) {
      law.refuse_missing("proportional");
    }
    PidLaw result;
    result.proportional = law.number("proportional", gain).value_or(0);
    result.integral = law.number("integral", rate).value_or(0);
    result.derivative = law.number("derivative", damping).value_or(0);
    result.filter = law.number("filter", dimension::time, Range::not_negative).value_or(0);
    if (result.derivative != 0 && result.filter == 0 && !is_sampled_) {
      law.refuse("derivative",
                 "needs 'filter' above 0, a time constant, unless the controller has "
                 "a 'period'");
    }
    return result;
  }

  StateSpaceLaw state_space(Section& law) const {
    StateSpaceLaw result;
    const auto inputs = static_cast<Eigen::Index>(inputs_.size());
    const auto outputs = static_cast<Eigen::Index>(actuators_.size());
    result.A = matrix(law, "A").value_or(Eigen::MatrixXd());
    const Eigen::Index n = result.A.rows();
    result.B = matrix(law, "B").value_or(Eigen::MatrixXd::Zero(n, inputs));
    result.C = matrix(law, "C").value_or(Eigen::MatrixXd::Zero(outputs, n));
    result.D = matrix(law, "D").value_or(Eigen::MatrixXd::Zero(outputs, inputs));
    if (n == 0 && !law.has("D")) law.refuse_missing("D");
    const auto require = [&](const char* key, const Eigen::MatrixXd& M, Eigen::Index rows,
                             Eigen::Index columns) {
      if (inputs == 0 || outputs == 0) return;
      if (M.rows() == rows && (M.cols() == columns || rows == 0)) return;
      law.refuse(key, "must have " + std::to_string(rows) + " rows and " + std::to_string(columns) +
                          " columns");
    };
    require("A", result.A, n, n);
    require("B", result.B, n, inputs);
    require("C", result.C, outputs, n);
    require("D", result.D, outputs, inputs);
    if (const auto initial = law.numbers("initial", static_cast<std::size_t>(n), KeyDimension())) {
      result.initial = Eigen::Map<const Eigen::VectorXd>(initial->data(), n);
    }
    return result;
  }

  /// A matrix as a list of rows.
  static std::optional<Eigen::MatrixXd> matrix(Section& law, const char* key) {
    const toml::node* const node = law.find(key);
    if (node == nullptr) return std::nullopt;
    const auto refuse = [&]() -> std::optional<Eigen::MatrixXd> {
      law.refuse(key, "must be a list of rows of numbers, all of the same length");
      return std::nullopt;
    };
    const toml::array* const rows = node->as_array();
    if (rows == nullptr || rows->empty()) return refuse();
    Eigen::MatrixXd result;
    for (std::size_t i = 0; i < rows->size(); ++i) {
      const toml::array* const row = rows->get(i)->as_array();
      if (row == nullptr || row->empty()) return refuse();
      const auto width = static_cast<Eigen::Index>(row->size());
      if (i == 0) result.resize(static_cast<Eigen::Index>(rows->size()), width);
      if (width != result.cols()) return refuse();
      for (std::size_t k = 0; k < row->size(); ++k) {
        const auto number = row->get(k)->value<double>();
        if (!number || !std::isfinite(*number)) return refuse();
        result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = *number;
      }
    }
    return result;
  }

  const SceneFile& scene_;
  std::vector<std::string> columns_;
  std::optional<BodyTree> tree_;  ///< unless the scene has mistakes
  std::vector<SensorNumber> inputs_;
  std::vector<Actuator> actuators_;
  bool is_sampled_ = false;
};

/// Appends the memory of a controller. Notes as a mistake whatever prevents the controller from
/// controlling the bodies.
void append_memory(Section& section, const Controller& controller, SceneFile& scene) {
  try {
    const BodyTree tree(scene.bodies, scene.elements, scene.constraints);
    const ControlLoop loop(controller, tree, 0);
    const Eigen::VectorXd start = loop.initial();
    for (const std::string& name : loop.memory_names()) scene.memory_names.push_back(name);
    scene.memory_start.insert(scene.memory_start.end(), start.begin(), start.end());
  } catch (const InvalidInput& error) {
    section.refuse_all(without_name(error.what(), controller.name));
  }
}

/// Refuses a reading that depends on a frame whose motion the equations do not have.
void check_frames(Section& section, const Controller& controller, const SceneFile& scene) {
  const bool is_inertial =
      std::any_of(controller.reads.begin(), controller.reads.end(), [](const Reading& reading) {
        const auto* const point = std::get_if<PointSensor>(&reading.sensor);
        return point != nullptr && point->against.kind == SensorFrame::Kind::inertial;
      });
  if (is_inertial && has_guide_of_equations(scene)) {
    section.refuse("reads",
                   "a point seen from the inertial frame, which controllers cannot read "
                   "on this guide: read it against the guide");
  }
}

}  // namespace

void read_controllers(Section& root, bool sound, SceneFile& scene) {
  if (!root.has("controller") || scene.bodies.empty()) return;
  ControllerReader reader(scene, sound);
  std::vector<std::string> taken;
  for (const SceneSensor& sensor : scene.sensors) taken.push_back(sensor.name);
  std::vector<SceneSensor> outputs;
  for (Section& section : root.sections("controller")) {
    const std::string name = section.required_text("name");
    if (section.has("name") && name.empty()) section.refuse("name", "is empty");
    if (!name.empty()) section.rename("controller '" + name + "'");
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      section.refuse("name", "is used by an earlier sensor or controller");
    }
    taken.push_back(name);
    const std::size_t before = section.mistakes();
    Controller controller = reader.read(section, name);
    section.finish();
    if (scene.model == SceneModel::small && controller.period > 0) {
      section.refuse_all("needs the model 'exact', because it has a period");
    } else if (scene.model != SceneModel::exact && scene.model != SceneModel::small) {
      section.refuse_all(
          std::string("needs the model 'exact', or 'small' without a period, not '") +
          kreisel::name(scene.model) + "'");
    }
    if (sound && section.mistakes() == before) {
      append_memory(section, controller, scene);
      check_frames(section, controller, scene);
    }
    scene_sensor::Outputs output{scene.controllers.size()};
    for (const Actuator& one : reader.outputs()) {
      output.drives.push_back(short_name(one));
      output.units.push_back(one.unit);
    }
    outputs.push_back({.name = name, .kind = std::move(output)});
    scene.controllers.push_back(std::move(controller));
  }
  std::move(outputs.begin(), outputs.end(), std::back_inserter(scene.sensors));
}

}  // namespace kreisel::detail
