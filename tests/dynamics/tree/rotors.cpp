#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/worst.hpp>

/// Trees with rotors against plain Newton-Euler, in which a rotor is an ordinary body.

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;
using test::Root;

namespace {

const Json& trajectory(const std::string& name) {
  return test::rotors_reference()["trajectories"][name];
}

/// The largest distance of two vectors, relative to the largest number of the second.
double off(const Eigen::VectorXd& found, const Eigen::VectorXd& truth) {
  const double size = std::max(truth.cwiseAbs().maxCoeff(), 1e-300);
  return (found - truth).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / size;
}

/// A state of a model from a row of results.
Eigen::VectorXd state(Root root, const Json& row) {
  const Eigen::VectorXd q = numbers(row["q"]);
  const Eigen::VectorXd qd = numbers(row["qd"]);
  if (root == Root::none || root == Root::fixed) {
    Eigen::VectorXd y(q.size() + qd.size());
    y << q, qd;
    return y;
  }
  const Eigen::VectorXd quat = numbers(row["quat"]);
  const Eigen::Quaterniond attitude(quat[0], quat[1], quat[2], quat[3]);
  const Eigen::VectorXd turn = numbers(row["Omega"]);
  const Eigen::Index extra = root == Root::free ? 3 : 0;
  Eigen::VectorXd y(7 + 2 * extra + q.size() + qd.size());
  if (root == Root::ball) {
    y << attitude.coeffs(), q, turn, qd;
  } else {
    const Vector3<double> v = numbers(row["v_root_axes"]);
    y << attitude.coeffs(), numbers(row["pos"]), q, turn, attitude * v, qd;
  }
  return y;
}

/// The accelerations of a row, in the order of the state, without those of a free position.
Eigen::VectorXd accelerations(Root root, const Json& row) {
  Eigen::VectorXd joints = numbers(row["joint_acc"]);
  if (root == Root::none || root == Root::fixed) return joints;
  Eigen::VectorXd dv(3 + joints.size());
  dv << numbers(row["Omega_dot"]), joints;
  return dv;
}

template <class System>
Eigen::VectorXd without_place(const System& system, Root root, const Eigen::VectorXd& dv) {
  if (root != Root::free) return dv;
  Eigen::VectorXd result(dv.size() - 3);
  result << dv.head(3), dv.tail(dv.size() - 6);
  BOOST_TEST_REQUIRE(dv.size() == system.tree().rates());
  return result;
}

struct Worst {
  double acceleration = 0, drive = 0, base = 0, momentum = 0, energy = 0, motion = 0, spin = 0;
};

/// Every row of a trajectory: the results at the row's state, and the motion from the first row on.
template <class System>
Worst compare(const System& system, Root root, const std::string& name) {
  Worst worst;
  const Json& results = trajectory(name)["results"];
  BodyWorkspace w = system.workspace();
  const Eigen::VectorXd start = state(root, results.at(0));
  Integrator run(system, 0, system.from_vector(start), {.relative = 1e-15});
  for (const Json& row : results) {
    const double t = number(row["t"]);
    const Eigen::VectorXd y = state(root, row);
    Eigen::VectorXd dv;
    system.accelerations(t, y, {}, dv, w);
    worst.acceleration = test::worst_of(
        worst.acceleration, off(without_place(system, root, dv), accelerations(root, row)));
    JointReactions r;
    system.reactions(t, y, r, w);
    for (const auto& [rotor, torque] : row["drive_torque"].items()) {
      const int v = system.tree().place(system.tree().index(rotor)).v;
      // The carriers' accelerations are its terms.
      const double size = std::max(std::abs(number(torque)),
                                   1e-4 * std::abs(number(row["rotor_momentum_weight_l"][rotor])));
      worst.drive = test::worst_of(worst.drive, std::abs(r.drive[v] - number(torque)) / size);
    }
    if (root == Root::fixed) {
      const Vector3<double> base = numbers(row["base_torque_required"]);
      worst.base = test::worst_of(worst.base, off(r.on_body[0].value.moment, base));
    }
    if (row.contains("T_kinetic")) {
      const BodyBalance b = system.balance(t, y, w);
      const Eigen::VectorXd H = numbers(row["H_inertial_about_inertial_origin"]);
      worst.momentum = test::worst_of(worst.momentum, off(b.momentum.value.moment, H));
      const double T = number(row["T_kinetic"]);
      const double law = number(row["T2_plus_V"]);
      worst.energy = test::worst_of(worst.energy, std::abs(b.kinetic_energy - T) / T,
                                    std::abs(b.carrier_energy + b.potential_energy - law) / law);
    }
    if (t > 0) {
      const Eigen::VectorXd found = System::to_vector(run.to(t));
      const Eigen::Index n = system.tree().coordinates();
      for (int i = 0; i < system.body_count(); ++i) {
        const JointPlace p = system.tree().place(i);
        const double turned = std::abs(y[p.q]);
        // All together, because the small ones pass through 0; a rotor alone, because its angle is
        // large.
        if (system.tree().body(i).rotor) {
          const double far = std::max(1.0, turned);
          worst.spin = test::worst_of(worst.spin, std::abs(found[p.q] - y[p.q]) / far,
                                      std::abs(found[n + p.v] - y[n + p.v]) / std::abs(y[n + p.v]));
          continue;
        }
        for (int k = 0; k < p.q_count; ++k) {
          worst.motion = test::worst_of(worst.motion, std::abs(found[p.q + k] - y[p.q + k]));
        }
        for (int k = 0; k < p.v_count; ++k) {
          worst.motion =
              test::worst_of(worst.motion, std::abs(found[n + p.v + k] - y[n + p.v + k]));
        }
      }
    }
  }
  BOOST_TEST_MESSAGE(name << ": accelerations " << worst.acceleration << ", drives " << worst.drive
                          << ", base " << worst.base << ", momentum " << worst.momentum
                          << ", energy " << worst.energy << ", motion " << worst.motion << ", spin "
                          << worst.spin << " in " << run.effort().evaluations);
  return worst;
}

void hold(const Worst& worst) {
  BOOST_TEST(worst.acceleration <= 1e-13);
  BOOST_TEST(worst.drive <= 1e-13);
  BOOST_TEST(worst.base <= 1e-13);
  BOOST_TEST(worst.momentum <= 1e-14);
  BOOST_TEST(worst.energy <= 1e-13);
  BOOST_TEST(worst.motion <= 1e-12);  // rad, m, rad/s, m/s
  BOOST_TEST(worst.spin <= 1e-13);
}

BodySystem<RestingFrame<>> resting(std::vector<BodyDescription> bodies,
                                   const Gravity& gravity = {}) {
  return {RestingFrame<>{}, std::move(bodies), gravity};
}

std::vector<BodyDescription> bodies_of(const std::string& name, Root root) {
  const Json& json = trajectory(name);
  const bool free = json["mode"] == "free";
  auto bodies = test::model_bodies(json["model"], root, json["springs_dampers_const"],
                                   free ? RotorMode::free : RotorMode::regulated);
  if (json["root_force"].is_array() && root != Root::none) {
    const Eigen::VectorXd force = numbers(json["root_force"]);
    ConstantLoad<Body> load{.torque = force.head(3)};
    if (force.size() == 6) load.force = force.tail(3);
    bodies.front().loads.emplace_back(load);
  }
  return bodies;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

/// A frame and a rotor in it.
std::vector<BodyDescription> frame_and_rotor() {
  BodyDescription frame;
  frame.name = "frame";
  frame.joint = {.kind = JointKind::revolute, .axis = {1, 0, 0}};
  frame.inertia =
      InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Vector3<double>(0.1, 0.2, 0.15).asDiagonal());
  BodyDescription rotor;
  rotor.name = "rotor";
  rotor.parent = "frame";
  rotor.joint = {.kind = JointKind::revolute, .axis = {0, 0, 2}, .position = {0, 0.1, 0}};
  rotor.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0.3},
                                                    Vector3<double>(0.1, 0.1, 0.2).asDiagonal());
  rotor.rotor = Rotor{};
  return {frame, rotor};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_system_with_rotors)

