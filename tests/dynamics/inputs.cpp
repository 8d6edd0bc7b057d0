#include <boost/test/unit_test.hpp>

#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/guide/earth.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/pendulum/pendulum_encke.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/small_oscillations.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/splitting.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;

/// Invalid inputs number by number, if other tests show only one of their kind. Also properties
/// that depend on which of several numbers is 0.

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

BodyDescription rod(JointKind kind = JointKind::revolute) {
  BodyDescription body;
  body.name = "rod";
  body.joint = {.kind = kind, .axis = {0, 0, 1}};
  body.inertia = InertiaTensor<Body>::about_origin(1, {0, 0, 0.1}, Matrix3<double>::Identity());
  return body;
}

BodySystem<RestingFrame<>> system_of(const BodyDescription& body) {
  return {RestingFrame<>{}, {body}};
}

template <class Change>
void refuses(const Change& change) {
  BodyDescription body = rod();
  change(body);
  BOOST_CHECK_THROW(system_of(body), InvalidInput);
}

/// The names of a scene's invariants, in one word.
template <class Scene>
std::string kept(const Scene& scene, const typename Scene::State& state) {
  std::string names;
  for (const auto& [name, value] : scene.conserved(0, state)) names += std::string(name) + ",";
  return names;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(inputs)

BOOST_AUTO_TEST_CASE(bodies_in_a_tree_are_checked) {
  refuses([](BodyDescription& b) { b.name = ""; });
  for (const double none : {not_a_number, infinite}) {
    for (int i = 0; i < 3; ++i) {
      refuses([&](BodyDescription& b) { b.joint.axis[i] = none; });
      refuses([&](BodyDescription& b) { b.joint.position[i] = none; });
    }
    for (int i = 0; i < 4; ++i) {
      refuses([&](BodyDescription& b) { b.joint.orientation.coeffs()[i] = none; });
    }
    BOOST_CHECK_THROW((BodySystem(RestingFrame<>{}, {rod()}, UniformGravity<Guide>{{0, none, 0}})),
                      InvalidInput);
  }
  const auto refuses_rotor = [](const auto& change) {
    refuses([&](BodyDescription& b) {
      b.rotor.emplace();
      change(b);
    });
  };
  refuses_rotor([](BodyDescription& b) { *b.rotor = {RotorMode::torque, infinite}; });
  refuses_rotor([](BodyDescription& b) { b.forces = {{.constant = 1}}; });
  refuses_rotor([](BodyDescription& b) { b.forces = {{.damping = 1}}; });
  BodyDescription pushed_by_nothing = rod();
  pushed_by_nothing.rotor.emplace();
  pushed_by_nothing.forces = {{}};
  BOOST_TEST(system_of(pushed_by_nothing).tree().rotors().size() == 1U);
}

BOOST_AUTO_TEST_CASE(workspaces_are_checked) {
  const auto turns = system_of(rod());
  const auto rests = system_of(rod(JointKind::fixed));
  BodyWorkspace of_other = rests.workspace();
  Eigen::VectorXd rates;
  BOOST_CHECK_THROW(turns.rates(0, Eigen::VectorXd::Zero(2), rates, of_other), InvalidInput);
}

// Needles along each axis, in a spherical joint: the message names the axis without resistance.
BOOST_AUTO_TEST_CASE(needles_are_refused_with_their_axis) {
  for (int axis = 0; axis < 3; ++axis) {
    BodyDescription needle = rod(JointKind::spherical);
    Vector3<double> moments(1, 1, 1);
    moments[axis] = 0;
    const Matrix3<double> Theta = moments.asDiagonal();
    needle.inertia = InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Theta);
    const auto system = system_of(needle);
    const std::string name[] = {"(1, 0, 0)", "(0, 1, 0)", "(0, 0, 1)"};
    BOOST_CHECK_EXCEPTION((void)system.rates(0, system.to_vector(system.rest())), ComputationFailed,
                          [&](const ComputationFailed& e) {
                            return std::string(e.what()).find(name[axis]) != std::string::npos;
                          });
    BOOST_CHECK_THROW(SmallOscillations(needle.inertia, RestingFrame<>{}, {}), InvalidInput);
  }
}

