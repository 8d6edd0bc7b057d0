#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/solve/error_measure.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/study/prune.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

// The bound of prune() against the true effect of dropped terms, by steps of 1e-15 of the whole
// scene and of the pruned one.

using namespace kreisel;

namespace {

template <class Vector>
using Rates = std::function<Vector(double, const Vector&)>;

template <class Scene>
auto rates_of(const Scene& scene) {
  return [&scene](double t, const typename Scene::Vector& y) ->
         typename Scene::Vector { return scene.rates(t, y); };
}

/// Much more accurate than the tolerances of pruning.
template <class Scene>
class Motion {
  using Vector = typename Scene::Vector;

 public:
  Motion(const Scene& scene, const Rates<Vector>& rates, const typename Scene::State& start)
      : steps_(rates, 0, scene.to_vector(start), {.relative = 1e-15}, Scene::blocks) {}

  [[nodiscard]] Vector at(double time) { return steps_.advance_to(time); }

 private:
  ExplicitRungeKutta<Vector, Rates<Vector>> steps_;
};

/// The greatest distance of a motion from one without some terms.
template <class Scene>
double distance(const Scene& scene, const Rates<typename Scene::Vector>& reduced,
                const typename Scene::State& start, double horizon) {
  Motion whole(scene, rates_of(scene), start);
  Motion less(scene, reduced, start);
  ErrorMeasure<Scene> measure(scene, 1e-3);
  constexpr int times = 50;
  double worst = measure(less.at(0), whole.at(0));
  for (int i = 1; i <= times; ++i) {
    const double t = horizon * std::pow(static_cast<double>(i) / times, 1.5);
    worst = test::worst_of(worst, measure(less.at(t), whole.at(t)));
  }
  return worst;
}

struct Tally {
  int scenes = 0;
  int terms = 0;
  int dropped = 0;
  int pruned = 0;
  int close = 0;  ///< of all dropped terms together: within a tenth of the bound
  double worst = 0;
  double worst_alone = 0;

  void print(const char* what) const {
    BOOST_TEST_MESSAGE(what << ": " << scenes << " scenes, " << dropped << " of " << terms
                            << " terms dropped, true/bound <= " << worst << " of all together, "
                            << worst_alone << " of each alone; above 0.1 in " << close << " of "
                            << pruned);
  }
};

/// Prunes and compares: all dropped terms together, and one quantity alone, dropped or not, if its
/// effect is small enough.
template <class Quantity, class Scene>
void compare(const Scene& scene, const typename Scene::State& start, const Pruning& options,
             Tally& tally) {
  const auto pruned = prune(scene, start, options);
  double sum = 0;
  ++tally.scenes;
  for (const PrunedTerm& term : pruned.terms) {
    ++tally.terms;
    tally.dropped += term.kept ? 0 : 1;
    sum += term.kept ? 0 : term.bound;
    if (term.name != Quantity::name || !(term.bound > 0 && term.bound < 0.1)) continue;
    const auto less = scene.without(Quantity{}, 0, options.horizon);
    const double off = distance(scene, rates_of(less), start, options.horizon);
    tally.worst_alone = test::worst_of(tally.worst_alone, off / term.bound);
    BOOST_TEST(off <= term.bound);
  }
  BOOST_TEST(sum <= options.tolerance);
  BOOST_TEST(pruned.bound <= options.tolerance);
  if (pruned.bound == 0) return;
  const double off = std::visit(
      [&](const auto& kind) { return distance(scene, rates_of(kind), start, options.horizon); },
      pruned.scene);
  BOOST_TEST(off <= pruned.bound);
  tally.worst = test::worst_of(tally.worst, off / pruned.bound);
  ++tally.pruned;
  tally.close += off > 0.1 * pruned.bound ? 1 : 0;
}

Pruning random_task(test::Sample& sample) {
  return {.tolerance = sample.magnitude(-9, -2), .horizon = sample.magnitude(-0.5, 1)};
}

InertiaTensor<Body> nearly_straight(test::Sample& sample) {
  Matrix3<double> T = Vector3<double>(0.05, 0.055, 0.06).asDiagonal();
  const Vector3<double> off = 0.05 * sample.magnitude(-11, -1) * sample.direction();
  T(0, 1) = T(1, 0) = off.x();
  T(0, 2) = T(2, 0) = off.y();
  T(1, 2) = T(2, 1) = off.z();
  return InertiaTensor<Body>::about_centre(
      2, sample.once_in(3) ? Vector3<double>(0, 0, 0) : 0.1 * sample.direction(), T);
}

RotatingFrame<> slow_table(test::Sample& sample) {
  const Displacement<Inertial, Guide> X{exp(Motor<>{sample.direction(), sample.direction()})};
  return {sample.magnitude(-10, -1) * sample.direction(), sample.direction(), X,
          sample.direction()};
}

/// Nearly at rest, or turning, with a small oscillation.
HarmonicFrame<> swell(test::Sample& sample, double horizon) {
  const double size = sample.magnitude(-10, -1);
  const auto shaking = [&](const Vector3<double>& mean, double amplitude) {
    return HarmonicSeries<>{
        mean, {{amplitude * sample.direction(), sample.uniform(0.5, 5), sample.uniform(0, 6)}}};
  };
  return {shaking(sample.magnitude(-10, -1) * sample.direction(), size),
          shaking(sample.direction(), size), 0, std::max(horizon, 1e-3)};
}

Eigen::Quaterniond attitude(test::Sample& sample) {
  return Eigen::Quaterniond(
      Eigen::Vector4d(sample.uniform(-1, 1), sample.uniform(-1, 1), sample.uniform(-1, 1), 1));
}

constexpr unsigned scenes_of_a_kind = 210;

}  // namespace

