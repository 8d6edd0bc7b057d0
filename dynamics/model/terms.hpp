#pragma once

#include <algorithm>
#include <cstddef>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace kreisel {

/// A term of a scene's equation of motion, and whether the scene's field computes it.
struct Term {
  std::string part;  ///< relative, guide, Coriolis or load: the parts of equation_of_motion
  std::string name;  ///< its formula, in the letters of the scene's documentation
  bool kept = true;
  std::string why = {};  ///< why it is dropped; for a kept term, the components that are not
};

/// All terms of a scene's equation of motion. Printed it is a table, a term a line.
class Terms {
 public:
  void add(std::string part, std::string name, bool kept, std::string why) {
    list_.push_back({std::move(part), std::move(name), kept, std::move(why)});
  }
  /// Adds a term that is always kept.
  void add(std::string part, std::string name) { add(std::move(part), std::move(name), true, {}); }

  [[nodiscard]] auto begin() const { return list_.begin(); }
  [[nodiscard]] auto end() const { return list_.end(); }
  [[nodiscard]] std::size_t size() const { return list_.size(); }

 private:
  std::vector<Term> list_;
};

/// The terms of a scene's equations of motion, those that its field computes and those that it
/// leaves out. A term is left out by the scene's type or by its numbers. The field is compiled from
/// the same constants and types.
///
///   std::cout << terms(FixedPointBody(rod, {0, 0, 0}, RestingFrame<>{}, ViscousDrag<>{0.02}));
///
/// A term that is kept may still be 0 in numbers that are not part of a type.
///
/// Every scene has terms; GyroPlatform has those of each of its linear equations.
///
/// Source : the scenes' own equations, after paper 002 (5)
template <class Scene>
requires requires(const Scene& scene) { scene.terms(); }
[[nodiscard]] Terms terms(const Scene& scene) { return scene.terms(); }

inline std::ostream& operator<<(std::ostream& out, const Terms& terms) {
  std::size_t part = 0;
  std::size_t name = 0;
  for (const Term& term : terms) {
    part = std::max(part, term.part.size());
    name = std::max(name, term.name.size());
  }
  const auto column = [](std::string text, std::size_t width) {
    text.resize(width + 2, ' ');
    return text;
  };
  for (const Term& term : terms) {
    out << column(term.part, part) << column(term.name, name) << (term.kept ? "kept" : "dropped");
    if (!term.why.empty()) out << ": " << term.why;
    out << '\n';
  }
  return out;
}

}  // namespace kreisel