BOOST_AUTO_TEST_CASE(single_numbers_are_checked) {
  BOOST_CHECK_THROW((void)EqualSpringsRange::of({0, 1, 1}, 1), InvalidInput);
  BOOST_CHECK_THROW((void)EqualSpringsRange::of({1, 1, 1}, 0), InvalidInput);
  BOOST_CHECK_THROW(SymmetricFreeFlow(1, 0), InvalidInput);
  BOOST_CHECK_THROW(exact::LagrangeTop(1, 1, infinite, {0, 0, 1}, Eigen::Quaterniond::Identity()),
                    InvalidInput);
  BOOST_CHECK_THROW(detail::require_step(infinite), InvalidInput);
  BOOST_CHECK_THROW(detail::require_positive("mass", infinite, "kg"), InvalidInput);
  BOOST_CHECK_THROW(exact::LagrangeTop(1, infinite, 1, {0, 0, 1}, Eigen::Quaterniond::Identity()),
                    InvalidInput);
  const Eigen::Quaterniond no_attitude(infinite, 0, 0, 0);
  BOOST_CHECK_THROW(exact::LagrangeTop(1, 1, 1, {0, 0, 1}, no_attitude), InvalidInput);
  BOOST_CHECK_THROW(detail::require_start(no_attitude, {0, 0, 1}), InvalidInput);
  BOOST_CHECK_THROW(EnckePendulum(infinite, [](double, double, double) { return 0.0; }),
                    InvalidInput);
  BOOST_CHECK_THROW(CardanGyro({{infinite, 1, 1}}, {}, RestingFrame<>{}), InvalidInput);
  const CardanBearings turned{{}, {.stiffness = 1, .reference = 0.1}};
  BOOST_CHECK_THROW(FoepplGyro<>({{1, 1, 1}}, turned, 1), InvalidInput);
  const CardanBearings rigid{{}, {.stiffness = infinite}};
  BOOST_CHECK_THROW(CardanGyro({{1, 1, 1}}, rigid, RestingFrame<>{}), InvalidInput);
  BOOST_TEST(std::isinf(detail::norm(Eigen::Vector2d(1, infinite), 0, 2)));
  BOOST_CHECK_THROW(detail::check(SolveOptions{.output_times = {1}, .tolerance = 0.1}),
                    InvalidInput);
}

// The invariants of a top depend on which of its numbers are 0.
BOOST_AUTO_TEST_CASE(tops_list_their_invariants) {
  const EulerTop::State state{Eigen::Quaterniond(0.9, 0.1, 0.2, 0.3), {1, 2, 3}};
  const std::string always = "energy,vertical momentum,";
  BOOST_TEST(kept(EulerTop({1, 1, 1.5}, {0, 0, 1}), state) == always + "axial momentum,");
  BOOST_TEST(kept(EulerTop({1, 1, 1.5}, {0, 1, 1}), state) == always);
  BOOST_TEST(kept(EulerTop({1, 1, 1.5}, {0, 0, 1}, {1, 0, 0}), state) == always);
  BOOST_TEST(kept(EulerTop({1, 1, 1.5}, {0, 0, 1}, {0, 1, 0}), state) == always);
  BOOST_TEST(kept(EulerTop({2, 2, 1}, {1, 0, 0}), state) == always + "kovalevskaya,");
  BOOST_TEST(kept(EulerTop({2, 2, 1}, {1, 0, 0}, {0, 0, 1}), state) == always);
}

// Those of a Cardan gyro depend on its bearings and on its rotor's drive.
BOOST_AUTO_TEST_CASE(gimbals_list_their_invariants) {
  const CardanMoments moments{{2, 2, 3}, {1, 1, 1}, {1, 1, 1}};
  const CardanState state{0.1, 0.2, 0.3, 1, 2, 30};
  const auto kept_by = [&](const CardanBearings& bearings, const auto& rotor) {
    return kept(CardanGyro(moments, bearings, RestingFrame<>{}, rotor), state);
  };
  const CardanBearing brake{.damping = 1}, spring{.stiffness = 1};
  BOOST_TEST(kept_by({}, FreeRotor{}) == "energy,alpha momentum,rotor momentum,");
  BOOST_TEST(kept_by({}, FreeRotor{0.1}) == "alpha momentum,");
  BOOST_TEST(kept_by({brake, {}}, FreeRotor{}) == "rotor momentum,");
  BOOST_TEST(kept_by({spring, brake}, FreeRotor{}) == "rotor momentum,");
  BOOST_TEST(kept_by({spring, {}}, RegulatedRotor{}) == "energy of rings,");
  const auto kept_on_a_table = [&](const auto& rotor) {
    return kept(CardanGyro(moments, {}, RotatingFrame<>{{0, 0, 1}}, rotor), state);
  };
  BOOST_TEST(kept_on_a_table(FreeRotor{}) == "Jacobi integral,rotor momentum,");
  BOOST_TEST(kept_on_a_table(FreeRotor{0.1}).empty());
  BOOST_TEST(kept_on_a_table(RegulatedRotor{}) == "Jacobi integral,");
}

