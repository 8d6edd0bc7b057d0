#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <dynamics/file/element_keys.hpp>
#include <dynamics/file/name_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel::detail {

namespace {

class ElementReader {
 public:
  ElementReader(const SceneFile& scene, bool sound) : scene_(scene), sound_(sound) {
    names_.emplace_back("guide");
    for (const BodyDescription& body : scene.bodies) names_.push_back(body.name);
  }

  /// Nothing if the kind is wrong, so that the other keys cannot be checked.
  std::optional<Element> read(Section& section, const std::string& name) {
    if (section.peek("kind") == "rope") {
      section.refuse("kind",
                     "'rope' is not available: a motion that becomes slack and taut needs events; "
                     "take a 'spring', which also pushes");
      return std::nullopt;
    }
    const std::string kind =
        section.required_choice("kind", {"spring", "mount", "coupling", "gear"});
    if (section.peek("kind") != kind) return std::nullopt;
    if (kind == "spring") return spring(section, name);
    if (kind == "mount") return mount(section, name);
    return coupling(section, name);
  }

 private:
  /// The two names at a key, as indices of names_.
  std::optional<std::array<int, 2>> two_names(Section& section, const char* key,
                                              const char* what) const {
    if (!section.has(key)) section.refuse_missing(key);
    const std::size_t before = section.mistakes();
    const std::vector<std::string> words = section.texts(key);
    if (section.mistakes() != before || !section.has(key)) return std::nullopt;
    if (words.size() != 2) {
      section.refuse(key, "must be two names, not " + std::to_string(words.size()));
      return std::nullopt;
    }
    const std::array<int, 2> result{index_of_name(section, key, words[0], names_, what),
                                    index_of_name(section, key, words[1], names_, what)};
    if (section.mistakes() != before) return std::nullopt;
    if (result[0] == result[1]) {
      section.refuse(key, "names " + in_quotes(words[0]) + " twice");
      return std::nullopt;
    }
    for (const int index : result) refuse_rotor(section, key, index);
    return result;
  }

  void refuse_rotor(Section& section, const char* key, int index) const {
    if (index == 0 || !body(index).rotor) return;
    section.refuse(key, in_quotes(names_[std::size_t(index)]) +
                            " is a rotor, whose angle no force may depend on; leave 'rotor' out "
                            "and it is an ordinary body");
  }

  [[nodiscard]] const BodyDescription& body(int index) const {
    return scene_.bodies[static_cast<std::size_t>(index - 1)];
  }

  /// The ends at the keys `between` and `at`.
  std::array<ElementEnd, 2> ends(Section& section) const {
    std::array<ElementEnd, 2> result;
    const auto bodies = two_names(section, "between", "body");
    const toml::node* const node = section.find("at");
    const toml::array* const points = node == nullptr ? nullptr : node->as_array();
    if (node != nullptr && (points == nullptr || points->size() != 2)) {
      section.refuse("at", "must be two points, each [x, y, z] or the name of a point");
    }
    if (!bodies) return result;
    for (const std::size_t end : {std::size_t(0), std::size_t(1)}) {
      const int index = (*bodies)[end];
      result[end].body = names_[static_cast<std::size_t>(index)];
      if (points == nullptr || points->size() != 2) continue;
      result[end].at = point(section, end, *points->get(end), index);
    }
    return result;
  }

  Vector3<double> point(Section& section, std::size_t end, const toml::node& node,
                        int index) const {
    const auto* const name = node.as_string();
    if (name == nullptr) {
      return section.vector_at("at", end, node, dimension::length)
          .value_or(Vector3<double>::Zero());
    }
    static const NamedPoints none;
    const NamedPoints& known =
        index == 0 ? none : scene_.points[static_cast<std::size_t>(index - 1)];
    return named_point(section, "at", name->get(), known, names_[static_cast<std::size_t>(index)]);
  }

  SpringElement spring(Section& section, const std::string& name) const {
    SpringElement result{.name = name, .ends = ends(section)};
    if (!section.has("stiffness") && !section.has("damping") && !section.has("table")) {
      section.refuse_missing("stiffness");
    }
    result.stiffness =
        section.number("stiffness", dimension::force / dimension::length).value_or(0);
    result.length = section.number("length", dimension::length, Range::not_negative).value_or(0);
    result.damping = damping(section, dimension::force / dimension::velocity);
    if (!section.has("table")) return result;
    for (const char* const key : {"stiffness", "length"}) {
      if (section.has(key)) section.refuse(key, "is given beside 'table', which replaces it");
    }
    const auto table = section.pairs("table", dimension::length, dimension::force);
    if (!table) return result;
    if (table->size() < 2) section.refuse("table", "needs two points [length, force] at least");
    for (std::size_t i = 0; i < table->size(); ++i) {
      const auto& [length, pull] = (*table)[i];
      if (length < 0) section.refuse("table", "has a length below 0");
      if (i > 0 && !(length > (*table)[i - 1].first)) {
        section.refuse("table", "must have increasing lengths");
      }
      result.table.push_back({length, pull});
    }
    return result;
  }

  static double damping(Section& section, const Dimension& of) {
    return section.number("damping", of, Range::not_negative).value_or(0);
  }

  static Matrix3<double> matrix(Section& section, const char* key, const Dimension& of) {
    return section.matrix(key, of).value_or(Matrix3<double>::Zero());
  }

  static Matrix3<double> damping_matrix(Section& section, const char* key, const Dimension& of) {
    const Matrix3<double> result = matrix(section, key, of);
    if (result.diagonal().minCoeff() < 0) {
      section.refuse(key, "must not be below 0 along an axis");
    }
    return result;
  }

