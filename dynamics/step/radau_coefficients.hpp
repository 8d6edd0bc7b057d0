#pragma once

#include <Eigen/Core>

#include <complex>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// Coefficients of Radau IIA collocation in s stages, s odd, of order 2 s - 1; the last node is the
/// end of the step.
///
///   sum_j A_ij c_j^k = c_i^(k+1)/(k+1),  k < s
///
/// The inverse of its matrix has one real eigenvalue and pairs of complex ones. They split Newton's
/// method for all stages into systems of the field's own size:
///
///   A^-1 = V diag(eigenvalue) V^-1
///
/// All coefficients follow from the nodes in closed form. A^-1 differentiates the polynomials of
/// degree s that vanish at 0. Let M(x) = (x - c_1) ... (x - c_s). The polynomials with y' = lambda
/// y at the nodes are y = sum_k M^(k) / lambda^k, and y(0) = 0 is the equation for lambda. By the
/// weights b the rows of V^-1 have the same form, with M(x) / (x - 1) and -lambda.
///
/// Source : E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, IV.5 and IV.8; the
///          same, Stiff differential equations solved by Radau methods, J. Comput. Appl. Math. 111
///          (1999) 93
/// Error  : <= 2e-14 of the greatest                      (tests/dynamics/step/radau.cpp)
struct KREISEL_API RadauCoefficients {
  explicit RadauCoefficients(int stages);

  /// An eigenvalue of A^-1 with its column of V and its row of V^-1.
  template <class Number>
  struct Mode {
    Number eigenvalue{};
    Eigen::Vector<Number, Eigen::Dynamic> vector;
    Eigen::Vector<Number, Eigen::Dynamic> covector;
  };

  Eigen::VectorXd node;     ///< c
  Eigen::MatrixXd inverse;  ///< A^-1

  Mode<double> real;
  std::vector<Mode<std::complex<double>>> pairs;  ///< one of each pair

  /// Weights of the stages in the error estimate f(y) + sum_i error_i Z_i / h.
  Eigen::VectorXd error;
};

}  // namespace kreisel