BOOST_AUTO_TEST_CASE(agrees_with_newton_and_euler) {
  for (const auto& [name, root] : {std::pair<std::string, Root>{"T1_cardan_regulated", Root::none},
                                   {"T2_cardan_free", Root::none},
                                   {"T3_cmgsat_regulated", Root::free},
                                   {"T5_pivsat_regulated", Root::free},
                                   {"T8_platform_free_base_regulated", Root::ball}}) {
    BOOST_TEST_CONTEXT(name) { hold(compare(resting(bodies_of(name, root)), root, name)); }
  }
}

// The base at rest, or moving like the guide: the torque for that.
BOOST_AUTO_TEST_CASE(needs_the_base_torque_of_the_reference) {
  for (const char* name : {"T1_cardan_regulated", "T2_cardan_free"}) {
    BOOST_TEST_CONTEXT(name) {
      hold(compare(resting(bodies_of(name, Root::fixed)), Root::fixed, name));
    }
  }
  const auto guide = [](double t) {
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = {0.02 + 0.05 * std::sin(1.5 * t), 0.03 * std::cos(2 * t),
                                -0.04 + 0.03 * std::sin(t)};
    motion.dV.value.resultant = {0.075 * std::cos(1.5 * t), -0.06 * std::sin(2 * t),
                                 0.03 * std::cos(t)};
    return motion;
  };
  const std::string name = "T10_platform_prescribed_Omega_regulated";
  hold(compare(BodySystem<std::decay_t<decltype(guide)>>(guide, bodies_of(name, Root::fixed)),
               Root::fixed, name));
}

