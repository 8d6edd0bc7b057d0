// Rotors in linear equations: an unsymmetric rotor near its unstable ranges, and the modes of a
// platform with three gyros.

#include <Eigen/LU>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/study/floquet.hpp>
#include <dynamics/study/spectrum.hpp>

#include "platform.hpp"
#include "trial.hpp"
#include <tests/support/worst.hpp>

namespace stability {

namespace {

using namespace kreisel;
using Real = long double;
using Matrix4 = Eigen::Matrix<Real, 4, 4>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double u = std::numeric_limits<double>::epsilon() / 2;

/// exp(A), by halving and Taylor's series.
Matrix4 exponential(Matrix4 A) {
  int halvings = 0;
  for (; A.cwiseAbs().rowwise().sum().maxCoeff() > 0.1L; A /= 2) ++halvings;
  Matrix4 sum = Matrix4::Identity();
  Matrix4 term = Matrix4::Identity();
  for (int k = 1; k < 20; ++k) {
    term = Matrix4(term.lazyProduct(A)) / k;
    sum += term;
  }
  for (int k = 0; k < halvings; ++k) sum = Matrix4(sum.lazyProduct(sum));
  return sum;
}

/// A rotor without rings in two equal springs, on its own axes, where its coefficients are constant:
///
///   D z'' + Omega (A + B - C) J z' + (c + Omega^2 diag(C - B, C - A)) z = 0,   J = (0 -1; 1 0)
struct OnItsAxes {
  Real A, B, C, stiffness, speed;

  /// k_1 and k_2 of EqualSpringsRange.
  [[nodiscard]] std::array<Real, 2> springs() const {
    return {stiffness + speed * speed * (C - B), stiffness + speed * speed * (C - A)};
  }

  /// The squares of the roots, the greater first.
  [[nodiscard]] std::array<Real, 2> squares() const {
    const auto [k_1, k_2] = springs();
    const Real E = A + B - C;
    const Real b = A * k_2 + B * k_1 + speed * speed * E * E;
    const Real root = std::sqrt(std::max(b * b - 4 * A * B * k_1 * k_2, Real(0)));
    const Real far = -(b + root) / (2 * A * B);
    return {k_1 * k_2 / (A * B * far), far};
  }

  [[nodiscard]] Real period() const { return std::numbers::pi_v<Real> / std::abs(speed); }