// A brake consumes the energy that a steady guide conserves.
BOOST_AUTO_TEST_CASE(loads_limit_the_invariants) {
  const auto kept_by = [](double damping) {
    const FixedPointBody body(
        InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Matrix3<double>::Identity()), {0, 0, 0},
        RotatingFrame<>{{0, 0, 1}}, Spring<>{{1, 0, 0}, {0, 1, 0}, 1.0, 0.5, damping});
    return kept(body, {});
  };
  BOOST_TEST(kept_by(0) == "Jacobi integral,");
  BOOST_TEST(kept_by(1).empty());
}

// The invariants of a tree depend on its joints, forces and rotors.
BOOST_AUTO_TEST_CASE(trees_list_their_invariants) {
  const auto kept_by = [](const BodyDescription& body) {
    const auto system = system_of(body);
    return kept(system, system.rest());
  };
  const std::string momentum =
      "momentum x,momentum y,momentum z,angular momentum x,angular momentum y,angular momentum z,";
  BodyDescription free = rod(JointKind::free);
  BOOST_TEST(kept_by(free) == "energy," + momentum);
  free.forces.assign(6, {});
  BOOST_TEST(kept_by(free) == "energy," + momentum);
  free.forces[0].constant = 1;
  BOOST_TEST(kept_by(free).empty());
  free.forces[0] = {.damping = 1};
  BOOST_TEST(kept_by(free).empty());
  BodyDescription held = rod(JointKind::free);
  held.rule = JointRule::held;
  BOOST_TEST(kept_by(held) == "energy,");
  BodyDescription ball = rod(JointKind::spherical);
  ball.forces.assign(3, {.constant = 1});
  BOOST_TEST(kept_by(ball).empty());
  BodyDescription regulated = rod();
  regulated.rotor.emplace();
  regulated.rotor->mode = RotorMode::regulated;
  BOOST_TEST(kept_by(regulated) == "energy without spin,");
  BodyDescription driven = regulated;
  driven.name = "driven";
  driven.rotor->mode = RotorMode::torque;
  const BodySystem both(RestingFrame<>{}, {regulated, driven});
  BOOST_TEST(kept(both, both.rest()).empty());
}

// A tensor whose rounding has a large effect on the rates is uncertain by its last digits.
BOOST_AUTO_TEST_CASE(nearly_singular_bodies_have_uncertainty) {
  const auto body = [](double least) {
    Matrix3<double> Theta = Vector3<double>(1, 1, least).asDiagonal();
    return FixedPointBody(InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Theta), {0, 0, 0},
                          RestingFrame<>{});
  };
  BOOST_TEST(!body(1e-3).perturbed_by_ulps().has_value());
  BOOST_TEST(body(1e-5).perturbed_by_ulps().has_value());
}

// A tensor is symmetric in each of its three pairs, and a body without mass has none anywhere.
BOOST_AUTO_TEST_CASE(tensors_are_checked) {
  for (const auto& [i, k] : {std::pair(0, 1), {0, 2}, {1, 2}}) {
    Matrix3<double> Theta = Matrix3<double>::Identity();
    Theta(i, k) = 1e-3;
    BOOST_CHECK_THROW((void)InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Theta), InvalidInput);
  }
  for (int i = 0; i < 3; ++i) {
    Inertia<> light{0, {0, 0, 0}, {1, 1, 1}};
    light.first_moment[i] = 1;
    BOOST_CHECK_THROW(check(light, Mass::zero_allowed), InvalidInput);
  }
}

// A spring without length whose ends meet has no force; one with a length has no direction.
BOOST_AUTO_TEST_CASE(springs_with_joined_ends_have_no_force) {
  const auto pulled_by = [](double rest_length) {
    const FixedPointBody body(
        InertiaTensor<Body>::about_origin(1, {0, 0, 0}, Matrix3<double>::Identity()), {0, 0, 0},
        RestingFrame<>{}, Spring<>{{0, 0, 0}, {0, 0, 0}, 1.0, rest_length});
    return body.rates(0, body.to_vector({}));
  };
  BOOST_TEST(pulled_by(0).isZero(0));
  BOOST_CHECK_THROW((void)pulled_by(1), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
