// Listed invariants of scenes against their values along motions. Loads must not list invariants
// that they do not keep.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include <dynamics/gimbal/cardan_parts.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/load/load.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/random_tree.hpp>

using namespace kreisel;

namespace {

using Names = std::vector<std::string>;

template <class Scene>
Names names(const Scene& scene, const typename Scene::State& state) {
  Names result;
  for (const auto& [name, value] : scene.conserved(0, state)) result.emplace_back(name);
  return result;
}

bool has(const Names& all, const std::string& name) {
  return std::find(all.begin(), all.end(), name) != all.end();
}

/// Steps held to 1e-12 drift by some 1e-10 of the exchanged energy, here of the order of 1 to 100.
template <class Scene>
void check_kept(const Scene& scene, const typename Scene::State& start, const std::string& what) {
  Integrator run(scene, 0, start, {.relative = 1e-12});
  const auto before = scene.conserved(0, start);
  for (const double t : {0.3, 0.7, 1.0}) {
    const auto after = scene.conserved(t, run.to(t));
    BOOST_TEST_REQUIRE(after.size() == before.size(), what);
    for (std::size_t i = 0; i < after.size(); ++i) {
      const double off = std::abs(after[i].second - before[i].second);
      BOOST_TEST(off <= 1e-9 * (1 + std::abs(before[i].second)),
                 what << ": " << before[i].first << " off by " << off << " at " << t);
    }
  }
}

InertiaTensor<Body> body() {
  return InertiaTensor<Body>::about_centre(2, {0.05, -0.02, -0.3},
                                           Vector3<double>(0.2, 0.25, 0.15).asDiagonal());
}

BodyDescription described(const std::string& name, const Joint& joint,
                          std::vector<BodyLoad> loads = {}) {
  BodyDescription b;
  b.name = name;
  b.joint = joint;
  b.inertia = body();
  b.loads = std::move(loads);
  return b;
}

const Joint free_joint{.kind = JointKind::free};

/// True if a tree and a free body with a load list the energy as invariant.
template <class L>
std::pair<bool, bool> list_energy(const L& load) {
  const BodySystem tree(RestingFrame<>{}, {described("m", free_joint, {load})});
  const FreeBody single(body(), RestingFrame<>{}, load);
  return {has(names(tree, tree.rest()), "energy"), has(names(single, {}), "energy")};
}

/// A user's load with a time-dependent potential.
struct Tide {
  static constexpr bool ignores_guide = true;

