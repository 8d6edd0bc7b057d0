#pragma once

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A motion exp(root t) shape of linear equations.
///
/// Units  : root in rad/s; the shape has norm 1 and no phase of its own
struct Mode {
  std::complex<double> root;
  double error = 0;  ///< of the root: rounding times its condition
  Eigen::VectorXcd shape;
};

/// Type of a mode of a system with rotors, by the dependence of its frequency on the rotors'
/// momenta L: d ln|root| / d ln(L). This tends to 1 for a nutation of fast rotors (~ L/J) and to -1
/// for a precession (~ K/L). It tends to 0 for an oscillation of stiffness and inertia alone.
enum class ModeKind {
  nutation,    ///< grows by more than the square root of L
  precession,  ///< falls by more than the square root of L
  oscillation  ///< neither: stiffness dominates the rotors. Also a root that does not oscillate
};

/// A mode of a system of second order without damping.
struct GyroscopicMode : Mode {
  /// d ln|root| / d ln(L) for all momenta in proportion. It is exact, by the first-order change of
  /// the root of m w^2 + gamma w - k = 0: -gamma/(2 m w + gamma). 0 for modes that do not
  /// oscillate.
  double spin_growth = 0;

  /// Sign of the energy x.(w^2 M + K) x of an oscillation. It is -1 if gyroscopic forces alone
  /// stabilise the mode: any damping, however small, then lets the mode grow. 0 without
  /// oscillation.
  int energy_sign = 0;

  [[nodiscard]] ModeKind kind() const {
    if (std::abs(spin_growth) <= 0.5) return ModeKind::oscillation;
    return spin_growth > 0 ? ModeKind::nutation : ModeKind::precession;
  }
};

namespace detail {

[[nodiscard]] inline bool faster(const std::complex<double>& a, const std::complex<double>& b) {
  if (std::abs(a.imag()) != std::abs(b.imag())) return std::abs(a.imag()) < std::abs(b.imag());
  return a.imag() != b.imag() ? a.imag() > b.imag() : a.real() < b.real();
}

/// Makes the greatest component real and positive, so that equal modes are equal numbers.
inline void take_phase_out(Eigen::VectorXcd& shape) {
  Eigen::Index greatest = 0;
  if (!(shape.cwiseAbs().maxCoeff(&greatest) > 0)) return;
  shape *= std::conj(shape[greatest]) / std::abs(shape[greatest]);
  shape /= shape.norm();
}

template <class... Words>
[[noreturn]] void refuse_spectrum(const Words&... words) {
  std::ostringstream text;
  text.precision(10);
  text << "spectrum: ";
  (text << ... << words);
  throw InvalidInput(text.str());
}

}  // namespace detail

/// The modes of x' = A x, slowest oscillation first. In a conjugate pair the root with root.imag()
/// > 0 comes first.
///
/// error  : of A itself, as a norm
/// Error  : reported for each: 8 u |A| and `error` times the condition 1/|y.x| of the root, y and x
///          its left and right vectors; for a root that is (nearly) multiple and has too few vectors
///          u^(1/n) |A|, the distance by which such a root moves
/// Throws : InvalidInput if A is not square or not finite; ComputationFailed if QR does not
///          converge
[[nodiscard]] inline std::vector<Mode> spectrum(const Eigen::MatrixXd& A, double error = 0) {
  if (A.rows() != A.cols() || !(A - A).isZero(0)) {
    detail::refuse_spectrum("the state matrix is not square or not finite");
  }
  const auto [roots, V] = detail::eigenpairs(A);
  const std::optional<Eigen::MatrixXcd> left = detail::inverse(V);
  const double size = A.norm();
  const double u = std::numeric_limits<double>::epsilon() / 2 + (size > 0 ? error / (8 * size) : 0);
  const double most = std::pow(u, 1 / std::max(2.0, double(A.rows()))) * size;
  std::vector<Mode> modes;
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const double condition = left ? left->row(i).norm() * V.col(i).norm() : 0;
    modes.push_back({roots[i], left ? std::min(8 * u * size * condition, most) : most, V.col(i)});
    detail::take_phase_out(modes.back().shape);
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return detail::faster(a.root, b.root); });
  return modes;
}

