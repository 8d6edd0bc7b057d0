#include <algorithm>

#include <dynamics/file/name_keys.hpp>
#include <dynamics/file/pair_keys.hpp>
#include <dynamics/file/quoted.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel::detail {

PairKeys::PairKeys(const SceneFile& scene) : scene_(scene) {
  names_.emplace_back("guide");
  for (const BodyDescription& body : scene.bodies) names_.push_back(body.name);
}

std::optional<std::array<int, 2>> PairKeys::joints(Section& section) const {
  return two_names(section, "joints", "joint");
}

int PairKeys::body(Section& section, const char* key, bool required) const {
  if (required && !section.has(key)) section.refuse_missing(key);
  const auto word = section.text(key);
  if (!word) return 0;
  const int index = index_of_name(section, key, *word, names_, "body");
  refuse_rotor(section, key, index);
  return index;
}

int PairKeys::index(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? 0 : static_cast<int>(found - names_.begin());
}

void PairKeys::check_name(Section& section, const std::string& name,
                          const std::vector<std::string>& before) const {
  if (name.empty()) {
    if (!section.peek("name").empty() || !section.has("name")) return;
    if (section.find("name")->is_string()) section.refuse("name", "is empty");
    return;
  }
  if (std::find(before.begin(), before.end(), name) != before.end()) {
    section.refuse("name", "is used by an earlier element or constraint");
  }
  if (std::find(names_.begin(), names_.end(), name) != names_.end()) {
    section.refuse("name", in_quotes(name) + " is the name of a body; choose another");
  }
}

const NamedPoints& PairKeys::points(int index) const {
  static const NamedPoints none;
  return index == 0 ? none : scene_.points[static_cast<std::size_t>(index - 1)];
}

Vector3<double> PairKeys::point(Section& section, int index) const {
  const toml::node* const node = section.find("at");
  if (node == nullptr) return Vector3<double>::Zero();
  if (const auto* const name = node->as_string()) {
    return named_point(section, "at", name->get(), points(index), this->name(index));
  }
  return section.vector("at", dimension::length).value_or(Vector3<double>::Zero());
}

std::optional<std::array<int, 2>> PairKeys::two_names(Section& section, const char* key,
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

void PairKeys::refuse_rotor(Section& section, const char* key, int index) const {
  if (index == 0 || !body(index).rotor) return;
  section.refuse(key, in_quotes(names_[std::size_t(index)]) +
                          " is a rotor, whose angle no force may depend on; leave 'rotor' out "
                          "and it is an ordinary body");
}

std::array<ElementEnd, 2> PairKeys::ends(Section& section) const {
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

Vector3<double> PairKeys::point(Section& section, std::size_t end, const toml::node& node,
                                int index) const {
  const auto* const name = node.as_string();
  if (name == nullptr) {
    return section.vector_at("at", end, node, dimension::length).value_or(Vector3<double>::Zero());
  }
  return named_point(section, "at", name->get(), points(index), this->name(index));
}

Dimension PairKeys::coordinate(int index) const {
  return dimension_of(joint_type(body(index).joint.kind).coordinates.front().unit);
}

bool PairKeys::has_one_coordinate(Section& section, int index) const {
  if (index == 0) {
    section.refuse("joints", "'guide' has no joint");
    return false;
  }
  const JointType& type = joint_type(body(index).joint.kind);
  if (type.rate_count() == 1) return true;
  section.refuse("joints", "the joint of " + in_quotes(body(index).name) + " is " + type.name +
                               "; take joints with one coordinate: revolute, prismatic, screw");
  return false;
}

}  // namespace kreisel::detail
