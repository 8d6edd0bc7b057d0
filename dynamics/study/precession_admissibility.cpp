#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/precession_admissibility.hpp>
#include <dynamics/study/precession_point.hpp>
#include <dynamics/study/spectrum.hpp>

namespace kreisel {

namespace detail {

/// True if all roots of A x'' + D x' + K x = 0 are real and <= 0, and half of them are slower than
/// all others. A may then be left out.
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

/// The state matrix of the precession equations on (displacement; v).
[[nodiscard]] inline Eigen::MatrixXd precession_matrix(const Directions& d,
                                                       const PrecessionPoint& p,
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

/// True if two shapes are parallel.
[[nodiscard]] inline bool parallel(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
  return 1 - std::abs(a.dot(b)) / (a.norm() * b.norm()) < 1e-6;
}

}  // namespace detail

Admissibility admissibility(const GyroForces& f, const Eigen::MatrixXd& K,
                            const AdmissibilityOptions& options) {
  using Complex = std::complex<double>;
  const Eigen::Index n = K.rows();
  Admissibility result;
  const PrecessionOptions on_kernel{.rank_tolerance = options.rank_tolerance};
  auto d = detail::Directions::of(f.G, on_kernel);
  result.singular_values = detail::singular_values(f.G).values;
  result.rank = static_cast<int>(d.P.cols());
  result.kernel = d.N;
  if (d.N.cols() > 0) {
    const auto along = [&d](const Eigen::MatrixXd& X) {
      return detail::product(detail::product(d.N_t, X), d.N);
    };
    result.kernel_overdamped = detail::overdamped(along(f.A), along(f.D), along(K));
    if (!result.kernel_overdamped) result.kept = KeptAccelerations::on_kernel;
  }
  if (result.kept == KeptAccelerations::none) {
    d = detail::Directions::of(f.G, {.kept = KeptAccelerations::none});
  }
  const detail::PrecessionPoint p(d, {f.A, f.G, f.D, Eigen::VectorXd::Zero(n)},
                                  Eigen::VectorXd::Zero(d.N.cols()));
  if (!p.determined) {
    result.obstacle = Obstacle::not_determined;
    return result;
  }

  struct {
    Eigen::MatrixXd mass, damping, stiffness;
  } const whole{f.A, p.W, K};
  std::vector<Mode> exact = spectrum(state_matrix(whole));
  const std::vector<Mode> precession = spectrum(detail::precession_matrix(d, p, K));
  const Eigen::MatrixXd A_kept = detail::product(detail::product(f.A, d.N), d.N_t);
  double size = 0, slow_growth = 0;
  for (const Mode& mode : precession) size = std::max(size, std::abs(mode.root));
  const auto simple = [&](std::size_t i) {
    return std::none_of(precession.begin(), precession.end(), [&](const Mode& other) {
      return &other != &precession[i] &&
             std::abs(other.root - precession[i].root) < 1e-6 * std::abs(other.root);
    });
  };
  for (std::size_t i = 0; i < precession.size(); ++i) {
    const Complex s = precession[i].root;
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
      const Eigen::MatrixXcd slope = p.W + 2.0 * s * A_kept;
      const Eigen::MatrixXcd left_out = (f.A - A_kept).cast<Complex>();
      const Eigen::VectorXcd sloped = slope * x, pushed = left_out * x;
      root.first_order = s - s * s * y.dot(pushed) / y.dot(sloped);
    }
    result.slow.push_back(root);
    for (std::size_t j = 0; j < i; ++j) {
      const bool one = std::abs(precession[j].root - s) <= 1e-6 * std::abs(s) &&
                       std::abs(s) > 1e-6 * size &&
                       detail::parallel(precession[i].shape, precession[j].shape);
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

Eigen::MatrixXd stiffness(const PrecessionModel& model, double t, const Eigen::VectorXd& position) {
  const Eigen::Index n = model.forces(t, position).A.rows();
  const double h = 1e-3;
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto off = [&](double step) -> Eigen::VectorXd {
      const Eigen::VectorXd e = step * Eigen::VectorXd::Unit(n, j);
      return model.forces(t, model.moved(position, Eigen::VectorXd(-e))).Q -
             model.forces(t, model.moved(position, e)).Q;
    };
    K.col(j) = (8 * off(h) - off(2 * h)) / (12 * h);
  }
  return K;
}

}  // namespace kreisel
