#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/gimbal/gyro_platform.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/tree/rotor_matrices.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;

namespace {

using Angles = GyroPlatform::Angles;
using Matrix8 = GyroPlatform::Matrix8;
using Vector8 = Eigen::Matrix<double, 8, 1>;

/// The model platform of the reference at 1000 rad/s.
GyroPlatform platform() {
  const Json& model = test::rotors_reference()["models"]["platform"];
  const auto body = [&](std::size_t i) -> const Json& { return model["bodies"][i]; };
  const auto part = [&](std::size_t i) -> GyroPlatform::Part {
    return {number(body(i)["m"]), test::rows(body(i)["I"]).diagonal()};
  };
  const auto wheel = [&](std::size_t i, Eigen::Index axis) -> GyroPlatform::Wheel {
    const Eigen::Vector3d moments = test::rows(body(i)["I"]).diagonal();
    return {number(body(i)["m"]), moments[axis], moments[(axis + 1) % 3]};
  };
  GyroPlatform p;
  p.platform = test::model_inertia(model["root"]);
  p.position_4 = numbers(body(0)["r"]);
  p.position_9 = numbers(body(5)["r"]);
  p.arm_5 = numbers(body(1)["r"])[1];
  p.arm_7 = numbers(body(3)["r"])[1];
  p.frame_4 = part(0);
  p.housing_5 = part(1);
  p.rotor_6 = wheel(2, 0);
  p.housing_7 = part(3);
  p.rotor_8 = wheel(4, 0);
  p.frame_9 = part(5);
  p.housing_10 = part(6);
  p.rotor_11 = wheel(7, 1);
  p.L = 1000 * p.spin_inertias();
  return p;
}

BodySystem<RestingFrame<>> loose(RotorMode mode) {
  return {RestingFrame<>{}, platform().bodies({.kind = JointKind::spherical}, mode)};
}

/// Indices of the five angles among eight, followed by the rotors.
constexpr int angle_places[] = {0, 1, 3, 5, 6};
constexpr int rotor_places[] = {2, 4, 7};

/// Without attitude, with the rotors at the rates of their momenta.
RotorMatrices matrices(RotorMode mode, const Angles& q, const Vector8& u) {
  const auto system = loose(mode);
  BodyWorkspace w = system.workspace();
  auto s = system.rest();
  s.rates.head(3) = u.head(3);
  for (int k = 0; k < 5; ++k) {
    s.coordinates[4 + angle_places[k]] = q[k];
    s.rates[3 + angle_places[k]] = u[3 + k];
  }
  for (const int rotor : rotor_places) s.rates[3 + rotor] = 1000;
  return rotor_matrices(system, 0, system.to_vector(s), w);
}

Angles some_angles() { return (Angles() << 0.7, -0.4, 0.9, 0.3, -0.8).finished(); }

double largest(const Eigen::MatrixXd& m) { return m.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(); }

}  // namespace

BOOST_AUTO_TEST_SUITE(the_gyro_platform)

BOOST_AUTO_TEST_CASE(agrees_with_the_reference_model) {
  const Json& truth = test::rotors_reference()["snapshots"]["platform_regulated"];
  const RotorMatrices m = matrices(RotorMode::regulated, numbers(truth["q"]), numbers(truth["u"]));
  BOOST_TEST(largest(m.A_eff - test::rows(truth["A_eff"])) <= 1e-15);
  BOOST_TEST(largest(m.G_R - test::rows(truth["G_R"])) <= 1e-15);
}

BOOST_AUTO_TEST_CASE(has_matrices_21_to_24_and_26) {
  const GyroPlatform p = platform();
  const Angles q = some_angles();
  const Vector8 none = Vector8::Zero();
  const RotorMatrices wide = matrices(RotorMode::regulated, q, none);
  BOOST_TEST(largest(GyroPlatform::spin_rows(q) - wide.B) <= 1e-15);
  BOOST_TEST(largest(p.spin_inertias() - wide.C) == 0);

  const Angles zero = Angles::Zero();
  const RotorMatrices rest = matrices(RotorMode::regulated, zero, none);
  BOOST_TEST(largest(p.carrier_inertia(zero) - rest.A) <= 1e-15);
  BOOST_TEST(largest(p.spin_inertia(zero) - (rest.A_eff - rest.A)) <= 1e-15);
  BOOST_TEST(largest(p.gyroscopic(zero) - rest.G_R) <= 1e-15);
  BOOST_TEST(largest(p.gyroscopic(zero, true) - rest.G_R) > 0.1);

  // The remainder is odd in the angles, so of third order.
  const double small = 1e-3;
  const RotorMatrices a = matrices(RotorMode::regulated, small * q, none);
  const RotorMatrices b = matrices(RotorMode::regulated, -small * q, none);
  const auto first_order = [&](const Matrix8& above, const Eigen::MatrixXd& x,
                               const Eigen::MatrixXd& y, const Matrix8& at_rest) {
    const Eigen::MatrixXd odd = (x - y) / (2 * small);
    const double error = largest((above - at_rest) / small - odd);
    BOOST_TEST_MESSAGE("of first order " << largest(odd) << ", off by " << error);
    return error;
  };
  const double third = 2 * small * small;
  BOOST_TEST(first_order(p.carrier_inertia(small * q), a.A, b.A, p.carrier_inertia(zero)) <=
             third * largest(p.carrier_inertia(small * q) - p.carrier_inertia(zero)) / small);
  BOOST_TEST(first_order(p.spin_inertia(small * q), a.A_eff - a.A, b.A_eff - b.A,
                         p.spin_inertia(zero)) <= third * largest(p.spin_inertia(zero)));
  BOOST_TEST(first_order(p.gyroscopic(small * q), a.G_R, b.G_R, p.gyroscopic(zero)) <=
             third * largest(p.gyroscopic(zero)));
}

