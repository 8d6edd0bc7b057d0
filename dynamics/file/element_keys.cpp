#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include <dynamics/file/element_keys.hpp>
#include <dynamics/file/pair_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/file/scene_signal.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel::detail {

namespace {

class ElementReader {
 public:
  ElementReader(const PairKeys& pairs, bool sound) : pairs_(pairs), sound_(sound) {}

  /// Nothing if the kind is wrong, so that the other keys cannot be checked.
  std::optional<Element> read(Section& section, const std::string& name) {
    const std::string kind =
        section.required_choice("kind", {"spring", "rope", "mount", "coupling", "gear"});
    if (section.peek("kind") != kind) return std::nullopt;
    if (kind == "spring") return spring(section, name);
    if (kind == "rope") return rope(section, name);
    if (kind == "mount") return mount(section, name);
    return coupling(section, name);
  }

 private:
  SpringElement spring(Section& section, const std::string& name) const {
    SpringElement result{.name = name, .ends = pairs_.ends(section)};
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

  RopeElement rope(Section& section, const std::string& name) const {
    RopeElement result{.name = name, .ends = pairs_.ends(section)};
    if (!section.has("length")) section.refuse_missing("length");
    result.stiffness =
        section.required_number("stiffness", dimension::force / dimension::length, Range::positive);
    result.damping = damping(section, dimension::force / dimension::velocity);
    const auto length = read_signal<double>(section, "length", dimension::length);
    if (!length) return result;
    if (length->jumps()) {
      section.refuse("length", "jumps at t = " + shown_time(length->discontinuities().front()) +
                                   " s; a winch needs time: take 'points' or 'rate'");
    } else if (length->is_constant() && (*length)(0.0) < 0) {
      section.refuse("length", "must not be below 0");
    }
    result.length = *length;
    return result;
  }

  static double damping(Section& section, const Dimension& of) {
    return section.number("damping", of, Range::not_negative).value_or(0);
  }

  static Matrix3<double> matrix(Section& section, const char* key, const Dimension& of) {
    return section.matrix(key, of).value_or(Matrix3<double>::Zero());
  }

  static Matrix3<double> damping_matrix(Section& section, const char* key, const Dimension& of) {
    Matrix3<double> result = matrix(section, key, of);
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
    MountElement result = mount(section, name, pairs_.ends(section));
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
    const auto joints = pairs_.joints(section);
    std::array<Dimension, 2> moved{dimension::angle, dimension::angle};
    bool fits = joints.has_value() && sound_;
    for (std::size_t end = 0; joints && end < 2; ++end) {
      const int index = (*joints)[end];
      result.joints[end] = pairs_.name(index);
      fits = sound_ && pairs_.has_one_coordinate(section, index) && fits;
      if (fits) moved[end] = pairs_.coordinate(index);
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

  const PairKeys& pairs_;
  bool sound_;
};

}  // namespace

std::vector<Element> read_elements(Section& root, const SceneFile& scene, bool sound) {
  std::vector<Element> result;
  if (!root.has("element") || scene.bodies.empty()) return result;
  const PairKeys pairs(scene);
  ElementReader reader(pairs, sound);
  std::vector<std::string> names;
  for (Section& section : root.sections("element")) {
    const std::string name = section.required_text("name");
    pairs.check_name(section, name, names);
    names.push_back(name);
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
