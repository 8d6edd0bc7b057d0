#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/precession.hpp>
#include <dynamics/study/spectrum.hpp>

namespace kreisel {

/// A root of the technical equations and the exact one next to it.
///
/// Units  : rad/s
struct SlowRoot {
  std::complex<double> technical;
  std::complex<double> exact;
  /// technical + ds,  ds = -s^2 y.(A - A N N') x / y.(W + 2 s A N N') x;  not a number
  /// where the root is multiple
  std::complex<double> first_order;
};

/// What there is against technical equations.
enum class Obstacle {
  none,
  not_determined,  ///< G + D is singular and no accelerations are kept
  not_slow,        ///< a root is off by more than tolerated: the nutations are not fast
  growing_nutation,
  defective  ///< a multiple slow root with too few shapes, which what is neglected takes apart
};

/// Whether the technical equations stand for the exact ones about a rest, by all their roots.
///
/// Source : paper 000, its condition corrected: det G != 0 is neither sufficient nor, with damping
///          or with kept accelerations, necessary; nor are roots that are all simple
struct Admissibility {
  KeptAccelerations kept = KeptAccelerations::none;  ///< on the kernel, if that is neither empty
                                                     ///< nor overdamped
  Eigen::VectorXd singular_values;                   ///< of G alone
  int rank = 0;
  Eigen::MatrixXd kernel;          ///< orthonormal columns
  bool kernel_overdamped = false;  ///< damping alone rules the motion there
  std::vector<SlowRoot> slow;
  std::vector<std::complex<double>> fast;  ///< exact roots that the technical equations lack
  double greatest_shift = 0;               ///< of a slow root, relative
  double fast_growth = 0;  ///< of the fast roots, beyond that of the slow ones; <= 0 if none grows
  Obstacle obstacle = Obstacle::none;