// The part of C in the forces of motion: (25) and, in rows 1-3, W x (B^t A_R B u).
BOOST_AUTO_TEST_CASE(has_the_matrix_25_at_zero_angles) {
  const GyroPlatform p = platform();
  const Angles zero = Angles::Zero();
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    test::Sample sample(seed);
    Vector8 u;
    for (double& x : u) x = sample.uniform(-3, 3);
    const Vector3<double> W = u.head(3);
    const Vector8 found = p.spin_inertia_rate(W, u.tail(5)) * u;
    Vector8 truth =
        matrices(RotorMode::regulated, zero, u).c - matrices(RotorMode::free, zero, u).c;
    truth.head(3) -= W.cross(Vector3<double>((p.spin_inertia(zero) * u).head(3)));
    BOOST_TEST(largest(found - truth) <= 1e-15);
    // Energy conservation requires it: (11) gives u^t G_A u = u^t A*' u/2, which a skew G_A cannot.
    BOOST_TEST((seed > 0 || std::abs(u.dot(found)) > 1e-5));
  }
}

// Nutations and precessions about rest, with the effect of the missing block 1-3.
BOOST_AUTO_TEST_CASE(swings_at_the_frequencies_of_the_reference) {
  const GyroPlatform p = platform();
  const Angles zero = Angles::Zero();
  for (const char* name : {"P_free_base_springs_only", "P_free_base_springs_dampers",
                           "P_servo_base_springs_dampers"}) {
    const Json& c = test::rotors_reference()["eigenvalues"][name];
    for (const bool as_printed : {false, true}) {
      Matrix8 K = Matrix8::Zero(), D = Matrix8::Zero();
      K.diagonal().head(3).setConstant(number(c["base_stiffness"]));
      D.diagonal().head(3).setConstant(number(c["base_damping"]));
      K.diagonal().tail(5) = numbers(c["frame_stiffness"]);
      D.diagonal().tail(5) = numbers(c["frame_damping"]);
      const Matrix8 A = p.carrier_inertia(zero) + p.spin_inertia(zero);
      Eigen::MatrixXd F = Eigen::MatrixXd::Zero(16, 16);
      F.topRightCorner(8, 8).setIdentity();
      F.bottomLeftCorner(8, 8) = -A.ldlt().solve(K);
      F.bottomRightCorner(8, 8) = -A.ldlt().solve(Matrix8(D + p.gyroscopic(zero, as_printed)));
      const Eigen::VectorXcd found = eigenvalues(F);
      double worst = 0;
      for (const Json& root : c[as_printed ? "eig_printed26" : "eig_corrected_regulated"]) {
        const std::complex<double> truth(number(root[0]), number(root[1]));
        // Zero is a root of multiplicity four or more, which rounding splits.
        if (std::abs(truth) < 1e-9) continue;
        worst = test::worst_of(
            worst, (found.array() - truth).abs().minCoeff<Eigen::PropagateNaN>() / std::abs(truth));
      }
      BOOST_TEST_MESSAGE(name << (as_printed ? ", as printed: " : ": ") << worst);
      BOOST_TEST(worst <= 1e-11);
    }
  }
}

