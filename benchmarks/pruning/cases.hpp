#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/motion.hpp>
#include <dynamics/load/load.hpp>

/// Right-hand sides in three forms. General: independent of the scene. Pruned: the scene's own
/// type. By hand: the least code for the same numbers.

namespace pruning {

constexpr std::size_t inputs = 64;  // in turn, so that none is a constant

struct Form {
  std::string name;
  std::function<void(long calls)> run;
  std::function<Eigen::VectorXd(std::size_t input)> rates;
};

struct Case {
  std::string name;
  std::vector<Form> forms;  // general, pruned, by hand; and what takes more for granted
};

/// States near `start`, with a time for each.
template <class Vector>
struct Inputs {
  std::array<Vector, inputs> states;
  std::array<double, inputs> times;

  explicit Inputs(const Vector& start) {
    for (std::size_t i = 0; i < inputs; ++i) {
      const double part = static_cast<double>(i) / inputs;
      states[i] = start;
      states[i][start.size() - 2] *= 1 + 0.1 * part;
      states[i][start.size() - 1] *= 1 - 0.1 * part;
      times[i] = 3 * part;
    }
  }
};

/// The field is called out of line and inlined inside, so that every form pays equally for call and
/// result.
template <class Vector, class Field>
[[gnu::noinline, gnu::flatten]] Vector call(const Field& field, double t, const Vector& y) {
  return field(t, y);
}

template <class Vector, class Field>
[[nodiscard]] Form form(const std::string& name, const Vector& start, const Field& field) {
  const Inputs<Vector> all(start);
  return {name,
          [all, field](long calls) {
            for (long n = 0; n < calls; ++n) {
              const std::size_t i = static_cast<std::size_t>(n) % inputs;
              const Vector result = call(field, all.times[i], all.states[i]);
              asm volatile("" : : "r"(&result) : "memory");
            }
          },
          [all, field](std::size_t i) -> Eigen::VectorXd {
            return field(all.times[i], all.states[i]);
          }};
}

/// A guide that moves as M does, with no other declaration.
template <class M>
[[nodiscard]] auto any_guide(const M& guide) {
  return [guide](double t) { return guide(t); };
}

/// A load that acts as L does, with no other declaration.
template <class L>
[[nodiscard]] auto any_load(const L& load) {
  return [load](const kreisel::LoadContext<>& s) { return load(s); };
}

/// The vector field of a scene.
template <class Scene>
[[nodiscard]] auto field(const Scene& scene) {
  return [scene](double t, const auto& y) { return scene.rates(t, y); };
}

[[nodiscard]] std::vector<Case> tops();
[[nodiscard]] std::vector<Case> pendulums();
[[nodiscard]] std::vector<Case> bodies();
[[nodiscard]] std::vector<Case> gyros();

[[nodiscard]] inline std::vector<Case> all_cases() {
  std::vector<Case> all = tops();
  for (auto more : {pendulums(), bodies(), gyros()}) {
    std::move(more.begin(), more.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace pruning