  [[nodiscard]] bool admissible() const { return obstacle == Obstacle::none; }
};

struct AdmissibilityOptions {
  double rank_tolerance = 1e-6;    ///< of singular values against the greatest
  double tolerated_shift = 0.1;    ///< of slow roots, relative
  double tolerated_growth = 1e-9;  ///< of fast roots, of their size: rounding
};

namespace detail {

/// Whether  A x'' + D x' + K x = 0  has real roots <= 0 only, half of which are slower than all
/// others: so that A can be left out.
[[nodiscard]] inline bool overdamped(const Eigen::MatrixXd& A, const Eigen::MatrixXd& D,
                                     const Eigen::MatrixXd& K) {
  struct {
    Eigen::MatrixXd mass, damping, stiffness;
  } const c{A, D, K};
  std::vector<double> sizes;
  for (const Mode& mode : spectrum(state_matrix(c))) {
    const double size = std::abs(mode.root);
    if (std::abs(mode.root.imag()) > 1e-9 * size || mode.root.real() > 1e-9 * size) return false;
    sizes.push_back(size);
  }
  std::sort(sizes.begin(), sizes.end());
  const std::size_t half = sizes.size() / 2;
  return sizes[half] > 2 * sizes[half - 1];
}

/// The state matrix of the technical equations on (displacement; v).
[[nodiscard]] inline Eigen::MatrixXd technical_matrix(const Directions& d, const TechnicalPoint& p,
                                                      const Eigen::MatrixXd& K) {
  const Eigen::Index n = K.rows(), kept = d.N.cols();
  Eigen::MatrixXd T(n + kept, n + kept);
  for (Eigen::Index j = 0; j < n + kept; ++j) {
    const Eigen::VectorXd z = Eigen::VectorXd::Unit(n + kept, j);
    const Eigen::VectorXd force = -K * z.head(n);
    const Eigen::VectorXd u = p.velocity(d, force, z.tail(kept));
    T.col(j) << u, p.acceleration(d, force - p.W * u);
  }
  return T;
}

/// Whether two shapes are one.
[[nodiscard]] inline bool parallel(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  return 1 - std::abs(a.dot(b)) / (a.norm() * b.norm()) < 1e-6;
}

}  // namespace detail

/// Tests technical equations about a rest:  A u' + (G + D) u + K x = 0,  x' = u.
///
/// Stiffness : K, which need not be symmetric (circulatory forces)
/// Error     : of the roots as spectrum(); "multiple" are roots that are closer than 1e-6 of their
///             size
/// Throws    : as spectrum(); InvalidInput if A is not positive definite
[[nodiscard]] inline Admissibility admissibility(const GyroForces& f, const Eigen::MatrixXd& K,
                                                 const AdmissibilityOptions& options = {}) {
  using Complex = std::complex<double>;
  const Eigen::Index n = K.rows();
  Admissibility result;
  const TechnicalOptions on_kernel{.rank_tolerance = options.rank_tolerance};
  auto d = detail::Directions::of(f.G, on_kernel);
  result.singular_values = detail::singular_values(f.G).values;
  result.rank = static_cast<int>(d.P.cols());
  result.kernel = d.N;
  if (d.N.cols() > 0) {
    const auto along = [&d](const Eigen::MatrixXd& X) {
      return Eigen::MatrixXd(d.N.transpose() * X * d.N);
    };
    result.kernel_overdamped = detail::overdamped(along(f.A), along(f.D), along(K));
    if (!result.kernel_overdamped) result.kept = KeptAccelerations::on_kernel;
  }
  if (result.kept == KeptAccelerations::none) {
    d = detail::Directions::of(f.G, {.kept = KeptAccelerations::none});
  }
  const detail::TechnicalPoint p(d, {f.A, f.G, f.D, Eigen::VectorXd::Zero(n)},
                                 Eigen::VectorXd::Zero(d.N.cols()));
  if (!p.determined) {
    result.obstacle = Obstacle::not_determined;
    return result;
  }

  struct {
    Eigen::MatrixXd mass, damping, stiffness;
  } const whole{f.A, p.W, K};
  std::vector<Mode> exact = spectrum(state_matrix(whole));
  const std::vector<Mode> technical = spectrum(detail::technical_matrix(d, p, K));
  const Eigen::MatrixXd A_kept = f.A * d.N * d.N.transpose();
  double size = 0, slow_growth = 0;
  for (const Mode& mode : technical) size = std::max(size, std::abs(mode.root));
  const auto simple = [&](std::size_t i) {
    return std::none_of(technical.begin(), technical.end(), [&](const Mode& other) {
      return &other != &technical[i] &&
             std::abs(other.root - technical[i].root) < 1e-6 * std::abs(other.root);
    });
  };
  for (std::size_t i = 0; i < technical.size(); ++i) {
    const Complex s = technical[i].root;
    const auto next = std::min_element(
        exact.begin(), exact.end(),
        [&s](const Mode& a, const Mode& b) { return std::abs(a.root - s) < std::abs(b.root - s); });
    SlowRoot root{s, next->root, std::numeric_limits<double>::quiet_NaN()};
    exact.erase(next);
    slow_growth = std::max(slow_growth, root.exact.real());
    const double shift = std::abs(root.exact - s) / std::max(std::abs(s), 1e-6 * size);
    result.greatest_shift = std::max(result.greatest_shift, shift);
    if (simple(i)) {
      const Eigen::MatrixXcd pencil = s * s * A_kept + s * p.W + K;
      const auto null = detail::singular_values(pencil);
      const Eigen::VectorXcd x = null.V.col(n - 1), y = null.U.col(n - 1);
      const Eigen::VectorXcd slope = (p.W + 2.0 * s * A_kept) * x;
      root.first_order = s - s * s * y.dot((f.A - A_kept) * x) / y.dot(slope);
    }
    result.slow.push_back(root);
    for (std::size_t j = 0; j < i; ++j) {
      const bool one = std::abs(technical[j].root - s) <= 1e-6 * std::abs(s) &&
                       std::abs(s) > 1e-6 * size &&
                       detail::parallel(technical[i].shape, technical[j].shape);
      if (one) result.obstacle = Obstacle::defective;
    }
  }
  result.fast_growth = -std::numeric_limits<double>::infinity();
  for (const Mode& mode : exact) {
    result.fast.push_back(mode.root);
    const double growth = mode.root.real() - slow_growth;
    result.fast_growth = std::max(result.fast_growth, growth);
    if (growth > options.tolerated_growth * std::abs(mode.root)) {
      result.obstacle = Obstacle::growing_nutation;
    }
  }
  if (result.obstacle == Obstacle::none && result.greatest_shift > options.tolerated_shift) {
    result.obstacle = Obstacle::not_slow;
  }
  return result;
}

/// K = -dQ/d(displacement) of a model at rest in a place, by differences.
///
/// Error  : of fourth order in steps of 1e-3
template <class Model>
[[nodiscard]] Eigen::MatrixXd stiffness(const Model& model, double t,
                                        const Eigen::VectorXd& place) {
  const Eigen::Index n = model.forces(t, place).A.rows();
  const double h = 1e-3;
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto off = [&](double step) -> Eigen::VectorXd {
      const Eigen::VectorXd e = step * Eigen::VectorXd::Unit(n, j);
      return model.forces(t, model.moved(place, Eigen::VectorXd(-e))).Q -
             model.forces(t, model.moved(place, e)).Q;
    };
    K.col(j) = (8 * off(h) - off(2 * h)) / (12 * h);
  }
  return K;
}

}  // namespace kreisel
