#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>

#include <motor/api.hpp>
#include <motor/error.hpp>

/// Decompositions of matrices whose size is known at run time, by Eigen. They are compiled once, in
/// libkreisel: they are the slowest of Eigen to compile and the same for every scene. A matrix
/// without rows or columns has no eigenvalues.

namespace kreisel {

/// The eigenvalues of a real square matrix, in no order.
///
/// Throws : ComputationFailed if the QR iteration does not converge
KREISEL_API [[nodiscard]] Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

namespace detail {

/// Eigenvalues and eigenvectors: A x = value x. The columns of `vectors` have norm 1.
struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// Throws : as eigenvalues(); so do all functions below that compute eigenvalues
KREISEL_API [[nodiscard]] Eigenpairs eigenpairs(const Eigen::MatrixXd& A);

/// Eigenpairs of a symmetric or Hermitian matrix: real values and orthonormal vectors.
template <class Matrix>
struct RealEigenpairs {
  Eigen::VectorXd values;  ///< rising
  Matrix vectors;
};

/// The eigenpairs of a symmetric matrix, of which only the lower triangle is read.
KREISEL_API [[nodiscard]] RealEigenpairs<Eigen::MatrixXd> symmetric_eigenpairs(
    const Eigen::MatrixXd& A);
KREISEL_API [[nodiscard]] RealEigenpairs<Eigen::MatrixXcd> hermitian_eigenpairs(
    const Eigen::MatrixXcd& A);

/// Singular values: A = U diag(values) V^*, with square U and V.
template <class Matrix>
struct SingularValues {
  Eigen::VectorXd values;  ///< falling
  Matrix U;
  Matrix V;
};

KREISEL_API [[nodiscard]] SingularValues<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A);
KREISEL_API [[nodiscard]] SingularValues<Eigen::MatrixXcd> singular_values(
    const Eigen::MatrixXcd& A);

/// The inverse, by full pivoting; nothing if A does not have full rank, to rounding.
KREISEL_API [[nodiscard]] std::optional<Eigen::MatrixXcd> inverse(const Eigen::MatrixXcd& A);

/// A^-1 b, by full pivoting.
KREISEL_API [[nodiscard]] Eigen::VectorXcd solution(const Eigen::MatrixXcd& A,
                                                    const Eigen::VectorXcd& b);

/// The exponential of a square matrix, by scaling and squaring of a Pade approximant.
///
/// Error : some 1e-15 |A| of its norm if A is normal
KREISEL_API [[nodiscard]] Eigen::MatrixXd exponential(const Eigen::MatrixXd& A);

/// The shortest of all x that minimise  |A x - b|.
struct ShortestSolution {
  Eigen::VectorXd x;
  int rank = 0;  ///< of A
};

/// The shortest solution, by a complete orthogonal decomposition.
///
/// threshold : a pivot below this fraction of the greatest pivot counts as 0
KREISEL_API [[nodiscard]] ShortestSolution shortest_solution(const Eigen::MatrixXd& A,
                                                             const Eigen::VectorXd& b,
                                                             double threshold);

}  // namespace detail

}  // namespace kreisel
