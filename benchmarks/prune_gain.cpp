// The time that prune() saves in a run of solve(), and the number of runs after which its bounds
// have paid. Writes a Markdown table; times are CPU times, the least of nine.
//
// Usage: prune_gain

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <variant>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/study/prune.hpp>

using namespace kreisel;

namespace {

template <class Work>
double least_seconds(const Work& work) {
  double least = INFINITY;
  for (int i = 0; i < 9; ++i) {
    const std::clock_t begin = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  return least;
}

/// ns for a call of the field.
template <class Scene>
double field(const Scene& scene, const typename Scene::State& start) {
  constexpr int calls = 100000;
  const typename Scene::Vector y = scene.to_vector(start);
  return 1e9 / calls * least_seconds([&] {
           for (int i = 0; i < calls; ++i) {
             const typename Scene::Vector dy = scene.rates(1e-6 * i, y);
             asm volatile("" : : "r"(&dy) : "memory");
           }
         });
}

struct Cost {
  double field, evaluations, seconds;
};

template <class Scene>
Cost cost(const Scene& scene, const typename Scene::State& start, const Pruning& options) {
  double evaluations = 0;
  const double seconds = least_seconds([&] {
    const auto run = solve(
        scene, start, {.output_times = {options.horizon}, .tolerance = options.tolerance / 10});
    evaluations = run.report.all_evaluations;
  });
  return {field(scene, start), evaluations, seconds};
}

template <class... Quantities, class Scene>
void row(const char* name, const Scene& scene, const typename Scene::State& start,
         const Pruning& options) {
  const auto pruned = prune<Quantities...>(scene, start, options);
  const double spent =
      least_seconds([&] { static_cast<void>(prune<Quantities...>(scene, start, options)); });
  std::string left_out;
  for (const PrunedTerm& term : pruned.terms) {
    if (term.kept) continue;
    if (!left_out.empty()) left_out += ", ";
    left_out += term.name;
  }
  const Cost whole = cost(scene, start, options);
  const Cost less =
      std::visit([&](const auto& kind) { return cost(kind, start, options); }, pruned.scene);
  fmt::print(
      "| {} | {} | {:.1e} of {:.0e} | {:.0f} / {:.0f} | {:.0f} / {:.0f} | {:.3g} / {:.3g} | "
      "{:.2f} | {:.3g} | {:.0f} |\n",
      name, left_out, pruned.bound, options.tolerance, whole.field, less.field, whole.evaluations,
      less.evaluations, 1e3 * whole.seconds, 1e3 * less.seconds, whole.seconds / less.seconds,
      1e3 * spent, std::ceil(spent / (whole.seconds - less.seconds)));
}

InertiaTensor<Body> body(const Vector3<double>& centre, double product) {
  Matrix3<double> T = Vector3<double>(0.05, 0.052, 0.06).asDiagonal();
  T(0, 1) = T(1, 0) = product;
  return InertiaTensor<Body>::about_centre(2, centre, T);
}

}  // namespace

int main() {
  fmt::print(
      "| scene | left out | bound | field, ns: whole / pruned | evaluations | ms | ratio | "
      "prune(), ms | pays after runs |\n|---|---|---|---|---|---|---|---|---|\n");
  const RotatingFrame<> earth{{-5e-5, 0, 5e-5}};
  const UniformGravity<Guide> plumb{{0, 0, -9.81}};
  const Eigen::Quaterniond tilted(1, 0.1, 0, 0);

  row("top of 100 rad/s on the earth, 5 s",
      FixedPointBody(body({0, 0, 0.1}, 1e-8), {0, 0, 0}, earth, plumb), {tilted, {0, 0, 100}},
      {.tolerance = 1e-2, .horizon = 5});

  const double swing = 1e-7;
  const HarmonicFrame<> ship(
      {{-5e-5, 0, 5e-5}, {{{swing, 0, 0}, 0.7, 0.0}, {{0, swing, 0}, 0.9, 1.0}}},
      {{0, 0, 9.81}, {{{swing, 0, 0}, 0.7, 0.0}, {{0, 0, swing}, 1.1, 1.0}}}, 0, 100);
  row<GuideUnsteadiness>("free body in a shaken frame, 2 s", FreeBody(body({0, 0, 0}, 0), ship),
                         {tilted, {1, 0, 0}, {{{0, 1, 20}, {10, 0, 10}}}},
                         {.tolerance = 1e-3, .horizon = 2});

  const CardanMoments round{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4.5e-4}};
  row("Cardan gyro on the shaken frame, 2 s",
      CardanGyro(round, {{0.5, 1e-3}, {0.3, 1e-3}}, ship, FrictionlessRotor{}),
      {0.1, 0.2, 0, 0, 0, 500}, {.tolerance = 1e-3, .horizon = 2});

  const CardanMoments oval{{5e-4, 5.00001e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4.5e-4}};
  row("unsymmetric rotor of 500 rad/s, slow rings, 2 s",
      CardanGyro(oval, {{50, 1e-3}, {30, 1e-3}}, earth, RegulatedRotor{}), {0.1, 0.2, 0, 0, 0, 500},
      {.tolerance = 1e-3, .horizon = 2});
}
