#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/AutoDiff>

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/study/body_states.hpp>
#include <dynamics/study/free_directions.hpp>
#include <dynamics/study/tangent.hpp>

namespace kreisel {

namespace detail {

template <int n>
using Duals = Eigen::AutoDiffScalar<Eigen::Matrix<double, n, 1>>;

/// Number of directions in which a field is differentiated at a time. With a state of dynamic size
/// an evaluation costs more than a further direction.
template <class Scene>
inline constexpr int directions = Scene::Vector::RowsAtCompileTime == Eigen::Dynamic ? 4 : 1;

template <class Scene, class S>
using StateOf = Eigen::Matrix<S, Scene::Vector::RowsAtCompileTime, 1>;

}  // namespace detail

/// A scene whose field accepts dual numbers: rates(t, y) on Eigen::Matrix<S, n, 1>, n fixed or
/// Eigen::Dynamic, for S = double and S = Eigen::AutoDiffScalar.
template <class Scene>
concept Differentiable = requires(const Scene& scene, const detail::Duals<1>& t,
                                  const detail::StateOf<Scene, detail::Duals<1>>& y) {
  { scene.rates(t, y) } -> std::convertible_to<detail::StateOf<Scene, detail::Duals<1>>>;
};

/// The linear equations of a scene's neighbouring motions:  eta' = A eta.
///
/// The rate is the one that `Observer` sees; eta is written in `In`, on its axes and reduced at its
/// origin. Matrices of different observers or frames are different types.
///
/// Constraints make components of eta depend on the others. Their columns of A are then 0, and
/// their rows are the rates that follow. The equations of the independent components are those of
/// the motions that fulfil the constraints.
///
/// Units  : those of the state, radian for the angles that stand for a quaternion
template <class Observer, class In>
struct Linearization {
  Eigen::VectorXd state;           ///< the state about which the equations are linear
  Eigen::MatrixXd A;               ///< state matrix
  Eigen::VectorXd rate;            ///< of the state, in the components of eta': 0 at an equilibrium
  std::vector<std::string> names;  ///< of eta

