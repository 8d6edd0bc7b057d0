// Precession equations of bodies with a singular gyroscopic matrix, so that part of the
// accelerations is kept. They are compared with the exact motion, its bound and the order of the
// error.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/load/load.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/study/precession_bodies.hpp>

#include <support/worst.hpp>

using namespace kreisel;

namespace {

using Bodies = BodySystem<RestingFrame<>>;
using Eigen::VectorXd;
using V = Vector3<double>;

BodyDescription body(const char* name, const char* parent, JointKind kind, const V& axis,
                     double mass, const V& centre, const V& moments) {
  BodyDescription b;
  b.name = name;
  b.parent = parent;
  b.joint.kind = kind;
  b.joint.axis = axis;
  b.inertia = InertiaTensor<Body>::about_centre(mass, centre, moments.asDiagonal());
  return b;
}

/// The first body carries a gyro in two gimbals on springs; the outer one is unbalanced.
Bodies with_gyro(BodyDescription base, const V& off_balance, RotorMode mode) {
  const std::string name = base.name;
  std::vector<BodyDescription> bodies{std::move(base)};
  bodies.push_back(body("outer", name.c_str(), JointKind::revolute, {0, 1, 0}, .5, off_balance,
                        {1.2e-3, 1.5e-3, 1e-3}));
  bodies.back().forces = {{.stiffness = .4, .constant = .02}};
  bodies.push_back(body("inner", "outer", JointKind::revolute, {0, 0, 1}, .3, {0, 0, 0},
                        {2.4e-4, 2.1e-4, 2.3e-4}));
  bodies.back().forces = {{.stiffness = .3, .constant = -.01}};
  bodies.push_back(
      body("rotor", "inner", JointKind::revolute, {1, 0, 0}, .2, {0, 0, 0}, {1.6e-4, 1e-4, 1e-4}));
  bodies.back().rotor = Rotor{.mode = mode};
  return {{}, std::move(bodies)};
}

Bodies on_sled(RotorMode mode) {
  auto sled = body("sled", "guide", JointKind::prismatic, {1, 0, 0}, 1, {0, 0, 0}, {1, 1, 1});
  sled.forces = {{.stiffness = 5, .constant = 1}};
  return with_gyro(std::move(sled), {0, 0, .02}, mode);
}

/// The same on a table that turns about the axis of the outer gimbal.
Bodies on_table(RotorMode mode) {
  auto table =
      body("table", "guide", JointKind::revolute, {0, 1, 0}, 1, {0, 0, 0}, {2e-3, 2e-3, 2e-3});
  table.forces = {{.stiffness = .2, .constant = .05}};
  return with_gyro(std::move(table), {0, 0, 0}, mode);
}

Bodies on_free_craft(RotorMode mode, std::vector<BodyLoad> loads) {
  auto craft =
      body("craft", "guide", JointKind::free, {1, 0, 0}, 10, {.01, -.02, .03}, {.3, .25, .35});
  craft.loads = std::move(loads);
  return with_gyro(std::move(craft), {0, 0, .02}, mode);
}

const ViscousDrag<> drag{.02, .5};
const ConstantLoad<Guide> thrust{{.1, .05, .02}, {.02, .03, -.01}, {.1, 0, 0}};

struct Comparison {
  PrecessionMotion motion;
  double error;

