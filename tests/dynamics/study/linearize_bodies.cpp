// Linear equations of systems of bodies and of single ones by dual numbers. They are compared with
// eigenvalues of 32 digits, with closed roots, and between different kinds of scenes.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;
using test::Root;

namespace {

constexpr const char* frames[] = {"frame4", "housing5", "housing7", "frame9", "housing10"};
constexpr const char* wheels[] = {"rotor6", "rotor8", "rotor11"};

/// The platform of the reference, at rest on springs and dampers in its frames. Springs of the base
/// are three joints without mass between them.
BodySystem<RestingFrame<>> platform(bool held, const Json& c, Root root,
                                    std::optional<RotorMode> mode) {
  auto bodies = test::model_bodies("platform", root, Json::object(), mode);
  for (BodyDescription& b : bodies) {
    for (std::size_t i = 0; i < 5; ++i) {
      if (b.name != frames[i] || !c.contains("frame_stiffness")) continue;
      b.forces = {
          {.stiffness = number(c["frame_stiffness"][i]), .damping = number(c["frame_damping"][i])}};
    }
  }
  if (held) {
    const JointForce servo{.stiffness = number(c["base_stiffness"]),
                           .damping = number(c["base_damping"])};
    BodyDescription x;
    x.name = "first";
    x.joint = {.kind = JointKind::revolute, .axis = {1, 0, 0}};
    x.forces = {servo};
    BodyDescription y = x;
    y.name = "second";
    y.parent = "first";
    y.joint.axis = {0, 1, 0};
    bodies.front().parent = "second";
    bodies.front().joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
    bodies.front().forces = {servo};
    bodies.insert(bodies.begin(), {x, y});
  }
  return {RestingFrame<>{}, bodies};
}

/// At rest, with the rotors' momenta L.
Eigen::VectorXd at_rest(const BodySystem<RestingFrame<>>& system, const Eigen::VectorXd& L) {
  auto s = system.rest();
  for (int i = 0; i < 3; ++i) {
    const int body = system.tree().index(wheels[i]);
    const double C = system.tree().body(body).inertia.value.tensor.matrix()(i / 2, i / 2);
    s.rates[system.tree().place(body).v] = L[i] / C;
  }
  return system.to_vector(s);
}

/// The greatest distance of a root, except zero roots, from the nearest computed one.
double worst(const Eigen::MatrixXd& A, const Json& roots) {
  const Eigen::VectorXcd found = eigenvalues(A);
  double off = 0;
  for (const Json& root : roots) {
    const std::complex<double> truth(number(root[0]), number(root[1]));
    if (std::abs(truth) < 1e-9) continue;
    off = test::worst_of(
        off, (found.array() - truth).abs().minCoeff<Eigen::PropagateNaN>() / std::abs(truth));
  }
  return off;
}

const InertiaTensor<Body> pendulum =
    InertiaTensor<Body>::about_centre(2, {0, 0, -1.5}, Vector3<double>(0.3, 0.3, 0.1).asDiagonal());

}  // namespace

BOOST_AUTO_TEST_SUITE(linear_equations_of_bodies)

BOOST_AUTO_TEST_CASE(platform_has_the_roots_of_the_reference) {
  const Json& all = test::rotors_reference()["eigenvalues"];
  const auto check = [&](const char* name, const char* key, bool held, Root root,
                         std::optional<RotorMode> mode) {
    Json c = all[name];
    if (root == Root::none) {
      const bool dampers = std::string(name).find("dampers") != std::string::npos;
      c["frame_stiffness"] = all["P_free_base_springs_only"]["frame_stiffness"];
      c["frame_damping"] = all[dampers ? "P_free_base_springs_dampers" : "P_free_base_springs_only"]
                              ["frame_damping"];
    }
    const auto system = platform(held, c, root, mode);
    const Eigen::VectorXd L = numbers(all["P_free_base_springs_only"]["L"]);
    const auto linear = linearize<Guide, Guide>(system, 0, at_rest(system, L));
    BOOST_TEST(linear.unsteadiness.norm() == 0);
    const double off = worst(linear.A, c[key]);
    BOOST_TEST_MESSAGE(name << ", " << key << ": " << off);
    BOOST_TEST(off <= 1e-12);
    return linear;
  };
  for (const char* name : {"P_free_base_springs_only", "P_free_base_springs_dampers"}) {
    const auto linear =
        check(name, "eig_corrected_regulated", false, Root::ball, RotorMode::regulated);
    BOOST_TEST(linear.A.rows() == 22);
    BOOST_TEST(linear.names[2] == "root about z");
    BOOST_TEST(linear.names[5] == "rotor6");
    BOOST_TEST(linear.names[13] == "root' about z");
    BOOST_TEST(linear.names[21] == "rotor11'");
    const char* free = "eig_corrected_free_rotors_p_equal_L";
    check(name, free, false, Root::ball, RotorMode::free);
    check(name, free, false, Root::ball, std::nullopt);
  }
  const char* servo = "P_servo_base_springs_dampers";
  check(servo, "eig_corrected_regulated", true, Root::ball, RotorMode::regulated);
  check(servo, "eig_corrected_free_rotors_p_equal_L", true, Root::ball, RotorMode::free);
  for (const char* name : {"base_fixed_frames_springs", "base_fixed_frames_springs_dampers"}) {
    check(name, "eig", false, Root::none, RotorMode::regulated);
  }
}