BOOST_AUTO_TEST_SUITE(the_bound_of_dropped_terms)

BOOST_AUTO_TEST_CASE(holds_for_fixed_point_bodies_on_a_table) {
  Tally tally;
  for (unsigned seed = 0; seed < scenes_of_a_kind; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      test::Sample sample(seed);
      const auto body = nearly_straight(sample);
      const auto table = slow_table(sample);
      const UniformGravity<Guide> plumb{{0, 0, -9.81}};
      const FixedPointBodyState start{attitude(sample),
                                      sample.magnitude(-1, 1.3) * sample.direction()};
      const Pruning options = random_task(sample);
      compare<GuideRate>(FixedPointBody(body, sample.direction(), table, plumb), start, options,
                         tally);
    }
  }
  tally.print("held on a table");
}

BOOST_AUTO_TEST_CASE(holds_for_fixed_point_bodies_on_a_swell) {
  Tally tally;
  for (unsigned seed = 0; seed < scenes_of_a_kind; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      test::Sample sample(1000 + seed);
      const auto body = nearly_straight(sample);
      const Pruning options = random_task(sample);
      const auto ship = swell(sample, options.horizon);
      const UniformGravity<Inertial> weight{{0, 0, -9.81}};
      const FixedPointBodyState start{attitude(sample),
                                      sample.magnitude(-1, 1) * sample.direction()};
      compare<GuideUnsteadiness>(FixedPointBody(body, 0.3 * sample.direction(), ship, weight),
                                 start, options, tally);
    }
  }
  tally.print("held on a swell");
}

BOOST_AUTO_TEST_CASE(holds_for_free_bodies_above_a_table) {
  Tally tally;
  for (unsigned seed = 0; seed < scenes_of_a_kind; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      test::Sample sample(2000 + seed);
      const auto body = nearly_straight(sample);
      const auto table = slow_table(sample);
      const UniformGravity<Guide> plumb{{0, 0, -9.81}};
      const FreeBodyState start{attitude(sample),
                                sample.vector(-1, 1),
                                {{sample.magnitude(-1, 1) * sample.direction(), sample.vector()}}};
      compare<CentrifugalForce>(FreeBody(body, table, plumb), start, random_task(sample), tally);
    }
  }
  tally.print("free above a table");
}

