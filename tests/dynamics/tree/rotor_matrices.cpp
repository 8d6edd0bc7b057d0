#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/tree/rotor_matrices.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;
using test::Root;

namespace {

BodySystem<RestingFrame<>> resting(std::vector<BodyDescription> bodies) {
  return {RestingFrame<>{}, std::move(bodies)};
}

double off(const Eigen::MatrixXd& found, const Eigen::MatrixXd& truth) {
  return (found - truth).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / truth.cwiseAbs().maxCoeff();
}

/// The state of a snapshot without its attitude, so that root and guide axes are equal.
template <class System>
Eigen::VectorXd state(const System& system, const Json& snapshot) {
  auto s = system.rest();
  const Eigen::VectorXd u = numbers(snapshot["u"]);
  const Eigen::VectorXd q = numbers(snapshot["q"]);
  const Eigen::VectorXd spin = numbers(snapshot["phidot"]);
  Eigen::Index angle = 0, rate = 0, rotor = 0;
  for (int i = 0; i < system.body_count(); ++i) {
    const JointPlace p = system.tree().place(i);
    for (int k = 0; k < p.v_count; ++k) {
      s.rates[p.v + k] = system.tree().body(i).rotor ? spin[rotor++] : u[rate++];
    }
    if (i > 0 && !system.tree().body(i).rotor) s.coordinates[p.q] = q[angle++];
  }
  return system.to_vector(s);
}

/// Difference of the reference's rates of the root's velocity on root axes to those on guide axes:
/// the rates of the velocity due to rotation.
Eigen::VectorXd turning_along(const Eigen::VectorXd& u, bool free) {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(u.size());
  if (free)
    result.segment<3>(3) = Vector3<double>(u.head(3)).cross(Vector3<double>(u.segment(3, 3)));
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_matrices_of_rotors)

BOOST_AUTO_TEST_CASE(treat_springs_as_forces) {
  const Json& reference = test::rotors_reference();
  const auto system = resting(
      test::model_bodies("cmgsat", Root::free,
                         reference["trajectories"]["T3_cmgsat_regulated"]["springs_dampers_const"],
                         RotorMode::regulated));
  BodyWorkspace w = system.workspace();
  const Json& snapshot = reference["snapshots"]["cmgsat_regulated"];
  const Eigen::VectorXd y = state(system, snapshot);
  const RotorMatrices m = rotor_matrices(system, 0, y, w);
  BOOST_TEST(!m.Q.isZero(0));
  Eigen::VectorXd dv;
  system.accelerations(0, y, {}, dv, w);
  const Eigen::VectorXd solved =
      m.A_eff.ldlt().solve(Eigen::VectorXd(m.Q - m.c - m.G_R * numbers(snapshot["u"])));
  BOOST_TEST(off(solved, dv(m.rates)) <= 1e-13);
}

BOOST_AUTO_TEST_CASE(contain_forces_that_change_with_time) {
  const auto gimbal = [](const Signal<double>& force) {
    BodyDescription ring;
    ring.name = "ring";
    ring.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
    ring.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
    ring.forces = {{.in_time = force}};
    BodyDescription wheel = ring;
    wheel.name = "wheel";
    wheel.parent = "ring";
    wheel.joint.axis = {1, 0, 0};
    wheel.forces = {};
    wheel.rotor = Rotor{.mode = RotorMode::regulated};
    return resting({ring, wheel});
  };
  const auto system = gimbal(Signal<double>(0.1, 2, {}));
  BodyWorkspace w = system.workspace();
  const RotorMatrices m = rotor_matrices(system, 3, system.to_vector(system.rest()), w);
  BOOST_TEST(m.Q[0] == 6.1);
}

BOOST_AUTO_TEST_CASE(agree_with_the_reference) {
  for (const char* name :
       {"platform_regulated", "platform_free", "pivsat_regulated", "cmgsat_regulated"}) {
    BOOST_TEST_CONTEXT(name) {
      const Json& truth = test::rotors_reference()["snapshots"][name];
      const std::string text = name;
      const std::string model = text.substr(0, text.find('_'));
      const bool platform = model == "platform";
      const bool regulated = truth["mode"] == "regulated";
      const auto system =
          resting(test::model_bodies(model, platform ? Root::ball : Root::free, Json::object(),
                                     regulated ? RotorMode::regulated : RotorMode::free));
      BodyWorkspace w = system.workspace();
      const Eigen::VectorXd y = state(system, truth);
      const RotorMatrices m = rotor_matrices(system, 0, y, w);
      const Eigen::VectorXd u = numbers(truth["u"]);
      const Eigen::VectorXd along = turning_along(u, !platform);

      std::vector<std::pair<const char*, double>> errors = {
          {"A", off(m.A, test::rows(truth["A"]))},
          {"B", off(m.B, test::rows(truth["B"]))},
          {"l", off(m.l, numbers(truth["l"]))},
          {"A_eff", off(m.A_eff, test::rows(truth["A_eff"]))},
          {"h", off(m.h, numbers(truth["h"]))},
          {"G_R", off(m.G_R, test::rows(truth["G_R"]))},
          {"c", off(m.c + m.A_eff * along, numbers(truth["G_A_u_incl_Hamel"]))}};
      BOOST_TEST((m.G_R + m.G_R.transpose()).isZero(0));
      BOOST_TEST(m.Q.isZero(0));

      Eigen::VectorXd dv;
      system.accelerations(0, y, {}, dv, w);
      errors.emplace_back("u'", off(dv(m.rates) - along, numbers(truth["udot_for_Q0"])));
      const Eigen::VectorXd solved =
          m.A_eff.ldlt().solve(Eigen::VectorXd(m.Q - m.c - m.G_R * u)) - along;
      errors.emplace_back("solved", off(solved, numbers(truth["udot_for_Q0"])));
      JointReactions r;
      system.reactions(0, y, r, w);
      for (std::size_t k = 0; k < m.rotors.size(); ++k) {
        const int v = system.tree().place(m.rotors[k]).v;
        const double expected = number(truth[regulated ? "drive_torque" : "phiddot"][k]);
        const double found = regulated ? r.drive[v] : dv[v];
        errors.emplace_back("of the rotor", std::abs(found - expected) / std::abs(expected));
      }
      for (const auto& [what, error] : errors) {
        BOOST_TEST_MESSAGE(name << ": " << what << " " << error);
        BOOST_TEST_CONTEXT(what) { BOOST_TEST(error <= 1e-13); }
      }
    }
  }
}

// On a turning table, under weight: the accelerations by the matrices agree with those of the
// bodies, which are computed without them.
BOOST_AUTO_TEST_CASE(move_the_bodies_on_a_turning_guide) {
  const RotatingFrame<> table{{0.3, -0.2, 0.5}};
  for (const RotorMode mode : {RotorMode::regulated, RotorMode::free}) {
    const BodySystem system(table, test::model_bodies("platform", Root::ball, Json::object(), mode),
                            UniformGravity<Guide>{{1, -2, -9}});
    BodyWorkspace w = system.workspace();
    const Eigen::VectorXd y =
        state(system, test::rotors_reference()["snapshots"]["platform_regulated"]);
    const RotorMatrices m = rotor_matrices(system, 0, y, w);
    const Eigen::VectorXd u = y.tail(system.tree().rates())(m.rates);
    Eigen::VectorXd dv;
    system.accelerations(0, y, {}, dv, w);
    const Eigen::VectorXd force = m.Q - m.c - m.G_R * u;
    BOOST_TEST(off(m.A_eff.ldlt().solve(force), dv(m.rates)) <= 1e-12);
  }
}

// A wheel fixed to a satellite: B is constant, and (14) gives G_R = 0; in truth the wheel's
// momentum resists every transverse rotation.
BOOST_AUTO_TEST_CASE(contain_a_wheel_fixed_in_a_satellite) {
  BodyDescription satellite;
  satellite.name = "satellite";
  satellite.joint.kind = JointKind::spherical;
  satellite.inertia =
      InertiaTensor<Body>::about_centre(10, {0, 0, 0}, Vector3<double>(1, 2, 1.5).asDiagonal());
  BodyDescription wheel;
  wheel.name = "wheel";
  wheel.parent = "satellite";
  wheel.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  wheel.inertia =
      InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Vector3<double>(0.1, 0.1, 0.2).asDiagonal());
  wheel.rotor = Rotor{.mode = RotorMode::regulated};
  const auto system = resting({satellite, wheel});
  BodyWorkspace w = system.workspace();
  auto s = system.rest();
  s.rates << 0.1, 0.2, 0.3, 50;
  const RotorMatrices m = rotor_matrices(system, 0, system.to_vector(s), w);
  Matrix3<double> G;
  G << 0, 10, 0, -10, 0, 0, 0, 0, 0;
  BOOST_TEST((m.G_R - G).norm() <= 1e-14);
  const GyroscopicRank rank = gyroscopic_rank(m);
  BOOST_TEST(rank.rank == 2);
  BOOST_TEST(rank.most == 2);
  BOOST_TEST((rank.kernel - rank.kernel(2, 0) * Vector3<double>::UnitZ()).norm() <= 1e-14);
}

