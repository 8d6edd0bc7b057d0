#pragma once

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <sstream>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/transition.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// Stability of a periodic motion by Floquet's theory.
enum class Stability {
  stable,    ///< bounded for ever, by the linear equations
  unstable,  ///< some neighbouring motions grow exponentially
  undecided  ///< so near to the boundary that the matrix's error does not allow a verdict
};

/// The eigenvalues of the transition matrix over one period: the growth factors of neighbouring
/// motions.
///
/// Source : G. Floquet, Annales de l'Ecole Normale 12 (1883) 47
/// Error  : u |X| and that of the matrix, times the eigenvalue's condition: near a stability
///          boundary, where two of them meet, the square root of it
/// Throws : ComputationFailed if the QR iteration does not converge
template <int n>
[[nodiscard]] Eigen::Matrix<std::complex<double>, n, 1> floquet_multipliers(
    const Transition<n>& period) {
  return eigenvalues(period.matrix);
}

/// The multipliers of two degrees of freedom without damping, in pairs l and 1/l:
///
///   l^4 - a_1 l^3 + a_2 l^2 - a_1 l + 1 = 0,   z = l + 1/l,   z^2 - a_1 z + a_2 - 2 = 0
///
/// Stable if and only if both z are real, distinct and within (-2, 2). On the boundary one of three
/// discriminants is 0:
///
///   at_minus_one = a_2 + 2 a_1 + 2    a pair leaves through -1: a subharmonic of twice the period
///   at_plus_one  = a_2 - 2 a_1 + 2    through +1: divergence
///   krein        = a_1^2 - 4 (a_2 - 2)    two pairs meet on the circle and leave it together
///
/// The discriminants are computed without multipliers. They are smooth in every parameter, also at
/// branch points of the multipliers.
///
/// Source : Floquet; M. G. Krein; paper 002 (49), whose coefficients have the period pi/Omega
/// Units  : 1
struct PairedMultipliers {
  double a_1 = 0;  ///< trace of X
  double a_2 = 0;  ///< sum of its principal 2x2 minors
  double a_1_error = 0;
  double a_2_error = 0;

  /// Error  : bounds by that of the matrix, entry by entry
  /// Throws : InvalidInput if the multipliers are no pairs: the equations are damped or driven, or
  ///          conserve nothing; then floquet_multipliers() has to do
  [[nodiscard]] static PairedMultipliers of(const Transition<4>& period) {
    const auto& X = period.matrix;
    const auto& E = period.error;
    PairedMultipliers p;
    for (int i = 0; i < 4; ++i) {
      p.a_1 += X(i, i);
      p.a_1_error += E(i, i);
      for (int j = 0; j < i; ++j) {
        p.a_2 += X(i, i) * X(j, j) - X(i, j) * X(j, i);
        p.a_2_error += std::abs(X(i, i)) * E(j, j) + std::abs(X(j, j)) * E(i, i) +
                       std::abs(X(i, j)) * E(j, i) + std::abs(X(j, i)) * E(i, j);
      }
    }
    const double det = X.determinant();
    // |X|^-1 has the size of X, so that this is the determinant's error on the minors' scale.
    const double slack = 8 * (p.a_1_error + p.a_2_error) + 1e-9;
    if (!(std::abs(det - 1) <= slack)) {
      std::ostringstream text;
      text.precision(10);
      text << "Floquet multipliers: the determinant over one period is " << det
           << ", not 1: the multipliers are no pairs l, 1/l";
      throw InvalidInput(text.str());
    }
    return p;
  }

  [[nodiscard]] double at_minus_one() const { return a_2 + 2 * a_1 + 2; }
  [[nodiscard]] double at_plus_one() const { return a_2 - 2 * a_1 + 2; }
  [[nodiscard]] double krein() const { return a_1 * a_1 - 4 * (a_2 - 2); }

  /// Errors of at_minus_one() and at_plus_one(), and of krein().
  [[nodiscard]] double one_error() const { return a_2_error + 2 * a_1_error; }
  [[nodiscard]] double krein_error() const { return 2 * std::abs(a_1) * a_1_error + 4 * a_2_error; }

  [[nodiscard]] Stability verdict() const {
    if (krein() < -krein_error() || at_minus_one() < -one_error() || at_plus_one() < -one_error()) {
      return Stability::unstable;
    }
    const bool inside = at_minus_one() > one_error() && at_plus_one() > one_error();
    // If both products (z_1 + 2)(z_2 + 2) and (z_1 - 2)(z_2 - 2) are positive, both z lie on the
    // same side of -2 and of 2.
    if (inside && krein() > krein_error()) {
      return std::abs(a_1) < 4 ? Stability::stable : Stability::unstable;
    }
    return inside && std::abs(a_1) - a_1_error > 4 ? Stability::unstable : Stability::undecided;
  }

  /// l_1, 1/l_1, l_2, 1/l_2; first those outside the unit circle or on its upper half.
  ///
  /// Error  : of a_1 and a_2 times 1/(|z_1 - z_2| |l - 1/l|)
  [[nodiscard]] std::array<std::complex<double>, 4> multipliers() const {
    using Complex = std::complex<double>;
    const double D = krein();
    // Krein's discriminant; that of l^2 - z l + 1 is a product, to avoid cancellation.
    Complex z_1, z_2;
    if (D >= 0) {
      const double larger = (a_1 + std::copysign(std::sqrt(D), a_1)) / 2;
      z_1 = larger;
      z_2 = larger != 0 ? (a_2 - 2) / larger : 0;
    } else {
      z_1 = Complex(a_1, std::sqrt(-D)) / 2.0;
      z_2 = std::conj(z_1);
    }
    const auto pair = [](const Complex& z) {
      const Complex root = std::sqrt(z - 2.0) * std::sqrt(z + 2.0);
      const Complex plus = (z + root) / 2.0;
      const Complex minus = (z - root) / 2.0;
      return std::abs(plus) >= std::abs(minus) ? plus : minus;
    };
    const Complex l_1 = pair(z_1);
    const Complex l_2 = pair(z_2);
    return {l_1, 1.0 / l_1, l_2, 1.0 / l_2};
  }

  /// The greatest |l|: growth in one period; 1 if the verdict is stable.
  [[nodiscard]] double growth() const {
    if (verdict() == Stability::stable) return 1;
    double most = 1;
    for (const auto& l : multipliers()) most = std::max(most, std::abs(l));
    return most;
  }
};

/// The paired multipliers of a linear scene of two degrees of freedom without damping.
///
/// Scene  : has period() in seconds and state_matrix(t), 4x4
template <class Scene>
[[nodiscard]] PairedMultipliers paired_multipliers(const Scene& scene,
                                                   const Accuracy& accuracy = {}) {
  const auto A = [&scene](double t) { return scene.state_matrix(t); };
  return PairedMultipliers::of(linear_transition<4>(A, 0, scene.period(), accuracy));
}

}  // namespace kreisel
