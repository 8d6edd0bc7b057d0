// Paper 002 (44)-(48), completed, against the exact gyro on a turning guide: the order of the error
// in the angles, and the effect of each part of J_f.

#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <string>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/gyro_small_oscillations.hpp>
#include <dynamics/study/deviation.hpp>

#include <support/worst.hpp>

using namespace kreisel;

namespace {

const Vector3<double> symmetric(.005, .005, .008);
const Vector3<double> unsymmetric(.0055, .0045, .008);
const CardanBearings springs{{2}, {1.5}};
constexpr double speed = 50;

using Guiding = FrameMotion<Guide, Inertial>;

/// u = eps (3, -2, 4), which oscillates if `frequency` is not 0; or u_z = 4 for any eps.
struct Turning {
  double eps;
  double frequency;
  bool fast_z;

  Guiding operator()(double t) const {
    const Vector3<double> size(3 * eps, -2 * eps, fast_z ? 4 : 4 * eps);
    const Vector3<double> phase(0.3, 1.1, 2.0);
    Guiding motion;
    for (int i = 0; i < 3; ++i) {
      const double angle = frequency * t + (frequency != 0 ? phase[i] : 0);
      motion.V.value.resultant[i] = size[i] * std::cos(angle);
      motion.dV.value.resultant[i] = -frequency * size[i] * std::sin(angle);
    }
    return motion;
  }
};

struct Law {
  const char* name;
  Vector3<double> rotor;
  GuideMomentum kept;
  double frequency;
  bool fast_z;
  double order;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(small_oscillations_of_a_gyro)

BOOST_AUTO_TEST_CASE(err_in_the_stated_order) {
  using enum GuideMomentum;
  const std::array laws = {
      Law{"first order, constant u, symmetric", symmetric, first_order, 0, false, 3},
      Law{"first order, constant u", unsymmetric, first_order, 0, false, 3},
      Law{"first order, oscillating u, symmetric", symmetric, first_order, 30, false, 3},
      Law{"first order, oscillating u", unsymmetric, first_order, 30, false, 3},
      Law{"first order, u_z = 4, symmetric", symmetric, first_order, 0, true, 3},
      Law{"first order, u_z = 4", unsymmetric, first_order, 0, true, 3},
      Law{"(47), constant u, symmetric", symmetric, constant, 0, false, 2},
      Law{"(47), constant u", unsymmetric, constant, 0, false, 2},
      Law{"(47), oscillating u", unsymmetric, constant, 30, false, 2},
      Law{"(47), u_z = 4", unsymmetric, constant, 0, true, 1},
      Law{"Schuler, constant u, symmetric", symmetric, none, 0, false, 2},
      Law{"Schuler, constant u", unsymmetric, none, 0, false, 1},
      Law{"Schuler, oscillating u, symmetric", symmetric, none, 30, false, 1},
  };
  for (const Law& law : laws) {
    double before = 0;
    double order = 0;
    for (const double eps : {0.16, 0.08, 0.04, 0.02, 0.01, 0.005}) {
      const GyroSmallOscillations gyro(law.rotor, springs, speed,
                                       Turning{eps, law.frequency, law.fast_z}, law.kept);
      const auto off = greatest_deviation(gyro, {eps, -0.5 * eps, 5 * eps, 3 * eps}, 0, 0.2, 100);
      const double error = test::worst_of(off[0], off[1]);
      order = before != 0 ? std::log2(before / error) : 0;
      before = error;
    }
    // Over the last two samples: before, the next order is visible.
    BOOST_TEST(std::abs(order - law.order) < 0.05, law.name << ": " << order);
    BOOST_TEST_MESSAGE(law.name << ": order " << order << ", error " << before);
  }
}

// To first order in the angles they are exact, for any rate of the guide.
BOOST_AUTO_TEST_CASE(hold_on_a_fast_turning_guide) {
  const Turning turning{0.3, 30, true};
  for (const double t : {0.0137, 0.31}) {
    const GyroSmallOscillations gyro(unsymmetric, springs, speed, turning);
    Eigen::Vector2d before(0, 0);
    for (const double eps : {2e-4, 1e-4}) {
      const auto found = gyro.rates(t, {eps, -0.5 * eps, 5 * eps, 3 * eps});
      const auto truth = gyro.exact().rates(
          t, gyro.exact().to_vector({eps, -0.5 * eps, speed * t, 5 * eps, 3 * eps, speed}));
      const Eigen::Vector2d off = (found.tail<2>() - truth.segment<2>(3)).cwiseAbs();
      for (int i = 0; i < 2 && before[i] != 0; ++i) {
        const double order = std::log2(before[i] / off[i]);
        BOOST_TEST(order > 1.95, "component " << i << ": order " << order);
      }
      before = off;
    }
  }
}

BOOST_AUTO_TEST_CASE(have_friction_in_both_bearings) {
  const Turning turning{0.1, 30, false};
  const GyroSmallOscillations smooth(unsymmetric, springs, speed, turning);
  const GyroSmallOscillations rubbed(unsymmetric, {{2, 0.02}, {1.5, 0.03}}, speed, turning);
  const Eigen::Matrix2d more = rubbed.coefficients(0.7).damping - smooth.coefficients(0.7).damping;
  BOOST_TEST((more - Eigen::Matrix2d(Eigen::Vector2d(0.02, 0.03).asDiagonal())).norm() < 1e-15);
}

// Without the drive's torque the error has second order if u_z changes.
BOOST_AUTO_TEST_CASE(need_the_torque_of_the_drive) {
  struct WithoutDrive : GyroSmallOscillations<Turning> {
    using GyroSmallOscillations::GyroSmallOscillations;
    [[nodiscard]] Vector rates(double t, const Vector& y) const {
      Vector dy = GyroSmallOscillations::rates(t, y);
      const auto c = coefficients(t);
      const double dz = turning(exact_guide, t).du.z();
      const Eigen::Vector2d left_out(0, symmetric.z() * dz * y[0]);
      dy.tail<2>() += c.mass.inverse() * left_out;
      return dy;
    }
    Turning exact_guide;
  };
  double before = 0;
  double order = 0;
  for (const double eps : {0.02, 0.01, 0.005}) {
    WithoutDrive gyro(symmetric, springs, speed, Turning{eps, 30, false});
    gyro.exact_guide = {eps, 30, false};
    const auto off = greatest_deviation(gyro, {eps, -0.5 * eps, 5 * eps, 3 * eps}, 0, 0.2, 100);
    const double error = test::worst_of(off[0], off[1]);
    order = before != 0 ? std::log2(before / error) : 0;
    before = error;
  }
  BOOST_TEST(std::abs(order - 2) < 0.05, order);
}

// (46): J against the exact momentum of the rotor, at one time.
BOOST_AUTO_TEST_CASE(have_the_momentum_to_fourth_order) {
  const CardanGyro exact({unsymmetric}, {}, RestingFrame<>{}, RegulatedRotor{});
  const GyroSmallOscillations gyro(unsymmetric, {}, speed, RestingFrame<>{});
  const double t = 0.0137;
  Vector3<double> before = Vector3<double>::Zero();
  double as_printed_before = 0;
  for (const double eps : {0.04, 0.02, 0.01}) {
    const Vector3<double> J =
        exact.balance(t, {eps, -0.5 * eps, speed * t, 5 * eps, 3 * eps, speed}).angular_momentum;
    const Vector3<double> approximate =
        gyro.relative_momentum(t, {eps, -0.5 * eps, 5 * eps, 3 * eps});
    const Vector3<double> off = (J - approximate).cwiseAbs();
    const double as_printed =
        std::abs(J.z() - approximate.z() - unsymmetric.z() * speed * eps * eps * 1.25 / 2);
    if (before.x() != 0) {
      BOOST_TEST(std::abs(std::log2(before.x() / off.x()) - 3) < 0.05);
      BOOST_TEST(std::abs(std::log2(before.y() / off.y()) - 3) < 0.05);
      BOOST_TEST(std::abs(std::log2(before.z() / off.z()) - 4) < 0.05);
      BOOST_TEST(std::abs(std::log2(as_printed_before / as_printed) - 2) < 0.05);
    }
    before = off;
    as_printed_before = as_printed;
  }
}

BOOST_AUTO_TEST_CASE(refuse_large_angles) {
  const CardanBearings tilted{{2, 0, 0.5}, {}};
  const auto make = [](const CardanBearings& bearings, double omega) {
    return GyroSmallOscillations(symmetric, bearings, omega, RestingFrame<>{});
  };
  BOOST_CHECK_THROW((void)make(tilted, speed), InvalidInput);
  BOOST_CHECK_THROW((void)make(springs, std::nan("")), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
