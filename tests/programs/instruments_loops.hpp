#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <programs/instrument.hpp>
#include <string>

/// The platform on three gyros and the damped compass of docs/site/instruments.md: closed loops.

namespace kreisel::test {

namespace servo {

inline constexpr double H = 0.5, d = 0.1, K = 50, K_i = 200;
inline constexpr double J = 2e-4;  ///< of a float and its rotor about the output axis

inline std::string gain(const std::string& name, double value) {
  return set("controller[0].law." + name, value);
}

/// The answer of a gimbal to a torque of 1 N m on the outer one, at 0.2 rad/s times the size.
inline Instrument answer_of(const std::string& gimbal, const std::function<double(double w)>& law,
                            double bound) {
  const auto frequency = [](double size) { return 0.2 * size; };
  return {"platform_servo",
          [=](double size) {
            return " --response joint.outer --to " + gimbal + ".angle --frequencies " +
                   std::to_string(frequency(size)) + ":1:2";
          },
          at("/response/rows/0/amplitude"),
          [=](double size) { return law(frequency(size)); },
          {},
          2,
          bound,
          true};
}

}  // namespace servo

/// The integral of the law would bring the gimbal back.
inline Instrument servo_stiffness() {
  using namespace servo;
  return {"platform_servo",
          [](double size) { return gain("integral", 0) + set("body.outer.force", 0.1 * size); },
          at("/final/joints/outer/coordinate"),
          [](double size) { return d * 0.1 * size / (H * K); },
          {},
          1,
          2e-4};
}

inline Instrument servo_compliance() {
  using namespace servo;
  return answer_of(
      "outer", [](double w) { return d * w / (H * K_i); }, 2e-3);
}

inline Instrument servo_decoupling() {
  using namespace servo;
  return answer_of(
      "middle", [](double w) { return J * d * w * w / (H * H * K_i); }, 2e-3);
}

/// The floats and rotors of x and y with moments `size` times as great, and the same momentum.
inline Instrument servo_bandwidth() {
  using namespace servo;
  const auto law = [](double size) {
    // All that turns about the axis y: platform and middle gimbal, gyros x and y, gyro z.
    const double I = 0.03 + 4e-4 * size + 3e-4;
    const std::array p{I * J * size, I * d, H * H, H * K, H * K_i};
    std::complex<double> s(-38, 85);
    for (int i = 0; i < 30; ++i) {
      std::complex<double> value = 0, slope = 0;
      for (const double coefficient : p) {
        slope = slope * s + value;
        value = value * s + coefficient;
      }
      s -= value / slope;
    }
    return s.imag();
  };
  return {"platform_servo",
          [](double size) {
            std::string options;
            for (const std::string axis : {"x", "y"}) {
              const Vector3<double> moments = Vector3<double>(1e-4, 1e-4, 1e-4) * size;
              options += set("body.float " + axis + ".inertia", moments);
              options += set("body.rotor " + axis + ".inertia",
                             moments + size * Vector3<double>(0, 0, 1e-4));
              options += set("body.rotor " + axis + ".rotor.speed", 2500 / size);
            }
            return options;
          },
          [law](const Json& answer) { return frequency_near(answer, law(1)); },
          law,
          {},
          2,
          4e-3,
          true};
}

inline Instrument servo_drift() {
  return {"platform_servo",
          [](double) {
            return set("body.outer.force", 0) + set("body.float x.force", 1e-3) + until(8);
          },
          at("/final/joints/outer/rate"),
          constant(-1e-3 / servo::H),
          {},
          0,
          1e-11};
}

namespace compass {

inline const double north = earth_rate * std::cos(50 * degree);

/// With a hundred times the scene's momentum and weight, so that nutations are fast, and without friction.
inline constexpr double H = 1000, D = 0.985;
inline const double B = 0.4 * 8.369087 * 9.81 + H * north;

inline double square_of_frequency() { return B * north / H; }

inline std::string options(double size) {
  return set("body.rotor.rotor.speed", 2e5) +
         set("body.inner.centre", Vector3<double>(8.369087, 0, 0)) + set("body.outer.damping", 0) +
         set("body.inner.damping", 0) + set("controller[0].law.proportional", D * size);
}

}  // namespace compass

inline Instrument damping_error() {
  using namespace compass;
  return {"damped_gyrocompass",
          options,
          at("/equilibria/0/joints/outer/coordinate"),
          [](double size) { return D * size / B * std::tan(50 * degree); },
          {},
          2,
          1e-3,
          true};
}

inline Instrument damped_oscillation() {
  using namespace compass;
  return {"damped_gyrocompass",
          options,
          at("/equilibria/0/roots/0/frequency"),
          [](double size) {
            return std::sqrt(square_of_frequency() - std::pow(D * size / (2 * H), 2));
          },
          {},
          2,
          1e-3,
          true};
}

inline Instrument damping_ratio() {
  using namespace compass;
  return {"damped_gyrocompass",
          options,
          [](const Json& answer) {
            const Json& root = answer.at("equilibria").at(0).at("roots").at(0);
            const auto rate = root.at("growth_rate").get<double>();
            return -rate / std::hypot(rate, root.at("frequency").get<double>());
          },
          [](double size) { return D * size / (2 * H * std::sqrt(square_of_frequency())); },
          {},
          2,
          1e-3,
          true};
}

}  // namespace kreisel::test
