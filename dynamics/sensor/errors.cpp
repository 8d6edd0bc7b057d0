#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include <dynamics/random.hpp>
#include <dynamics/sensor/errors.hpp>

namespace kreisel {

namespace {

/// The FNV-1a hash (Fowler, Noll and Vo) of a name, 64 bits.
std::uint64_t hash(std::string_view name) {
  std::uint64_t result = 0xCBF29CE484222325;
  for (const char c : name) result = (result ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return result;
}

Vector3<double> normal(MemberRandom& random) {
  Vector3<double> n;
  for (double& x : n) x = random.normal();
  return n;
}

Vector3<double> distorted(const SensorErrors& errors, const Vector3<double>& truth,
                          const Vector3<double>& noise) {
  const Vector3<double>& m = errors.misalignment;
  Vector3<double> y = truth;
  if (!m.isZero(0)) y = Eigen::AngleAxisd(-m.norm(), m.normalized()) * y;
  return y + errors.scale.cwiseProduct(y) + errors.bias + noise;
}

double rounded(const SensorErrors& errors, double x) {
  return errors.resolution > 0 ? std::round(x / errors.resolution) * errors.resolution : x;
}

double limited(const SensorErrors& errors, double x) {
  return errors.range > 0 ? std::clamp(x, -errors.range, errors.range) : x;
}

}  // namespace

Vector3<double> misread(const SensorErrors& errors, const Vector3<double>& truth,
                        const Vector3<double>& noise) {
  Vector3<double> y = distorted(errors, truth, noise);
  for (double& x : y) x = limited(errors, rounded(errors, x));
  return y;
}

Vector3<double> misread_increment(const SensorErrors& errors, const Vector3<double>& truth,
                                  double period, const Vector3<double>& noise,
                                  Vector3<double>& rest) {
  Vector3<double> y = distorted(errors, truth / period, noise);
  for (int k = 0; k < 3; ++k) {
    const double whole = period * limited(errors, y[k]) + rest[k];
    y[k] = rounded(errors, whole);
    rest[k] = whole - y[k];
  }
  return y;
}

SensorNoise::SensorNoise(const SensorErrors& errors, std::string_view name)
    : errors_(errors), key_(errors.seed ^ hash(name)) {}

Vector3<double> SensorNoise::next(double dt) {
  MemberRandom random(key_, count_);
  const Vector3<double> white = normal(random);
  const Vector3<double> step = normal(random);
  const Vector3<double> shock = normal(random);
  const bool is_first = count_++ == 0;
  if (!is_first) walk_ += std::sqrt(dt) * errors_.drift.cwiseProduct(step);
  const double kept = is_first ? 0 : std::exp(-dt / errors_.correlation.time);
  const double fresh = is_first ? 1 : std::sqrt(-std::expm1(-2 * dt / errors_.correlation.time));
  correlated_ = kept * correlated_ + fresh * errors_.correlation.sigma.cwiseProduct(shock);
  return errors_.noise.cwiseProduct(white) / std::sqrt(dt) + walk_ + correlated_;
}

}  // namespace kreisel
