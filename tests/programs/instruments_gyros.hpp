#pragma once

#include <cmath>
#include <programs/instrument.hpp>
#include <string>

/// Gyros, horizons, compasses and platforms of docs/site/instruments.md.

namespace kreisel::test {

inline Instrument rate_gyro() {
  constexpr double H = 0.05, k = 0.5, W = 0.2;
  const auto lean = [=](double size) {
    double angle = 0;
    for (int i = 0; i < 50; ++i) angle = H * W * size * std::cos(angle) / k;
    return angle;
  };
  return {
      "rate_gyro",
      [=](double size) { return set("guide.angular_velocity", Vector3<double>(0, 0, W * size)); },
      at("/equilibria/0/joints/ring/coordinate"),
      lean,
      [=](double size) { return 1.5e-5 * W * size * lean(size) / H; },  // moments about y and z
      2,
      1e-5,
      true};
}

inline Instrument bandwidth() {
  constexpr double k = 0.5, J = 5e-5, d = 7e-3, H = 0.05, W = 0.2;
  const double square = k / J - std::pow(d / (2 * J), 2);
  return {
      "rate_gyro",
      [=](double size) { return set("guide.angular_velocity", Vector3<double>(0, 0, W * size)); },
      frequency(std::sqrt(square)),
      constant(std::sqrt(square)),
      [=](double size) { return std::pow(H * W * size, 2) / (2 * k * J * square); },
      2,
      1e-3,
      true};
}

inline Instrument integrating_gyro() {
  constexpr double late = 1e-3, w = 20, a = 1e-4;
  return {"integrating_gyro",
          [=](double size) {
            return set("guide.angles.yaw.constant", a) +
                   set("guide.angles.yaw.terms[0].amplitude", -a) +
                   set("guide.angles.yaw.terms[0].frequency", w * size) + until(pi / (w * size));
          },
          at("/final/joints/ring/coordinate"),
          constant(2 * a),
          [=](double size) { return std::pow(late * w * size, 2) / 2; },
          2,
          1e-3};
}

inline Instrument directional_gyro() {
  return {"directional_gyro",
          [](double size) { return set("body.rotor.rotor.speed", 2500 / size) + until(pi); },
          at("/final/joints/outer/coordinate"),
          constant(std::atan(std::tan(30 * degree) * std::cos(40 * degree))),
          {},
          1,
          1e-4};
}

inline Instrument earth_drift() {
  constexpr double hour = 3600;
  return {
      "drifting_gyro",
      [](double size) {
        return set("solve.model", "\"exact\"") + set("body.rotor.rotor.speed", 100) +
               until(hour * size);
      },
      at("/final/joints/outer/coordinate"),
      [](double size) { return earth_rate * std::sin(50 * degree) * hour * size; },
      [](double size) { return std::pow(earth_rate * std::cos(50 * degree) * hour * size, 2) / 6; },
      2,
      1e-2};
}

inline Instrument horizon_in_turn() {
  constexpr double v = 10, w = 0.05, S = 0.4 * 0.0288, g = 9.81, H = 1.2;
  return {"horizon_in_turn",
          [=](double size) {
            return set("guide.angular_velocity", Vector3<double>(0, 0, w * size)) +
                   set("guide.origin_acceleration", Vector3<double>(0, v * w * size, 0));
          },
          at("/equilibria/0/joints/outer/coordinate"),
          [=](double size) { return -std::atan(S * v * w * size / (S * g + H * w * size)); },
          [=](double size) {  // moments about y and z
            const double moments = 3e-3 - 0.4 * 0.0288 * 0.0288;
            return moments * std::pow(w * size, 2) / (S * g + H * w * size);
          },
          2,
          1e-3,
          true};
}

inline Instrument erection() {
  const double tilt = 5 * degree;
  return {"gyro_horizon",
          [=](double size) {
            return set("guide.angles.roll.terms[0].amplitude", 0) +
                   set("body.outer.initial.angle_deg", 5 * size) + until(60);
          },
          [](const Json& answer) {
            return answer.at("final").at("sensors").at("level").at("position").at(1).get<double>();
          },
          [=](double size) { return -std::sin(tilt * size) * std::exp(-1.0); },
          [=](double size) { return std::pow(tilt * size, 2) * (1 - std::exp(-2.0)) / 4; },
          2,
          5e-3};
}

inline Instrument gyrocompass() {
  constexpr double H = 0.12, A = 5e-3;  // a hundredth of the scene's speed
  const double north = earth_rate * std::cos(50 * degree);
  return {"gyrocompass",
          [=](double size) { return set("body.rotor.rotor.speed", 24 / size); },
          at("/equilibria/0/roots/0/frequency"),
          [=](double size) { return std::sqrt(H / size * north / A); },
          [=](double size) { return 2e-3 * north * size / (2 * H); },  // moments about y and z
          1,
          1e-6,
          true};
}

inline Instrument course_error() {
  const double latitude = 50 * degree;
  const double s = std::sin(latitude);
  const double R = Wgs84::radius * (1 - Wgs84::e2) / std::pow(1 - Wgs84::e2 * s * s, 1.5);
  return {
      "sailing_gyrocompass",
      [](double size) {
        return set("guide.acceleration.steps",
                   "[[100, " + std::to_string(0.1 * size) + "], [200, 0]]");
      },
      at("/final/joints/ring/coordinate"),
      [=](double size) { return -std::atan(10 * size / (R * earth_rate * std::cos(latitude))); },
      // The ship is 2500 m farther north, where the earth's rate has a smaller part along north.
      [=](double size) { return std::tan(latitude) * 2500 * size / R; }, 1, 1e-3};
}

inline Instrument platform_stiffness() {
  return {"stabilised_platform",
          [](double size) { return set("body.platform.force", 0.1 * size); },
          at("/final/joints/platform/coordinate"),
          [](double size) { return 0.05 * 0.1 * size / (0.5 * 50); },
          {},
          2,
          1e-6};
}

inline Instrument platform_drift() {
  return {"stabilised_platform",
          [](double) { return set("body.platform.force", 0) + set("body.ring.force", 0.01); },
          at("/final/joints/platform/rate"),
          constant(-0.01 / 0.5),
          {},
          0,
          1e-12};
}

/// With less than a hundredth of the scene's momentum, so that the nutations are slow, and to 1 m/s.
inline Instrument pendulous_gyrocompass() {
  const double R = 6372955.93;  // of the meridian at 50 degrees
  const double north = earth_rate * std::cos(50 * degree);
  return {"pendulous_gyrocompass",
          [=](double size) {
            constexpr double C = 5e-3;
            const double speed = 2 / size;
            const double tuned = C * speed / (R * north);  // m s
            return set("solve.model", "\"exact\"") + set("body.rotor.rotor.speed", speed) +
                   set("body.inner.centre", Vector3<double>(tuned / 0.4, 0, 0)) +
                   set("guide.acceleration.points",
                       "[[100, 0], [120, 0.01], [200, 0.01], [220, 0]]") +
                   until(250);
          },
          at("/final/joints/outer/coordinate"), constant(-std::atan(1 / (R * north))),
          // The momentum of the azimuth's own motion tilts the axis.
          [=](double size) { return 5e-3 * 9.81 / (R * north) / (0.01 / size); }, 1, 3e-2};
}

}  // namespace kreisel::test
