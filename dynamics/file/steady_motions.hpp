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

/// A state in which the motion does not change, but for angles on which nothing depends.
struct Steady {
  enum class Kind {
    start,  ///< that of the file
    found,  ///< one next to it
    none
  };
  Kind kind = Kind::none;
  std::string reason;     ///< why there is none
  bool turns = false;     ///< more than rotors and drives do
  Eigen::VectorXd state;  ///< of the system; empty where there is none
  double distance = 0;    ///< from the file's start, greatest component
  double residual = 0;    ///< of the rates that should be 0, greatest

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

/// The directions of a state, first those of the coordinates, then of the rates, and what depends
/// on them.
struct Directions {
  int rates;
  Places given, held, running;  ///< as RuledDirections has them
  std::vector<int> attitudes;

  explicit Directions(const StudySystem& system);

  /// Coordinates on which no acceleration depends: at a state and at another, for an equilibrium
  /// may hide a dependence.
  [[nodiscard]] Places cyclic(const Eigen::MatrixXd& here, const Eigen::MatrixXd& elsewhere) const;

  /// Directions that can be left out, and those that stay keep their roots: what is given, which
  /// depends on nothing else, and that on which nothing else depends.
  [[nodiscard]] Places without_roots(const Eigen::MatrixXd& A) const;

 private:
  [[nodiscard]] Places set(const std::vector<int>& directions) const;

  /// The angles of an attitude are taken as a whole: the first, and how many.
  [[nodiscard]] std::pair<int, int> group(int direction) const;
};

/// A state that has nothing special.
[[nodiscard]] Eigen::VectorXd off(const StudySystem& system, const Eigen::VectorXd& y);

template <class Kind>
[[nodiscard]] bool has_link(const SceneFile& scene) {
  return std::any_of(scene.guide.begin(), scene.guide.end(),
                     [](const auto& link) { return std::holds_alternative<Kind>(link); });
}

/// Whether the linear equations stay what they are along the motion and with time.
[[nodiscard]] bool stays(const StudySystem& system, const Linearization& linear, double t_end);

/// The steady motion at the guess, or next to it.
[[nodiscard]] Steady find_steady(const StudySystem& system, const Eigen::VectorXd& guess,
                                 double t_end);

/// Equilibria of a scene; none where its guide goes on changing.
[[nodiscard]] Equilibria find_equilibria(const StudySystem& system, const SceneFile& scene,
                                         const Eigen::VectorXd& start);

/// The steady motion at a scene's start; else a turning one that Newton's method finds from there;
/// else the nearest of the equilibria and of what Newton's method finds, of several at the same
/// distance that whose neighbouring motions grow least.
[[nodiscard]] Steady find_steady(const StudySystem& system, const SceneFile& scene,
                                 const Eigen::VectorXd& start, const Equilibria& equilibria);
[[nodiscard]] Steady find_steady(const StudySystem& system, const SceneFile& scene,
                                 const Eigen::VectorXd& start);

}  // namespace steady_motion

}  // namespace kreisel