  static MountElement mount(Section& section, const std::string& name,
                            std::array<ElementEnd, 2> ends) {
    using namespace dimension;
    MountElement result{.name = name, .ends = std::move(ends)};
    result.axes = quaternion(section, "axes").value_or(result.axes);
    result.stiffness.rm = matrix(section, "stiffness", force / length);
    result.stiffness.mr = matrix(section, "turning_stiffness", torque / angle);
    result.stiffness.rr = matrix(section, "coupling", force / angle);
    result.stiffness.mm = result.stiffness.rr.transpose();
    result.damping.rm = damping_matrix(section, "damping", force / velocity);
    result.damping.mr = damping_matrix(section, "turning_damping", torque / angular_rate);
    result.preload = preload(section);
    return result;
  }

  MountElement mount(Section& section, const std::string& name) const {
    MountElement result = mount(section, name, ends(section));
    const char* const keys[] = {"stiffness", "turning_stiffness", "coupling",
                                "damping",   "turning_damping",   "preload"};
    const bool is_given = std::any_of(std::begin(keys), std::end(keys),
                                      [&section](const char* key) { return section.has(key); });
    if (!is_given) section.refuse_missing("stiffness");
    return result;
  }

  static Motor<> preload(Section& section) {
    const toml::node* const node = section.find("preload");
    if (node == nullptr) return {};
    const Dimension &f = dimension::force, &m = dimension::torque;
    if (!node->is_array()) {
      section.refuse("preload", "must be 6 numbers: force x, y, z, torque x, y, z");
      return {};
    }
    const auto numbers = section.number_or_list("preload", {f, f, f, m, m, m});
    if (!numbers) return {};
    return {Vector3<double>(numbers->data()), Vector3<double>(numbers->data() + 3)};
  }

  CouplingElement coupling(Section& section, const std::string& name) const {
    CouplingElement result{.name = name};
    const auto joints = two_names(section, "joints", "joint");
    std::array<Dimension, 2> moved{dimension::angle, dimension::angle};
    bool fits = joints.has_value() && sound_;
    for (std::size_t end = 0; joints && end < 2; ++end) {
      const int index = (*joints)[end];
      result.joints[end] = names_[static_cast<std::size_t>(index)];
      fits = has_one_coordinate(section, index) && fits;
      if (fits) moved[end] = coordinate(index);
    }
    if (!fits) {
      section.ignore_rest();  // units of numbers are not known
      return result;
    }
    if (!section.has("stiffness") && !section.has("damping")) section.refuse_missing("stiffness");
    result.ratio = section.number("ratio", moved[0] / moved[1]).value_or(1);
    if (result.ratio == 0) section.refuse("ratio", "must not be 0");
    const Dimension stiffness = joint_force(moved[0]) / moved[0];
    result.stiffness = section.number("stiffness", stiffness).value_or(0);
    result.damping = damping(section, stiffness * dimension::time);
    return result;
  }

  [[nodiscard]] Dimension coordinate(int index) const {
    return dimension_of(joint_type(body(index).joint.kind).coordinates.front().unit);
  }

  /// True if the joint of a body has a single coordinate, so that it can be coupled.
  bool has_one_coordinate(Section& section, int index) const {
    if (index == 0) {
      section.refuse("joints", "'guide' has no joint");
      return false;
    }
    if (!sound_) return false;
    const JointType& type = joint_type(body(index).joint.kind);
    if (type.rate_count() == 1) return true;
    section.refuse("joints", "the joint of " + in_quotes(body(index).name) + " is " + type.name +
                                 "; take joints with one coordinate: revolute, prismatic, screw");
    return false;
  }

  const SceneFile& scene_;
  bool sound_;
  std::vector<std::string> names_;  ///< the guide, then the bodies
};

/// Refuses a name that is empty or that makes two columns of a run the same.
void check_name(Section& section, const std::string& name, const SceneFile& scene,
                const std::vector<Element>& before) {
  if (name.empty()) {
    if (!section.peek("name").empty() || !section.has("name")) return;
    if (section.find("name")->is_string()) section.refuse("name", "is empty");
    return;
  }
  const auto is_of = [&name](const Element& element) { return kreisel::name(element) == name; };
  if (std::any_of(before.begin(), before.end(), is_of)) {
    section.refuse("name", "is used by an earlier element");
  }
  const auto is_body = [&name](const BodyDescription& body) { return body.name == name; };
  if (std::any_of(scene.bodies.begin(), scene.bodies.end(), is_body)) {
    section.refuse("name", in_quotes(name) + " is the name of a body; choose another");
  }
}

}  // namespace

std::vector<Element> read_elements(Section& root, const SceneFile& scene, bool sound) {
  std::vector<Element> result;
  if (!root.has("element") || scene.bodies.empty()) return result;
  ElementReader reader(scene, sound);
  for (Section& section : root.sections("element")) {
    const std::string name = section.required_text("name");
    check_name(section, name, scene, result);
    if (!name.empty()) section.rename("element '" + name + "'");
    const std::size_t before = section.mistakes();
    auto element = reader.read(section, name);
    if (!element) section.ignore_rest();
    section.finish();
    if (!element) continue;
    if (section.mistakes() == before && !name.empty()) {
      try {
        check_element(*element);
      } catch (const InvalidInput& error) {
        section.refuse_all(error.what());
      }
    }
    result.push_back(std::move(*element));
  }
  return result;
}

}  // namespace kreisel::detail
