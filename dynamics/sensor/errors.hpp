#pragma once

#include <cstdint>
#include <string_view>

#include <motor/api.hpp>
#include <motor/motor.hpp>

namespace kreisel {

/// The errors of a gyro or accelerometer. Its reading is
///
///   y = clamp(round((1 + scale) R(-misalignment) truth + bias + noise)),
///
/// where R(m) is the rotation by the vector m. The reading is rounded to multiples of `resolution`,
/// then limited to +-range. The noise is the sum of white noise, a random walk and an exponentially
/// correlated process.
///
/// Frame  : the sensor's axes, one number for each
/// Units  : those of the reading, rad/s or m/s^2, called y here
/// Source : IEEE Std 952-1997, appendix C (names of the noises)
struct SensorErrors {
  /// An exponentially correlated process (Gauss-Markov, first order).
  struct Correlation {
    Vector3<double> sigma = Vector3<double>::Zero();  ///< standard deviation, y
    double time = 1;                                  ///< s: the correlation is then 1/e
  };

  Vector3<double> misalignment =
      Vector3<double>::Zero();                      ///< rad: rotates the nominal axes to the real
  Vector3<double> scale = Vector3<double>::Zero();  ///< 1: relative excess of the reading
  Vector3<double> bias = Vector3<double>::Zero();   ///< y
  Vector3<double> noise = Vector3<double>::Zero();  ///< y/sqrt(Hz): density of the white noise
  Vector3<double> drift = Vector3<double>::Zero();  ///< y/s/sqrt(Hz): of the walk's steps
  Correlation correlation = {};
  double resolution = 0;  ///< y, or y s of increments; 0: none
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

/// The reading of an instrument that integrates over `period` seconds, as inertial units do. Errors
/// of the mean rate are as above. The increment is rounded to `resolution`, and the remainder is
/// added to the next increment. The sum of all readings is thus off by half a step at most.
///
/// truth : the increment, y s
/// rest  : remainder of the previous increment, initially 0; replaced by that of this one
KREISEL_API [[nodiscard]] Vector3<double> misread_increment(const SensorErrors& errors,
                                                            const Vector3<double>& truth,
                                                            double period,
                                                            const Vector3<double>& noise,
                                                            Vector3<double>& rest);

/// The noise of an instrument, generated sample by sample.
///
///   white  N n / sqrt(dt);   walk  d += K n sqrt(dt), initially 0;
///   correlated  c = p c + sigma n sqrt(1 - p^2), p = exp(-dt/T), initially sigma n
///
/// The numbers n of a sample are normal and independent. They depend only on the seed, the name of
/// the sensor and the index of the sample.
///
/// Error  : Allan deviations, means of 40 to 100 sensors, within 5 % of N/sqrt(tau), K sqrt(tau/3)
///          and that of the correlated process (tests/dynamics/sensor/errors)
class KREISEL_API SensorNoise {
 public:
  SensorNoise(const SensorErrors& errors, std::string_view name);

  /// The number of samples so far.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// The noise of the next sample. dt > 0 is the time since the previous sample, in seconds; for
  /// the first sample it is the sample's length.
  [[nodiscard]] Vector3<double> next(double dt);

 private:
  SensorErrors errors_;
  std::uint64_t key_;
  std::uint64_t count_ = 0;
  Vector3<double> walk_ = Vector3<double>::Zero();
  Vector3<double> correlated_ = Vector3<double>::Zero();
};

}  // namespace kreisel