  /// The transition matrix over one period, in which the axes have made half a turn, on  (x, x').
  [[nodiscard]] Matrix4 transition() const {
    const auto [k_1, k_2] = springs();
    const Real g = speed * (A + B - C);
    // The rate in units of the speed.
    Matrix4 field;
    field << 0, 0, speed, 0,            //
        0, 0, 0, speed,                 //
        -k_1 / A / speed, 0, 0, g / A,  //
        0, -k_2 / B / speed, -g / B, 0;
    Matrix4 to_x = Matrix4::Identity();
    to_x(2, 1) = -speed;
    to_x(3, 0) = speed;
    to_x(2, 2) = to_x(3, 3) = speed;
    const Matrix4 grown = to_x.lazyProduct(exponential(field * period()));
    return -grown.lazyProduct(Matrix4(to_x.inverse()));
  }
};

/// Verdict, growth and transition matrix near the limits of the unstable range. The last digits of
/// A, B and C have an effect of A/B times as much, which the matrix's error does not contain.
void beside_limit(const Recorder& out, const std::string& what, const Vector3<double>& rotor,
                  double stiffness, double limit) {
  double worst_growth = 0;
  double worst_transition = 0;
  int undecided = 0;
  const EqualSpringsRange range = EqualSpringsRange::of(rotor, stiffness);
  out.begin(what, "Floquet");
  for (const double off : {-1e-1, -1e-3, -1e-6, -1e-9, -1e-12, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1}) {
    const double speed = std::copysign(limit * (1 + off), off);
    const UnsymmetricRotor<> gyro({rotor}, {{stiffness}, {stiffness}}, speed);
    const auto X =
        linear_transition<4>([&](double t) { return gyro.state_matrix(t); }, 0, gyro.period());
    const OnItsAxes truth{rotor.x(), rotor.y(), rotor.z(), stiffness, speed};
    const Eigen::Matrix4d wrong =
        (X.matrix.cast<Real>() - truth.transition()).cwiseAbs().cast<double>();
    // Rates in units of the speed, so that no number is small in other units.
    const Eigen::Vector4d units(1, 1, std::abs(speed), std::abs(speed));
    const Eigen::Matrix4d scale = units * units.cwiseInverse().transpose();
    const double size = X.matrix.cwiseQuotient(scale).cwiseAbs().maxCoeff();
    const double digits = 4 * u * rotor.x() / rotor.y();
    worst_transition = test::worst_of(
        worst_transition,
        wrong.cwiseQuotient(X.error + digits * size * scale).maxCoeff<Eigen::PropagateNaN>());

    const PairedMultipliers m = PairedMultipliers::of(X);
    const auto [growing, swinging] = truth.squares();
    const bool unstable = std::abs(speed) > range.begin && std::abs(speed) < range.end;
    const double l = unstable ? double(std::exp(std::sqrt(growing) * truth.period())) : 1;
    if (m.verdict() == Stability::undecided) {
      undecided += 1;
      if (l > 1.001) worst_growth = inf;
    } else if ((m.verdict() == Stability::unstable) != unstable) {
      worst_growth = inf;
    } else if (unstable) {
      const double z_1 = -(l + 1 / l);
      const double z_2 = -2 * double(std::cos(std::sqrt(-swinging) * truth.period()));
      const double known = m.one_error() + digits * size * size;
      const double bound = 4 * known / (std::abs(z_1 - z_2) * (l - 1 / l)) + 4 * u;
      worst_growth = test::worst_of(worst_growth, std::abs(m.growth() / l - 1) / bound);
    }
  }
  expect_below(out, what + ": error of the growth over its bound", "Floquet", worst_growth, 1,
               fmt::format("{} of 10 speeds undecided", undecided));
  expect_below(out, what + ": error of the transition matrix over the reported one",
               "linear_transition", worst_transition, 1);
}

void unsymmetric_rotor(const Recorder& out) {
  struct Shape {
    const char* what;
    Vector3<double> rotor;
  };
  const Shape shapes[] = {{"A/B = 1 + 1e-10", {1 + 1e-10, 1, 0.5}},
                          {"A/B = 1.1", {1.1, 1, 0.5}},
                          {"a plate, A = B + C", {1.5, 1, 0.5}},
                          {"A/B = 1e3", {1, 1e-3, 0.9995}}};
  for (const auto& [shape, rotor] : shapes) {
    for (const double stiffness : {1e-6, 1.0, 1e12}) {
      const EqualSpringsRange range = EqualSpringsRange::of(rotor, stiffness);
      for (const double limit : {range.begin, range.end}) {
        if (limit == inf) continue;
        beside_limit(out,
                     fmt::format("{}, {:g} N m/rad, beside {:.4g} rad/s", shape, stiffness, limit),
                     rotor, stiffness, limit);
      }
    }
  }
  const CardanMoments moments{{1.1, 1, 0.5}};
  for (const double speed : {0.0, nan, inf}) {
    expect_refusal(out, fmt::format("speed = {}", speed), "UnsymmetricRotor",
                   [&] {
                     UnsymmetricRotor<>(moments, {{1}, {1}}, speed);
                   },
                   {"speed"});
  }
  for (const double stiffness : {-1.0, nan, inf}) {
    expect_refusal(out, fmt::format("stiffness = {}", stiffness), "UnsymmetricRotor", [&] {
      UnsymmetricRotor<>(moments, {{stiffness}, {1}}, 1);
    });
  }
  for (const double speed : {1e-160, 1e160}) {
    const std::string what = fmt::format("speed = {:g}", speed);
    out.begin(what, "Floquet");
    try {
      const UnsymmetricRotor<> gyro(moments, {{1}, {1}}, speed);
      const auto verdict = paired_multipliers(gyro, {.max_evaluations = 1e5}).verdict();
      // Without a significant spring C = 0.5 < B decides: the rotor is stable at any speed above
      // the range.
      expect_below(out, what, "Floquet", verdict == Stability::unstable ? 1 : 0, 0.5);
    } catch (const kreisel::Error& error) {
      add_refusal(out, what, "Floquet", error.what());
    }
  }
}

struct Coefficients {
  GyroPlatform::Matrix8 mass, damping, stiffness;
};

Coefficients on_springs(double speed, double stiffness) {
  const GyroPlatform p = platform(speed);
  const GyroPlatform::Angles none = GyroPlatform::Angles::Zero();
  Coefficients c{p.carrier_inertia(none) + p.spin_inertia(none), p.gyroscopic(none), {}};
  c.stiffness.setZero().diagonal().tail<5>().setConstant(stiffness);
  return c;
}

/// The error of a root of  det(s^2 M + s G + K) = 0:  Newton's correction, by elimination in 64
/// bits.
///
///   d ln det / ds = trace(P^-1 P'),   P = s^2 M + s G + K
double correction(const Coefficients& c, const std::complex<double>& root) {
  using Complex = std::complex<Real>;
  constexpr int n = 8;
  const Complex s(root.real(), root.imag());
  Eigen::Matrix<Complex, n, 2 * n> P;  // and P' on its right
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Real m = c.mass(i, j);
      const Real g = c.damping(i, j);
      P(i, j) = s * s * m + s * g + Real(c.stiffness(i, j));
      P(i, n + j) = Real(2) * s * m + g;
    }
  }
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i) {
      if (std::abs(P(i, k)) > std::abs(P(pivot, k))) pivot = i;
    }
    for (int j = 0; j < 2 * n; ++j) std::swap(P(k, j), P(pivot, j));
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const Complex factor = P(i, k) / P(k, k);
      for (int j = k; j < 2 * n; ++j) P(i, j) -= factor * P(k, j);
    }
  }
  Complex trace = 0;
  for (int k = 0; k < n; ++k) trace += P(k, n + k) / P(k, k);
  return double(1 / std::abs(trace));
}