BOOST_AUTO_TEST_CASE(holds_for_bodies_under_weak_loads) {
  Tally tally;
  for (unsigned seed = 0; seed < scenes_of_a_kind; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      test::Sample sample(3000 + seed);
      const ViscousDrag<> drag{sample.magnitude(-12, -2), 0};
      const FixedPointBody body(nearly_straight(sample), {0, 0, 0}, slow_table(sample),
                                UniformGravity<Guide>{{0, 0, -9.81}}, drag);
      const FixedPointBodyState start{attitude(sample),
                                      sample.magnitude(-1, 1) * sample.direction()};
      const Pruning options = random_task(sample);
      const auto pruned = prune<LoadOf<ViscousDrag<>>, ProductsOfInertia>(body, start, options);
      const double off = std::visit(
          [&](const auto& kind) { return distance(body, rates_of(kind), start, options.horizon); },
          pruned.scene);
      ++tally.scenes;
      tally.terms += 2;
      for (const PrunedTerm& term : pruned.terms) tally.dropped += term.kept ? 0 : 1;
      if (pruned.bound == 0) continue;
      BOOST_TEST(off <= pruned.bound);
      tally.worst = test::worst_of(tally.worst, off / pruned.bound);
      ++tally.pruned;
      tally.close += off > 0.1 * pruned.bound ? 1 : 0;
    }
  }
  tally.print("under weak loads");
}

BOOST_AUTO_TEST_CASE(holds_for_cardan_gyros) {
  Tally tally;
  for (unsigned seed = 0; seed < scenes_of_a_kind; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      test::Sample sample(4000 + seed);
      const double oval = sample.magnitude(-11, -1);
      const double rings = sample.magnitude(-11, -1);
      const CardanMoments moments{{5, 5 * (1 + oval), 8},
                                  {2 * rings, 3 * rings, 2.5 * rings},
                                  {4 * rings, 4 * rings, 4.5 * rings}};
      const CardanState start{sample.uniform(-1, 1),       sample.uniform(-0.8, 0.8),
                              sample.uniform(-1, 1),       0.1 * sample.uniform(-1, 1),
                              0.1 * sample.uniform(-1, 1), sample.magnitude(0, 1.5)};
      const Pruning options = random_task(sample);
      compare<RingInertia>(CardanGyro(moments, {}, slow_table(sample)), start, options, tally);
    }
  }
  tally.print("Cardan gyros");
}

BOOST_AUTO_TEST_CASE(covers_several_motions) {
  const RotatingFrame<> table{{0, 1e-6, 0}};
  test::Sample sample(7);
  const FixedPointBody body(nearly_straight(sample), {0, 0, 0}, table);
  const std::vector<FixedPointBodyState> starts{{attitude(sample), {1, 0, 0}},
                                                {attitude(sample), {0, 5, 1}}};
  const Pruning options{.tolerance = 1e-3, .horizon = 3};
  const auto both = prune<GuideRate>(body, starts, options);
  double greatest = 0;
  for (const auto& start : starts) {
    greatest = test::worst_of(greatest, prune<GuideRate>(body, start, options).bound);
  }
  BOOST_TEST(both.bound == greatest);
  BOOST_TEST(both.bound > 0);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_pruned_scene)

