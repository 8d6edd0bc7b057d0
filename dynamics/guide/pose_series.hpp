#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <utility>
#include <vector>

#include <dynamics/guide/piecewise.hpp>

namespace kreisel::detail {

/// Attitude, position and velocity at the end of the pieces that are integrated so far.
///
/// Frame  : attitude G to I, position and velocity on I's axes
template <class Wide>
struct PoseChain {
  Eigen::Quaternion<Wide> q = Eigen::Quaternion<Wide>::Identity();
  Vector3<Wide> x = Vector3<Wide>::Zero();
  Vector3<Wide> v = Vector3<Wide>::Zero();
};

/// Series coefficients of attitude and position. They follow from those of the angular velocity u
/// and the acceleration a, both on the rotating axes, and a uniform acceleration g on I's axes:
///
///   q' = q u / 2,   x'' = q a q^-1 + g
template <class Wide>
[[nodiscard]] std::pair<std::vector<Eigen::Quaternion<Wide>>, std::vector<Vector3<Wide>>>
pose_series(const std::vector<Vector3<Wide>>& u, const std::vector<Vector3<Wide>>& a,
            const Vector3<Wide>& g, const PoseChain<Wide>& start) {
  using Quaternion = Eigen::Quaternion<Wide>;
  const std::size_t terms = u.size();
  const auto pure = [](const Vector3<Wide>& v) { return Quaternion(Wide(0), v.x(), v.y(), v.z()); };
  const auto number = [](std::size_t n) { return Wide(static_cast<double>(n)); };
  std::vector<Quaternion> q{start.q};
  std::vector<Quaternion> qa;  // of q a
  std::vector<Vector3<Wide>> x{start.x, start.v};
  for (std::size_t n = 0; n + 1 < terms; ++n) {
    Quaternion qu_n(Wide(0), Wide(0), Wide(0), Wide(0));
    Quaternion qa_n = qu_n;
    Vector3<Wide> acceleration = n == 0 ? g : Vector3<Wide>(Vector3<Wide>::Zero());
    for (std::size_t k = 0; k <= n; ++k) {
      qu_n.coeffs() += (q[k] * pure(u[n - k])).coeffs();
      qa_n.coeffs() += (q[k] * pure(a[n - k])).coeffs();
    }
    q.emplace_back(Eigen::Matrix<Wide, 4, 1>(qu_n.coeffs() / number(2 * (n + 1))));
    qa.push_back(qa_n);
    for (std::size_t k = 0; k <= n; ++k) acceleration += (qa[k] * q[n - k].conjugate()).vec();
    if (n + 2 < terms) x.push_back(acceleration / number((n + 1) * (n + 2)));
  }
  return {std::move(q), std::move(x)};
}

/// Appends a piece that begins at t and has the length `step`, and moves the chain to its end.
template <class S, class Wide>
void append_piece(PiecewisePose<S>& pose, PoseChain<Wide>& chain, const S& t, const Wide& step,
                  const std::vector<Vector3<Wide>>& u, const std::vector<Vector3<Wide>>& a,
                  const Vector3<Wide>& g) {
  chain.q.normalize();
  const auto [attitudes, places] = pose_series(u, a, g, chain);
  std::vector<typename PiecewisePose<S>::Components> coefficients;
  for (std::size_t n = 0; n < attitudes.size(); ++n) {
    coefficients.push_back(PiecewisePose<S>::components(attitudes[n].template cast<S>(),
                                                        places[n].template cast<S>()));
  }
  pose.append(t, coefficients);
  chain.q.coeffs().setZero();
  chain.x.setZero();
  chain.v.setZero();
  for (std::size_t n = attitudes.size(); n-- > 0;) {
    chain.q.coeffs() = chain.q.coeffs() * step + attitudes[n].coeffs();
    chain.v = chain.v * step + chain.x;
    chain.x = chain.x * step + places[n];
  }
}

}  // namespace kreisel::detail
