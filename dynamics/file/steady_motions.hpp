#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/file/equilibria.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/body_states.hpp>
#include <dynamics/study/linearize.hpp>

namespace kreisel {

/// A state in which the motion does not change, except for angles on which nothing depends.
struct Steady {
  enum class Kind {
    start,  ///< the start in the file
    found,  ///< a state next to the start
    none
  };
  Kind kind = Kind::none;
  std::string reason;     ///< the reason if none exists
  bool turns = false;     ///< bodies other than rotors and drives rotate
  Eigen::VectorXd state;  ///< of the system; empty if none exists
  double distance = 0;    ///< from the file's start, greatest component
  double residual = 0;    ///< greatest of the rates that should be 0

  [[nodiscard]] bool exists() const { return kind != Kind::none; }
};

namespace steady_motion {

using Linearization = kreisel::Linearization<Guide, Body>;

[[nodiscard]] Linearization linearized(const StudySystem& system, double t,
                                       const Eigen::VectorXd& y);

[[nodiscard]] Tangent tangent_of(const StudySystem& system, const Eigen::VectorXd& y);

/// A set of directions.
using Places = std::vector<bool>;

[[nodiscard]] std::vector<int> list(const Places& places, bool in = true);

[[nodiscard]] Places joined(Places a, const Places& b);

/// The directions of a state: coordinates, as many rates, then the memory of controllers.
struct Directions {
  int rates;
  int dimension;
  Places given, held, running;  ///< as RuledDirections has them
  std::vector<int> attitudes;

  explicit Directions(const StudySystem& system);

  /// Coordinates on which no acceleration depends. The test uses two states, because an equilibrium
  /// may hide a dependence.
  [[nodiscard]] Places cyclic(const Linearization& here, const Linearization& elsewhere) const;

  /// Directions that can be left out without changing the roots of the others. They depend on no
  /// other direction because they are given, or no other direction depends on them. Directions that
  /// follow from the others by constraints are among them.
  [[nodiscard]] Places without_roots(const Linearization& linear) const;

 private:
  [[nodiscard]] Places set(const std::vector<int>& directions) const;

  /// The first index and the number of a direction's group: the angles of an attitude are one
  /// group.
  [[nodiscard]] std::pair<int, int> group(int direction) const;
};

/// The state after a move along eta, on the constraints.
[[nodiscard]] Eigen::VectorXd moved(const StudySystem& system, const Eigen::VectorXd& y,
                                    const Eigen::VectorXd& eta);

/// A state next to y without special values.
[[nodiscard]] Eigen::VectorXd off(const StudySystem& system, const Eigen::VectorXd& y);

template <class Kind>
[[nodiscard]] bool has_link(const SceneFile& scene) {
  return std::any_of(scene.guide.begin(), scene.guide.end(),
                     [](const auto& link) { return std::holds_alternative<Kind>(link); });
}

/// True if the linear equations stay the same along the motion and with time.
[[nodiscard]] bool stays(const StudySystem& system, const Linearization& linear, double duration);

/// The steady motion at the guess or next to it.
[[nodiscard]] Steady find_steady(const StudySystem& system, const Eigen::VectorXd& guess,
                                 double duration);

/// Equilibria of a scene; none if its guide keeps changing.
[[nodiscard]] Equilibria find_equilibria(const StudySystem& system, const SceneFile& scene,
                                         const Eigen::VectorXd& start);

/// The steady motion at a scene's start, if there is one. Otherwise it is a steady rotation that
/// Newton's method finds from there. Otherwise it is the nearest of the equilibria and of Newton's
/// results. At equal distances the one whose neighbouring motions grow least is taken.
[[nodiscard]] Steady find_steady(const StudySystem& system, const SceneFile& scene,
                                 const Eigen::VectorXd& start, const Equilibria& equilibria);
[[nodiscard]] Steady find_steady(const StudySystem& system, const SceneFile& scene,
                                 const Eigen::VectorXd& start);

}  // namespace steady_motion

}  // namespace kreisel