BOOST_AUTO_TEST_CASE(agrees_with_the_reference_between_springs) {
  const Json& json = trajectory("T13_cardan_springs_exact_and_precession");
  auto bodies = test::model_bodies("cardan", Root::none, Json::object(), RotorMode::regulated);
  bodies[0].forces = {{.stiffness = 0.4, .constant = 0.02}};
  bodies[1].forces = {{.stiffness = 0.3, .constant = -0.01}};
  const auto system = resting(bodies);
  BodyWorkspace w = system.workspace();
  Eigen::VectorXd y(6);
  y << 0.2, -0.1, 0, 0, 0, 1000;
  Integrator run(system, 0, system.from_vector(y), {.relative = 1e-15});
  for (const Json& row : json["exact"]) {
    const double t = number(row["t"]);
    const auto found = run.to(t);
    BOOST_TEST(off(found.coordinates.head(2), numbers(row["q"])) <= 1e-12);
    BOOST_TEST(off(found.rates.head(2), numbers(row["qd"])) <= 1e-12);
    JointReactions r;
    system.reactions(t, system.to_vector(found), r, w);
    const double drive = number(row["drive_torque"]);
    BOOST_TEST(std::abs(r.drive[2] - drive) <= 1e-11 * std::abs(drive));
  }
}

// The same momentum with ever smaller moments of inertia, in long runs and in short ones, in which
// the first steps matter. An ordinary body at 1e6 rad/s needs a thousand times the steps of one at
// 1e3.
BOOST_AUTO_TEST_CASE(costs_the_same_at_any_speed) {
  const auto evaluations = [](RotorMode mode, double rate, double end) {
    auto bodies = test::model_bodies("cardan", Root::none, Json::object(), mode);
    bodies[2].inertia = {{0.2, {0, 0, 0}, {0.01 / rate, 1e-4, 1e-4, 0, 0, 0}}};
    bodies[0].forces = {{.stiffness = 0.4, .constant = 0.02}};
    bodies[1].forces = {{.stiffness = 0.3, .constant = -0.01}};
    const auto system = resting(bodies);
    auto start = system.rest();
    start.coordinates << 0.2, -0.1, 0;
    start.rates << 0, 0, rate;
    const auto run = solve(system, start, {.output_times = {end}, .tolerance = 1e-9});
    BOOST_TEST(run.report.tolerance_kept);
    BOOST_TEST(run.report.method == "taylor");
    return run.report.all_evaluations;
  };
  for (const RotorMode mode : {RotorMode::regulated, RotorMode::free}) {
    for (const double end : {0.3, 1.0, 3.0}) {
      const double slow = evaluations(mode, 1e2, end);
      for (const double rate : {1e3, 1e4, 1e5, 1e6}) {
        const double fast = evaluations(mode, rate, end);
        BOOST_TEST_MESSAGE(end << " s at " << rate << " rad/s: " << fast
                               << " evaluations, at 100: " << slow);
        BOOST_TEST(fast <= 1.1 * slow);
      }
    }
  }
}

