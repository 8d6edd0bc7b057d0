// Admissibility of precession equations: the reference's examples, 10 digits.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <dynamics/study/precession_admissibility.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/tree/rotors_reference.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;
using test::numbers;

namespace {

using Complex = std::complex<double>;
using Eigen::Matrix2d, Eigen::Matrix4d, Eigen::MatrixXd;

const Matrix2d quarter = (Matrix2d() << 0, 1, -1, 0).finished();

const Json& examples() { return test::rotors_reference()["admissibility_examples"]; }

/// "(-0.04 + 6.4e-06j)"
Complex complex(const std::string& text) {
  std::size_t end = 0;
  const double real = std::stod(text.substr(1), &end);
  std::string rest = text.substr(1 + end);
  rest.erase(std::remove(rest.begin(), rest.end(), ' '), rest.end());
  return {real, std::stod(rest)};
}

/// The greatest distance of a reference root from the nearest computed one.
double off(const Json& roots, const std::vector<Complex>& found) {
  double worst = 0;
  for (const Json& root : roots) {
    const Complex truth = complex(root.get<std::string>());
    double least = 1e9;
    for (const Complex& s : found) least = std::min(least, std::abs(s - truth));
    worst = test::worst_of(worst, least);
  }
  return worst;
}

/// Both sets of roots of an example against the reference.
void check_roots(const char* name, const Admissibility& found, double precession_tolerance) {
  std::vector<Complex> precession, exact = found.fast;
  for (const SlowRoot& root : found.slow) {
    precession.push_back(root.precession);
    exact.push_back(root.exact);
  }
  const double a = off(examples()[name]["precession"], precession);
  const double b = off(examples()[name]["full"], exact);
  BOOST_TEST_MESSAGE(name << ": precession roots off by " << a << ", exact ones by " << b);
  BOOST_TEST(a <= precession_tolerance);
  double size = 0;
  for (const Complex& s : exact) size = std::max(size, std::abs(s));
  BOOST_TEST(b <= 5e-10 * size);  // ten digits are printed
}

GyroForces forces(const MatrixXd& A, const MatrixXd& G, const MatrixXd& D) {
  return {A, G, D, Eigen::VectorXd::Zero(A.rows())};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(precession_equations_are_admissible)

// det G != 0 and simple roots, but the nutations grow: circulatory torques.
BOOST_AUTO_TEST_CASE(unless_a_nutation_grows) {
  const Matrix2d A = .002 * Matrix2d::Identity();
  const auto found = [&](double d) {
    return admissibility(forces(A, .5 * quarter, d * Matrix2d::Identity()), .02 * quarter);
  };
  const Admissibility bare = found(0), damped = found(1e-4);
  check_roots("circulatory_d=0", bare, 1e-12);
  check_roots("circulatory_d=1e-4", damped, 1e-10);
  BOOST_TEST((bare.obstacle == Obstacle::growing_nutation));
  BOOST_TEST(std::abs(bare.fast_growth - .04) < 1e-8);
  BOOST_TEST(damped.admissible());
  BOOST_TEST(damped.rank == 2);
}

// Multiple roots alone are harmless: two gyros of one kind.
BOOST_AUTO_TEST_CASE(with_double_roots_that_have_two_shapes) {
  Matrix4d G = Matrix4d::Zero();
  G.topLeftCorner<2, 2>() = G.bottomRightCorner<2, 2>() = .5 * quarter;
  const auto found = admissibility(forces(.002 * Matrix4d::Identity(), G, Matrix4d::Zero()),
                                   .3 * Matrix4d::Identity());
  check_roots("double_roots_harmless", found, 1e-12);
  BOOST_TEST(found.admissible());
  BOOST_TEST(found.greatest_shift < 0.003);
}

// A root that lacks a shape is not: precession roots on the axis, exact ones beside it.
BOOST_AUTO_TEST_CASE(unless_a_double_root_lacks_a_shape) {
  Matrix4d K = Matrix4d::Zero();  // of q1 p2 - q2 p1 + (q1^2 + q2^2)/4
  K(0, 0) = K(1, 1) = .5;
  K(0, 3) = K(3, 0) = 1;
  K(1, 2) = K(2, 1) = -1;
  for (const double H : {10.0, 100.0}) {
    for (const double m : {1.0, 2.0}) {
      Matrix4d G = Matrix4d::Zero();
      G.topRightCorner<2, 2>() = H * Matrix2d::Identity();
      G.bottomLeftCorner<2, 2>() = -H * Matrix2d::Identity();
      const Eigen::Vector4d A(1, 1, m, 1);
      const auto found = admissibility(forces(A.asDiagonal(), G, Matrix4d::Zero()), K);
      const std::string name = std::string("defective_H") + (H > 50 ? "100" : "10") + "_m=(1," +
                               (m > 1 ? "2" : "1") + ",1,1)";
      check_roots(name.c_str(), found, 1e-8);
      BOOST_TEST((found.obstacle == Obstacle::defective));
    }
  }
}

// The neglected terms move a root by -s^2 y.A x / y.G x.
BOOST_AUTO_TEST_CASE(with_corrected_roots) {
  const Json& truth = examples()["slow_correction"];
  const Matrix2d A = Eigen::Vector2d(2.1e-3, 3.3e-4).asDiagonal();
  const Matrix2d K = Eigen::Vector2d(.4, .3).asDiagonal();
  const auto found = admissibility(forces(A, .08 * quarter, Matrix2d::Zero()), K);
  const auto size = [&](const char* key) {
    return std::abs(complex(truth[key].get<std::string>()));
  };
  const SlowRoot& root = found.slow[0];
  BOOST_TEST(std::abs(std::abs(root.precession) - size("precession")) < 1e-13);
  BOOST_TEST(std::abs(std::abs(root.exact) - size("exact")) < 1e-12);
  BOOST_TEST(std::abs(std::abs(root.first_order) - size("first_order")) < 1e-13);
  BOOST_TEST(found.admissible());
  // Twice as slow a rotor: no more.
  const auto slower = admissibility(forces(A, .04 * quarter, Matrix2d::Zero()), K);
  BOOST_TEST((slower.obstacle == Obstacle::not_slow));
}

// Five frames, rank 4: accelerations are kept on the kernel, because its damping does not dominate
// there.
BOOST_AUTO_TEST_CASE(for_the_platform_with_one_acceleration_kept) {
  const Json& all = test::rotors_reference()["eigenvalues"];
  for (const bool dampers : {false, true}) {
    const Json& c = all[dampers ? "P_free_base_springs_dampers" : "P_free_base_springs_only"];
    auto bodies =
        test::model_bodies("platform", test::Root::none, Json::object(), RotorMode::regulated);
    std::size_t frame = 0;
    for (BodyDescription& b : bodies) {
      if (b.rotor) continue;
      b.forces = {{.stiffness = number(c["frame_stiffness"][frame]),
                   .damping = number(c["frame_damping"][frame])}};
      ++frame;
    }
    const BodySystem<RestingFrame<>> system({}, bodies);
    auto s = system.rest();
    for (const int rotor : {2, 4, 7}) s.rates[rotor] = 1000;
    const PrecessionBodies model(system);
    const auto [place, u] = model.start(0, system.to_vector(s));
    const Eigen::MatrixXd K = stiffness(model, 0, place);
    const Eigen::VectorXd springs = numbers(c["frame_stiffness"]);
    BOOST_TEST((K - Eigen::MatrixXd(springs.asDiagonal())).norm() < 1e-11);
    const auto found = admissibility(model.forces(0, place), K);
    BOOST_TEST(found.rank == 4);
    BOOST_TEST(found.kernel.cols() == 1);
    BOOST_TEST(!found.kernel_overdamped);
    BOOST_TEST(found.admissible());
    BOOST_TEST(found.slow.size() == 6U);
    BOOST_TEST(found.fast.size() == 4U);
    if (dampers) continue;
    for (const double w : {2.2798, 2.9412, 39.5683}) {
      const auto near = [w](const SlowRoot& root) {
        return std::abs(root.precession - Complex(0, w)) < 1e-4;
      };
      BOOST_TEST(std::count_if(found.slow.begin(), found.slow.end(), near) == 1, w);
    }
    const char* key = "base_fixed_frames_springs";
    for (const Json& row : all[key]["eig"]) {
      const Complex truth(number(row[0]), number(row[1]));
      double least = 1e9;
      for (const SlowRoot& root : found.slow) least = std::min(least, std::abs(root.exact - truth));
      for (const Complex& root : found.fast) least = std::min(least, std::abs(root - truth));
      BOOST_TEST(least < 1e-10);
    }
  }
  // With enough damping the kernel needs no acceleration; without damping it is undetermined.
  const Eigen::Matrix3d G = (Eigen::Matrix3d() << 0, 1, 0, -1, 0, 0, 0, 0, 0).finished();
  const Eigen::Matrix3d A = 1e-3 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d D = Eigen::Vector3d(0, 0, .3).asDiagonal();
  const auto damped = admissibility(forces(A, G, D), Eigen::Matrix3d::Identity());
  BOOST_TEST(damped.kernel_overdamped);
  BOOST_TEST((damped.kept == KeptAccelerations::none));
  BOOST_TEST(damped.admissible());
  BOOST_TEST(damped.slow.size() == 3U);
}

BOOST_AUTO_TEST_SUITE_END()
