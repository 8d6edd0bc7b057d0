// Tops in 50 digits.

#include "truth.hpp"

#include <support/top_truth.hpp>

namespace stability {

namespace {

using kreisel::EulerTop;
using kreisel::test::Digits50;
using Quaternion = Eigen::Quaternion<Digits50>;
using Vector = kreisel::Vector3<Digits50>;

EulerTop::State rounded(const Quaternion& q, const Vector& w) {
  return {{double(q.w()), double(q.x()), double(q.y()), double(q.z())},
          {double(w.x()), double(w.y()), double(w.z())}};
}

/// exp(v t) as a quaternion.
Quaternion turn(const Vector& v, const Digits50& t) {
  const Digits50 rate = sqrt(v.dot(v));
  if (rate == 0) return {1, 0, 0, 0};
  const Digits50 half = rate * t / 2;
  const Vector along = v * Digits50(sin(half) / rate);
  return {cos(half), along.x(), along.y(), along.z()};
}

}  // namespace

std::vector<EulerTop::State> top_in_50_digits(const EulerTop& top, const EulerTop::State& start,
                                              const std::vector<double>& times) {
  kreisel::test::TopTruth truth(top.moments(), top.rotor_momentum(), top.weight_moment().z(),
                                start.angular_velocity, start.attitude);
  std::vector<EulerTop::State> states;
  Digits50 now = 0;
  for (const double t : times) {
    truth.advance(Digits50(t) - now);
    now = t;
    states.push_back(rounded(truth.attitude, truth.omega));
  }
  return states;
}

EulerTop::State symmetric_in_50_digits(const EulerTop& top, const EulerTop::State& start,
                                       double time) {
  const Digits50 A = top.moments().x();
  const Digits50 C = top.moments().z();
  const Digits50 t = time;
  const Eigen::Quaterniond& q = start.attitude;
  const Vector w = start.angular_velocity.cast<Digits50>();
  // On axes that do not take part in the excess of spin the momentum is constant.
  const Quaternion q0(q.w(), q.x(), q.y(), q.z());
  const Vector L(w.x(), w.y(), Digits50(C / A) * w.z());
  const Digits50 excess = (A - C) / A * w.z();
  const Quaternion attitude = q0 * turn(L, t) * turn(Vector(0, 0, excess), t);
  const Digits50 angle = -excess * t;
  const Vector now(cos(angle) * w.x() - sin(angle) * w.y(), sin(angle) * w.x() + cos(angle) * w.y(),
                   w.z());
  return rounded(attitude, now);
}

}  // namespace stability