// A sleeping top wakes if (C w)^2 < 4 A k: as a top, as a body with a fixed point and as a system.
BOOST_AUTO_TEST_CASE(sleeping_top_has_its_stability_limit) {
  const double A = 0.3, C = 0.1, m = 0.5, g = 10, arm = 0.5;
  const double k = m * g * arm;
  const double limit = 2 * std::sqrt(A * k) / C;
  const auto inertia =
      InertiaTensor<Body>::about_origin(m, {0, 0, arm}, Vector3<double>(A, A, C).asDiagonal());
  const EulerTop top({A, A, C}, {0, 0, k});
  const FixedPointBody held(inertia, {0, 0, 0}, RestingFrame<>{},
                            UniformGravity<Guide>{{0, 0, -g}});
  BodyDescription body;
  body.name = "top";
  body.joint.kind = JointKind::spherical;
  body.inertia = inertia;
  const BodySystem<RestingFrame<>> system({}, {body}, UniformGravity<Guide>{{0, 0, -g}});
  for (const double w : {0.5 * limit, 0.999 * limit, 1.001 * limit, 2 * limit}) {
    const auto linear =
        linearize<Guide, Body>(top, 0, top.to_vector({.angular_velocity = {0, 0, w}}));
    BOOST_TEST(linear.names[5] == "w_z");
    BOOST_TEST(linear.unsteadiness.norm() == 0);
    const Eigen::VectorXcd roots = eigenvalues(linear.A);
    const std::complex<double> D = std::sqrt(std::complex<double>(C * C * w * w - 4 * A * k));
    const std::complex<double> nu = (C * w + D) / (2 * A);
    const double off = (roots.array() - std::complex<double>(0, 1) * (nu - w))
                           .abs()
                           .minCoeff<Eigen::PropagateNaN>();
    BOOST_TEST(off < 1e-12 * w, "at " << w << " rad/s off by " << off);
    const double growth = roots.real().maxCoeff<Eigen::PropagateNaN>();
    BOOST_TEST(std::abs(growth - std::abs(nu.imag())) < 1e-7 * w);
    BOOST_TEST((growth > 0.1) == (w < limit));

    auto s = system.rest();
    s.rates[2] = w;
    const auto of_system = linearize<Guide, Body>(system, 0, system.to_vector(s));
    const auto of_held =
        linearize<Guide, Body>(held, 0, held.to_vector({.angular_velocity = {0, 0, w}}));
    BOOST_TEST((of_system.A - linear.A).norm() <= 1e-14 * linear.A.norm());
    BOOST_TEST((of_held.A - linear.A).norm() <= 1e-14 * linear.A.norm());
    BOOST_TEST(of_system.names[1] == "top about y");
  }
}

