#include <Eigen/Geometry>

#include <cmath>

#include <dynamics/study/tangent_rates.hpp>

namespace kreisel {

using Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// The position in eta of the i-th attitude.
int angles_of(const Tangent& tangent, std::size_t i) {
  return tangent.quaternions()[i] - static_cast<int>(i);
}

/// R(eta)^T w for the body's axes after the rotation eta.
Vector3d on_axes_after(const Vector3d& eta, const Vector3d& w) {
  const double angle = eta.norm();
  if (angle == 0) return w;
  return Eigen::AngleAxisd(-angle, eta / angle) * w;
}

/// J eta' = eta' - c1 eta x eta' + c2 eta x (eta x eta'). Series where the quotients cancel.
Vector3d times_jacobian(const Vector3d& eta, const Vector3d& v) {
  const double x = eta.squaredNorm();
  const double angle = std::sqrt(x);
  const bool small = x < 1e-2;
  const double half = std::sin(angle / 2);
  const double c1 = small ? 0.5 - x / 24 + x * x / 720 - x * x * x / 40320 : 2 * half * half / x;
  const double c2 = small ? 1.0 / 6 - x / 120 + x * x / 5040 - x * x * x / 362880
                          : (angle - std::sin(angle)) / (x * angle);
  const Vector3d once = eta.cross(v);
  return v - c1 * once + c2 * eta.cross(once);
}

/// J^-1 v = v + eta x v / 2 + c eta x (eta x v).
Vector3d times_inverse_jacobian(const Vector3d& eta, const Vector3d& v) {
  const double x = eta.squaredNorm();
  const double angle = std::sqrt(x);
  const double c = x < 1e-2 ? 1.0 / 12 + x / 720 + x * x / 30240 + x * x * x / 1209600
                            : 1 / x - 1 / (2 * angle * std::tan(angle / 2));
  const Vector3d once = eta.cross(v);
  return v + once / 2 + c * eta.cross(once);
}

}  // namespace

VectorXd tangent_rate(const Tangent& tangent, const VectorXd& y, const VectorXd& dy) {
  VectorXd rate(tangent.dimension());
  Eigen::Index from = 0;
  Eigen::Index to = 0;
  const auto copy = [&](Eigen::Index end) {
    rate.segment(to, end - from) = dy.segment(from, end - from);
    to += end - from;
    from = end;
  };
  for (const int at : tangent.quaternions()) {
    copy(at);
    const Eigen::Quaterniond q(y[at + 3], y[at], y[at + 1], y[at + 2]);
    const Eigen::Quaterniond dq(dy[at + 3], dy[at], dy[at + 1], dy[at + 2]);
    rate.segment<3>(to) = 2 / q.squaredNorm() * (q.conjugate() * dq).vec();
    to += 3;
    from += 4;
  }
  copy(y.size());
  return rate;
}

VectorXd rate_of_moved(const Tangent& tangent, const VectorXd& rate, const VectorXd& eta,
                       const VectorXd& eta_rate) {
  VectorXd result = rate + eta_rate;
  for (std::size_t i = 0; i < tangent.quaternions().size(); ++i) {
    const int at = angles_of(tangent, i);
    const Vector3d angles = eta.segment<3>(at);
    result.segment<3>(at) = on_axes_after(angles, rate.segment<3>(at)) +
                            times_jacobian(angles, eta_rate.segment<3>(at));
  }
  return result;
}

VectorXd rate_of_move(const Tangent& tangent, const VectorXd& rate, const VectorXd& rate_after,
                      const VectorXd& eta) {
  VectorXd result = rate_after - rate;
  for (std::size_t i = 0; i < tangent.quaternions().size(); ++i) {
    const int at = angles_of(tangent, i);
    const Vector3d angles = eta.segment<3>(at);
    const Vector3d relative =
        rate_after.segment<3>(at) - on_axes_after(angles, rate.segment<3>(at));
    result.segment<3>(at) = times_inverse_jacobian(angles, relative);
  }
  return result;
}

}  // namespace kreisel
