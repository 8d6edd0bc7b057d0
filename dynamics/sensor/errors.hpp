#pragma once

#include <cstdint>
#include <string_view>

#include <motor/api.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// By what the reading of a gyro or an accelerometer differs from the truth.
///
///   y = clamp(round((1 + scale) R(-misalignment) truth + bias + noise)),
///
/// with R(m) the turn by the vector m; rounded to whole multiples of `resolution`, then held within
/// +-range. The noise is the sum of white noise, a random walk and an exponentially correlated
/// process.
///
/// Frame  : the sensor's axes, one number for each
/// Units  : those of the reading, rad/s or m/s^2, called y here
/// Source : IEEE Std 952-1997, appendix C (names of the noises)
struct SensorErrors {
  /// An exponentially correlated process (Gauss and Markov, first order).
  struct Correlation {
    Vector3<double> sigma = Vector3<double>::Zero();  ///< standard deviation, y
    double time = 1;                                  ///< s, after which the correlation is 1/e
  };

  Vector3<double> misalignment =
      Vector3<double>::Zero();                      ///< rad: turns the nominal axes to the real
  Vector3<double> scale = Vector3<double>::Zero();  ///< 1: part by which it reads too much
  Vector3<double> bias = Vector3<double>::Zero();   ///< y
  Vector3<double> noise = Vector3<double>::Zero();  ///< y/sqrt(Hz): density of the white noise
  Vector3<double> drift = Vector3<double>::Zero();  ///< y/s/sqrt(Hz): of the walk's steps
  Correlation correlation = {};
  double resolution = 0;  ///< y; 0: none
  double range = 0;       ///< y; 0: none
  std::uint64_t seed = 0;

  [[nodiscard]] bool is_random() const {
    return !noise.isZero(0) || !drift.isZero(0) || !correlation.sigma.isZero(0);
  }
};

/// The reading of an instrument with these errors.
KREISEL_API [[nodiscard]] Vector3<double> misread(const SensorErrors& errors,
                                                  const Vector3<double>& truth,
                                                  const Vector3<double>& noise);

/// The noise of an instrument, sample after sample.
///
///   white  N n / sqrt(dt);   walk  d += K n sqrt(dt), 0 at first;
///   correlated  c = p c + sigma n sqrt(1 - p^2), p = exp(-dt/T), sigma n at first
///
/// The numbers n of a sample, normal and independent, depend on the seed, the name of the sensor
/// and the index of the sample alone.
///
/// Error  : Allan deviations, means of 40 to 100 sensors, within 5 % of N/sqrt(tau), K sqrt(tau/3)
///          and the correlated process's own (tests/dynamics/sensor/errors)
class KREISEL_API SensorNoise {
 public:
  SensorNoise(const SensorErrors& errors, std::string_view name);

  /// How many samples there were.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// That of the next sample, dt > 0 seconds after the one before; of the first sample its length.
  [[nodiscard]] Vector3<double> next(double dt);

 private:
  SensorErrors errors_;
  std::uint64_t key_;
  std::uint64_t count_ = 0;
  Vector3<double> walk_ = Vector3<double>::Zero();
  Vector3<double> correlated_ = Vector3<double>::Zero();
};

}  // namespace kreisel