BOOST_AUTO_TEST_CASE(is_solved_and_lists_dropped_terms) {
  const RotatingFrame<> earth{{-5e-5, 0, 5e-5}};
  const CardanGyro gyro({{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4.5e-4}}, {}, earth,
                        FrictionlessRotor{});
  const CardanState start{0.02, 0.2, 0, 1, 1, 500};
  const auto pruned = prune(gyro, start, {.tolerance = 1e-2, .horizon = 0.1});
  const auto solved = [&](const auto& scene) {
    return solve(scene, start, {.output_times = {0.02, 0.04, 0.06, 0.08, 0.1}, .tolerance = 1e-10});
  };
  const auto run = std::visit(solved, pruned.scene);
  const auto whole = solved(gyro);
  BOOST_TEST(run.report.tolerance_kept);
  ErrorMeasure<decltype(gyro)> measure(gyro, 1e-3);
  double off = measure(gyro.to_vector(start), gyro.to_vector(start));
  for (std::size_t i = 0; i < 5; ++i) {
    off = test::worst_of(off,
                         measure(gyro.to_vector(run.states[i]), gyro.to_vector(whole.states[i])));
  }
  BOOST_TEST(off <= pruned.bound);
  BOOST_TEST(off > 0);
  const std::string left = std::visit(
      [](const auto& scene) {
        std::ostringstream text;
        text << terms(scene);
        return text.str();
      },
      pruned.scene);
  BOOST_TEST(left.find("the guide does not turn") != std::string::npos);
  std::ostringstream table;
  table << pruned.terms;
  BOOST_TEST(table.str().find("GuideRate       dropped") == 0U);
  BOOST_TEST(table.str().find("RingInertia     kept") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(is_the_scene_itself_if_nothing_is_dropped) {
  const RotatingFrame<> table{{1, 2, 3}};
  test::Sample sample(3);
  const FixedPointBody body(nearly_straight(sample), {0, 0, 0}, table);
  const auto pruned =
      prune(body, {attitude(sample), {1, 2, 3}}, {.tolerance = 1e-12, .horizon = 1});
  BOOST_TEST(pruned.scene.index() == 0U);
  BOOST_TEST(pruned.bound == 0);
  for (const PrunedTerm& term : pruned.terms) BOOST_TEST(term.kept);
}

// Massless rings leave nothing that resists alpha about a rotor that is a needle along A.
BOOST_AUTO_TEST_CASE(keeps_indispensable_terms) {
  const CardanGyro needle({{0, 8, 8}, {2, 3, 2.5}, {4, 4, 4.5}}, {}, RestingFrame<>{});
  const auto pruned = prune<RingInertia>(needle, CardanState{0.1, 0.2, 0, 0, 0, 1},
                                         {.tolerance = 1e-2, .horizon = 1});
  BOOST_TEST(pruned.terms[0].kept);
  BOOST_TEST(std::isinf(pruned.terms[0].bound));
  BOOST_TEST(pruned.terms[0].why.find("singular") != std::string::npos);
  std::ostringstream table;
  table << pruned.terms;
  BOOST_TEST(table.str().find(pruned.terms[0].why) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(is_refused_with_invalid_options) {
  test::Sample sample(3);
  const FixedPointBody body(nearly_straight(sample), {0, 0, 0}, RotatingFrame<>{{0, 0, 1e-5}});
  const FixedPointBodyState start;
  const auto refused = [&](const Pruning& options) {
    BOOST_CHECK_THROW(static_cast<void>(prune<GuideRate>(body, start, options)), InvalidInput);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused({.tolerance = 0, .horizon = 1});
  refused({.tolerance = -1e-6, .horizon = 1});
  refused({.tolerance = nan, .horizon = 1});
  refused({.tolerance = 1e-6, .horizon = -1});
  refused({.tolerance = 1e-6, .horizon = nan});
  refused({.tolerance = 1e-6, .horizon = HUGE_VAL});
  refused({.tolerance = 1e-6, .horizon = 1, .begin = nan});
  BOOST_CHECK_THROW(
      static_cast<void>(prune<GuideRate>(body, std::vector<FixedPointBodyState>{}, {})),
      InvalidInput);
  const auto at_once = prune<GuideRate>(body, start, {.tolerance = 1e-6, .horizon = 0});
  BOOST_TEST(!at_once.terms[0].kept);
}

BOOST_AUTO_TEST_SUITE_END()
