#include <algorithm>
#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <dynamics/control/actuator.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/scene_section.hpp>
#include <dynamics/file/sensor_numbers.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

constexpr const char* axes[] = {"x", "y", "z"};

/// A name with the number of one of several, from 1.
std::string numbered(std::string name, int index, int count) {
  if (count > 1) name.append(".").append(std::to_string(index + 1));
  return name;
}

void append(const std::vector<Actuator>& actuators, std::vector<PlantInput>& inputs) {
  for (const Actuator& one : actuators) inputs.push_back({one.name, one.unit, one});
}

void append_references(const SceneFile& scene, std::vector<PlantInput>& inputs) {
  for (std::size_t c = 0; c < scene.controllers.size(); ++c) {
    const Controller& controller = scene.controllers[c];
    const int count = static_cast<int>(controller.reads.size());
    for (int i = 0; i < count; ++i) {
      inputs.push_back(
          {numbered(controller.name + ".reference", i, count), "", PlantInput::Reference{c, i}});
    }
  }
}

void append_guide(std::vector<PlantInput>& inputs) {
  constexpr const char* angles[] = {"roll", "pitch", "yaw"};
  for (int k = 0; k < 3; ++k) {
    inputs.push_back({std::string("guide.") + angles[k], "rad", PlantInput::GuideTurn{k, false}});
  }
  for (int k = 0; k < 3; ++k) {
    inputs.push_back({std::string("guide.angular_velocity.") + axes[k], "rad/s",
                      PlantInput::GuideTurn{k, true}});
  }
  for (int k = 0; k < 3; ++k) {
    inputs.push_back({std::string("guide.origin_acceleration.") + axes[k], "m/s^2",
                      PlantInput::GuideAcceleration{k}});
  }
}

/// The inputs of a scene; loads on all bodies, or only on those that have loads.
std::vector<PlantInput> inputs_of(const SceneFile& scene, bool all_loads) {
  const BodyTree tree(scene.bodies, scene.elements, scene.constraints);
  std::vector<PlantInput> inputs;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    append(joint_actuators(tree, i), inputs);
  }
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (all_loads || !tree.body(i).loads.empty()) append(load_actuators(tree, i), inputs);
  }
  for (const Actuator& winch : winches(tree)) {
    const int element = std::get<Actuator::Winch>(winch.kind).element;
    const auto& rope = std::get<RopeElement>(tree.elements()[static_cast<std::size_t>(element)]);
    // With damping the rate of the length would act, too.
    if (rope.damping == 0) inputs.push_back({winch.name, winch.unit, winch});
  }
  append_references(scene, inputs);
  append_guide(inputs);
  return inputs;
}

/// Appends the columns of a sensor that can be read.
void append_sensor(const SceneSensor& sensor, const std::vector<BodyDescription>& bodies,
                   std::vector<PlantOutput>& outputs) {
  const std::vector<std::string> names = columns(sensor, bodies);
  if (const auto* const of = std::get_if<scene_sensor::Outputs>(&sensor.kind)) {
    for (std::size_t k = 0; k < names.size(); ++k) {
      outputs.push_back(
          {names[k], of->units[k], PlantOutput::OfController{of->controller, static_cast<int>(k)}});
    }
    return;
  }
  if (!obstacle_to_reading(sensor).empty()) return;
  const std::vector<SensorNumber> numbers = numbers_of(sensor, bodies);
  for (std::size_t k = 0; k < names.size(); ++k) {
    outputs.push_back({names[k], numbers[k].unit, numbers[k].reading});
  }
}

template <class Named>
Named named(const std::vector<Named>& all, const std::string& name, const char* what) {
  std::vector<std::string> names;
  for (const Named& one : all) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  std::string list;
  constexpr std::size_t most = 24;
  for (std::size_t i = 0; i < names.size() && i < most; ++i)
    list.append(i > 0 ? ", " : "").append(names[i]);
  if (names.size() > most) list += ", ..";
  throw InvalidInput(detail::in_quotes(name) + " is no " + what +
                     detail::did_you_mean(name, names) + "; there are " + list);
}

}  // namespace

std::vector<PlantInput> plant_inputs(const SceneFile& scene) { return inputs_of(scene, false); }

PlantInput plant_input(const SceneFile& scene, const std::string& name) {
  return named(inputs_of(scene, true), name, "input");
}

std::vector<PlantOutput> plant_outputs(const SceneFile& scene) {
  std::vector<PlantOutput> outputs;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const SceneSensor joint{scene.bodies[static_cast<std::size_t>(i)].name, scene_sensor::Joint{i}};
    const JointType& type = joint_type(scene.bodies[static_cast<std::size_t>(i)].joint.kind);
    std::vector<PlantOutput> own;
    append_sensor(joint, scene.bodies, own);
    // The coordinates of an attitude are read by an attitude sensor.
    const auto from = type.has_attitude() ? static_cast<std::size_t>(type.coordinate_count()) : 0;
    outputs.insert(outputs.end(), own.begin() + static_cast<std::ptrdiff_t>(from), own.end());
  }
  for (const SceneSensor& sensor : scene.sensors) append_sensor(sensor, scene.bodies, outputs);
  return outputs;
}

PlantOutput plant_output(const SceneFile& scene, const std::string& name) {
  return named(plant_outputs(scene), name, "output that can be read");
}

}  // namespace kreisel
