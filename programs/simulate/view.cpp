#include "view.hpp"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/columns.hpp>
#include <dynamics/tree/joint/list.hpp>

#include "samples.hpp"
#include "shape.hpp"

using namespace kreisel;

using nlohmann::ordered_json;

namespace {

/// 20 s at 100 frames a second; the page interpolates between frames by coordinates and rates.
constexpr std::size_t most_frames = 2000;

/// A number rounded to the digits that are visible.
double rounded(double x, int digits) {
  return std::strtod(fmt::format("{:.{}g}", x, digits).c_str(), nullptr);
}

template <class Numbers>
ordered_json rounded(const Numbers& all, int digits) {
  ordered_json list = ordered_json::array();
  for (const double x : all) list.push_back(rounded(x, digits));
  return list;
}

constexpr int row_digits = 9;    ///< of numbers that move a body
constexpr int arrow_digits = 4;  ///< of numbers that are only drawn

ordered_json numbers(const Eigen::Vector3d& v) { return rounded(v, row_digits); }

/// The entries of a matrix, row by row.
ordered_json numbers(const Eigen::Matrix3d& m) {
  return rounded(m.transpose().reshaped(), row_digits);
}

/// The motions of a joint with single coordinates: rotation about the axis by `turns` of one
/// coordinate, displacement along it by `slides`.
ordered_json joint_motions(const kreisel::Joint& joint) {
  using kreisel::detail::LinkKind;
  ordered_json list = ordered_json::array();
  for (const auto& part : kreisel::joint_type(joint.kind).parts(joint)) {
    if (kreisel::detail::rate_count(part.kind) != 1) continue;
    list.push_back({{"axis", numbers(part.axis.normalized())},
                    {"turns", part.kind == LinkKind::prismatic ? 0 : 1},
                    {"slides", part.pitch}});
  }
  return list;
}

/// Name and unit of each number.
ordered_json named(const std::vector<kreisel::JointQuantity>& quantities) {
  ordered_json list = ordered_json::array();
  for (const auto& quantity : quantities) {
    for (const std::string& column : quantity.columns) {
      list.push_back(ordered_json::array({column, quantity.unit}));
    }
  }
  return list;
}

/// The direction opposite to gravity, if the scene has one.
Eigen::Vector3d up(const kreisel::SceneFile& scene) {
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  if (std::holds_alternative<kreisel::scene_guide::Earth>(scene.guide.front()) ||
      std::holds_alternative<kreisel::scene_guide::Course>(scene.guide.front())) {
    down = Eigen::Vector3d::UnitX();
  }
  if (std::holds_alternative<kreisel::scene_guide::Orbit>(scene.guide.front())) {
    down = -Eigen::Vector3d::UnitX();
  }
  std::visit(
      [&down](const auto& field) {
        if constexpr (requires { field.g; }) down = field.g;
      },
      scene.gravity);
  return down.norm() > 0 ? Eigen::Vector3d(-down.normalized()) : Eigen::Vector3d::UnitZ();
}

/// North on guide axes at a site of the earth, whose guide is at rest there; null elsewhere.
ordered_json north(const kreisel::SceneFile& scene) {
  const auto* const earth = std::get_if<kreisel::scene_guide::Earth>(&scene.guide.front());
  if (earth == nullptr || scene.guide.size() > 1) return {};
  const double azimuth = earth->site.azimuth * std::numbers::pi / 180;
  return numbers(Eigen::Vector3d(0, std::sin(azimuth), std::cos(azimuth)));
}

ordered_json drawn_as(const Shape& shape) {
  return {{"form", shape.form},
          {"axes", numbers(shape.axes)},
          {"centre", numbers(shape.centre)},
          {"half", numbers(shape.half)},
          {"see_through", shape.holds_a_joint},
          {"axle", numbers(shape.axle)},
          {"axle_begin", rounded(shape.axle_begin, row_digits)},
          {"mark", numbers(shape.mark)}};
}

ordered_json bodies(const kreisel::BodyTree& tree) {
  const std::vector<Shape> drawn = shapes(tree);
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const kreisel::BodyDescription& body = tree.bodies()[i];
    const kreisel::Joint& joint = body.joint;
    const kreisel::JointType& type = kreisel::joint_type(joint.kind);
    list.push_back({{"name", body.name},
                    {"parent", body.parent == "guide" ? -1 : tree.index(body.parent)},
                    {"axis", numbers(joint.axis.normalized())},
                    {"parts", joint_motions(joint)},
                    {"coordinates", named(type.coordinates)},
                    {"rates", named(type.rates)},
                    {"position", numbers(joint.position)},
                    {"orientation", numbers(joint.orientation.normalized().toRotationMatrix())},
                    {"shape", drawn_as(drawn[i])}});
  }
  return list;
}

/// Relative, guide and Coriolis part of each body, force and torque.
std::vector<double> terms_row(const Result& result, double t, const kreisel::JointState& state,
                              const kreisel::SceneScale& scale) {
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(result.scene.bodies.size()); ++i) {
    const auto parts = result.model.terms(t, state, i);
    for (const auto& part : {parts.relative.value, parts.guide.value, parts.coriolis.value}) {
      for (const double x : part.resultant) values.push_back(shown(x, scale.force));
      for (const double x : part.moment) values.push_back(shown(x, scale.torque));
    }
  }
  return values;
}

/// Name, columns and units of each sensor.
ordered_json sensors(const kreisel::SceneFile& scene) {
  ordered_json list = ordered_json::array();
  for (const kreisel::SceneSensor& sensor : scene.sensors) {
    ordered_json shown = ordered_json::array();
    for (const kreisel::SensorPart& part : parts(sensor, scene.bodies)) {
      const std::string before = part.name == "value" ? "" : part.name + " ";
      for (std::size_t k = 0; k < part.components.size(); ++k) {
        shown.push_back({before + part.components[k], part.units[k]});
      }
    }
    list.push_back({{"name", sensor.name}, {"shown", shown}});
  }
  return list;
}

/// JSON for a script element, which "</script" or "<!--" in a name would end.
std::string text(const ordered_json& values) {
  std::string result;
  for (const char c : values.dump())
    result += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return result;
}

}  // namespace

void write_view(const Result& result, const std::filesystem::path& place) {
  const Samples samples(result, most_frames);
  const kreisel::SceneScale scale = scale_of(result);
  const kreisel::BodyTree& tree = result.model.tree();
  ordered_json run{{"title", result.scene.title},
                   {"up", numbers(up(result.scene))},
                   {"north", north(result.scene)},
                   {"bodies", bodies(tree)},
                   {"columns", columns(tree, false)},
                   {"rows", samples.all([&](double t, const kreisel::JointState& state) {
                      return rounded(
                          shown_row(result.model, row(result.model, t, state, {}), scale),
                          row_digits);
                    })}};
  if (!result.scene.sensors.empty()) {
    run["sensors"] = sensors(result.scene);
    ordered_json& readings = run["readings"] = ordered_json::array();
    for (const auto& reading : samples.readings()) {
      readings.push_back(rounded(reading, row_digits));
    }
  }
  if (result.terms) {
    run["terms"] = samples.all([&](double t, const kreisel::JointState& state) {
      return rounded(terms_row(result, t, state, scale), arrow_digits);
    });
  }
  constexpr std::string_view mark = "RUN_AS_JSON";
  const std::size_t at = view_page.find(mark);
  kreisel::AtomicFile page(place);
  page.stream() << view_page.substr(0, at) << text(run) << view_page.substr(at + mark.size());
  page.commit();
}
