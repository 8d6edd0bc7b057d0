// What a right-hand side costs, beside the least that can be written by hand for the same scene:
// doubles, no frames, unit quaternions, nothing that the scene does not need.

#include <Eigen/Geometry>
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/scene/cardan_gyro.hpp>
#include <dynamics/scene/euler_top.hpp>
#include <dynamics/scene/held_body.hpp>
#include <dynamics/scene/pendulum.hpp>

using namespace kreisel;

namespace {

using V3 = Vector3<double>;
using Top = EulerTop::Vector;
using Gyro = Eigen::Matrix<double, 6, 1>;

// --- A top held at a point -----------------------------------------------------------------------

const V3 top_moments(0.25, 0.27, 0.06);
const V3 top_weight(0.3, -0.2, 4);

struct TopByHand {
  V3 k;  // weight moment
  V3 inverse = top_moments.cwiseInverse();
  V3 difference{top_moments.y() - top_moments.z(), top_moments.z() - top_moments.x(),
                top_moments.x() - top_moments.y()};

  template <bool heavy>
  [[nodiscard]] Top rates(const Top& y) const {
    const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
    double A = difference.x() * b * c, B = difference.y() * c * a, C = difference.z() * a * b;
    if constexpr (heavy) {
      const double x = 2 * (qx * qz - qw * qy), v = 2 * (qy * qz + qw * qx);
      const double z = 1 - 2 * (qx * qx + qy * qy);
      A -= k.y() * z - k.z() * v;
      B -= k.z() * x - k.x() * z;
      C -= k.x() * v - k.y() * x;
    }
    return Top(0.5 * (qw * a + qy * c - qz * b), 0.5 * (qw * b + qz * a - qx * c),
               0.5 * (qw * c + qx * b - qy * a), -0.5 * (qx * a + qy * b + qz * c), A * inverse.x(),
               B * inverse.y(), C * inverse.z());
  }
};

// --- Pendulums on the earth ----------------------------------------------------------------------

const V3 earth(-5.15630e-5, 0, 5.15630e-5);  // rad/s, x south, z up
constexpr double gravity = 9.81;
constexpr double arm = 0.45;
const V3 ball_moments(0.25, 0.25, 0.01);

/// State: attitude and rate against the earth. The rate of R^t w_E is -u' x R^t w_E.
Top ball_by_hand(const Top& y) {
  const double qx = y[0], qy = y[1], qz = y[2], qw = y[3], a = y[4], b = y[5], c = y[6];
  const double r11 = 1 - 2 * (qy * qy + qz * qz), r31 = 2 * (qx * qz - qw * qy);
  const double r12 = 2 * (qx * qy - qw * qz), r32 = 2 * (qy * qz + qw * qx);
  const double r13 = 2 * (qx * qz + qw * qy), r33 = 1 - 2 * (qx * qx + qy * qy);
  const double ex = r11 * earth.x() + r31 * earth.z();
  const double ey = r12 * earth.x() + r32 * earth.z();
  const double ez = r13 * earth.x() + r33 * earth.z();
  const double wx = a + ex, wy = b + ey, wz = c + ez;
  const double A = ball_moments.x(), B = ball_moments.y(), C = ball_moments.z();
  const double dwx = ((B - C) * wy * wz - arm * gravity * r32) / A;
  const double dwy = ((C - A) * wz * wx + arm * gravity * r31) / B;
  const double dwz = (A - B) * wx * wy / C;
  return Top(0.5 * (qw * a + qy * c - qz * b), 0.5 * (qw * b + qz * a - qx * c),
             0.5 * (qw * c + qx * b - qy * a), -0.5 * (qx * a + qy * b + qz * c),
             dwx + (b * ez - c * ey), dwy + (c * ex - a * ez), dwz + (a * ey - b * ex));
}

const PendulumBody<> rod = PendulumBody<>::from_reduced_length(0.5);
const PendulumGuide<> meridian{{3e-5, 6e-5, 0}, V3::Zero(), {9.81, 0.01, 0}, {}};

/// (23) with E + 2 K cos, F and H put together beforehand.
struct PlaneByHand {
  double E, F, H, K;

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& y) const {
    const double s = std::sin(y[0]);
    const double c = std::cos(y[0]);
    return {y[1], -(s * (E + 2 * K * c) + F * c + H * (1 - 2 * s * s))};
  }
};

PlaneByHand plane_by_hand() {
  const PendulumCoefficients<> c = coefficients(rod, meridian);
  return {c.e() / rod.theta_c, c.f / rod.theta_c, c.h / rod.theta_c, c.k / rod.theta_c};
}

// --- The Cardan gyro -----------------------------------------------------------------------------

const CardanMoments moments{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4e-4}};
constexpr double outer_stiffness = 0.5, outer_damping = 1e-3, inner_stiffness = 1e3,
                 inner_damping = 2;
const V3 base(0.3, -0.2, 0.1);

/// Lagrange's equations on a base at rest; the rotor is symmetric and free.
Gyro gyro_by_hand(const Gyro& y) {
  constexpr double A_1 = 5e-4, C_1 = 8e-4, A_2 = 2e-4, B_2 = 3e-4, C_2 = 2.5e-4, A_3 = 4e-4;
  const double s = std::sin(y[1]), c = std::cos(y[1]);
  const double da = y[3], db = y[4], df = y[5];
  const double p = C_1 * (df + da * s);
  const double J = A_3 + (A_1 + A_2) * c * c + C_2 * s * s;
  const double g = (C_2 - A_1 - A_2) * s * c * da;
  const double dda = (-outer_stiffness * y[0] - outer_damping * da - (2 * g + p * c) * db) / J;
  const double ddb =
      (-inner_stiffness * y[1] - inner_damping * db + (g + p * c) * da) * (1 / (B_2 + A_1));
  return Gyro(da, db, df, dda, ddb, -(dda * s + da * db * c));
}