// Foucault: the swing plane of a pendulum on the rotating earth turns by u sin(latitude). A body
// that is no point turns a little less: 1 - C/2A of it.
BOOST_AUTO_TEST_CASE(pendulum_on_the_earth_turns_its_plane) {
  const double u = 7.292115e-5, latitude = 0.84;
  const RotatingFrame<> earth{{u * std::cos(latitude), 0, u * std::sin(latitude)}};
  const UniformGravity<Guide> weight{{0, 0, -9.81}};
  const FixedPointBody held(pendulum, {0, 0, 0}, earth, weight);
  const auto rest = find_equilibrium(held, 0, held.to_vector({}));
  BOOST_TEST(rest.residual < 1e-14);
  const auto linear = linearize<Guide, Body>(held, 0, rest.state);
  BOOST_TEST(linear.unsteadiness.norm() < 1e-14);
  const std::vector<Mode> modes = spectrum(linear.A);
  const double A = 0.3 + 2 * 1.5 * 1.5, C = 0.1;
  const double apart = std::abs(modes[4].root.imag()) - std::abs(modes[2].root.imag());
  const double expected = 2 * u * std::sin(latitude) * (1 - C / (2 * A));
  BOOST_TEST_MESSAGE("both frequencies are apart by " << apart << ", by the law " << expected);
  BOOST_TEST(std::abs(apart - expected) < 1e-8 * expected + 1e-14);
  const double mean = (std::abs(modes[4].root.imag()) + std::abs(modes[2].root.imag())) / 2;
  BOOST_TEST(std::abs(mean - std::sqrt(2 * 9.81 * 1.5 / A)) < 1e-8);

  BodyDescription body;
  body.name = "pendulum";
  body.joint.kind = JointKind::spherical;
  body.inertia = pendulum;
  const BodySystem<RotatingFrame<>> system(earth, {body}, weight);
  const auto again = linearize<Guide, Body>(system, 0, Eigen::VectorXd(rest.state));
  BOOST_TEST((again.A - linear.A).norm() <= 1e-14 * linear.A.norm());
  BOOST_TEST((again.rate - linear.rate).norm() <= 1e-14);
  BOOST_TEST(again.unsteadiness.norm() < 1e-10);
}

// A free body on springs, a damper and a rubber mount, on a guide that turns and brakes, in any
// state. As one body and as a system of one it has the same rate. The linear equations agree with
// differences of the field.
BOOST_AUTO_TEST_CASE(loads_agree_with_differences) {
  const RotatingFrame<> guide{{0.3, -0.2, 0.5}, {0.1, 0.2, -0.3}};
  const ElasticMount<> mount{{0.1, 0, 0.2},
                             {0.2, 0.1, 0},
                             Vector3<double>(90, 70, 50).asDiagonal(),
                             Vector3<double>(3, 2, 1).asDiagonal(),
                             {1, 2, 3}};
  const FreeBody body(pendulum, guide, UniformGravity<Inertial>{{0, 0, -9.81}},
                      Spring<>{{0, 0, 1}, {0.1, 0.2, 0.3}, 40, 0.7, 2}, mount,
                      ViscousDrag<>{0.3, 0.2},
                      ConstantLoad<Guide>{{1, 2, 3}, {0.3, 0.2, 0.1}, {0.1, 0, 0.2}});
  using Six = Eigen::Matrix<double, 13, 1>;
  Six y;
  y << 0.1, -0.3, 0.2, 1.1, 0.4, 0.3, -0.2, 0.5, -0.6, 0.7, 0.3, 0.2, -0.4;
  const auto linear = linearize<Guide, Body>(body, 0.3, y);
  BOOST_TEST(linear.A.rows() == 12);
  const Tangent tangent(13, {0});
  const Eigen::MatrixXd P = tangent.inverse(y);
  const double h = 1e-3;
  double off = 0;
  for (int j = 0; j < 12; ++j) {
    const auto slope = [&](double step) -> Eigen::VectorXd {
      const Eigen::VectorXd eta = step * Eigen::VectorXd::Unit(12, j);
      const Six a = tangent.moved(y, eta), b = tangent.moved(y, Eigen::VectorXd(-eta));
      return (tangent.inverse(a) * body.rates(0.3, a) - tangent.inverse(b) * body.rates(0.3, b)) /
             (2 * step);
    };
    Eigen::VectorXd found = (4 * slope(h) - slope(2 * h)) / 3;
    // An attitude's rate, from the axes of the attitude after the move to those before it.
    if (j < 3) {
      const Vector3<double> w = linear.rate.head<3>();
      found.head<3>() += Vector3<double>::Unit(j).cross(w);
    }
    off = test::worst_of(off, (found - linear.A.col(j)).norm());
  }
  BOOST_TEST_MESSAGE("off by " << off << " of " << linear.A.norm());
  BOOST_TEST(off < 1e-9 * linear.A.norm());
  const double t = 0.3;
  const Eigen::VectorXd later = P * (body.rates(t + h, y) - body.rates(t - h, y)) / (2 * h);
  const Eigen::VectorXd expected = later + linear.A * linear.rate;
  BOOST_TEST((linear.unsteadiness - expected).norm() < 1e-5 * expected.norm());
}