  /// The rate of the rate along the motion. It is 0 at an equilibrium and in a steady motion, in
  /// which only cyclic components run. Otherwise A holds only at that time.
  Eigen::VectorXd unsteadiness;
  FreeDirections free = {};  ///< of a constrained scene: its independent components
};

namespace detail {

/// f(t, y) and its derivatives along t and along the columns of E.
struct Derivatives {
  Eigen::VectorXd f;
  Eigen::VectorXd along_time;  ///< 0 if not requested
  Eigen::MatrixXd along;
};

/// If the derivative in time is not requested, the guide is evaluated at t only: t may be its first
/// time.
enum class InTime { yes, no };

template <class Scene>
[[nodiscard]] Derivatives derivatives(const Scene& scene, double t, const typename Scene::Vector& y,
                                      const Eigen::MatrixXd& E, InTime in_time = InTime::yes) {
  static_assert(Differentiable<Scene>,
                "the scene's rates(t, y) does not take dual numbers: make it a template on the "
                "number type of t and y");
  constexpr int at_once = directions<Scene>;
  using Number = Duals<at_once>;
  Derivatives d;
  d.along.resize(y.size(), E.cols());
  d.along_time.setZero(y.size());
  d.f.resize(y.size());
  const Eigen::Index columns = E.cols() + (in_time == InTime::yes ? 1 : 0);
  for (Eigen::Index begin = 0; begin < columns; begin += at_once) {
    Number now(t);
    StateOf<Scene, Number> state(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) state[i] = Number(y[i]);
    const Eigen::Index count = std::min<Eigen::Index>(at_once, columns - begin);
    for (Eigen::Index k = 0; k < count; ++k) {
      if (begin + k == E.cols()) {
        now.derivatives()[k] = 1;
        continue;
      }
      for (Eigen::Index i = 0; i < y.size(); ++i) state[i].derivatives()[k] = E(i, begin + k);
    }
    const StateOf<Scene, Number> f = scene.rates(now, state);
    for (Eigen::Index i = 0; i < y.size(); ++i) {
      d.f[i] = f[i].value();
      for (Eigen::Index k = 0; k < count; ++k) {
        (begin + k == E.cols() ? d.along_time[i] : d.along(i, begin + k)) = f[i].derivatives()[k];
      }
    }
  }
  return d;
}

template <class Scene>
[[nodiscard]] Tangent tangent_of(const Scene& scene, Eigen::Index components,
                                 std::vector<int> quaternions) {
  if constexpr (requires { scene.quaternions(); }) {
    const auto& own = scene.quaternions();
    quaternions.assign(own.begin(), own.end());
  } else if constexpr (requires { scene.tree(); }) {
    quaternions = kreisel::quaternions(scene.tree());
  }
  return {static_cast<int>(components), std::move(quaternions)};
}

template <class Scene>
[[nodiscard]] std::vector<std::string> names_of(const Scene& scene, const Tangent& tangent) {
  std::vector<std::string> names;
  if constexpr (requires { scene.tree(); }) {
    names = direction_names(scene.tree());
    if constexpr (requires { scene.memory_names(); }) {
      for (std::string& name : scene.memory_names()) names.push_back(std::move(name));
    }
    return names;
  }
  const int components = tangent.dimension() + static_cast<int>(tangent.quaternions().size());
  auto next = tangent.quaternions().begin();
  for (int i = 0; i < components; ++i) {
    if (next != tangent.quaternions().end() && *next == i) {
      for (const char* axis : {"x", "y", "z"}) names.push_back(std::string("angle about ") + axis);
      i += 3;
      ++next;
    } else if constexpr (requires { scene.names[0]; }) {
      names.emplace_back(scene.names[std::size_t(i)]);
    } else {
      names.push_back("y" + std::to_string(i));
    }
  }
  return names;
}

/// True if a scene has constraints.
template <class Scene>
[[nodiscard]] bool is_constrained(const Scene& scene) {
  if constexpr (requires {
                  scene.constraint_slopes(typename Scene::Vector(), Eigen::MatrixXd());
                }) {
    return !scene.tree().constraints().empty();
  } else {
    return false;
  }
}

/// The state nearest to y that fulfils the constraints.
///
/// Throws : ComputationFailed, naming the constraint that stays open, if there is none near
template <class Scene>
[[nodiscard]] typename Scene::Vector on_constraints(const Scene& scene,
                                                    const typename Scene::Vector& y) {
  if constexpr (requires { scene.assembled(y); }) {
    if (is_constrained(scene)) return scene.assembled(y);
  }
  return y;
}

/// The state after a finite move along eta.
///
/// Throws : as on_constraints()
template <class Scene>
[[nodiscard]] typename Scene::Vector moved(const Scene& scene, const Tangent& tangent,
                                           const typename Scene::Vector& y,
                                           const Eigen::VectorXd& eta) {
  return on_constraints(scene, tangent.moved(y, eta));
}

template <class Scene>
[[nodiscard]] FreeDirections free_directions(const Scene& scene, const typename Scene::Vector& y,
                                             const Eigen::MatrixXd& E) {
  if constexpr (requires { scene.constraint_slopes(y, E); }) {
    if (is_constrained(scene)) {
      return free_directions(scene.constraint_slopes(y, E), RuledDirections::of(scene.tree()).given,
                             scene.tree().rates());
    }
  }
  return {};
}

/// The derivatives of a field along eta. y' = E v and the rate dE of E give
/// A = P (f_y E - dE), v' = P (f_t + f_y E v - dE v).
struct Reduced {
  Eigen::VectorXd f;
  Eigen::VectorXd v;
  Eigen::MatrixXd A;
  Eigen::VectorXd dv;
  FreeDirections free = {};
};

template <class Scene>
[[nodiscard]] Reduced reduced(const Scene& scene, double t, const typename Scene::Vector& y,
                              const Tangent& tangent, InTime in_time, FreeDirections free) {
  Reduced r;
  r.free = std::move(free);
  Eigen::MatrixXd E = tangent.basis(y);
  if (r.free.bound()) E *= r.free.N;
  const Derivatives d = derivatives(scene, t, y, E, in_time);
  const Eigen::MatrixXd P = tangent.inverse(y);
  Eigen::MatrixXd dE = tangent.basis_rate(d.f);
  if (r.free.bound()) dE *= r.free.N;
  r.f = d.f;
  r.v = P * d.f;
  r.A = P * (d.along - dE);
  if (r.free.bound()) r.A = with_columns(r.A, r.free.independent, tangent.dimension());
  r.dv = P * d.along_time + r.A * r.v;
  return r;
}

template <class Scene>
[[nodiscard]] Reduced reduced(const Scene& scene, double t, const typename Scene::Vector& y,
                              const Tangent& tangent, InTime in_time = InTime::yes) {
  return reduced(scene, t, y, tangent, in_time, free_directions(scene, y, tangent.basis(y)));
}

}  // namespace detail

/// The linear equations about the state y at the time t, by dual numbers: exact, no differences. The
/// state fulfils the constraints, if there are any, at a position where their rank does not change.
///
/// Scene       : Differentiable. May offer quaternions(), the positions in y of quaternions, and
///               names, of the components of y; a BodySystem has both
/// quaternions : those positions, if the scene does not give them
/// Error       : that of the scene's own formulas. On a guide that takes times of type double alone
///               the unsteadiness errs by 2^-42 of the accelerations' fifth derivative in time
/// Cost        : n + 1 evaluations of the field in numbers of two parts; of a BodySystem n/4 in
///               numbers of five
/// Throws      : as rates() does: for a BodySystem InvalidInput if a load accepts no dual numbers
template <class Observer, class In, class Scene>
[[nodiscard]] Linearization<Observer, In> linearize(const Scene& scene, double t,
                                                    const typename Scene::Vector& y,
                                                    std::vector<int> quaternions = {}) {
  const Tangent tangent = detail::tangent_of(scene, y.size(), std::move(quaternions));
  detail::Reduced r = detail::reduced(scene, t, y, tangent);
  return {y,
          std::move(r.A),
          std::move(r.v),
          detail::names_of(scene, tangent),
          std::move(r.dv),
          std::move(r.free)};
}

}  // namespace kreisel
