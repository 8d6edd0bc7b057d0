// Laws of a Cardan gyro against its equations, and the equations of paper 002 in its own form,
// corrected and as printed.

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/cardan_gyro_laws.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/displacement.hpp>

#include <support/json.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::near;
using test::number;
using test::Sample;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

const Json& reference() {
  static const Json json = test::reference_file("cardan-gyro.json");
  return json;
}

const CardanMoments symmetric{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
const CardanMoments unsymmetric{{.0055, .0045, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
constexpr double degree = std::numbers::pi / 180;

bool close(double x, double y, double relative) {
  return std::abs(x - y) <= relative * std::abs(y);
}

/// Start of a drift case of the reference.
CardanGyro<RestingFrame<>>::State drift_start(const Json& c) {
  if (c.contains("case")) return {0, 1.2, 0, 0, 3.387, 50};  // T7, to within 5 degrees of 90
  return {0, 0.5, 0, 0, number(c.at("betadot0")), 50};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(laws_of_the_cardan_gyro)

// The drift over one nutation, with its length from the reference, and over a hundred.
BOOST_AUTO_TEST_CASE(drift_agrees_with_the_reference) {
  const CardanGyro gyro(symmetric, {}, RestingFrame<>{});
  double worst = 0;
  for (const Json& c : reference().at("drift").at("data")) {
    const double period = number(c.at("T"));
    const double mean = number(c.at("mean"));
    for (const int periods : {1, 100}) {
      const double t = periods * period;
      Integrator run(gyro, 0, drift_start(c));
      const double off = std::abs(run.to(t).alpha / t / mean - 1);
      worst = test::worst_of(worst, off);
      BOOST_TEST(off < 1e-10, c.at("b") << ", " << periods << " periods: " << off);
    }
  }
  BOOST_TEST_MESSAGE("drift: relative error " << worst);
}

// The law leaves out terms of second order in the amplitude only: a quarter at half of it.
BOOST_AUTO_TEST_CASE(drift_law_has_second_order) {
  double before = 0;
  for (const Json& c : reference().at("drift").at("data")) {
    const auto start = drift_start(c);
    const GimbalDrift law =
        gimbal_drift(symmetric, start.beta, start.alpha_rate, start.beta_rate, start.phi_rate);
    BOOST_TEST(close(law.drift, number(c.at("asym")), 1e-13));
    if (c.contains("case")) continue;  // not small
    BOOST_TEST(close(law.tilt, 0.5, 1e-15));
    const double off = number(c.at("mean")) / law.drift - 1;
    const double period_off =
        number(c.at("T")) * law.nutation_frequency / (2 * std::numbers::pi) - 1;
    const double w2 = law.nutation_amplitude * law.nutation_amplitude;
    BOOST_TEST_MESSAGE("w = " << law.nutation_amplitude << ": drift off by " << off
                              << ", period by " << period_off);
    BOOST_TEST(std::abs(off) < 1.2 * w2);
    BOOST_TEST(std::abs(period_off) < 1.2 * w2);
    if (before != 0) BOOST_TEST(std::abs(off / before - 4) < 0.1);
    before = off;
  }
}

// Both momenta are the gyro's own, including alpha', so that the tilt is constant along a motion.
BOOST_AUTO_TEST_CASE(tilt_follows_from_the_momenta) {
  const CardanGyro gyro(symmetric, {}, RestingFrame<>{});
  for (const auto& start : {CardanGyro<RestingFrame<>>::State{0, 0.5, 0, 7, 1, 50},
                            {0, -0.9, 0.3, 5, -2, 60},
                            {0, 0.2, 0, -6, 0, -40}}) {
    const CardanBalance exact = gyro.balance(0, start);
    const GimbalDrift law =
        gimbal_drift(symmetric, start.beta, start.alpha_rate, start.beta_rate, start.phi_rate);
    BOOST_TEST(close(law.rotor_momentum, exact.rotor_momentum, 1e-15));
    // J is a sum of four products, p of two: 8 roundings of terms no larger than p and H.
    BOOST_TEST(near(std::sin(law.tilt), exact.alpha_momentum / exact.rotor_momentum, 1.0, 8));
  }
}

BOOST_AUTO_TEST_CASE(massless_rings_cause_no_drift) {
  const CardanMoments bare{symmetric.rotor};
  BOOST_TEST(gimbal_drift(bare, 0.5, 0, 1, 50).drift == 0);
  // Nor if alpha' compensates the tilt: the gyro does not drift.
  const GimbalDrift still = gimbal_drift(symmetric, 0.5, 0, 0, 50);
  BOOST_TEST(still.nutation_amplitude < 1e-15);
  BOOST_CHECK_THROW((void)gimbal_drift(unsymmetric, 0.5, 0, 1, 50), InvalidInput);
  BOOST_CHECK_THROW((void)gimbal_drift(symmetric, 0.5, 100, 1, 0), InvalidInput);
  BOOST_CHECK_THROW((void)gimbal_drift(symmetric, 2, 0, 1, 50), InvalidInput);
}

BOOST_AUTO_TEST_CASE(frequencies_are_foeppls) {
  const Json& foeppl = reference().at("foeppl_T4");
  const CardanBearings springs{{2}, {1.5}};
  const CardanFrequencies f = cardan_frequencies(symmetric, springs, 50);
  BOOST_TEST(close(f.nutation, number(foeppl.at("omega_nutation")), 1e-15));
  BOOST_TEST(close(f.precession, number(foeppl.at("omega_precession")), 1e-15));
  // The nutation between no springs; 63.11 from the kinematics as printed.
  BOOST_TEST(close(cardan_frequencies(symmetric, {}, 50).nutation, 43.5142634576, 1e-11));
  BOOST_TEST(cardan_frequencies(symmetric, {}, 50).precession == 0);
  BOOST_TEST(
      close(cardan_frequencies(symmetric, springs, 0).nutation, std::sqrt(1.5 / .0065), 1e-15));
  BOOST_TEST(cardan_frequencies({{1, 1, 1}}, {}, 0).precession == 0);
}

// Massless rings follow the rotor's axis, which is fixed in space: on a turntable with rate u the
// axis appears as exp(-u t) n.
BOOST_AUTO_TEST_CASE(kinematic_gimbal_error_appears) {
  const Json* c = nullptr;
  for (const Json& t : reference().at("trajectories")) {
    if (t.at("name") == "T10_kinematic_gimbal_error") c = &t;
  }
  BOOST_REQUIRE(c != nullptr);
  const Vector3<double> u(0.3, -0.2, 0.5);
  const GimbalAngles start{0.1, -0.2};
  const auto s0 = riding_rates(start, 0.3, 60, u);
  BOOST_TEST(close(s0.alpha_rate, number(c->at("qd0").at(0)), 1e-15));
  BOOST_TEST(close(s0.beta_rate, number(c->at("qd0").at(1)), 1e-15));
  BOOST_TEST(close(s0.phi_rate, number(c->at("qd0").at(2)), 1e-15));
  const CardanGyro gyro({symmetric.rotor}, {}, RotatingFrame<>{u});
  Integrator run(gyro, 0, {s0.alpha, s0.beta, s0.phi, s0.alpha_rate, s0.beta_rate, s0.phi_rate});
  for (const Json& point : c->at("points")) {
    const double t = number(point.at("t"));
    const Matrix3<double> back = exp(Motor<double>{-u * t, {0, 0, 0}}).rotation;
    const GimbalAngles law = GimbalAngles::of(back * start.axis());
    const auto s = run.to(t);
    const auto rates = riding_rates(law, 0, 60, u);
    const auto both = [&](double mine, double formula, const char* name) {
      const double truth = number(point.at(name));
      BOOST_TEST(near(mine, truth, std::max(1.0, std::abs(truth)), 1e-13 / test::u<>, name));
      BOOST_TEST(near(formula, truth, std::max(1.0, std::abs(truth)), 1e-14 / test::u<>, name));
    };
    both(s.alpha, law.alpha, "alpha");
    both(s.beta, law.beta, "beta");
    both(s.alpha_rate, rates.alpha_rate, "alphadot");
    both(s.beta_rate, rates.beta_rate, "betadot");
    both(s.phi_rate, rates.phi_rate, "phidot");
    BOOST_TEST(close(s.phi, number(point.at("phi")), 1e-14));
  }
  BOOST_TEST((GimbalAngles::of({1, 0, 0}).beta == std::numbers::pi / 2));
  BOOST_TEST(GimbalAngles::of({1, 0, 0}).alpha == 0);
}

BOOST_AUTO_TEST_SUITE_END()

// The paper's own thirteen equations for thirteen unknowns.
BOOST_AUTO_TEST_SUITE(paper_002)

namespace {

using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;

enum class Kinematics { corrected, printed };

/// The unknowns of (35)-(39).
struct Unknowns {
  Vector3<double> du_1;  ///< .u'_A, .u'_B, .u'_C of the rotor
  Vector3<double> du_2;  ///< of the inner ring
  double du_a3;          ///< of the outer ring
  double M_A21, M_B21, M_A32, M_C32, M_BL, M_CL;
};

struct Situation002 {
  CardanMoments moments;
  Vector6 y;
  Vector3<double> u, du;      ///< of the guide, on guide axes
  double M_A3, M_B23, M_C12;  ///< known torques: springs and drive
};

/// The left side of (35) and (36) without .u':  Theta (.u) + (C - B)(u'_B + u_B)(u'_C + u_C) + ...
/// + Theta_A (u_B u'_C - u_C u'_B) + ...
Vector3<double> known_part(const Vector3<double>& theta, const Vector3<double>& own,
                           const Vector3<double>& u, const Vector3<double>& du) {
  const auto& [A, B, C] = std::array{theta.x(), theta.y(), theta.z()};
  const Vector3<double> w = own + u;
  return {A * du.x() + (C - B) * w.y() * w.z() + A * (u.y() * own.z() - u.z() * own.y()),
          B * du.y() + (A - C) * w.x() * w.z() + B * (u.z() * own.x() - u.x() * own.z()),
          C * du.z() + (B - A) * w.x() * w.y() + C * (u.x() * own.y() - u.y() * own.x())};
}

Unknowns thirteen(const Situation002& s, Kinematics kinematics) {
  const auto& [T_1, T_2, T_3] = s.moments;
  const double a = s.y[0], b = s.y[1], f = s.y[2], da = s.y[3], db = s.y[4], df = s.y[5];
  const double sb = std::sin(b), cb = std::cos(b), sf = std::sin(f), cf = std::cos(f);
  const Matrix3<double> X = Eigen::AngleAxisd(a, Vector3<double>::UnitX()).toRotationMatrix();
  const Matrix3<double> Y = Eigen::AngleAxisd(b, Vector3<double>::UnitY()).toRotationMatrix();
  const Matrix3<double> Z = Eigen::AngleAxisd(f, Vector3<double>::UnitZ()).toRotationMatrix();
  const Vector3<double> u_3 = X.transpose() * s.u, u_2 = Y.transpose() * u_3;
  const Vector3<double> u_1 = Z.transpose() * u_2, du_3 = X.transpose() * s.du;
  const Vector3<double> du_2 = Y.transpose() * du_3, du_1 = Z.transpose() * du_2;
  const bool corrected = kinematics == Kinematics::corrected;

  // u' of the three bodies from that of the rotor.
  const Vector3<double> own_1 =
      Z.transpose() * Vector3<double>(da * cb, db, da * sb) + Vector3<double>(0, 0, df);
  const double own_a2 = own_1.x() * cf - own_1.y() * sf;
  const double own_b2 = own_1.x() * sf + own_1.y() * cf;
  const double own_a3 = corrected ? own_a2 / cb : own_a2 * cb + own_1.z() * sb;
  const Vector3<double> own_2(own_a2, own_b2, corrected ? own_a3 * sb : own_1.z());
  const double spin = own_1.z() - (corrected ? own_2.z() : 0);  // phi'

  enum { uA, uB, uC, uA2, uB2, uC2, uA3, MA21, MB21, MA32, MC32, MBL, MCL };
  Eigen::Matrix<double, 13, 13> left = Eigen::Matrix<double, 13, 13>::Zero();
  Eigen::Matrix<double, 13, 1> right = Eigen::Matrix<double, 13, 1>::Zero();
  int row = 0;
  const auto equation = [&](std::vector<std::pair<int, double>> terms, double known) {
    for (const auto& [unknown, factor] : terms) left(row, unknown) += factor;
    right[row++] = known;
  };
  // (35)
  const Vector3<double> k_1 = known_part(T_1, own_1, u_1, du_1);
  equation({{uA, T_1.x()}, {MA21, cf}, {MB21, sf}}, -k_1.x());
  equation({{uB, T_1.y()}, {MA21, -sf}, {MB21, cf}}, -k_1.y());
  equation({{uC, T_1.z()}}, s.M_C12 - k_1.z());
  // (36)
  const Vector3<double> k_2 = known_part(T_2, own_2, u_2, du_2);
  equation({{uA2, T_2.x()}, {MA21, -1}, {MA32, cb}, {MC32, -sb}}, -k_2.x());
  equation({{uB2, T_2.y()}, {MB21, -1}}, s.M_B23 - k_2.y());
  equation({{uC2, T_2.z()}, {MA32, sb}, {MC32, cb}}, -s.M_C12 - k_2.z());
  // (37), third line with u_B3 as corrected; u_A3 etc. are the guide's
  const auto& [A, B, C] = std::array{T_3.x(), T_3.y(), T_3.z()};
  equation({{uA3, A}, {MA32, -1}}, s.M_A3 - A * du_3.x() - (C - B) * u_3.y() * u_3.z());
  equation({{MBL, 1}},
           s.M_B23 + B * du_3.y() + (A - C) * u_3.x() * u_3.z() + (A + B - C) * own_a3 * u_3.z());
  equation({{MCL, 1}, {MC32, 1}},
           C * du_3.z() + (B - A) * u_3.x() * u_3.y() - (A - B + C) * own_a3 * u_3.y());
  // (38), (39), differentiated
  equation({{uA2, 1}, {uA, -cf}, {uB, sf}}, -spin * own_b2);
  equation({{uB2, 1}, {uA, -sf}, {uB, -cf}}, spin * own_a2);
  if (corrected) {
    equation({{uA3, cb}, {uA2, -1}}, own_a3 * sb * own_b2);
    equation({{uC2, 1}, {uA3, -sb}}, own_a3 * cb * own_b2);
  } else {
    equation({{uC2, 1}, {uC, -1}}, 0);
    equation({{uA3, 1}, {uA2, -cb}, {uC, -sb}}, (own_1.z() * cb - own_a2 * sb) * own_b2);
  }
  const Eigen::Matrix<double, 13, 1> x = left.fullPivLu().solve(right);
  return {x.head<3>(), x.segment<3>(3), x[uA3], x[MA21], x[MB21], x[MA32], x[MC32], x[MBL], x[MCL]};
}

/// The paper's equations (40), at u = 0, first two lines: left side less right side. `power` of
/// sin beta is 1 as corrected, 2 as printed.
Eigen::Vector2d forty(const CardanMoments& m, const Vector6& y, const Vector3<double>& dqd,
                      double M_A3, double M_B23, int power) {
  const auto dual = [](double value, double rate) {
    return Dual(value, Eigen::Matrix<double, 1, 1>(rate));
  };
  const Dual b = dual(y[1], y[4]), f = dual(y[2], y[5]);
  const Dual da = dual(y[3], dqd[0]), db = dual(y[4], dqd[1]), df = dual(y[5], dqd[2]);
  const Dual sb = sin(b), cb = cos(b), sf = sin(f), cf = cos(f);
  using V = Eigen::Matrix<Dual, 3, 1>;
  const V w_2(Dual(da * cb), db, Dual(da * sb));
  const auto turned = [&](const V& v) {
    return V(Dual(v[0] * cf + v[1] * sf), Dual(v[1] * cf - v[0] * sf), v[2]);
  };
  V w_1 = turned(w_2);
  w_1[2] += df;
  V J_1, J_2;
  for (int k = 0; k < 3; ++k) J_1[k] = m.rotor[k] * w_1[k];
  for (int k = 0; k < 3; ++k) J_2[k] = m.inner_ring[k] * w_2[k];
  const V J_21 = turned(J_2);  // the ring's momentum on the rotor's axes
  const auto value = [](const Dual& x) { return x.value(); };
  const auto rate = [](const Dual& x) { return x.derivatives()[0]; };
  const double s = std::pow(value(sb), power);
  const double bracket =
      rate(J_2[2]) + value(J_2[1]) * value(w_2[0]) - value(J_2[0]) * value(w_2[1]);
  const double in_braces = M_A3 - m.outer_ring.x() * dqd[0] - bracket * s;
  const double uA = value(w_1[0]), uB = value(w_1[1]), uC = value(w_1[2]);
  const double first = rate(J_1[0]) + value(J_1[2]) * uB - value(J_1[1]) * uC -
                       (in_braces * value(cf) / value(cb) + M_B23 * value(sf) - rate(J_21[0]) -
                        value(J_21[2]) * uB + value(J_21[1]) * uC);
  const double second = rate(J_1[1]) + value(J_1[0]) * uC - value(J_1[2]) * uA -
                        (-in_braces * value(sf) / value(cb) + M_B23 * value(cf) - rate(J_21[1]) -
                         value(J_21[0]) * uC + value(J_21[2]) * uA);
  return {first, second};
}

struct Momentary {
  Vector3<double> u, du;

  FrameMotion<Guide, Inertial> operator()(double /*t*/) const {
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = u;
    motion.dV.value.resultant = du;
    return motion;
  }
};

Vector6 state_at_random(Sample& sample) {
  return (Vector6() << sample.uniform(-3, 3), sample.uniform(-1.3, 1.3), sample.uniform(-3, 3),
          sample.uniform(-3, 3), sample.uniform(-3, 3), sample.uniform(-60, 60))
      .finished();
}

}  // namespace

// On a moving base, with the kinematics corrected: the scene's accelerations and moments.
BOOST_AUTO_TEST_CASE(equations_35_to_39_corrected_are_the_scene) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Sample sample(seed);
    const Vector6 y = state_at_random(sample);
    const Momentary base{sample.vector(-1, 0), sample.vector(-1, 0)};
    const CardanMoments& m = sample.once_in(2) ? symmetric : unsymmetric;
    const CardanBearings springs{{2}, {1.5}};
    const double drive = 0.01;
    const CardanGyro gyro(m, springs, base, DrivenRotor{drive});
    const Vector6 dy = gyro.rates(0, y);
    const CardanReactions r = gyro.reactions(0, gyro.from_vector(y));
    const Unknowns x =
        thirteen({m, y, base.u, base.du, -2 * y[0], -1.5 * y[1], drive}, Kinematics::corrected);
    const double size = std::max(1.0, dy.tail<3>().norm());
    BOOST_TEST(near(x.du_a3, dy[3], size, 1e-12 / test::u<>, "alpha''"));
    BOOST_TEST(near(x.du_2.y(), dy[4], size, 1e-12 / test::u<>, "beta''"));
    const double moments[] = {
        x.M_A21 - r.rotor_on_inner_ring.x(),      x.M_B21 - r.rotor_on_inner_ring.y(),
        x.M_A32 - r.inner_ring_on_outer_ring.x(), x.M_C32 - r.inner_ring_on_outer_ring.z(),
        x.M_BL - r.guide_on_outer_ring.y(),       x.M_CL - r.guide_on_outer_ring.z()};
    for (const double off : moments) worst = test::worst_of(worst, std::abs(off));
  }
  BOOST_TEST_MESSAGE("moments off by " << worst);
  BOOST_TEST(worst < 1e-11);
}

// Two rings at rest turn with the rotor, by (38) third line and (39) as printed.
BOOST_AUTO_TEST_CASE(printed_38_39_turn_rings_at_rest) {
  const double u_c = 100, b = 30 * degree;
  BOOST_TEST(close(u_c * std::sin(b), 50, 1e-15));  // u'_A3 by (39); u'_C2 = 100 by (38)
  // and its effect on the acceleration
  const Vector6 y = (Vector6() << .3, .5, .7, .4, -.6, 50).finished();
  const Situation002 s{unsymmetric, y, {0, 0, 0}, {0, 0, 0}, -2 * .3, -1.5 * .5, 0};
  const Unknowns right = thirteen(s, Kinematics::corrected);
  const Unknowns wrong = thirteen(s, Kinematics::printed);
  BOOST_TEST(close(right.du_a3, -27.37623318, 1e-9));
  BOOST_TEST(close(right.M_A21, .4282157280, 1e-9));
  BOOST_TEST(close(wrong.du_a3, -36.92342598, 1e-9));
  BOOST_TEST(close(wrong.M_A21, .3680165670, 1e-9));
}

// The torque of (40) as printed and as corrected.
BOOST_AUTO_TEST_CASE(equation_40_has_the_sine_not_its_square) {
  double corrected = 0, printed = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Sample sample(seed);
    const Vector6 y = state_at_random(sample);
    const CardanGyro gyro(unsymmetric, {{2}, {1.5}}, RestingFrame<>{});
    const Vector3<double> dqd = gyro.rates(0, y).tail<3>();
    const auto off = [&](int power) {
      return forty(unsymmetric, y, dqd, -2 * y[0], -1.5 * y[1], power).norm();
    };
    corrected = test::worst_of(corrected, off(1));
    printed = test::worst_of(printed, off(2));
  }
  BOOST_TEST_MESSAGE("(40) off by " << corrected << ", as printed by " << printed);
  BOOST_TEST(corrected < 1e-13);
  BOOST_TEST(printed > 0.1);
  // By hand: all moments 1, at rest, beta = 30 degrees, M_A3 = 1.
  const CardanMoments ones{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
  const CardanGyro gyro(ones, {{1}, {}}, RestingFrame<>{});
  Vector6 y = Vector6::Zero();
  y[0] = -1;
  y[1] = 30 * degree;
  const Vector6 dy = gyro.rates(0, y);
  BOOST_TEST(close(dy[3], 4.0 / 11, 1e-15));
  const double M_A12 = -gyro.reactions(0, gyro.from_vector(y)).rotor_on_inner_ring.x();
  BOOST_TEST(close(M_A12, 0.314918, 2e-6));
  BOOST_TEST(close(M_A12 - forty(ones, y, dy.tail<3>(), 1, 0, 2)[0], 0.367405, 2e-6));
}

// At 90 degrees all is finite if the rings have mass. det M = C_1 (A_3 + C_2)(B_2 + Q) there.
BOOST_AUTO_TEST_CASE(equations_keep_their_meaning_at_90_degrees) {
  const CardanGyro gyro(symmetric, {}, RestingFrame<>{});
  const auto at = [&gyro](double t) { return Integrator(gyro, 0, {0, 1.2, 0, 0, 6, 50}).to(t); };
  const auto moment_at = [&](double beta) {  // bisection for the time at which beta is reached
    double low = 0, high = 0.08;
    for (int i = 0; i < 60; ++i) {
      const double t = (low + high) / 2;
      (at(t).beta < beta * degree ? low : high) = t;
    }
    const auto s = at(low);
    BOOST_TEST(gyro.rates(0, gyro.to_vector(s)).allFinite());
    return gyro.reactions(low, s).rotor_on_inner_ring.x();
  };
  BOOST_TEST(std::abs(moment_at(87.45) + 2.0826) < 1e-3);
  BOOST_TEST(std::abs(moment_at(90.206) + 2.0702) < 1e-3);
  BOOST_TEST(std::abs(moment_at(92.97) + 2.0869) < 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()
