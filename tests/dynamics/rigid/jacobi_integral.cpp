#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/step/integrator.hpp>

#include <support/worst.hpp>

using namespace kreisel;

namespace {

InertiaTensor<Body> lopsided_body() {
  Matrix3<double> Theta;
  Theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  return InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, Theta);
}

struct Drift {
  double largest;
  double energy_exchanged;  ///< range of the kinetic energy meanwhile: the part that must cancel
};

/// The drift of the scene's invariants over 10 s.
template <class Scene, class KineticEnergy>
Drift drift(const Scene& scene, const typename Scene::State& start, const std::string& name,
            const KineticEnergy& kinetic) {
  const auto value = [&](double t, const typename Scene::State& state) {
    for (const auto& [what, number] : scene.conserved(t, state)) {
      if (what == name) return number;
    }
    BOOST_FAIL("no " + name + " is kept");
    return 0.0;
  };
  Drift found{0, 0};
  Integrator run(scene, 0, start, {1e-13});
  for (int i = 1; i <= 20; ++i) {
    const double t = 0.5 * i;
    const auto state = run.to(t);
    found.largest = test::worst_of(found.largest, std::abs(value(t, state) - value(0, start)));
    found.energy_exchanged =
        test::worst_of(found.energy_exchanged, std::abs(kinetic(t, state) - kinetic(0, start)));
  }
  return found;
}

constexpr auto of_body = [](const auto& body) {
  return
      [&body](double t, const auto& state) { return body.body_outputs(t, state).kinetic_energy; };
};

// Steps held to 1e-13 drift by some 1e-12 of the exchanged energies.
void holds(const Drift& found) {
  BOOST_TEST(found.energy_exchanged > 0.1);
  BOOST_TEST(found.largest <= 1e-11 * found.energy_exchanged);
}

const UniformGravity<Guide> plumb{{1, 2, -9}};
const Spring<> spring{{2, 1, 1}, {0.1, 0.2, 0}, 30, 0.5};

}  // namespace

BOOST_AUTO_TEST_SUITE(jacobi_integral)

BOOST_AUTO_TEST_CASE(is_constant_for_a_fixed_point_body) {
  const auto check = [](const auto& guide, const char* name) {
    const FixedPointBody body(lopsided_body(), {0.3, 0.1, -0.2}, guide, plumb, spring);
    holds(drift(body, {.angular_velocity = {1, -2, 3}}, name, of_body(body)));
  };
  check(RestingFrame<>{}, "energy");
  check(RotatingFrame<>{{0.7, -0.3, 0.5}, {0.4, 0.2, -1}, {}, {1, 0, 2}}, "Jacobi integral");
  check(SteadyFrame<>{{}, {{{0.7, -0.3, 0.5}, {3, -1, 2}}}}, "Jacobi integral");
}

BOOST_AUTO_TEST_CASE(is_constant_for_a_free_body) {
  const auto check = [](const auto& guide, const char* name) {
    const FreeBody body(lopsided_body(), guide, plumb, spring);
    holds(drift(body, {.velocity = {{{1, -2, 3}, {0.5, 0, 1}}}}, name, of_body(body)));
  };
  check(RestingFrame<>{}, "energy");
  check(RotatingFrame<>{{0.7, -0.3, 0.5}, {0.4, 0.2, -1}, {}, {1, 0, 2}}, "Jacobi integral");
}

BOOST_AUTO_TEST_CASE(is_listed_only_if_constant) {
  const auto kept = [](const auto& guide, const auto&... loads) {
    const FixedPointBody body(lopsided_body(), {0.3, 0.1, -0.2}, guide, loads...);
    const auto all = body.conserved(0, {});
    return std::count_if(all.begin(), all.end(), [](const auto& invariant) {
      return std::string(invariant.first).find("momentum") == std::string::npos;
    });
  };
  const RotatingFrame<> turning{{0.7, -0.3, 0.5}};
  BOOST_TEST(kept(turning) == 1);
  BOOST_TEST(kept(RestingFrame<>{}, UniformGravity<Inertial>{{0, 0, -9}}) == 1);
  BOOST_TEST(kept(turning, UniformGravity<Inertial>{{0, 0, -9}}) == 0);
  BOOST_TEST(kept(turning, ViscousDrag<>{0.1, 0}) == 0);
  BOOST_TEST(kept(turning, Spring<>{{2, 1, 1}, {0.1, 0.2, 0}, 30, 0.5, 0.1}) == 0);
  BOOST_TEST(kept(turning, ConstantLoad<Guide>{.torque = {0, 0, 1}}) == 0);
  BOOST_TEST(kept([](double t) { return RotatingFrame<>{{0, 0, 1}}(t); }) == 0);
}

BOOST_AUTO_TEST_CASE(is_constant_for_a_cardan_gyro) {
  const CardanMoments unsymmetric{{0.2, 0.25, 0.3}, {0.1, 0.12, 0.15}, {0.2, 0.2, 0.1}};
  const CardanMoments symmetric{{0.2, 0.2, 0.3}, {0.1, 0.12, 0.15}, {0.2, 0.2, 0.1}};
  const CardanBearings springs{.outer = {.stiffness = 2}, .inner = {.stiffness = 3}};
  const RotatingFrame<> turning{{0.7, -0.3, 0.5}};
  const auto check = [&](const CardanMoments& moments, const auto& rotor) {
    const CardanGyro gyro(moments, springs, turning, rotor);
    holds(drift(gyro, {.alpha = 0.3, .beta = 0.5, .alpha_rate = 1, .beta_rate = 2, .phi_rate = 9},
                "Jacobi integral",
                [&](double t, const auto& s) { return gyro.balance(t, s).kinetic_energy; }));
  };
  check(unsymmetric, FreeRotor{});
  check(symmetric, FreeRotor{});
  check(symmetric, RegulatedRotor{});
}

BOOST_AUTO_TEST_SUITE_END()