// All forces and accelerations are linear in the speed of a regulated rotor; no term of the size of
// C phi'^2 may cancel. With the rotor as an ordinary body such terms cancel.
BOOST_AUTO_TEST_CASE(loses_no_digits_at_1e6_rad_per_second) {
  const auto unevenness = [](bool rotor) {
    auto bodies = test::model_bodies("cardan", Root::none, Json::object(), RotorMode::regulated);
    for (BodyDescription& b : bodies) b.joint.axis = b.joint.axis + Vector3<double>(0.3, -0.1, 0.2);
    const Vector3<double> e = bodies[2].joint.axis.normalized();
    const double C = 0x1p-30;
    const double A = 0x1p-31;
    bodies[2].inertia.value.tensor = Symmetric3<>::from(
        Matrix3<double>(A * Matrix3<double>::Identity() + (C - A) * e * e.transpose()));
    if (!rotor) {
      bodies[2].rotor.reset();
      bodies[2].rule = JointRule::driven;
    }
    const auto system = resting(bodies);
    BodyWorkspace w = system.workspace();
    const auto at = [&](double rate) {
      Eigen::VectorXd y(6), dv;
      y << 0.2, -0.1, 0.7, 3, 5, rate;
      JointReactions r;
      system.reactions(0, y, r, w);
      system.accelerations(0, y, {}, dv, w);
      Eigen::VectorXd all(5);
      all << dv.head(2), r.on_body[2].value.moment;
      return all;
    };
    const Eigen::VectorXd rest = at(0);
    const Eigen::VectorXd fast = at(0x1p20) - rest;
    const Eigen::VectorXd slow = 0x1p10 * (at(0x1p10) - rest);
    return test::worst_of((fast - slow).head(2).norm() / fast.head(2).norm(),
                          (fast - slow).tail(3).norm() / fast.tail(3).norm());
  };
  BOOST_TEST_MESSAGE("not linear: rotor " << unevenness(true) << ", ordinary body "
                                          << unevenness(false));
  BOOST_TEST(unevenness(true) <= 1e-13);
  BOOST_TEST(unevenness(false) > 1e-12);
}

BOOST_AUTO_TEST_CASE(follows_the_given_speed) {
  auto bodies = frame_and_rotor();
  bodies[1].rotor = Rotor{.mode = RotorMode::regulated,
                          .acceleration = [](double t) { return 40 * std::cos(8 * t); }};
  const auto system = resting(bodies, UniformGravity<Guide>{{0, -9, 2}});
  auto state = system.rest();
  state.rates << 0.5, 100;
  Integrator run(system, 0, state, {.relative = 1e-13});
  const auto end = run.to(1.5);
  BOOST_TEST(std::abs(end.rates[1] - (100 + 5 * std::sin(12.0))) <= 1e-10);
  BOOST_TEST(std::abs(end.coordinates[1] - (150 + 0.625 * (1 - std::cos(12.0)))) <= 1e-10);
  BOOST_TEST(system.conserved(0, state).empty());
  // The same as an ordinary body with the torque of that motion.
  BodyWorkspace w = system.workspace();
  JointReactions r;
  const auto y = system.to_vector(end);
  system.reactions(1.5, y, r, w);
  Eigen::VectorXd dv, ordinary;
  system.accelerations(1.5, y, {}, dv, w);
  bodies[1].rotor.reset();
  bodies[1].forces = {{.constant = r.drive[1]}};
  const auto other = resting(bodies, UniformGravity<Guide>{{0, -9, 2}});
  BodyWorkspace w2 = other.workspace();
  other.accelerations(1.5, y, {}, ordinary, w2);
  BOOST_TEST((dv - ordinary).norm() <= 1e-13 * 100);
  BOOST_TEST(std::abs(dv[1] - 40 * std::cos(12.0)) <= 1e-13);
}