/// The state matrix of  M x'' + C x' + K x = 0  on (x, x').
///
/// Coefficients : has mass, damping and stiffness, square matrices of one size
/// Throws       : InvalidInput if M is not positive definite
template <class Coefficients>
[[nodiscard]] Eigen::MatrixXd state_matrix(const Coefficients& c) {
  const Eigen::MatrixXd M = c.mass;
  const Eigen::LLT<Eigen::MatrixXd> factor(M);
  if (factor.info() != Eigen::Success) {
    detail::refuse_spectrum("the mass matrix is not positive definite");
  }
  const Eigen::Index n = M.rows();
  Eigen::MatrixXd A(2 * n, 2 * n);
  A << Eigen::MatrixXd::Zero(n, n), Eigen::MatrixXd::Identity(n, n),
      -factor.solve(Eigen::MatrixXd(c.stiffness)), -factor.solve(Eigen::MatrixXd(c.damping));
  return A;
}

namespace detail {

/// x.M x, x.K x and the imaginary part of x.G x. They determine the root i w of a mode of shape x:
/// m w^2 + gamma w - k = 0.
struct ModalNumbers {
  double m, gamma, k;

  template <class Coefficients>
  [[nodiscard]] static ModalNumbers of(const Coefficients& c, const Eigen::VectorXcd& x) {
    const Eigen::MatrixXd M = c.mass, G = c.damping, K = c.stiffness;
    const Eigen::VectorXd re = x.real(), im = x.imag();
    return {re.dot(M * re) + im.dot(M * im), 2 * re.dot(G * im), re.dot(K * re) + im.dot(K * im)};
  }

  /// The root next to w, without cancellation for k >= 0. The value is stationary: its error is the
  /// square of the shape's error.
  [[nodiscard]] double frequency(double w) const {
    const double root = std::sqrt(std::max(gamma * gamma + 4 * m * k, 0.0));
    const double far = -(gamma + std::copysign(root, gamma)) / (2 * m);
    const double near = far != 0 ? -k / (m * far) : 0;
    return std::abs(far - w) < std::abs(near - w) ? far : near;
  }
};

template <class Coefficients>
[[nodiscard]] GyroscopicMode oscillation(const Coefficients& c, Eigen::VectorXcd shape, double w,
                                         double error) {
  take_phase_out(shape);
  const auto [m, gamma, k] = ModalNumbers::of(c, shape);
  const double frequency = ModalNumbers{m, gamma, k}.frequency(w);
  GyroscopicMode mode;
  mode.root = {0, frequency};
  mode.error = error;
  mode.shape = std::move(shape);
  const double slope = 2 * frequency * m + gamma;
  mode.spin_growth = slope != 0 ? -gamma / slope : 0;
  mode.energy_sign = frequency * frequency * m + k > 0 ? 1 : -1;
  return mode;
}

/// With M = L L' and p = L' x the equations are p'' + G p' + R R' p = 0, and in s = R' p, v = p'
///
///   (s; v)' = (0  R'; -R  -G) (s; v),
///
/// a skew matrix. Times i it is Hermitian, and its eigenvalues are real to the last bit.
template <class Coefficients>
[[nodiscard]] std::vector<GyroscopicMode> definite_modes(const Coefficients& c,
                                                         const Eigen::MatrixXd& L,
                                                         const Eigen::MatrixXd& G,
                                                         const Eigen::MatrixXd& R) {
  using Complex = std::complex<double>;
  const Eigen::Index n = G.rows();
  Eigen::MatrixXd skew(2 * n, 2 * n);
  skew << Eigen::MatrixXd::Zero(n, n), R.transpose(), -R, -G;
  // exp(i w t) z with (-i skew) z = w z.
  const auto [speeds, shapes] = hermitian_eigenpairs(skew.cast<Complex>() * Complex(0, -1));
  const double u = std::numeric_limits<double>::epsilon() / 2;
  const double error = 8 * u * skew.norm();
  std::vector<GyroscopicMode> modes;
  for (Eigen::Index i = n; i < 2 * n; ++i) {
    const double w = speeds[i];
    Eigen::VectorXcd shape =
        L.transpose().triangularView<Eigen::Upper>().solve(Eigen::VectorXcd(shapes.col(i).tail(n)));
    if (w > error) {
      modes.push_back(oscillation(c, std::move(shape), w, error));
      continue;
    }
    GyroscopicMode rest;
    rest.error = error;
    rest.shape = Eigen::VectorXcd::Zero(n);
    modes.push_back(rest);
  }
  return modes;
}

/// The roots of the state matrix. Roots of a conservative system are symmetric about the imaginary
/// axis. A root with no other root within its error of its mirror image lies on the axis.
template <class Coefficients>
[[nodiscard]] std::vector<GyroscopicMode> indefinite_modes(const Coefficients& c) {
  const std::vector<Mode> all = spectrum(state_matrix(c));
  const Eigen::Index n = c.mass.rows();
  std::vector<GyroscopicMode> modes;
  for (const Mode& mode : all) {
    if (mode.root.imag() < 0) continue;
    const std::complex<double> mirror = -std::conj(mode.root);
    const auto near = [&](const Mode& other) {
      return std::abs(other.root - mirror) <= 2 * mode.error + other.error;
    };
    const auto partners = std::count_if(all.begin(), all.end(), near);
    const bool own = std::abs(mode.root.real()) <= mode.error && partners == 1;
    Eigen::VectorXcd shape = mode.shape.head(n);
    if (own && mode.root.imag() > mode.error) {
      modes.push_back(oscillation(c, std::move(shape), mode.root.imag(), mode.error));
    } else {
      GyroscopicMode other;
      other.root = mode.root;
      other.error = mode.error;
      take_phase_out(shape);
      other.shape = shape;
      modes.push_back(other);
    }
  }
  return modes;
}

}  // namespace detail