/// Couplings from none to 1e12 rad/s, springs from nearly none to rigid.
void platform_modes(const Recorder& out) {
  for (const double speed : {0.0, 1e-6, 1.0, 1e3, 1e6, 1e9, 1e12}) {
    for (const double stiffness : {1e-9, 0.5, 1e9}) {
      const std::string what = fmt::format("{:g} rad/s, {:g} N m/rad", speed, stiffness);
      out.begin(what, "conservative_spectrum");
      const Coefficients c = on_springs(speed, stiffness);
      double worst = 0;
      int resting = 0;
      for (const GyroscopicMode& mode : conservative_spectrum(c)) {
        if (mode.root == 0.0) {
          resting += 1;
          continue;
        }
        worst = test::worst_of(worst, correction(c, mode.root) / mode.error);
      }
      expect_below(out, what + ": error of the modes over the reported one",
                   "conservative_spectrum", worst, 1,
                   fmt::format("{} of 8 modes told to rest", resting));
    }
  }
  for (const double x : {nan, inf}) {
    expect_refusal(out, fmt::format("stiffness = {}", x), "conservative_spectrum",
                   [&] { (void)conservative_spectrum(on_springs(1, x)); });
    expect_refusal(out, fmt::format("speed = {}", x), "conservative_spectrum",
                   [&] { (void)conservative_spectrum(on_springs(x, 1)); });
  }
}

}  // namespace

void rotors(std::vector<Case>& cases) {
  cases.push_back({"unsymmetric-rotor", "beside the limits of the range where it is unstable",
                   &unsymmetric_rotor});
  cases.push_back(
      {"gyro-platform", "couplings from 0 to 1e12 rad/s, springs to 1e9 N m/rad", &platform_modes});
}

}  // namespace stability