BOOST_AUTO_TEST_CASE(conserves_its_listed_invariants) {
  const auto drift = [](const auto& system, const auto& start, double t) {
    Integrator run(system, 0, start, {.relative = 1e-14});
    const auto before = system.conserved(0, start);
    const auto after = system.conserved(t, run.to(t));
    std::vector<std::string> names;
    for (std::size_t i = 0; i < before.size(); ++i) {
      names.push_back(before[i].first);
      BOOST_TEST(std::abs(after[i].second - before[i].second) <=
                 1e-12 * (std::abs(before[i].second) + 1e-2));
    }
    return names;
  };
  using Names = std::vector<std::string>;
  const Names momenta = {"momentum x",         "momentum y",         "momentum z",
                         "angular momentum x", "angular momentum y", "angular momentum z"};
  const auto with = [&](Names names) {
    names.insert(names.end(), momenta.begin(), momenta.end());
    return names;
  };
  const Json springs = test::parsed(R"({"gimbal": {"k": "0.8", "d": "0", "Q0": "0"}})");
  for (const RotorMode mode : {RotorMode::free, RotorMode::regulated, RotorMode::torque}) {
    auto bodies = test::model_bodies("cmgsat", Root::free, springs, mode);
    if (mode == RotorMode::torque) bodies[2].rotor->torque = 3;
    const auto system = resting(bodies);
    auto start = system.rest();
    start.coordinates[7] = 0.4;
    start.rates << 0.05, -0.03, 0.08, 0.1, 0.2, -0.1, 0.2, 600;
    const Names expected =
        with(mode == RotorMode::free        ? Names{"cyclic momentum of 'rotor'", "energy"}
             : mode == RotorMode::regulated ? Names{"energy without spin"}
                                            : Names{"energy"});
    BOOST_TEST(drift(system, start, 2) == expected, boost::test_tools::per_element());
  }
  // The cyclic momentum is constant for any guide motion.
  const BodySystem<RotatingFrame<>> turning({.angular_velocity = {0.3, -0.2, 0.5}},
                                            frame_and_rotor(), UniformGravity<Guide>{{0, -9, 2}});
  auto start = turning.rest();
  start.rates << 2, 50;
  BOOST_TEST(drift(turning, start, 2) == Names{"cyclic momentum of 'rotor'"},
             boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(keeps_the_order_of_its_coordinates) {
  const auto bodies = bodies_of("T3_cmgsat_regulated", Root::free);
  const auto system = resting(bodies);
  const auto ordinary =
      resting(test::model_bodies("cmgsat", Root::free, Json::object(), std::nullopt));
  BOOST_TEST(system.blocks() == ordinary.blocks(), boost::test_tools::per_element());
  for (int i = 0; i < system.body_count(); ++i) {
    const JointPlace a = system.tree().place(i);
    const JointPlace b = ordinary.tree().place(i);
    BOOST_TEST((a.q == b.q && a.v == b.v && a.q_count == b.q_count && a.v_count == b.v_count));
  }
}

BOOST_AUTO_TEST_CASE(refuses_invalid_rotors) {
  using Change = std::function<void(std::vector<BodyDescription>&)>;
  const auto refusal = [](const Change& change) {
    auto bodies = frame_and_rotor();
    change(bodies);
    return message_of([&] { (void)resting(bodies); });
  };
  const auto shape = [](const Vector3<double>& centre, const Vector3<double>& moments) {
    return InertiaTensor<Body>::about_centre(1, centre, moments.asDiagonal());
  };
  BOOST_TEST(refusal([](auto&) {}).empty());
  const auto refuses = [&](const Change& change, const std::string& reason) {
    const std::string message = refusal(change);
    BOOST_TEST_CONTEXT(message) {
      BOOST_TEST(message.find("'rotor'") != std::string::npos);
      BOOST_TEST(message.find(reason) != std::string::npos);
    }
  };
  refuses([&](auto& b) { b[1].inertia = shape({0, 1e-6, 0.3}, {0.1, 0.1, 0.2}); }, "unbalanced");
  refuses(
      [&](auto& b) {
        b[1].inertia = shape({0, 0, 0.3}, {0.1, 0.1000001, 0.2});
      },
      "not symmetric");
  refuses([&](auto& b) { b[1].inertia = shape({0, 0, 0}, {0, 0, 0}); }, "no moment of inertia");
  refuses([](auto& b) { b[1].joint.kind = JointKind::prismatic; }, "no revolute joint");
  refuses([](auto& b) { b[1].rule = JointRule::driven; }, "held or driven");
  refuses([](auto& b) { b[1].forces = {{.stiffness = 1}}; }, "spring");
  refuses([](auto& b) { b[1].forces = {{.damping = 1}}; }, "momentum of a free one");
  refuses([](auto& b) { b[1].rotor->torque = 1; }, "mode torque");
  refuses([](auto& b) { b[1].rotor->acceleration = [](double) { return 1.0; }; }, "not regulated");
  refuses([](auto& b) { b[1].loads.emplace_back(ConstantLoad<Guide>{}); }, "load");
  refuses(
      [](auto& b) {
        b.push_back(b[0]);
        b[2].name = "child";
        b[2].parent = "rotor";
      },
      "can carry nothing");
  BOOST_TEST(refusal([](auto& b) {
               b[1].rotor->mode = RotorMode::torque;
               b[1].forces = {{.damping = 1, .constant = 2}};
             }).empty());
  BOOST_TEST(refusal([](auto& b) {
               b[1].rotor->mode = RotorMode::regulated;
               b[1].forces = {{.damping = 1}};
             }).empty());
}

BOOST_AUTO_TEST_SUITE_END()
