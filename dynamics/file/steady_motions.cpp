#include <algorithm>
#include <cmath>
#include <cstddef>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace steady_motion {

Linearization linearized(const StudySystem& system, double t, const VectorXd& y) {
  return linearize<Guide, Body>(system, t, y);
}

Tangent tangent_of(const StudySystem& system, const VectorXd& y) {
  return {static_cast<int>(y.size()), quaternions(system.tree())};
}

std::vector<int> list(const Places& places, bool in) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(places.size()); ++i) {
    if (places[static_cast<std::size_t>(i)] == in) result.push_back(i);
  }
  return result;
}

Directions::Directions(const StudySystem& system)
    : rates(system.tree().rates()),
      dimension(2 * rates + static_cast<int>(system.memory_names().size())) {
  auto ruled = RuledDirections::of(system.tree());
  given = set(ruled.given);
  held = set(ruled.held);
  running = set(ruled.running);
  attitudes = std::move(ruled.attitudes);
}

Places Directions::set(const std::vector<int>& directions) const {
  Places places(static_cast<std::size_t>(dimension), false);
  for (const int i : directions) places[static_cast<std::size_t>(i)] = true;
  return places;
}

std::pair<int, int> Directions::group(int direction) const {
  for (const int first : attitudes) {
    if (direction >= first && direction < first + 3) return {first, 3};
  }
  return {direction, 1};
}

Places Directions::cyclic(const Linearization& here, const Linearization& elsewhere) const {
  Places result(static_cast<std::size_t>(dimension), false);
  const auto counts = [this](const Linearization& linear, int i) {
    return linear.A.col(i).tail(dimension - rates).cwiseAbs().maxCoeff() >
               1e-13 * linear.A.norm() ||
           linear.free.is_dependent(i);
  };
  for (int i = 0; i < rates; ++i) {
    const auto [first, count] = group(i);
    bool none = true;
    for (int k = first; k < first + count; ++k) {
      none = none && !counts(here, k) && !counts(elsewhere, k);
    }
    result[static_cast<std::size_t>(i)] = none;
  }
  return result;
}

Places Directions::without_roots(const Linearization& linear) const {
  const MatrixXd& A = linear.A;
  Places out = set(linear.free.dependent);
  const double zero = 1e-14 * A.norm();
  const auto in = [](const Places& places, int i) { return places[static_cast<std::size_t>(i)]; };
  const auto nothing_depends = [&](int i) {
    const auto [first, count] = group(i);
    for (int row = 0; row < dimension; ++row) {
      const bool own = count > 1 && row >= first && row < first + count;
      if (!own && !in(out, row) && std::abs(A(row, i)) > zero) return false;
    }
    return true;
  };
  for (bool more = true; more;) {
    more = false;
    for (int i = 0; i < dimension; ++i) {
      if (in(out, i) || in(given, i)) continue;
      const auto [first, count] = group(i);
      bool all = true;
      for (int k = first; k < first + count; ++k) all = all && nothing_depends(k);
      if (!all) continue;
      for (int k = first; k < first + count; ++k) out[static_cast<std::size_t>(k)] = true;
      more = true;
    }
  }
  for (const int i : list(given)) out[static_cast<std::size_t>(i)] = true;
  return out;
}

Places joined(Places a, const Places& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] || b[i];
  return a;
}

VectorXd moved(const StudySystem& system, const VectorXd& y, const VectorXd& eta) {
  return detail::moved(system, tangent_of(system, y), y, eta);
}

VectorXd off(const StudySystem& system, const VectorXd& y) {
  VectorXd eta(Directions(system).dimension);
  for (Eigen::Index i = 0; i < eta.size(); ++i) {
    eta[i] = 0.1 * std::cos(2.0 * static_cast<double>(i + 1));
  }
  // Constraints may leave less room.
  for (const double share : {1.0, 0.25, 0.06, 0.015, 0.004}) {
    const auto there = detail::moved_or_none(system, tangent_of(system, y), y, share * eta);
    if (there) return *there;
  }
  return y;
}

bool stays(const StudySystem& system, const Linearization& linear, double duration) {
  const double fastest = linear.rate.cwiseAbs().maxCoeff();
  std::vector<double> times{0.31 * duration, 0.77 * duration};
  // Later times, so that no angle has changed by full rotations by chance.
  if (fastest * duration > 1.9) times.insert(times.end(), {0.7 / fastest, 1.9 / fastest});
  return std::all_of(times.begin(), times.end(), [&](double t) {
    const VectorXd later = moved(system, linear.state, VectorXd(t * linear.rate));
    const Linearization then = linearized(system, system.begin() + t, later);
    return (then.A - linear.A).norm() <= 1e-9 * linear.A.norm() &&
           (then.rate - linear.rate).norm() <= 1e-9 * (1 + linear.rate.norm());
  });
}

namespace {

Steady steady_at(const StudySystem& system, const Linearization& linear) {
  Steady steady;
  steady.state = linear.state;
  const Places running = Directions(system).running;
  const int rates = system.tree().rates();
  for (int i = 0; i < rates; ++i) {
    const bool counts = !running[static_cast<std::size_t>(i)];
    steady.turns = steady.turns || (counts && std::abs(linear.rate[i]) > 1e-9);
  }
  return steady;
}

}  // namespace