/// Euler's equations of the three bodies on a base that turns steadily.
Gyro gyro_on_base_by_hand(const Gyro& y) {
  constexpr double A_1 = 5e-4, C_1 = 8e-4, A_2 = 2e-4, B_2 = 3e-4, C_2 = 2.5e-4, A_3 = 4e-4;
  const double sa = std::sin(y[0]), ca = std::cos(y[0]), s = std::sin(y[1]), c = std::cos(y[1]);
  const double da = y[3], db = y[4], df = y[5];
  const double x3 = da + base.x(), y3 = base.y() * ca + base.z() * sa,
               z3 = base.z() * ca - base.y() * sa;
  const double dy3 = da * z3, dz3 = -da * y3;
  const double x2 = x3 * c - z3 * s, y2 = y3 + db, z2 = x3 * s + z3 * c;
  const double dx2 = -dz3 * s - db * z2, dz2 = dz3 * c + db * x2;
  const double H = C_1 * (z2 + df);
  const double a = (A_1 + A_2) * dx2 + (C_2 - B_2 - A_1) * y2 * z2 + y2 * H;
  const double b = (B_2 + A_1) * dy3 + (A_1 + A_2 - C_2) * z2 * x2 - x2 * H;
  const double cc = C_2 * dz2 + (B_2 - A_2) * x2 * y2;
  const double J = A_3 + (A_1 + A_2) * c * c + C_2 * s * s;  // the outer ring's B_3 = C_3
  const double dda = (-outer_stiffness * y[0] - outer_damping * da - (c * a + s * cc)) / J;
  const double ddb = (-inner_stiffness * y[1] - inner_damping * db - b) * (1 / (B_2 + A_1));
  return Gyro(da, db, df, dda, ddb, -(dz2 + dda * s));
}

// --- Both, timed and compared --------------------------------------------------------------------

constexpr std::size_t count = 64;  // inputs in turn, so that none is a constant

template <class Vector>
std::array<Vector, count> inputs(const Vector& y) {
  std::array<Vector, count> all;
  for (std::size_t i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / count;
    all[i] = y;
    all[i][y.size() - 2] *= 1 + 0.1 * part;
    all[i][y.size() - 1] *= 1 - 0.1 * part;
  }
  return all;
}

/// A quaternion of norm 1, which the hand-written take for granted.
const Top top_state = (Top() << 0.1, -0.5, 0.7, 0.5, 0.3, -2, 5).finished();
const Gyro gyro_state = (Gyro() << 0.02, 0.001, 3, 0.5, 0.01, 500).finished();
const Eigen::Vector2d plane_state(0.1, 0.3);

template <class Vector, class Field>
void time(benchmark::State& state, const Vector& start, const Field& field) {
  const auto all = inputs(start);
  for (auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) {
      Vector result = field(all[i]);
      benchmark::DoNotOptimize(result);
    }
  }
}

bool good = true;

/// Registers a field of the library and the same by hand; times of two that differ say nothing.
template <class Vector, class Field, class ByHand>
void pair(const std::string& name, const Vector& start, const Field& field, const ByHand& by_hand) {
  const Vector y = inputs(start)[7];
  const Vector f = field(y);
  const double off = (f - by_hand(y)).cwiseAbs().maxCoeff() / f.cwiseAbs().maxCoeff();
  if (!(off < 1e-13)) {
    std::fprintf(stderr, "fields: %s and the one by hand differ by %.1e\n", name.c_str(), off);
    good = false;
  }
  benchmark::RegisterBenchmark((name + "/library").c_str(),
                               [start, field](benchmark::State& s) { time(s, start, field); });
  benchmark::RegisterBenchmark((name + "/by_hand").c_str(),
                               [start, by_hand](benchmark::State& s) { time(s, start, by_hand); });
}

}  // namespace

int main(int argc, char** argv) {
  const EulerTop free(top_moments);
  const EulerTop heavy(top_moments, top_weight);
  const TopByHand hand{top_weight};
  const HeldBody ball(InertiaTensor<Body>::about_origin(1, {0, 0, -arm},
                                                        Matrix3<double>(ball_moments.asDiagonal())),
                      V3::Zero(), RotatingFrame<>{earth}, UniformGravity<Guide>{{0, 0, -gravity}});
  const PendulumField plane(rod, meridian);
  const CardanBearings bearings{{outer_stiffness, outer_damping}, {inner_stiffness, inner_damping}};
  const CardanGyro gyro(moments, bearings, RestingFrame<>{});
  const CardanGyro gyro_on_base(moments, bearings, RotatingFrame<>{base});

  pair(
      "free top", top_state, [=](const Top& y) { return free.rates(0, y); },
      [=](const Top& y) { return hand.rates<false>(y); });
  pair(
      "heavy top", top_state, [=](const Top& y) { return heavy.rates(0, y); },
      [=](const Top& y) { return hand.rates<true>(y); });
  pair(
      "plane pendulum on the earth", plane_state,
      [=](const Eigen::Vector2d& y) { return plane(0.0, y); }, plane_by_hand());
  pair(
      "ball pendulum on the earth", top_state, [=](const Top& y) { return ball.rates(0, y); },
      &ball_by_hand);
  pair(
      "Cardan gyro", gyro_state, [=](const Gyro& y) { return gyro.rates(0, y); }, &gyro_by_hand);
  pair(
      "Cardan gyro on a base that turns", gyro_state,
      [=](const Gyro& y) { return gyro_on_base.rates(0, y); }, &gyro_on_base_by_hand);
  if (!good) return EXIT_FAILURE;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