/// The modes of a system without damping,
///
///   M x'' + G x' + K x = 0,   M = M' > 0,   G = -G',   K = K',
///
/// slowest first; the root with root.imag() > 0 stands for each conjugate pair.
///
/// K >= 0: one mode for each coordinate, its root exactly on the imaginary axis. A double root 0
/// appears once, with the shape 0.
///
/// K indefinite: gyroscopic forces may keep the roots on the axis or not (Thomson and Tait). A root
/// then counts as on the axis only if rounding cannot hide a distance from it. At the border of
/// stability this stays undecided.
///
/// Coefficients : has mass, damping = G, and stiffness
/// Error        : of each root reported; where K >= 0 some 1e-15 of |K/M|^(1/2) and |G/M|, and slow
///                modes better, since their frequency is taken from M, G, K and the shape again
/// Throws       : InvalidInput if M, G, K are not exactly symmetric, skew, symmetric or M is not
///                positive definite; damped systems go through spectrum(state_matrix(c))
template <class Coefficients>
[[nodiscard]] std::vector<GyroscopicMode> conservative_spectrum(const Coefficients& c) {
  const Eigen::MatrixXd M = c.mass, G = c.damping, K = c.stiffness;
  if (!(M - M.transpose()).isZero(0) || !(K - K.transpose()).isZero(0) ||
      !(G + G.transpose()).isZero(0)) {
    detail::refuse_spectrum(
        "mass and stiffness are not symmetric, or the gyroscopic matrix is not skew: the system is "
        "damped or driven");
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(M);
  if (factor.info() != Eigen::Success) {
    detail::refuse_spectrum("the mass matrix is not positive definite");
  }
  const Eigen::MatrixXd L = factor.matrixL();
  const auto normalised = [&L](const Eigen::MatrixXd& X) {
    const Eigen::MatrixXd half = L.triangularView<Eigen::Lower>().solve(X);
    return Eigen::MatrixXd(L.triangularView<Eigen::Lower>().solve(half.transpose()).transpose());
  };
  const Eigen::MatrixXd G_1 = normalised(G);
  const auto [k, directions] = detail::symmetric_eigenpairs(normalised(K));
  const double zero = 16 * std::numeric_limits<double>::epsilon() * k.cwiseAbs().maxCoeff();
  std::vector<GyroscopicMode> modes;
  if (k.minCoeff() >= -zero) {
    // No square root of a rounding residue.
    const Eigen::VectorXd roots =
        k.unaryExpr([zero](double x) { return x > zero ? std::sqrt(x) : 0.0; });
    const Eigen::MatrixXd R = directions * roots.asDiagonal();
    modes = detail::definite_modes(c, L, (G_1 - G_1.transpose()) / 2, R);
  } else {
    modes = detail::indefinite_modes(c);
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const Mode& a, const Mode& b) { return detail::faster(a.root, b.root); });
  return modes;
}

}  // namespace kreisel