Steady find_steady(const StudySystem& system, const VectorXd& guess, double duration) {
  const Linearization at_guess =
      linearized(system, system.begin(), detail::on_constraints(system, guess));
  const double change = at_guess.unsteadiness.norm();
  const bool moves = at_guess.rate.norm() > 0;
  if (moves && change <= 1e-12 * at_guess.A.norm() * at_guess.rate.norm() &&
      stays(system, at_guess, duration)) {
    Steady steady = steady_at(system, at_guess);
    steady.kind = Steady::Kind::start;
    return steady;
  }
  const Directions directions(system);
  const Places cyclic =
      directions.cyclic(at_guess, linearized(system, system.begin(), off(system, guess)));
  Places held = joined(directions.held, cyclic);
  for (const int first : directions.attitudes) {
    // Newton's steps would otherwise halve the angular velocity of a free body down to 0.
    const int w = directions.rates + first;
    Eigen::Index most = 0;
    const Eigen::Index at = system.tree().coordinates() + first;
    const double turns = guess.segment(at, 3).cwiseAbs().maxCoeff(&most);
    const bool free = cyclic[static_cast<std::size_t>(first)] && turns > 0;
    if (free) held[static_cast<std::size_t>(w) + static_cast<std::size_t>(most)] = true;
  }
  Steady steady;
  try {
    const auto found =
        find_equilibrium(system, system.begin(), guess,
                         {.held = list(held), .running = list(joined(directions.running, cyclic))});
    const Linearization there = linearized(system, system.begin(), found.state);
    if (!stays(system, there, duration)) {
      steady.reason =
          "the linear equations change along the motion or with time (if periodically: --period)";
      return steady;
    }
    steady = steady_at(system, there);
    steady.residual = found.residual;
    steady.distance = (found.state - guess).cwiseAbs().maxCoeff();
    const bool same = steady.distance <= 1e-9 * (1 + guess.cwiseAbs().maxCoeff());
    steady.kind = same ? Steady::Kind::start : Steady::Kind::found;
  } catch (const ComputationFailed& error) {
    steady.reason = error.what();
  }
  return steady;
}

namespace {

/// The reason why a scene has no steady motion at all; empty if it may have one.
std::string changes(const SceneFile& scene) {
  if (scene.guide_follows_log()) return "the guide follows a log";
  if (has_link<scene_guide::Harmonic>(scene)) {
    return "the guide swings: the motions that stay repeat it";
  }
  const auto moves = [](const scene_guide::Link& link) {
    const auto* const motion = std::get_if<scene_guide::Motion>(&link);
    return motion != nullptr && !motion->pose.is_constant();
  };
  if (std::any_of(scene.guide.begin(), scene.guide.end(), moves)) {
    return "the guide moves as functions of time";
  }
  const auto* const course = std::get_if<scene_guide::Course>(&scene.guide.front());
  if (course != nullptr && !course->plan.rests()) return "the guide moves over the earth";
  if (scene.forces_change) return "a force, a torque, a drive or a rotor's speed changes with time";
  return "";
}

/// Rotors whose torque is not balanced by friction, as the end of a reason.
std::string driven_rotors(const StudySystem& system) {
  std::string text;
  for (const auto& rotor : system.tree().rotors()) {
    if (rotor.mode != RotorMode::torque) continue;
    const auto& force = system.tree().forces()[static_cast<std::size_t>(rotor.link.v)];
    if (force.constant == 0 || force.damping != 0) continue;
    text += "; the torque on rotor '" + system.tree().body(rotor.link.body).name +
            "' goes on acting, and no friction balances it";
  }
  return text;
}

double growth(const StudySystem& system, const VectorXd& state) {
  return eigenvalues(linearized(system, system.begin(), state).A).real().maxCoeff();
}

/// The equilibrium nearest to a state; null if there is none.
const Equilibrium* nearest(const StudySystem& system, const Equilibria& equilibria,
                           const VectorXd& state) {
  const Equilibrium* best = nullptr;
  double least = 0;
  for (const Equilibrium& candidate : equilibria.list) {
    const double d = distance(system, state, candidate.state);
    const bool ties = best != nullptr && std::abs(d - least) <= 1e-6 * (1 + least);
    const bool wins =
        best == nullptr ||
        (ties ? growth(system, candidate.state) < growth(system, best->state) : d < least);
    if (!wins) continue;
    best = &candidate;
    least = d;
  }
  return best;
}

}  // namespace

Equilibria find_equilibria(const StudySystem& system, const SceneFile& scene,
                           const VectorXd& start) {
  return changes(scene).empty() ? find_equilibria(system, start, scene.duration()) : Equilibria{};
}

Steady find_steady(const StudySystem& system, const SceneFile& scene, const VectorXd& start,
                   const Equilibria& equilibria) {
  Steady steady;
  steady.reason = changes(scene);
  if (!steady.reason.empty()) return steady;
  steady = find_steady(system, start, scene.duration());
  if (steady.kind == Steady::Kind::start || (steady.exists() && steady.turns)) return steady;
  const Equilibrium* const near = nearest(system, equilibria, start);
  if (near == nullptr) {
    if (!steady.exists()) steady.reason += driven_rotors(system);
    return steady;
  }
  // A family is listed once, and another member may be nearer.
  if (steady.exists() &&
      distance(system, start, steady.state) < distance(system, start, near->state) - 1e-6) {
    return steady;
  }
  const VectorXd state = in_turns_of(system, near->state, start);
  Steady rest = steady_at(system, linearized(system, system.begin(), state));
  rest.kind = Steady::Kind::found;
  rest.residual = near->residual;
  rest.distance = (state - start).cwiseAbs().maxCoeff();
  return rest;
}

Steady find_steady(const StudySystem& system, const SceneFile& scene, const VectorXd& start) {
  return find_steady(system, scene, start, find_equilibria(system, scene, start));
}

}  // namespace steady_motion

}  // namespace kreisel