// A body that floats on springs, a damper and a rubber mount, on a guide that swings; its rotor is
// accelerated and slowed down. The linear equations agree with the differences of the field. The
// unsteadiness includes the field's own change in time, due to both motions. The guide is known
// from 0 to 2 s only, like a log or a series: its rates at the ends come from inside.
BOOST_AUTO_TEST_CASE(bodies_at_the_ends_of_a_guide) {
  const auto swing = [](double t) {
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = {0.3 * std::sin(2 * t), 0.1, 0};
    motion.dV.value.resultant = {0.6 * std::cos(2 * t), 0, 0};
    motion.dV.value.moment = {0, std::sin(5 * t), 0};
    return motion;
  };
  const auto known = [swing](double t) {
    if (!(t >= 0 && t <= 2)) throw InvalidInput("not known");
    return swing(t);
  };
  const Eigen::Quaterniond attitude(0.8, 0.1, -0.3, 0.2);
  const FixedPointBody everywhere(pendulum, {0.4, 0, 0}, swing,
                                  UniformGravity<Guide>{{0, 0, -9.81}});
  const FixedPointBody within(pendulum, {0.4, 0, 0}, known, UniformGravity<Guide>{{0, 0, -9.81}});
  const auto y = within.to_vector({attitude, {1, -2, 0.5}});
  for (const double t : {0.0, 1.0, 2.0}) {
    const auto found = linearize<Guide, Body>(within, t, y).unsteadiness;
    const auto expected = linearize<Guide, Body>(everywhere, t, y).unsteadiness;
    BOOST_TEST((found - expected).norm() <= 1e-9 * expected.norm(), "at " << t << " s");
  }
  const auto run =
      solve(FixedPointBody(pendulum, {0.4, 0, 0}, known, ViscousDrag<>{0, 100}),
            {attitude, {1, -2, 0.5}}, {.output_times = {2}, .method = Method::radau13});
  BOOST_TEST(run.report.tolerance_kept, run.report.message);
  BOOST_CHECK_THROW(((void)linearize<Guide, Body>(within, 2.1, y)), InvalidInput);
}

BOOST_AUTO_TEST_CASE(systems_with_loads_on_a_swinging_guide) {
  const auto swing = [](double t) {
    FrameMotion<Guide, Inertial> motion;
    motion.X = RotatingFrame<>{{0, 0, 1}}(-0.15 * std::cos(2 * t)).X;
    motion.V.value.resultant = {0, 0, 0.3 * std::sin(2 * t)};
    motion.dV.value.resultant = {0, 0, 0.6 * std::cos(2 * t)};
    return motion;
  };
  BodyDescription body;
  body.name = "body";
  body.joint.kind = JointKind::free;
  body.inertia = pendulum;
  body.loads = {Spring<>{{0, 0, 1}, {0.1, 0.2, 0.3}, 40, 0.7, 2},
                ElasticMount<>{{0.1, 0, 0.2},
                               {0.2, 0.1, 0},
                               Vector3<double>(90, 70, 50).asDiagonal(),
                               Vector3<double>(3, 2, 1).asDiagonal(),
                               {1, 2, 3}},
                ViscousDrag<>{0.3, 0.2},
                ConstantLoad<Inertial>{{1, 2, 3}, {0.3, 0.2, 0.1}, {0.1, 0, 0.2}}};
  BodyDescription rotor;
  rotor.name = "rotor";
  rotor.parent = "body";
  rotor.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  rotor.inertia =
      InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Vector3<double>(.1, .1, .15).asDiagonal());
  rotor.rotor = Rotor{.mode = RotorMode::regulated,
                      .acceleration = [](double t) { return 5 * std::sin(3 * t); }};
  using Swinging = BodySystem<std::decay_t<decltype(swing)>>;
  const Swinging system(swing, {body, rotor}, UniformGravity<Inertial>{{0, 3, -9.81}});
  Eigen::VectorXd y(15);
  y << 0.1, -0.3, 0.2, 1.1, 0.4, 0.3, -0.2, 0.6, 0.5, -0.6, 0.7, 0.3, 0.2, -0.4, 30;
  const double t = 0.3;
  const auto linear = linearize<Guide, Body>(system, t, y);
  BOOST_TEST(linear.A.rows() == 14);
  const Tangent tangent(15, {0});
  const double h = 1e-3;
  const auto slope = [h](const auto& difference) -> Eigen::VectorXd {
    return (4 * difference(h) / (2 * h) - difference(2 * h) / (4 * h)) / 3;
  };
  for (int j = 0; j < 14; ++j) {
    Eigen::VectorXd found = slope([&](double step) -> Eigen::VectorXd {
      const Eigen::VectorXd eta = step * Eigen::VectorXd::Unit(14, j);
      const Eigen::VectorXd a = tangent.moved(y, eta), b = tangent.moved(y, Eigen::VectorXd(-eta));
      return tangent.inverse(a) * system.rates(t, a) - tangent.inverse(b) * system.rates(t, b);
    });
    if (j < 3) {
      const Vector3<double> w = linear.rate.head<3>();
      found.head<3>() += Vector3<double>::Unit(j).cross(w);
    }
    BOOST_TEST((found - linear.A.col(j)).norm() < 1e-11 * linear.A.norm());
  }
  const Eigen::VectorXd later = tangent.inverse(y) * slope([&](double step) -> Eigen::VectorXd {
                                  return system.rates(t + step, y) - system.rates(t - step, y);
                                });
  BOOST_TEST(later.norm() > 10);
  BOOST_TEST(std::abs(later[13] - 15 * std::cos(0.9)) < 1e-9);
  const Eigen::VectorXd expected = later + linear.A * linear.rate;
  BOOST_TEST((linear.unsteadiness - expected).norm() < 1e-11 * expected.norm());
}