// det G_R != 0 is impossible in the paper's own example: three rotors, eight velocities.
BOOST_AUTO_TEST_CASE(have_a_rank_of_twice_the_rotors_at_most) {
  const auto system =
      resting(test::model_bodies("platform", Root::ball, Json::object(), RotorMode::regulated));
  BodyWorkspace w = system.workspace();
  auto s = system.rest();
  for (const char* rotor : {"rotor6", "rotor8", "rotor11"}) {
    s.rates[system.tree().place(system.tree().index(rotor)).v] = 1000;
  }
  const auto rank = [&] {
    return gyroscopic_rank(rotor_matrices(system, 0, system.to_vector(s), w));
  };
  BOOST_TEST(rank().rank == 4);
  BOOST_TEST(rank().kernel.cols() == 4);
  const Json& generic = test::rotors_reference()["snapshots"]["platform_regulated"];
  const RotorMatrices m = rotor_matrices(system, 0, state(system, generic), w);
  const GyroscopicRank r = gyroscopic_rank(m);
  BOOST_TEST(r.rank == 6);
  BOOST_TEST(r.most == 6);
  BOOST_TEST((m.G_R * r.kernel).norm() <= 1e-15);
  const auto fixed =
      resting(test::model_bodies("platform", Root::none, Json::object(), RotorMode::regulated));
  BodyWorkspace w2 = fixed.workspace();
  auto frames = fixed.rest();
  for (const char* rotor : {"rotor6", "rotor8", "rotor11"}) {
    frames.rates[fixed.tree().place(fixed.tree().index(rotor)).v] = 1000;
  }
  BOOST_TEST(gyroscopic_rank(rotor_matrices(fixed, 0, fixed.to_vector(frames), w2)).rank == 4);
}