  [[nodiscard]] Force<Body> operator()(const LoadContext<>& s) const {
    return {{s.on_body_axes<Guide>({0, 0, std::sin(s.t)}), {0, 0, 0}}};
  }
  [[nodiscard]] double potential(const LoadContext<>& s) const {
    return -std::sin(s.t) * s.position<Guide>({0, 0, 0}).z();
  }
};

template <class T>
void check_same_in_used_memory(const char* what) {
  alignas(T) unsigned char memory[2][sizeof(T)];
  std::memset(memory[0], 0x41, sizeof(T));
  std::memset(memory[1], 0x3e, sizeof(T));
  new (memory[0]) T{};
  new (memory[1]) T{};
  BOOST_TEST(std::memcmp(memory[0], memory[1], sizeof(T)) == 0, what);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(invariants_of_loads)

BOOST_AUTO_TEST_CASE(energy_is_listed_if_loads_conserve_it) {
  const auto check = [](const char* what, bool keeps, const auto& load) {
    const auto [tree, single] = list_energy(load);
    BOOST_TEST(tree == keeps, what << ", tree");
    BOOST_TEST(single == keeps, what << ", free body");
  };
  ElasticMount<> mount;
  mount.stiffness = Vector3<double>(2000, 1500, 3000).asDiagonal();
  check("mount", true, mount);
  // A matrix on turned axes is symmetric up to rounding.
  const Matrix3<double> R = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().matrix();
  ElasticMount<> turned = mount;
  turned.stiffness = R * mount.stiffness * R.transpose();
  check("turned mount", true, turned);
  ElasticMount<> damped = mount;
  damped.damping(2, 1) = 1e-3;
  check("damped mount", false, damped);
  ElasticMount<> crossed = mount;
  crossed.stiffness(0, 1) = 300;
  crossed.stiffness(1, 0) = -300;
  check("unsymmetric mount", false, crossed);
  crossed.stiffness(1, 0) = 300;
  check("coupled mount", true, crossed);
  check("spring", true, Spring<>{{0, 0, 1}, {0, 0, 0}, 100, 1});
  check("spring with damper", false, Spring<>{{0, 0, 1}, {0, 0, 0}, 100, 1, 0.1});
  check("drag", false, ViscousDrag<>{0, 0.1});
  check("torque", false, ConstantLoad<Guide>{.torque = {0, 0, 1}});
  check("follower force", false, ConstantLoad<Body>{.force = {0, 0, 1}});
  check("gravity on guide axes", true, UniformGravity<Guide>{{0, 0, -9}});
  check("gravity on inertial axes", true, UniformGravity<Inertial>{{0, 0, -9}});
  check("gravity on body axes", false, UniformGravity<Body>{{0, 0, -9}});
  check("potential that depends on time", false, Tide{});
}

BOOST_AUTO_TEST_CASE(omitted_members_are_zero) {
  check_same_in_used_memory<UniformGravity<Guide>>("UniformGravity");
  check_same_in_used_memory<ConstantLoad<Guide>>("ConstantLoad");
  check_same_in_used_memory<ViscousDrag<>>("ViscousDrag");
  check_same_in_used_memory<Spring<>>("Spring");
  check_same_in_used_memory<ElasticMount<>>("ElasticMount");
  check_same_in_used_memory<CardanMoments>("CardanMoments");
  check_same_in_used_memory<CardanBearings>("CardanBearings");
  check_same_in_used_memory<DrivenRotor<>>("DrivenRotor");
  check_same_in_used_memory<HarmonicSeries<>::Term>("HarmonicSeries::Term");
  check_same_in_used_memory<JointForce>("JointForce");
  check_same_in_used_memory<InertiaTensor<Body>>("InertiaTensor");
  check_same_in_used_memory<RotatingFrame<>>("RotatingFrame");
  BOOST_TEST(Spring<>{}.guide_end.isZero(0));
  BOOST_TEST(ElasticMount<>{}.body_end.isZero(0));
  BOOST_TEST(UniformGravity<Inertial>{}.g.isZero(0));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(invariants_of_trees)

// All listed invariants of random trees are constant, on guides at rest and in motion, with gravity
// and without.
BOOST_AUTO_TEST_CASE(listed_ones_are_constant_along_motions) {
  const std::vector<Gravity> gravities{Gravity{}, UniformGravity<Guide>{{1, 2, -9}},
                                       UniformGravity<Inertial>{{0, 0, -9}}};
  int momenta = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    auto bodies = test::random_tree(seed);
    // Half of them without the forces in joints, which leave few invariants.
    for (BodyDescription& b : bodies) {
      if (seed % 2 == 0 && !b.rotor) b.forces.clear();
      if (seed % 4 == 0) b.rule = JointRule::forces;
    }
    const auto check = [&](const auto& system) {
      auto start = system.rest();
      test::Sample sample(seed);
      for (double& rate : start.rates) rate = sample.uniform(-1, 1);
      for (const detail::Link& link : system.tree().links()) {
        for (int k = 0; link.rule == JointRule::held && k < detail::rate_count(link.kind); ++k) {
          start.rates[link.v + k] = 0;
        }
      }
      for (const std::string& name : names(system, start)) {
        momenta += name.find("momentum") != std::string::npos ? 1 : 0;
      }
      check_kept(system, start, "seed " + std::to_string(seed));
    };
    const Gravity& gravity = gravities[seed % gravities.size()];
    check(BodySystem(RestingFrame<>{}, bodies, gravity));
    if (seed % 5 == 0) check(BodySystem(RotatingFrame<>{{0.3, -0.2, 0.5}}, bodies, gravity));
  }
  BOOST_TEST(momenta >= 60);
}

BOOST_AUTO_TEST_CASE(momenta_are_listed_if_nothing_acts) {
  const auto listed = [](const std::vector<BodyDescription>& bodies, const Gravity& gravity = {}) {
    const BodySystem system(RestingFrame<>{}, bodies, gravity);
    auto start = system.rest();
    for (Eigen::Index i = 0; i < start.rates.size(); ++i) start.rates[i] = 1 + 0.3 * double(i);
    check_kept(system, start, bodies.front().name);
    Names all = names(system, start);
    BOOST_TEST_REQUIRE(all.front() == "energy");
    all.erase(all.begin());
    return all;
  };
  const UniformGravity<Guide> weight{{0, 0, -9.81}};
  const Names angular{"angular momentum x", "angular momentum y", "angular momentum z"};
  const auto expect = [](const Names& found, const Names& wanted) {
    BOOST_TEST(found == wanted, boost::test_tools::per_element());
  };
  const Joint ball{.kind = JointKind::spherical, .position = {1, 2, 3}};
  expect(listed({described("ball", ball)}), angular);
  expect(listed({described("ball", ball)}, weight), {"angular momentum along gravity"});
  expect(listed({described("free", free_joint)}, weight),
         {"momentum x", "momentum y", "angular momentum along gravity"});
  const auto turning = [](const Vector3<double>& axis) {
    return Joint{.kind = JointKind::revolute, .axis = axis, .position = {1, 2, 3}};
  };
  const std::string about = "angular momentum about the axis of 'door'";
  expect(listed({described("door", turning({1, 2, 2}))}), {about});
  expect(listed({described("door", turning({0, 0, 2}))}, weight), {about});
  expect(listed({described("door", turning({0, 0.1, 2}))}, weight), {});
  const auto sliding = [](const Vector3<double>& axis) {
    return Joint{.kind = JointKind::prismatic, .axis = axis};
  };
  const std::string along = "momentum along the axis of 'slide'";
  expect(listed({described("slide", sliding({0, 0, 1}))}), {along});
  expect(listed({described("slide", sliding({3, 4, 0}))}, weight), {along});
  expect(listed({described("slide", sliding({3, 4, 1}))}, weight), {});
  const Joint cross{.kind = JointKind::universal, .axis = {0, 0, 1}, .second_axis = {1, 0, 0}};
  expect(listed({described("cross", cross)}, weight),
         {"angular momentum about the axis of 'cross'"});
  // A spring in the root's joint acts from outside, one further out does not.
  auto sprung = described("door", turning({0, 0, 1}));
  sprung.forces = {{.stiffness = 3}};
  expect(listed({sprung}), {});
  auto leaf = sprung;
  leaf.name = "leaf";
  leaf.parent = "door";
  expect(listed({described("door", turning({0, 0, 1})), leaf}), {about});
  // Both parts are treated separately; a load on one does not affect the other.
  auto pulled = described("pulled", ball, {Spring<>{{0, 0, 5}, {0, 0, 0.1}, 10, 1}});
  expect(listed({described("ball", ball), pulled}),
         {"angular momentum x of 'ball'", "angular momentum y of 'ball'",
          "angular momentum z of 'ball'"});
  // A body on a fixed body does not move.
  auto stand = described("stand", {.kind = JointKind::fixed, .position = {0, 0, 1}});
  auto on_stand = described("ball", ball);
  on_stand.parent = "stand";
  expect(listed({stand, on_stand}), angular);
}

BOOST_AUTO_TEST_CASE(single_bodies_list_the_same) {
  const Names linear{"energy",
                     "momentum x",
                     "momentum y",
                     "momentum z",
                     "angular momentum x",
                     "angular momentum y",
                     "angular momentum z"};
  const auto expect = [](const auto& scene, const auto& start, const Names& wanted) {
    check_kept(scene, start, wanted.back());
    BOOST_TEST(names(scene, start) == wanted, boost::test_tools::per_element());
  };
  const FreeBody<RestingFrame<>>::State flying{.velocity = {{{1, -2, 3}, {0.5, 0, 1}}}};
  const FixedPointBody<RestingFrame<>>::State turning{.angular_velocity = {1, -2, 3}};
  expect(FreeBody(body(), RestingFrame<>{}), flying, linear);
  const auto& state = flying.velocity;
  const FreeBody heavy(body(), RestingFrame<>{}, UniformGravity<Guide>{{0, 3, 0}});
  expect(heavy, decltype(heavy)::State{.velocity = state},
         {"energy", "momentum x", "momentum z", "angular momentum along gravity"});
  expect(FixedPointBody(body(), {1, 2, 3}, RestingFrame<>{}), turning,
         {"energy", "angular momentum x", "angular momentum y", "angular momentum z"});
  const FixedPointBody top(body(), {1, 2, 3}, RestingFrame<>{},
                           UniformGravity<Inertial>{{1, 3, 0}});
  expect(top, decltype(top)::State{.angular_velocity = {1, -2, 3}},
         {"energy", "angular momentum along gravity"});
  const FixedPointBody spinner(body(), {1, 2, 3}, RestingFrame<>{},
                               Spring<>{{0, 0, 5}, {0, 0, 1}, 3});
  BOOST_TEST(names(spinner, {}) == Names{"energy"}, boost::test_tools::per_element());
}

BOOST_AUTO_TEST_SUITE_END()