BOOST_AUTO_TEST_CASE(loads_without_dual_numbers_are_refused) {
  BodyDescription body;
  body.name = "bob";
  body.joint.kind = JointKind::spherical;
  body.inertia = pendulum;
  body.loads = {ViscousDrag<>{0.1}, [](const LoadContext<>& s) -> Force<Body> {
                  return {{{0, 0, 0}, -0.1 * s.V_rel.value.resultant}};
                }};
  const BodySystem<RestingFrame<>> system({}, {body}, UniformGravity<Guide>{{0, 0, -9.81}});
  const auto names_the_body = [](const InvalidInput& error) {
    const std::string message = error.what();
    return message.find("'bob'") != std::string::npos &&
           message.find("template on the number type") != std::string::npos;
  };
  const Eigen::VectorXd rest = system.to_vector(system.rest());
  BOOST_CHECK_EXCEPTION((void)(linearize<Guide, Body>(system, 0, rest)), InvalidInput,
                        names_the_body);
  body.loads.pop_back();
  const BodySystem<RestingFrame<>> other({}, {body}, UniformGravity<Guide>{{0, 0, -9.81}});
  const auto linear = linearize<Guide, Body>(other, 0, rest);
  const double across = 0.3 + 2 * 1.5 * 1.5;
  BOOST_TEST(std::abs(linear.A(3, 3) + 0.1 / across) < 1e-15);
  BOOST_TEST(std::abs(linear.A(3, 0) + 2 * 9.81 * 1.5 / across) < 1e-14);
}

const InertiaTensor<Body> block{{2, {0, 0, -1}, {2.6, 2.6, 0.1}}};

BodySystem<RestingFrame<>> block_on(const Joint& joint, double stiffness = 0) {
  BodyDescription body{.name = "block", .joint = joint, .inertia = block};
  if (stiffness > 0) body.forces = {{.stiffness = stiffness}};
  return {RestingFrame<>{}, {body}, UniformGravity<Guide>{{0, 0, -9.81}}};
}

// No coordinate causes the fall, so that Newton's step is 0; the body is not at rest.
BOOST_AUTO_TEST_CASE(falling_bodies_have_no_equilibrium) {
  for (const JointKind kind : {JointKind::prismatic, JointKind::free}) {
    const auto falling = block_on({.kind = kind, .axis = {0, 0, 1}});
    const Eigen::VectorXd y = falling.to_vector(falling.rest());
    BOOST_CHECK_THROW((void)find_equilibrium(falling, 0, y), ComputationFailed);
  }
  for (const double stiffness : {1e-6, 1.0, 1e12}) {
    const auto held = block_on({.kind = JointKind::prismatic, .axis = {0, 0, 1}}, stiffness);
    const auto rest = find_equilibrium(held, 0, held.to_vector(held.rest()));
    BOOST_TEST(rest.state[0] == -2 * 9.81 / stiffness, boost::test_tools::tolerance(1e-14));
    BOOST_TEST(rest.neutral == 0);
    // At the held position it is not at rest.
    BOOST_CHECK_THROW((void)find_equilibrium(held, 0, held.to_vector(held.rest()), {{0, 1}}),
                      ComputationFailed);
  }
}

BOOST_AUTO_TEST_CASE(fixed_bodies_have_no_equations) {
  const auto still = block_on({});
  const Eigen::VectorXd nothing = still.to_vector(still.rest());
  BOOST_TEST(find_equilibrium(still, 0, nothing).neutral == 0);
  BOOST_TEST((linearize<Guide, Body>(still, 0, nothing).A.size()) == 0);
}

BOOST_AUTO_TEST_SUITE_END()