// The paper's (11) for rows 1 to 3 is valid for rates of coordinates. Here it is the exact equation
// with a spurious torque W x (A* u + B^t L). The reference has the numbers.
BOOST_AUTO_TEST_CASE(refute_rows_1_to_3_of_the_paper) {
  for (const auto& [name, source, model] :
       {std::array<const char*, 3>{"T8_platform_free_base_regulated",
                                   "T8_platform_free_base_regulated", "platform"},
        {"T12_pivsat_airbearing_regulated", "T5_pivsat_regulated", "pivsat_ball"}}) {
    const Json& start = test::rotors_reference()["trajectories"][source];
    auto bodies =
        test::model_bodies(model, Root::ball, start["springs_dampers_const"], RotorMode::regulated);
    const Vector3<double> torque = numbers(start["root_force"]).head(3);
    bodies.front().loads.emplace_back(ConstantLoad<Body>{.torque = torque});
    const auto system = resting(bodies);
    auto s = system.rest();
    const Eigen::VectorXd q = numbers(start["initial"]["q0"]);
    s.coordinates.tail(q.size()) = q;
    s.rates << numbers(start["initial"]["Om0"]), numbers(start["initial"]["qd0"]);
    const Eigen::Index n = system.tree().coordinates();

    for (const bool plain : {false, true}) {
      BodyWorkspace w = system.workspace();
      Eigen::VectorXd dv;
      Eigen::VectorXd push = Eigen::VectorXd::Zero(system.tree().rates());
      const auto field = [&](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
        system.rates(t, y, rate, w);
        if (!plain) return;
        const RotorMatrices m = rotor_matrices(system, t, y, w);
        const Eigen::VectorXd u = y.tail(system.tree().rates())(m.rates);
        const Vector3<double> H = (m.A_eff * u + m.h).head(3);
        push.head(3) = Vector3<double>(u.head(3)).cross(H);
        system.accelerations(t, y, push, dv, w);
        rate.tail(dv.size()) = dv;
      };
      ExplicitRungeKutta steps(field, 0.0, system.to_vector(s), {.relative = plain ? 1e-10 : 1e-13},
                               system.blocks());
      double worst = 0;
      double apart = 0;
      for (const Json& row :
           test::rotors_reference()["plain_lagrange_rows123_error"][name]["rows"]) {
        steps.step_towards(number(row["t"]));
        const Eigen::VectorXd y = steps.advance_to(number(row["t"]));
        const Eigen::VectorXd W = numbers(row[plain ? "Omega_plain" : "Omega_exact"]);
        worst = test::worst_of(worst, (y.segment(n, 3) - W).norm() / W.norm());
        apart = (numbers(row["Omega_plain"]) - numbers(row["Omega_exact"])).norm() /
                numbers(row["Omega_exact"]).norm();
      }
      BOOST_TEST_MESSAGE(name << (plain ? ", as printed: " : ": ") << worst
                              << " from the reference; both at the end apart by " << apart);
      BOOST_TEST(worst <= (plain ? 1e-10 : 1e-12));
      BOOST_TEST(apart > 0.25);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
