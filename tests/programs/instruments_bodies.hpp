#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <programs/instrument.hpp>
#include <string>

#include <dynamics/guide/orbit.hpp>

/// Satellites, pendulums, rotors, engines and vehicles of docs/site/instruments.md.

namespace kreisel::test {

inline Instrument swing_in_orbit() {
  const double n = Orbit<>({.semi_major_axis = 7e6}).mean_motion();
  const double law = n * std::sqrt(3 * (75 - 10) / 80.0);
  return {"gravity_gradient", no_options, frequency(law), constant(law), {}, 0, 1e-11, true};
}

/// The momentum of both rotors, 30 N m s, turned by gimbals that go to 0.1 rad and back.
inline Instrument control_moment_gyros() {
  const auto angle = [](double t) {  // of a gimbal, integral of its rate
    const auto ramp = [](double x) { return x > 0 ? x * x / 2 : 0; };
    return 0.01 * (ramp(t - 10) - ramp(t - 11) - ramp(t - 20) + ramp(t - 22) + ramp(t - 31) -
                   ramp(t - 32));
  };
  double law = 0;
  constexpr int steps = 24000;
  for (int i = 0; i < steps; ++i) {
    const double s = std::sin(angle(9 + 24 * (i + 0.5) / steps));
    const double moment = 75 + 2 * (0.01 + 0.03 + 0.02 * s * s);
    law += 2 * 30 * s / moment * 24 / steps;
  }
  return {"orbit_cmg",
          [](double size) {
            return set("guide.semi_major_axis", 7e6 / std::pow(size, 2.0 / 3)) + until(33);
          },
          [](const Json& answer) {
            return answer.at("final").at("sensors").at("attitude").at("value").at(1).get<double>();
          },
          constant(law),
          {},
          2,
          3e-4};
}

inline Instrument nutation() {
  const double law = 20 / std::sqrt(60.02 * 90.02);
  return {"bias_momentum_satellite",
          [](double size) { return set("body.wheel.rotor.speed", 500 / size); },
          [law](const Json& answer) { return frequency_near(answer, 10 * law); },
          [law](double size) { return law / size; },
          {},
          1,
          1e-2,
          true};
}

inline Instrument kamerlingh_onnes() {
  constexpr double T = 10.4, T_a = 0.5, rate = 1e-3, unequal = 0.027;
  const auto law = [=](double size) {
    const double w = std::sqrt(10 * 9.814 / T);
    const double apart = w - std::sqrt(10 * 9.814 / (T + unequal * size));
    const double turned = (2 * T - T_a) / T * rate * size * std::sin(53.2 * degree);
    return std::hypot(apart, turned);
  };
  return {"kamerlingh_onnes",
          [=](double size) {
            return set("guide.rate", rate * size) +
                   set("body.rod.inertia[2]", 0.4 + unequal * size);
          },
          [](const Json& answer) {
            const Json& roots = answer.at("equilibria").at(0).at("roots");
            return std::abs(roots.at(0).at("frequency").get<double>() -
                            roots.at(1).at("frequency").get<double>());
          },
          law,
          {},
          1,
          2e-2,
          true};
}

inline Instrument foucault() {
  return {"foucault_pendulum",
          [](double size) {
            return set("body.bob.initial.angle", "[" + std::to_string(-0.05 * size) + ", 0]") +
                   until(1200);
          },
          at("/final/sensors/plane/value/0"),
          constant(earth_rate * std::sin(48.846222 * degree) * 1200),
          // Airy's precession, and the field that converges to the earth's centre.
          [](double size) { return 3.0 / 8 * std::pow(0.05 * size, 2) + 67 / Wgs84::radius; }, 2,
          2e-3};
}

/// The sum of the squares of all roots is the trace of the squared state matrix.
inline Instrument engine_block() {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const double m = 160;
  Matrix3<double> I;
  I << 6, 0.2, -1.1, 0.2, 14, 0.1, -1.1, 0.1, 11;
  Matrix6 mass = Matrix6::Zero(), stiffness = mass, damping = mass;
  mass.topLeftCorner<3, 3>() = m * Matrix3<double>::Identity();
  mass.bottomRightCorner<3, 3>() = I;
  for (const double x : {0.3, -0.3}) {
    for (const double y : {0.3, -0.3}) {
      Eigen::Matrix<double, 3, 6> P;
      P << Matrix3<double>::Identity(), -skew(Vector3<double>(x, y, -0.15));
      const double tilt = (y > 0 ? 30 : -30) * degree;
      const Matrix3<double> R(Eigen::AngleAxisd(tilt, Vector3<double>::UnitX()));
      const auto turned = [&](double across, double along) -> Matrix6 {
        const Vector3<double> k(across, across, along);
        return P.transpose() * R * k.asDiagonal() * R.transpose() * P;
      };
      stiffness += turned(1.2e5, 4e5);
      damping += turned(150, 400);
      // The preload, a quarter of the weight, turns with the block.
      const Vector3<double> preload(0, 0, m * 9.81 / 4);
      stiffness.bottomRightCorner<3, 3>() -= skew(preload) * skew(Vector3<double>(x, y, -0.15));
    }
  }
  const Matrix6 D = mass.inverse() * damping;
  const double law = (D * D).trace() - 2 * (mass.inverse() * stiffness).trace();
  return {"engine_on_mounts",
          no_options,
          [](const Json& answer) {
            double sum = 0;
            for (const Json& root : answer.at("equilibria").at(0).at("roots")) {
              const auto s = root.at("growth_rate").get<double>();
              const auto w = root.at("frequency").get<double>();
              sum += 2 * (s * s - w * w);
            }
            return sum;
          },
          constant(law),
          {},
          0,
          1e-9,
          true};
}

inline Instrument heavy_rotor() {
  constexpr double A = 1.1, B = 0.9, C = 1.5, c = -9.81 * 0.05;
  constexpr double k_1 = c + C - B, k_2 = c + C - A;
  const double sum = A * k_2 + B * k_1 + (A + B - C) * (A + B - C);
  const double square = (std::sqrt(sum * sum - 4 * A * B * k_1 * k_2) - sum) / (2 * A * B);
  return {"heavy_unsymmetric_top",
          no_options,
          [](const Json& answer) {
            const Json& floquet = answer.at("floquet");
            return std::log(floquet.at("multipliers").at(0).at("size").get<double>()) /
                   floquet.at("period").get<double>();
          },
          constant(std::sqrt(square)),
          {},
          0,
          1e-10,
          true};
}

/// Weigand's propeller: 25 digits by another program, of half a turn.
inline Instrument propeller() {
  return {"propeller_between_springs",
          no_options,
          at("/floquet/multipliers/0/size"),
          constant(std::pow(1.0353843867300570, 2)),
          {},
          0,
          1e-11,
          true};
}

inline Instrument rolling_disc() {
  constexpr double A = 0.125, C = 0.25, m = 2, r = 0.5, w = 3, knock = 0.01;
  const double root = std::sqrt((C * (C + m * r * r) * w * w / A - m * 9.81 * r) / (A + m * r * r));
  return {"rolling_disc",
          [=](double size) {
            return set("body.disc.initial.angular_velocity", Vector3<double>(knock * size, w, 0)) +
                   set("body.disc.initial.velocity", Vector3<double>(r * w, -r * knock * size, 0)) +
                   until(pi / (2 * root));
          },
          [](const Json& answer) {
            const Json& axle = answer.at("final").at("sensors").at("axle").at("position");
            return axle.at(2).get<double>();
          },
          [=](double size) { return r + knock * size / root; },
          {},
          2,
          1e-5};
}

inline Instrument schuler_pendulum() {
  constexpr double longer = 0.04, a = 1, pushed = 100;
  const double R = Wgs84::radius;
  const double w = std::sqrt(9.8 / R);
  const double t = 1266;
  return {"schuler_pendulum",
          [=](double size) {
            return set("body.pendulum.centre",
                       Vector3<double>(1 / (R * (1 + longer * size)), 0, 0)) +
                   until(t);
          },
          at("/final/joints/pendulum/coordinate"),
          [=](double size) {
            return longer * size * a / (R * w * w) * (std::cos(w * t) - std::cos(w * (t - pushed)));
          },
          {},
          1,
          8e-2};
}

inline Instrument bicycle() {
  return {"bicycle",
          no_options,
          [](const Json& answer) {
            double least = 0;
            for (const Json& root : answer.at("linear").at("roots")) {
              least = std::min(least, root.at("growth_rate").get<double>());
            }
            return least;
          },
          constant(-14.07838969279822),
          {},
          0,
          1e-9,
          true};
}

}  // namespace kreisel::test
