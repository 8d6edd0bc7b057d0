// Spectra against 32-digit references (platform with three gyros) and closed forms.

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <string>
#include <vector>

#include <dynamics/gimbal/cardan_gyro_laws.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/study/campbell.hpp>
#include <dynamics/study/spectrum.hpp>
#include <motor/motor.hpp>

#include <support/json.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::number;

namespace {

using Complex = std::complex<double>;

struct Coefficients {
  Eigen::MatrixXd mass, damping, stiffness;
};

const Json& rotors() {
  static const Json json = test::reference_file("rotors.json");
  return json;
}

Vector3<double> vector(const Json& json) {
  return {number(json.at(0)), number(json.at(1)), number(json.at(2))};
}

Matrix3<double> matrix(const Json& json) {
  Matrix3<double> m;
  for (int i = 0; i < 3; ++i) m.row(i) = vector(json.at(std::size_t(i))).transpose();
  return m;
}

enum class Rotors { regulated, free };

/// The platform with three gyros in its normal position, linearized. Paper 000 (19) with its
/// missing term for quasi-velocities, (G_R)_kj = sum of l_i e_i.(J_k x J_j).
Coefficients platform(const Json& c, Rotors rotors_are) {
  const Json& model = rotors().at("models").at("platform");
  const Json& bodies = model.at("bodies");
  struct Placed {
    Vector3<double> axis, origin;
    Eigen::MatrixXd turning;  ///< J_w
  };
  std::vector<Placed> placed;
  Coefficients s;
  s.mass = Eigen::MatrixXd::Zero(8, 8);
  s.mass.topLeftCorner(3, 3) = matrix(model.at("root").at("I"));
  s.damping = s.stiffness = Eigen::MatrixXd::Zero(8, 8);
  Eigen::MatrixXd base = Eigen::MatrixXd::Zero(3, 8);
  base.leftCols(3).setIdentity();
  Eigen::Index joint = 3;
  std::size_t rotor = 0;
  for (const Json& body : bodies) {
    const int parent = body.at("parent").get<int>();
    const bool is_rotor = body.at("rotor").get<bool>();
    Placed p{vector(body.at("axis")), vector(body.at("r")), base};
    if (parent >= 0) {
      p.origin += placed[std::size_t(parent)].origin;
      p.turning = placed[std::size_t(parent)].turning;
    }
    Matrix3<double> I = matrix(body.at("I"));
    if (is_rotor) {
      const double l = number(c.at("L").at(rotor++));
      for (int k = 0; k < 8; ++k) {
        for (int j = 0; j < 8; ++j) {
          const Vector3<double> J_k = p.turning.col(k), J_j = p.turning.col(j);
          s.damping(k, j) += l * p.axis.dot(J_k.cross(J_j));
        }
      }
      const double C = p.axis.dot(I * p.axis);
      if (rotors_are == Rotors::free) I -= C * p.axis * p.axis.transpose();
    } else {
      p.turning.col(joint++) = p.axis;
    }
    // Centres of mass are on the joints' axes: their velocities come from the base alone.
    const Eigen::MatrixXd moving = -skew(p.origin) * base;
    s.mass += p.turning.transpose() * I * p.turning;
    s.mass += number(body.at("m")) * moving.transpose() * moving;
    placed.push_back(p);
  }
  s.mass = Eigen::MatrixXd((s.mass + s.mass.transpose()) / 2);
  s.damping = Eigen::MatrixXd((s.damping - s.damping.transpose()) / 2);
  for (Eigen::Index i = 0; i < 3; ++i) {
    s.stiffness(i, i) = number(c.at("base_stiffness"));
    s.damping(i, i) += number(c.at("base_damping"));
  }
  for (Eigen::Index i = 0; i < 5; ++i) {
    s.stiffness(3 + i, 3 + i) = number(c.at("frame_stiffness").at(std::size_t(i)));
    s.damping(3 + i, 3 + i) += number(c.at("frame_damping").at(std::size_t(i)));
  }
  return s;
}

/// The roots of a reference, without those with a negative imaginary part.
std::vector<Complex> upper_half(const Json& roots) {
  std::vector<Complex> upper;
  for (const Json& r : roots) {
    const Complex root(number(r.at(0)), number(r.at(1)));
    if (root.imag() > 1e-30) upper.push_back(root);
  }
  std::sort(upper.begin(), upper.end(),
            [](const Complex& a, const Complex& b) { return a.imag() < b.imag(); });
  return upper;
}

double residual(const Coefficients& c, const Mode& mode) {
  const Eigen::VectorXcd r = c.mass.cast<Complex>() * mode.shape * mode.root * mode.root +
                             c.damping.cast<Complex>() * mode.shape * mode.root +
                             c.stiffness.cast<Complex>() * mode.shape;
  return r.norm();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(spectra)

BOOST_AUTO_TEST_CASE(platform_agrees_with_the_reference) {
  const Json& c = rotors().at("eigenvalues").at("P_free_base_springs_only");
  double worst = 0;
  for (const auto rotor : {Rotors::regulated, Rotors::free}) {
    const auto* name =
        rotor == Rotors::free ? "eig_corrected_free_rotors_p_equal_L" : "eig_corrected_regulated";
    const std::vector<Complex> expected = upper_half(c.at(name));
    const auto modes = conservative_spectrum(platform(c, rotor));
    BOOST_REQUIRE(modes.size() == 8);
    BOOST_REQUIRE(expected.size() == 6);
    BOOST_TEST((modes[0].root == Complex(0) && modes[1].root == Complex(0)));
    for (std::size_t i = 0; i < 6; ++i) {
      const GyroscopicMode& mode = modes[i + 2];
      const double off = std::abs(mode.root.imag() / expected[i].imag() - 1);
      BOOST_TEST(mode.root.real() == 0);
      BOOST_TEST(off < 1e-12, expected[i].imag() << ": " << off);
      BOOST_TEST(std::abs(mode.root - expected[i]) <= mode.error);
      BOOST_TEST(mode.energy_sign == 1);
      BOOST_TEST(residual(platform(c, rotor), mode) < 1e-10);
      worst = test::worst_of(worst, off);
    }
  }
  BOOST_TEST_MESSAGE("platform: relative error " << worst);
}

BOOST_AUTO_TEST_CASE(damped_platform_agrees_with_the_reference) {
  double worst = 0;
  for (const char* name : {"P_free_base_springs_dampers", "P_servo_base_springs_dampers"}) {
    const Json& c = rotors().at("eigenvalues").at(name);
    for (const Json& r : c.at("eig_corrected_regulated")) {
      const Complex expected(number(r.at(0)), number(r.at(1)));
      if (std::abs(expected) < 1e-30) continue;
      const Mode* best = nullptr;
      const std::vector<Mode> modes = spectrum(state_matrix(platform(c, Rotors::regulated)));
      for (const Mode& mode : modes) {
        if (!best || std::abs(mode.root - expected) < std::abs(best->root - expected)) best = &mode;
      }
      const double off = std::abs(best->root - expected);
      BOOST_TEST(off <= best->error, name << ' ' << expected << ": " << off << ' ' << best->error);
      BOOST_TEST(off < 1e-12 * 270, name << ' ' << expected << ": " << off);
      worst = test::worst_of(worst, off);
    }
    BOOST_CHECK_THROW((void)conservative_spectrum(platform(c, Rotors::regulated)), InvalidInput);
  }
  BOOST_TEST_MESSAGE("damped platform: error " << worst << " rad/s");
}

// Two rings on a fixed base: L cos(beta_0)/sqrt(A B), the gyro of two rings.
BOOST_AUTO_TEST_CASE(gyro_in_two_rings_has_its_nutation) {
  const Json& all = rotors().at("eigenvalues");
  const Json& bodies = rotors().at("models").at("cardan").at("bodies");
  const auto I = [&](std::size_t body, int axis) {
    return matrix(bodies.at(body).at("I"))(axis, axis);
  };
  const double C = I(2, 0);
  for (const char* beta : {"0", "0.5", "1.0"}) {
    const double s = std::sin(std::stod(beta)), cosine = std::cos(std::stod(beta));
    const Json& c = all.at(std::string("cardan_nutation_beta0=") + beta + "_phidot=300");
    for (const bool free : {false, true}) {
      // Outer axis y; the inner ring has turned about z by beta, from rotor axis x.
      const double along = I(1, 0) + (free ? 0 : C);
      const double about_y = I(0, 1) + along * s * s + (I(1, 1) + I(2, 1)) * cosine * cosine;
      Coefficients g;
      g.mass = Eigen::Vector2d(about_y, I(1, 2) + I(2, 2)).asDiagonal();
      g.stiffness = Eigen::Matrix2d::Zero();
      g.damping.resize(2, 2);
      g.damping << 0, C * 300 * cosine, -C * 300 * cosine, 0;
      const auto modes = conservative_spectrum(g);
      const double expected =
          number(c.at(free ? "free_p_equal_L" : "regulated_L_cosb_over_sqrt_Astar_J5"));
      BOOST_TEST(std::abs(modes[1].root.imag() / expected - 1) < 1e-14, modes[1].root.imag()
                                                                            << ' ' << expected);
      BOOST_TEST((modes[1].kind() == ModeKind::nutation));
      BOOST_TEST((modes[0].root == Complex(0)));
    }
  }
}

// Three gyros whose frames hang on springs, one pair of frames with opposed momenta. The spring
// mode at 39.57 rad/s is no nutation although the spin makes it a little faster. The growth of each
// mode is compared with two spectra at different momenta.
BOOST_AUTO_TEST_CASE(gyros_on_a_base_separate_springs_and_spin) {
  const Json& all = rotors().at("eigenvalues");
  const Coefficients whole = platform(all.at("P_free_base_springs_only"), Rotors::regulated);
  const auto frames = [&whole](double momenta) {
    return Coefficients{whole.mass.bottomRightCorner(5, 5),
                        momenta * whole.damping.bottomRightCorner(5, 5),
                        whole.stiffness.bottomRightCorner(5, 5)};
  };
  const auto modes = conservative_spectrum(frames(1));
  BOOST_REQUIRE(modes.size() == 5);
  const double h = 1e-4;
  const auto more = conservative_spectrum(frames(1 + h)),
             less = conservative_spectrum(frames(1 - h));
  for (std::size_t i = 0; i < 5; ++i) {
    const double w = modes[i].root.imag();
    BOOST_TEST_MESSAGE(w << " rad/s grows as L^" << modes[i].spin_growth);
    const double slope = (more[i].root.imag() - less[i].root.imag()) / (2 * h * w);
    BOOST_TEST(std::abs(modes[i].spin_growth - slope) < 1e-7);
    const ModeKind kind = w < 3    ? ModeKind::precession
                          : w < 40 ? ModeKind::oscillation
                                   : ModeKind::nutation;
    BOOST_TEST((modes[i].kind() == kind));
  }
  const auto roots = upper_half(all.at("base_fixed_frames_springs").at("eig"));
  BOOST_TEST(std::abs(modes[2].root - roots[2]) < 1e-11);
  BOOST_TEST(std::abs(modes[2].root.imag() - 39.568) < 1e-3);
}

// A slow precession keeps its digits beside a nutation 1e8 times as fast.
BOOST_AUTO_TEST_CASE(slow_precession_keeps_its_digits) {
  const CardanMoments moments{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
  const CardanBearings springs{{2}, {1.5}};
  for (const double spin : {0.0, 1.0, 50.0, 1e3, 1e5}) {
    const auto f = cardan_frequencies(moments, springs, spin);
    const auto modes = conservative_spectrum(FoepplGyro<>(moments, springs, spin).coefficients());
    BOOST_TEST(std::abs(modes[0].root.imag() / f.precession - 1) < 1e-14,
               spin << ' ' << modes[0].root.imag() / f.precession - 1);
    BOOST_TEST(std::abs(modes[1].root.imag() / f.nutation - 1) < 1e-14);
  }
}

// Thomson and Tait: two unstable coordinates are stabilised if g^2 > 4 k. One of both modes has
// negative energy, and damping lets it grow.
BOOST_AUTO_TEST_CASE(gyroscopic_stabilisation_is_recognised) {
  Coefficients c;
  c.mass = Eigen::Matrix2d::Identity();
  c.stiffness = -Eigen::Matrix2d::Identity();
  c.damping.resize(2, 2);
  for (const double g : {2.5, 10.0}) {
    c.damping << 0, g, -g, 0;
    const auto modes = conservative_spectrum(c);
    BOOST_REQUIRE(modes.size() == 2);
    const double root = std::sqrt(g * g - 4);
    BOOST_TEST(std::abs(modes[0].root.imag() - 2 / (g + root)) < 1e-14);
    BOOST_TEST(std::abs(modes[1].root.imag() - (g + root) / 2) < 1e-13);
    BOOST_TEST((modes[0].root.real() == 0 && modes[1].root.real() == 0));
    BOOST_TEST((modes[0].energy_sign == -1 && modes[1].energy_sign == 1));
    BOOST_TEST((modes[0].kind() == ModeKind::precession));
    Coefficients damped = c;
    damped.damping += 1e-3 * Eigen::Matrix2d::Identity();
    int growing = 0;
    for (const Mode& mode : spectrum(state_matrix(damped))) {
      growing += mode.root.real() > 0 ? 1 : 0;
      if (mode.root.real() > 0) {
        BOOST_TEST(std::abs(std::abs(mode.root.imag()) - modes[0].root.imag()) < 1e-3);
      }
    }
    BOOST_TEST(growing == 2);
  }
  c.damping << 0, 1.9, -1.9, 0;
  const auto unstable = conservative_spectrum(c);
  BOOST_TEST(unstable.back().root.real() != 0);
}

// Circulatory torques: the precession is damped, the nutation grows (rotors.json). Also a double
// root without a second vector.
BOOST_AUTO_TEST_CASE(damped_and_circulatory_systems) {
  Coefficients c;
  c.mass = 0.002 * Eigen::Matrix2d::Identity();
  c.damping.resize(2, 2);
  c.stiffness.resize(2, 2);
  c.stiffness << 0, 0.02, -0.02, 0;
  for (const double d : {0.0, 1e-4}) {
    c.damping << d, 0.5, -0.5, d;
    const auto modes = spectrum(state_matrix(c));
    const Complex slow =
        d == 0 ? Complex(-0.03999999795, 6.399999181e-6) : Complex(-0.04000000019, 1.599999987e-6);
    const Complex fast =
        d == 0 ? Complex(0.03999999795, 250.0000064) : Complex(-0.009999999808, 249.9999984);
    BOOST_TEST(std::abs(modes[0].root - slow) < 1e-11, modes[0].root);
    BOOST_TEST(std::abs(modes[2].root - fast) < 1e-7, modes[2].root);
  }
  Eigen::Matrix2d jordan;
  jordan << 1, 1, 0, 1;
  for (const Mode& mode : spectrum(jordan)) {
    BOOST_TEST(std::abs(mode.root - 1.0) <= mode.error);
    BOOST_TEST(mode.error > 1e-9);
  }
  BOOST_CHECK_THROW((void)spectrum(Eigen::MatrixXd::Zero(2, 3)), InvalidInput);
  BOOST_CHECK_THROW((void)spectrum(Eigen::Matrix2d::Constant(HUGE_VAL)), InvalidInput);
  c.mass.setZero();
  BOOST_CHECK_THROW((void)state_matrix(c), InvalidInput);
}

// Each of the three matrices has its symmetry, and the mass is positive.
BOOST_AUTO_TEST_CASE(other_than_conservative_systems_are_refused) {
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d lame = one;
  lame(0, 1) = 1e-3;
  const auto refuses = [](const Coefficients& c) {
    BOOST_CHECK_THROW((void)conservative_spectrum(c), InvalidInput);
  };
  refuses({lame, 0 * one, one});
  refuses({one, 0 * one, lame});
  refuses({one, one, one});
  refuses({-one, 0 * one, one});
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(campbell_diagrams)

// A gyro between springs: nutation rises, precession falls, in agreement with the growth of each.
BOOST_AUTO_TEST_CASE(follow_nutation_and_precession) {
  const CardanMoments moments{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
  const CardanBearings springs{{2}, {1.5}};
  const auto at = [&](double spin) { return FoepplGyro<>(moments, springs, spin).coefficients(); };
  std::vector<double> spins;
  for (int i = 1; i <= 50; ++i) spins.push_back(2 * i);
  const CampbellDiagram diagram = campbell(at, spins);
  BOOST_TEST(diagram.frequency.rows() == 2);
  bool was_slow = false, was_fast = false;
  for (std::size_t i = 0; i < spins.size(); ++i) {
    const auto f = cardan_frequencies(moments, springs, spins[i]);
    const auto column = static_cast<Eigen::Index>(i);
    BOOST_TEST(std::abs(diagram.frequency(0, column) / f.precession - 1) < 1e-14);
    BOOST_TEST(std::abs(diagram.frequency(1, column) / f.nutation - 1) < 1e-14);
    const double h = 1e-4 * spins[i];
    const double slope = (cardan_frequencies(moments, springs, spins[i] + h).nutation -
                          cardan_frequencies(moments, springs, spins[i] - h).nutation) /
                         (2e-4 * f.nutation);
    BOOST_TEST(std::abs(diagram.modes[i][1].spin_growth - slope) < 1e-7);
    // The product of both frequencies depends on the springs only: one falls as the other rises.
    BOOST_TEST(std::abs(diagram.modes[i][0].spin_growth + slope) < 1e-7);
    const bool fast = slope > 0.5;
    BOOST_TEST((diagram.modes[i][0].kind() == ModeKind::precession) == fast);
    BOOST_TEST((diagram.modes[i][1].kind() == ModeKind::nutation) == fast);
    was_slow = was_slow || !fast;
    was_fast = was_fast || fast;
  }
  BOOST_TEST((was_slow && was_fast));
  BOOST_TEST(diagram.damping.norm() == 0);
}

// A spring that changes its sign turns one oscillation into two real roots.
BOOST_AUTO_TEST_CASE(end_if_a_mode_is_lost) {
  const auto at = [](double stiffness) {
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(1, 1);
    return Coefficients{one, 0 * one, stiffness * one};
  };
  BOOST_TEST(campbell(at, {3, 2, 1}).frequency.cols() == 3);
  BOOST_TEST(campbell(at, {}).frequency.size() == 0);
  BOOST_CHECK_THROW((void)campbell(at, {1, -1}), InvalidInput);
}

// Two independent gyros: their curves cross and are not confused.
BOOST_AUTO_TEST_CASE(allow_curves_to_cross) {
  const auto at = [](double spin) {
    Coefficients c;
    c.mass = Eigen::Matrix4d::Identity();
    c.stiffness = Eigen::Vector4d(1, 1, 9, 9).asDiagonal();
    c.damping = Eigen::Matrix4d::Zero();
    c.damping(0, 1) = 2 * spin;
    c.damping(1, 0) = -2 * spin;
    return c;
  };
  const CampbellDiagram diagram = campbell(at, {0.5, 1, 1.3, 1.6, 2, 4});
  // The nutation sqrt(1 + s^2) + s passes 3 at s = 4/3.
  for (Eigen::Index j = 0; j < 6; ++j) {
    const double s = diagram.parameter[std::size_t(j)];
    BOOST_TEST(std::abs(diagram.frequency(0, j) - (std::sqrt(1 + s * s) - s)) < 1e-14);
    BOOST_TEST(std::abs(diagram.frequency(1, j) - (std::sqrt(1 + s * s) + s)) < 1e-14 * 9);
    BOOST_TEST(std::abs(diagram.frequency(2, j) - 3) < 1e-14);
  }
  BOOST_TEST((diagram.modes[0][2].kind() == ModeKind::oscillation));
}

BOOST_AUTO_TEST_SUITE_END()
