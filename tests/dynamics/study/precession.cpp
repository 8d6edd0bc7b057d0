// Precession equations against exact ones: the reference's motion and orders, and the reliability
// of the bound.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <dynamics/step/explicit.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/study/precession_gimbals.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;

namespace {

using Regulated = CardanGyro<RestingFrame<>, RegulatedRotor>;

/// The two-gimbal gyro of T13: its springs are slack at zero force.
constexpr double slack_a = 0.02 / 0.4, slack_b = -0.01 / 0.3;

Regulated gyro_of_the_reference() {
  const CardanMoments moments{
      {1e-4, 1e-4, 1.6e-4}, {2.1e-4, 2.3e-4, 2.4e-4}, {1.5e-3, 1e-3, 1.2e-3}};
  return {moments, {{.4, 0, slack_a}, {.3, 0, slack_b}}, RestingFrame<>{}, RegulatedRotor{}};
}

const Regulated::State start{.2 - slack_a, -.1 - slack_b, 0, 0, 0, 1000};

/// The greatest distance in position from the exact motion, at the samples of the precession
/// equations.
template <class Exact, class Places>
double true_error(Exact& exact, const Places& places, const PrecessionMotion& motion) {
  double worst = 0;
  for (const PrecessionSample& s : motion.samples) {
    exact.advance_to(s.t);
    worst = test::worst_of(worst, (places(exact.y()) - places(s.position)).norm());
  }
  return worst;
}

template <class Gyro>
double true_error(const Gyro& gyro, const typename Gyro::State& from, double relative,
                  const PrecessionMotion& motion) {
  const auto field = [&gyro](double t, const typename Gyro::Vector& y) { return gyro.rates(t, y); };
  ExplicitRungeKutta exact(field, 0.0, gyro.to_vector(from), {.relative = relative}, gyro.blocks);
  return true_error(
      exact, [](const auto& y) { return Eigen::Vector2d(y[0], y[1]); }, motion);
}

struct Comparison {
  PrecessionMotion motion;
  double error;
};

/// From a start with the precession velocity or with none.
Comparison compare(double spin, double end, bool with_velocity) {
  const Regulated gyro = gyro_of_the_reference();
  Regulated::State s = start;
  s.phi_rate = spin;
  const PrecessionGimbals model(gyro, 0, s);
  const Eigen::Vector2d place(s.alpha, s.beta);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(2);
  if (with_velocity) {
    const GyroForces f = model.forces(0, place);
    u = f.G.lu().solve(f.Q);
    s.alpha_rate = u[0];
    s.beta_rate = u[1];
  }
  PrecessionMotion motion = precession_motion(model, 0, place, u, end);
  const double error = true_error(gyro, s, 1e-13, motion);
  return {std::move(motion), error};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(precession_equations)

BOOST_AUTO_TEST_CASE(agree_with_the_reference) {
  const Json& truth =
      test::rotors_reference()["trajectories"]["T13_cardan_springs_exact_and_precession"];
  const PrecessionGimbals model(gyro_of_the_reference(), 0, start);
  const Eigen::Vector2d place(start.alpha, start.beta);
  for (const Json& row : truth["precession"]) {
    const auto motion =
        precession_motion(model, 0, place, Eigen::VectorXd::Zero(2), number(row["t"]));
    const Eigen::Vector2d found =
        motion.samples.back().position + Eigen::Vector2d(slack_a, slack_b);
    const double off = (found - numbers(row["q"])).norm();
    BOOST_TEST_MESSAGE("t = " << number(row["t"]) << " s: off by " << off << " rad, "
                              << motion.effort.steps << " steps, bound "
                              << motion.samples.back().bound);
    BOOST_TEST(off < 1e-11);
    BOOST_TEST(motion.kept == 0);
    BOOST_TEST(motion.slow);
  }
}

// The same as bodies, within one step's accuracy.
BOOST_AUTO_TEST_CASE(agree_for_the_gyro_as_bodies) {
  const Json springs = {{"outer", {{"k", 0.4}, {"d", 0.002}, {"Q0", 0.02}}},
                        {"inner", {{"k", 0.3}, {"d", 0.001}, {"Q0", -0.01}}}};
  for (const RotorMode mode : {RotorMode::regulated, RotorMode::free}) {
    const BodySystem<RestingFrame<>> system(
        {}, test::model_bodies("cardan", test::Root::none, springs, mode));
    const PrecessionBodies model(system);
    auto s = system.rest();
    s.coordinates[0] = .2;
    s.coordinates[1] = -.1;
    s.rates << 0.1, 0.3, 1000;
    const auto [place, u] = model.start(0, system.to_vector(s));
    const auto motion = precession_motion(model, 0, place, u, 1);

    const auto same = [&](auto rotor) {
      const CardanGyro gyro(gyro_of_the_reference().moments(),
                            {{.4, .002, slack_a}, {.3, .001, slack_b}}, RestingFrame<>{}, rotor);
      const typename decltype(gyro)::State from{.2 - slack_a, -.1 - slack_b, 0, 0.1, 0.3, 1000};
      const PrecessionGimbals gimbals(gyro, 0, from);
      return precession_motion(gimbals, 0, Eigen::Vector2d(from.alpha, from.beta),
                               Eigen::Vector2d(0.1, 0.3), 1);
    };
    const auto other = mode == RotorMode::free ? same(FreeRotor{}) : same(RegulatedRotor{});
    const PrecessionSample &a = motion.samples.back(), &b = other.samples.back();
    const Eigen::Vector2d slack(slack_a, slack_b);
    BOOST_TEST((a.position.head<2>() - slack - b.position).norm() < 1e-11);
    BOOST_TEST((a.velocity - b.velocity).norm() < 1e-10);
    BOOST_TEST(std::abs(a.bound - b.bound) < 1e-3 * b.bound);
  }
}

// L^-2 with the nutation of a start at rest, L^-3 without; over times in proportion to L both L^-2.
BOOST_AUTO_TEST_CASE(err_in_the_orders_of_the_reference) {
  const Json& orders = test::rotors_reference()["precession_order"]["orders"];
  for (const auto& [name, stretched, with_velocity] :
       {std::tuple{"fixed_t_1s_start_at_rest", false, false},
        {"fixed_t_1s_start_on_precession_velocity", false, true},
        {"t_1s_times_L_over_L0_start_at_rest", true, false},
        {"t_1s_times_L_over_L0_start_on_precession_velocity", true, true}}) {
    double last = 0;
    for (const Json& row : orders[name]) {
      const double spin = number(row["phidot"]);
      const auto [motion, error] = compare(spin, stretched ? spin / 500 : 1, with_velocity);
      const double ratio = error / motion.samples.back().bound;
      BOOST_TEST_MESSAGE(name << ", " << spin << " rad/s: " << error << ", order "
                              << std::log2(last / error) << ", of the bound " << ratio);
      // Both take the maximum over some hundred times of their own.
      BOOST_TEST(std::abs(error - number(row["max_err"])) < 0.2 * error);
      BOOST_TEST(ratio > 0.4);
      BOOST_TEST(ratio < 1);
      last = error;
    }
  }
}

// 1000 gyros and platforms, of any size, spring and damper, regulated and free. They start at rest,
// with the precession velocity or with any.
BOOST_AUTO_TEST_CASE(have_a_reliable_bound) {
  constexpr double relative = 1e-10;
  std::vector<double> ratios;
  int broken_off = 0;
  const auto gimbals = [&](test::Sample& r, auto rotor) {
    const auto decades = [&r](double low, double high) { return r.magnitude(low, high); };
    const double A = r.uniform(.55, 1.5), a = decades(-1, 0), b = decades(-1, 0);
    const double c = r.uniform(std::abs(a - b), a + b), out = decades(-1, .3);
    const double spin = decades(1.3, 2.3);
    const auto bearing = [&]() -> CardanBearing {
      const double damping = r.once_in(2) ? 0 : spin * decades(-3, -1);
      return {decades(0, 2), damping, r.uniform(-.3, .3)};
    };
    const CardanGyro gyro({{A, A, 1}, {a, b, c}, {out, out, out}}, {bearing(), bearing()},
                          RestingFrame<>{}, rotor);
    typename decltype(gyro)::State s{r.uniform(-.4, .4), r.uniform(-.4, .4), 0, 0, 0, spin};
    const Eigen::Vector2d place(s.alpha, s.beta);
    const GyroForces f = PrecessionGimbals(gyro, 0, s).forces(0, place);
    Eigen::Vector2d u = (f.G + f.D).lu().solve(f.Q);
    if (r.once_in(2))
      u = r.once_in(2) ? u : Eigen::Vector2d(u.norm() * r.uniform(-2, 2), 0);
    else
      u.setZero();
    s.alpha_rate = u[0];
    s.beta_rate = u[1];
    const auto& [outer, inner] = gyro.bearings();
    const double slow = std::sqrt(outer.stiffness * inner.stiffness) / spin;
    const double nutation = spin / std::sqrt(f.A(0, 0) * f.A(1, 1));
    const double end = std::min(r.uniform(.3, 1.5) / slow, 60 / nutation);
    const auto motion = precession_motion(PrecessionGimbals(gyro, 0, s), 0, place, u, end,
                                          {.accuracy = {.relative = relative}});
    broken_off += motion.slow ? 0 : 1;
    ratios.push_back(true_error(gyro, s, relative, motion) / motion.samples.back().bound);
  };
  const auto platform = [&](test::Sample& r, RotorMode mode) {
    auto bodies = test::model_bodies("platform", test::Root::none, Json::object(), mode);
    for (BodyDescription& b : bodies) {
      if (b.rotor) continue;
      b.forces = {{.stiffness = r.magnitude(-1, .3),
                   .rest = r.uniform(-.1, .1),
                   .damping = r.once_in(2) ? 0 : r.magnitude(-4, -2)}};
    }
    const BodySystem<RestingFrame<>> system({}, bodies);
    auto s = system.rest();
    for (int i = 0; i < system.body_count(); ++i) {
      const JointPlace p = system.tree().place(i);
      if (system.tree().body(i).rotor) {
        s.rates[p.v] = r.uniform(600, 2000);
        continue;
      }
      s.coordinates[p.q] = r.uniform(-.3, .3);
      if (r.once_in(2)) s.rates[p.v] = r.uniform(-1, 1);
    }
    const PrecessionBodies model(system);
    const auto [place, u] = model.start(0, system.to_vector(s));
    const auto motion =
        precession_motion(model, 0, place, u, 0.05, {.accuracy = {.relative = relative}});
    broken_off += motion.slow ? 0 : 1;
    BodyWorkspace w = system.workspace();
    const auto field = [&](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
      system.rates(t, y, rate, w);
    };
    ExplicitRungeKutta exact(field, 0.0, system.to_vector(s), {.relative = relative},
                             system.blocks());
    const std::vector<int> angles = {0, 1, 3, 5, 6};
    const double error = true_error(
        exact, [&](const Eigen::VectorXd& y) { return Eigen::VectorXd(y(angles)); }, motion);
    ratios.push_back(error / motion.samples.back().bound);
  };
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    test::Sample r(seed);
    if (seed % 10 == 0) {
      platform(r, seed % 20 == 0 ? RotorMode::regulated : RotorMode::free);
    } else if (seed % 2 == 0) {
      gimbals(r, RegulatedRotor{});
    } else {
      gimbals(r, FreeRotor{});
    }
  }
  const auto honest =
      std::count_if(ratios.begin(), ratios.end(), [](double x) { return x >= 0.1 && x <= 1; });
  std::sort(ratios.begin(), ratios.end());
  BOOST_TEST_MESSAGE("true error / bound in [0.1, 1]: "
                     << honest << " of 1000; least " << ratios.front() << ", median " << ratios[500]
                     << ", greatest " << ratios.back() << "; broken off " << broken_off);
  BOOST_TEST(honest >= 950);
  BOOST_TEST(ratios.back() <= 1);
}

// Near gimbal lock the nutations become slow: the motion stops with a report.
BOOST_AUTO_TEST_CASE(stop_near_gimbal_lock) {
  const CardanGyro pushed(gyro_of_the_reference().moments(), {{0.05, 0, 1.5}, {0, 0, 0}},
                          RestingFrame<>{}, RegulatedRotor{});
  const Regulated::State s{-1.5, 0, 0, 0, 0, 200};
  const auto motion =
      precession_motion(PrecessionGimbals(pushed, 0, s), 0, Eigen::Vector2d(s.alpha, s.beta),
                        Eigen::Vector2d(0, 0), 10);
  const PrecessionSample& last = motion.samples.back();
  BOOST_TEST(!motion.slow);
  BOOST_TEST(last.t < 10);
  BOOST_TEST(std::abs(last.position[1]) > 0.5);
  BOOST_TEST(motion.valid_until < last.t);
}

BOOST_AUTO_TEST_CASE(are_refused_if_not_applicable) {
  auto bodies = test::model_bodies("platform", test::Root::none, Json::object(), RotorMode::free);
  bodies[0].rule = JointRule::held;
  using Bodies = BodySystem<RestingFrame<>>;
  BOOST_CHECK_THROW((PrecessionBodies(Bodies({}, bodies))), InvalidInput);
  BOOST_CHECK_THROW(
      (PrecessionBodies(Bodies(
          {}, test::model_bodies("platform", test::Root::none, Json::object(), std::nullopt)))),
      InvalidInput);
  // Five frames, three rotors: without accelerations on the kernel the motion there is
  // undetermined.
  const Bodies system(
      {}, test::model_bodies("platform", test::Root::none, Json::object(), RotorMode::regulated));
  auto s = system.rest();
  for (const int rotor : {2, 4, 7}) s.rates[rotor] = 1000;
  const PrecessionBodies model(system);
  const auto [place, u] = model.start(0, system.to_vector(s));
  BOOST_CHECK_THROW(
      (void)precession_motion(model, 0, place, u, 0.1, {.kept = KeptAccelerations::none}),
      ComputationFailed);
  BOOST_TEST(precession_motion(model, 0, place, u, 0.1).kept == 1);
  // A decelerating rotor and an unsymmetric one have no constant momentum.
  const CardanMoments round{{1, 1, 1.5}}, flat{{1, 1.2, 1.5}};
  const CardanState turns{.phi_rate = 100};
  BOOST_CHECK_THROW(
      PrecessionGimbals(CardanGyro(round, {}, RestingFrame<>{}, FreeRotor{0.1}), 0, turns),
      InvalidInput);
  BOOST_CHECK_THROW(
      PrecessionGimbals(CardanGyro(flat, {}, RestingFrame<>{}, FreeRotor{}), 0, turns),
      InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