  [[nodiscard]] double of_the_bound() const { return error / motion.samples.back().bound; }
};

/// Over 0.5 s from an eccentric position, at rest or with the precession velocity. The distance is
/// one of angles and lengths, like the drift.
Comparison compare(const Bodies& system, double spin, bool with_velocity) {
  const BodyTree& tree = system.tree();
  const int gimbals = tree.place(1).q;
  auto s = system.rest();
  s.coordinates[gimbals] = .2;
  s.coordinates[gimbals + 1] = .3;
  s.rates[tree.place(3).v] = spin;
  const PrecessionBodies model(system);
  auto [place, u] = model.start(0, system.to_vector(s));
  if (with_velocity) {
    u = precession_motion(model, 0, place, u, 1e-6).samples.front().velocity;
    s.rates.head(u.size()) = u;
    place = model.start(0, system.to_vector(s)).first;  // a free rotor's momentum changes too
  }
  PrecessionMotion motion = precession_motion(model, 0, place, u, .5);

  BodyWorkspace w = system.workspace();
  const auto field = [&](double t, const VectorXd& y, VectorXd& rate) {
    system.rates(t, y, rate, w);
  };
  ExplicitRungeKutta exact(field, 0.0, system.to_vector(s), {.relative = 1e-12}, system.blocks());
  double error = 0;
  for (const PrecessionSample& sample : motion.samples) {
    exact.advance_to(sample.t);
    VectorXd off = exact.y().head(gimbals + 2) - sample.position.head(gimbals + 2);
    if (tree.body(0).joint.kind == JointKind::free) {
      const Eigen::Quaterniond a(Eigen::Vector4d(exact.y().head<4>()));
      const Eigen::Quaterniond b(Eigen::Vector4d(sample.position.head<4>()));
      off.head<4>() << 2 * (b.conjugate() * a).vec(), 0;
    }
    error = test::worst_of(error, off.norm());
  }
  return {std::move(motion), error};
}

/// The bound holds and is at most ten times the error. At twice the spin the error has fallen by
/// this order at least.
template <class System>
void check(const char* name, const System& system, bool with_velocity, int kept, double order) {
  for (const RotorMode mode : {RotorMode::regulated, RotorMode::free}) {
    const Bodies bodies = system(mode);
    double last = 0;
    for (const double spin : {1000., 2000.}) {
      const Comparison c = compare(bodies, spin, with_velocity);
      BOOST_TEST_MESSAGE(name << (with_velocity ? ", precession velocity, " : ", at rest, ") << spin
                              << " rad/s: " << c.error << ", order " << std::log2(last / c.error)
                              << ", of the bound " << c.of_the_bound());
      BOOST_TEST(c.motion.kept == kept);
      BOOST_TEST(c.motion.slow);
      BOOST_TEST(c.of_the_bound() >= 0.1);
      BOOST_TEST(c.of_the_bound() <= 1);
      if (last > 0) BOOST_TEST(std::log2(last / c.error) > order);
      last = c.error;
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(precession_equations_with_kept_accelerations)

// No gyroscopic moment acts on the sled, but its acceleration acts on the unbalanced gimbal: the
// orders are those without it, 2 and 3.
BOOST_AUTO_TEST_CASE(describe_a_gyro_on_a_sled) {
  check("sled", on_sled, false, 1, 1.8);
  check("sled", on_sled, true, 1, 2.7);
}

// The table turns against the gimbal on it without a gyroscopic moment. A nutation from rest also
// leaves a velocity of that motion, of order 1.
BOOST_AUTO_TEST_CASE(describe_a_gyro_on_a_table) {
  check("table", on_table, false, 1, 1.0);
  check("table", on_table, true, 1, 1.8);
}

// Six of eight accelerations are kept; as the gimbals turn, the kernel leaves them: order 1.
BOOST_AUTO_TEST_CASE(describe_a_free_craft_under_loads) {
  check(
      "craft", [](RotorMode mode) { return on_free_craft(mode, {}); }, false, 6, 0.7);
  const auto loaded = [](RotorMode mode) { return on_free_craft(mode, {drag, thrust}); };
  check("craft under loads", loaded, false, 6, 0.7);
  // Far too fast for a good approximation; the bound shows that and holds.
  const Comparison c = compare(loaded(RotorMode::free), 500, false);
  BOOST_TEST_MESSAGE("craft under loads, 500 rad/s: of the bound " << c.of_the_bound());
  BOOST_TEST(c.of_the_bound() >= 0.1);
  BOOST_TEST(c.of_the_bound() <= 1);
  BOOST_TEST(c.motion.valid_until < 0.5);
}

// A force that grows with the square of the velocity is no damping: D is -dQ/du at rest.
BOOST_AUTO_TEST_CASE(use_the_damping_of_loads_at_rest) {
  const double k = 2;
  const auto quadratic = [k](const LoadContext<>& s) -> Force<Body> {
    const V& v = s.V_rel.value.moment;
    return {{-k * v.norm() * v, V::Zero()}};
  };
  const auto damping = [](const Bodies& system) {
    const PrecessionBodies model(system);
    const auto place = model.start(0, system.to_vector(system.rest())).first;
    return model.forces(0, place).D;
  };
  const Eigen::MatrixXd D = damping(on_free_craft(RotorMode::free, {drag}));
  VectorXd expected = VectorXd::Zero(8);
  expected.head<6>() << .02, .02, .02, .5, .5, .5;
  BOOST_TEST((D - Eigen::MatrixXd(expected.asDiagonal())).norm() < 1e-11);
  const Eigen::MatrixXd both = damping(on_free_craft(RotorMode::free, {drag, quadratic}));
  // Differences over 1e-3 m/s add 1e-3 k to each of three directions.
  BOOST_TEST((both - D).norm() < 1.8e-3 * k);
}

BOOST_AUTO_TEST_SUITE_END()