// At any motion of the platform: the complete equations against bodies on the same moving guide.
BOOST_AUTO_TEST_CASE(complete_equations_contain_the_linear_ones) {
  const GyroPlatform p = platform();
  double worst = 0;
  double wrong = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    test::Sample sample(seed);
    const auto angles = [&](double size) {
      Angles a;
      for (double& x : a) x = sample.uniform(-size, size);
      return a;
    };
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = 2 * sample.direction();
    motion.dV.value.resultant = 3 * sample.direction();
    const Vector3<double>& W = motion.V.value.resultant;
    const Vector3<double>& dW = motion.dV.value.resultant;
    const auto guide = [motion](double) { return motion; };
    const BodySystem<std::decay_t<decltype(guide)>> system(
        guide, p.bodies({.kind = JointKind::fixed}, RotorMode::regulated));
    BodyWorkspace w = system.workspace();
    const auto exact = [&](const Angles& q, const Angles& dq) {
      auto s = system.rest();
      for (int k = 0; k < 5; ++k) {
        s.coordinates[angle_places[k]] = q[k];
        s.rates[angle_places[k]] = dq[k];
      }
      for (const int rotor : rotor_places) s.rates[rotor] = 1000;
      Eigen::VectorXd dv;
      system.accelerations(0, system.to_vector(s), {}, dv, w);
      Angles result;
      for (int k = 0; k < 5; ++k) result[k] = dv[angle_places[k]];
      return result;
    };
    const Angles q = angles(1), dq = angles(1), none = Angles::Zero();
    const auto linear = [&](PlatformEquations equations, const Angles& a, const Angles& b) {
      return p.linear_accelerations(equations, W, dW, a, b, none);
    };
    const Angles still = exact(none, none);
    const double small = 1e-4;
    const Angles slope =
        (exact(small * q, small * dq) - exact(-small * q, -small * dq)) / small / 2;
    const auto errors = [&](PlatformEquations equations) {
      const Angles at_rest = linear(equations, none, none);
      const Angles change = linear(equations, q, dq) - at_rest;
      return std::pair{largest(at_rest - still) / largest(still),
                       largest(change - slope) / largest(slope)};
    };
    const auto [at_rest, slopes] = errors(PlatformEquations::complete);
    BOOST_TEST(at_rest <= 1e-13);
    BOOST_TEST(slopes <= 1e-6);
    worst = test::worst_of(worst, slopes);
    wrong = test::worst_of(wrong, errors(PlatformEquations::printed).first);
    BOOST_TEST(errors(PlatformEquations::corrected).first <= 0.1);
  }
  BOOST_TEST_MESSAGE("complete (27) off by " << worst << ", the printed one's constants by "
                                             << wrong);
  BOOST_TEST(wrong > 0.5);
}

// A gently moved platform: the range of (27), and the effect of its printed sign in row 5.
BOOST_AUTO_TEST_CASE(follows_a_moved_platform_by_27) {
  const GyroPlatform p = platform();
  const char* name = "T10_platform_prescribed_Omega_regulated";
  const Json& springs = test::rotors_reference()["trajectories"][name]["springs_dampers_const"];
  const Json& truth = test::rotors_reference()["eq27_vs_exact"][name];
  Angles stiffness, damping;
  int k = 0;
  for (const char* axis : {"frame4", "housing5", "housing7", "frame9", "housing10"}) {
    stiffness[k] = number(springs[axis]["k"]);
    damping[k++] = number(springs[axis]["d"]);
  }
  for (const auto& [equations, key, error] :
       {std::tuple{PlatformEquations::complete, "complete", 3.9e-5},
        {PlatformEquations::corrected, "corrected", 4.0e-5},
        {PlatformEquations::printed, "printed", 1.36e-2}}) {
    const PlatformEquations which = equations;
    const auto field = [&p, &stiffness, &damping, which](double t, const Eigen::VectorXd& y,
                                                         Eigen::VectorXd& rate) {
      const Vector3<double> W(0.02 + 0.05 * std::sin(1.5 * t), 0.03 * std::cos(2 * t),
                              -0.04 + 0.03 * std::sin(t));
      const Vector3<double> dW(0.075 * std::cos(1.5 * t), -0.06 * std::sin(2 * t),
                               0.03 * std::cos(t));
      const Angles q = y.head(5), dq = y.tail(5);
      const Angles Q = -stiffness.cwiseProduct(q) - damping.cwiseProduct(dq);
      rate.resize(10);
      rate << dq, p.linear_accelerations(which, W, dW, q, dq, Q);
    };
    ExplicitRungeKutta steps(field, 0.0, Eigen::VectorXd(Eigen::VectorXd::Zero(10)),
                             {.relative = 1e-12, .absolute_scale = 1e-3}, std::vector<int>(10, 1));
    double off = 0;
    double from_exact = 0;
    std::size_t row = 0;
    for (const double t : {0.25, 0.5, 1.0}) {
      const Angles found = steps.advance_to(t).head(5);
      off = test::worst_of(off, largest(found - numbers(truth[key]["angles"][row])));
      from_exact = test::worst_of(from_exact, largest(found - numbers(truth["exact"][row])));
      ++row;
    }
    BOOST_TEST_MESSAGE(key << ": " << off << " from the reference, " << from_exact
                           << " rad from the exact motion");
    BOOST_TEST(off <= 1e-12);
    BOOST_TEST(std::abs(from_exact - error) <= 0.05 * error);
  }
}

BOOST_AUTO_TEST_SUITE_END()
