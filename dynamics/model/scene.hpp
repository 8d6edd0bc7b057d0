#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <array>
#include <concepts>
#include <ostream>
#include <vector>

#include <dynamics/model/corner.hpp>

namespace kreisel {

/// The scene computes its rates: a vector of the state's type, or one in a workspace of the scene.
template <class S>
concept HasRates = requires(const S& scene, double t, const typename S::Vector& y) {
  { scene.rates(t, y) } -> std::convertible_to<typename S::Vector>;
}
|| requires(const S& scene, double t, const typename S::Vector& y, typename S::Vector& rate) {
  { scene.workspace() } -> std::move_constructible;
  requires requires(decltype(scene.workspace())& workspace) { scene.rates(t, y, rate, workspace); };
};

/// The scene divides its components into blocks that share a unit and a size, in a range of int.
template <class S>
concept HasBlocks = requires(const S& scene) {
  std::vector<int>(scene.blocks.begin(), scene.blocks.end());
}
|| requires(const S& scene) { std::vector<int>(scene.blocks().begin(), scene.blocks().end()); };

/// A system whose motion obeys  y' = rates(t, y):  parameters, and how a state becomes a vector.
///
///   State                 : the state as users write it
///   Vector                : Eigen::Matrix<double, n, 1>, n fixed or Eigen::Dynamic
///   rates(t, y)           : y' in SI units
///   to_vector, from_vector: State <-> Vector
///   blocks                : components in turn that share a unit and a size
///
/// All else is optional. Each optional hook has a concept below. A misspelt hook is no hook: put
/// static_assert(HasSeries<MyScene>) beside your scene, or print check_scene<MyScene>().
template <class S>
concept Scene = HasRates<S> && HasBlocks<S> &&
    requires(const S& scene, const typename S::State& state, const typename S::Vector& y) {
  { scene.to_vector(state) } -> std::convertible_to<typename S::Vector>;
  { scene.from_vector(y) } -> std::convertible_to<typename S::State>;
};

/// rates(t, y) also for dual numbers in place of double.
template <class S>
concept HasDualRates = requires {
  typename S::Vector;
}
&&requires(const S& scene, const Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>& t,
           const Eigen::Matrix<Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>,
                               S::Vector::RowsAtCompileTime, 1>& y) {
  scene.rates(t, y);
};

/// conserved(t, state): name and value of each conserved quantity.
template <class S>
concept HasConserved = requires(const S& scene, double t, const typename S::State& state) {
  { scene.conserved(t, state)[0].second } -> std::convertible_to<double>;
};

/// series(): writes the Taylor coefficients of the state.
template <class S>
concept HasSeries = requires(const S& scene) {
  scene.series();
};

/// closed_form(scene, t_begin, state): the motion in closed form, if these parameters have one.
template <class S>
concept HasClosedForm = requires(const S& scene, double t, const typename S::State& state) {
  closed_form(scene, t, state)->at(t);
};

/// may_be_stiff(): true if a part of the scene can make it stiff.
template <class S>
concept HasStiffness = requires(const S& scene) {
  { scene.may_be_stiff() } -> std::convertible_to<bool>;
};

/// perturbed_by_ulps(): the scene with parameters perturbed by a unit in the last place, if the
/// motion is sensitive to them.
template <class S>
concept HasPerturbation = requires(const S& scene) {
  scene.perturbed_by_ulps();
};

/// Parts of the state jump, as the memory of sampled controllers:
///
///   has_samples()            : true if any part does
///   sample_times(begin, end) : the times in (begin, end] at which they jump, in order
///   sample(t, y)             : makes the jump, if t is such a time
template <class S>
concept HasSamples = requires(const S& scene, double t, typename S::Vector& y) {
  { scene.has_samples() } -> std::convertible_to<bool>;
  { scene.sample_times(t, t) } -> std::convertible_to<std::vector<double>>;
  scene.sample(t, y);
};

/// The field has corners where parts of the scene begin or end to act, as ropes do:
///
///   has_corners()      : true if there may be any
///   corners(t, y)      : the functions whose changes of sign are corners. At the time of a jump y is
///                        the state after it, or before it at the end of a step
///   corner_frequency() : rad/s, the fastest oscillation of these functions at given states
template <class S>
concept HasCorners = requires(const S& scene, double t, const typename S::Vector& y) {
  { scene.has_corners() } -> std::convertible_to<bool>;
  { scene.corners(t, y) } -> std::convertible_to<std::vector<Corner>>;
  { scene.corner_frequency() } -> std::convertible_to<double>;
};

/// terms(): the terms of the equations of motion, kept and dropped.
template <class S>
concept HasTerms = requires(const S& scene) {
  scene.terms();
};

/// tree(): the bodies, joints and rotors of a general system.
template <class S>
concept HasTree = requires(const S& scene) {
  scene.tree();
};

/// An optional hook of a scene.
struct SceneHook {
  const char* name;
  bool recognised;
  const char* used_by;
  const char* without;  ///< consequence for a scene without it
};

/// The optional hooks of a scene, each marked if the library recognises it.
template <Scene S>
[[nodiscard]] constexpr std::array<SceneHook, 10> check_scene() {
  return {{
      {"rates(t, y) of dual numbers", HasDualRates<S>, "radau13, linearize()",
       "radau13 takes a Jacobian by differences, linearize() is refused"},
      {"conserved(t, state)", HasConserved<S>, "RunReport::invariants", "no drift is reported"},
      {"series()", HasSeries<S>, "Method::taylor", "automatic integrates by verner98"},
      {"closed_form(scene, t, state)", HasClosedForm<S>, "Method::closed_form",
       "the motion is integrated by steps"},
      {"may_be_stiff()", HasStiffness<S>, "Method::automatic", "the field is tested for stiffness"},
      {"perturbed_by_ulps()", HasPerturbation<S>, "RunReport::error_estimate",
       "rounding of parameters is not part of the error"},
      {"sample_times(begin, end), sample(t, y)", HasSamples<S>, "solve()",
       "the state is continuous"},
      {"corners(t, y)", HasCorners<S>, "solve()", "steps do not end at corners of the field"},
      {"terms()", HasTerms<S>, "terms(), simulate", "terms(scene) is refused"},
      {"tree()", HasTree<S>, "linearize(), equilibria",
       "names of directions come from the scene's own `names`"},
  }};
}

/// One line a hook: "yes" or "no ", its name, what uses it or what happens without.
inline std::ostream& operator<<(std::ostream& out, const std::array<SceneHook, 10>& hooks) {
  for (const SceneHook& hook : hooks) {
    out << (hook.recognised ? "yes  " : "no   ") << hook.name << ": "
        << (hook.recognised ? hook.used_by : hook.without) << '\n';
  }
  return out;
}

}  // namespace kreisel
