#pragma once

// Includes toml++: only for the .cpp files of this folder.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_section.hpp>

namespace kreisel::detail {

/// Reads the two bodies, joints and points of an element or a constraint.
class PairKeys {
 public:
  /// The scene's bodies and points are known, and must outlive this object.
  explicit PairKeys(const SceneFile& scene);

  /// The ends at the keys `between` and `at`.
  [[nodiscard]] std::array<ElementEnd, 2> ends(Section& section) const;

  /// The two joints at the key `joints`, as indices; nothing after a mistake.
  [[nodiscard]] std::optional<std::array<int, 2>> joints(Section& section) const;

  /// The body at a key, as an index; 0 after a mistake.
  [[nodiscard]] int body(Section& section, const char* key, bool required) const;

  /// A point of a body at the key `at`: coordinates, or a name; the origin without that key.
  [[nodiscard]] Vector3<double> point(Section& section, int index) const;

  /// Refuses a name that is empty, of a body, or among the names before.
  void check_name(Section& section, const std::string& name,
                  const std::vector<std::string>& before) const;

  /// Indices: 0 is the guide, then the bodies.
  [[nodiscard]] const std::string& name(int index) const {
    return names_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] int index(const std::string& name) const;

  /// The dimension of the coordinate of a body's joint, which has one.
  [[nodiscard]] Dimension coordinate(int index) const;

  /// True if the joint of a body has a single coordinate; else a mistake at `joints`.
  [[nodiscard]] bool has_one_coordinate(Section& section, int index) const;

 private:
  [[nodiscard]] std::optional<std::array<int, 2>> two_names(Section& section, const char* key,
                                                            const char* what) const;
  void refuse_rotor(Section& section, const char* key, int index) const;
  [[nodiscard]] Vector3<double> point(Section& section, std::size_t end, const toml::node& node,
                                      int index) const;
  [[nodiscard]] const NamedPoints& points(int index) const;
  [[nodiscard]] const BodyDescription& body(int index) const {
    return scene_.bodies[static_cast<std::size_t>(index - 1)];
  }

  const SceneFile& scene_;
  std::vector<std::string> names_;
};

}  // namespace kreisel::detail
