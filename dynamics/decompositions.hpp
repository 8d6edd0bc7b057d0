#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>

#include <motor/api.hpp>
#include <motor/error.hpp>

/// Decompositions of matrices whose size is known at run time, by Eigen. They are the slowest of
/// Eigen to compile, and are the same for every scene. A matrix without rows or columns has no values.

namespace kreisel::detail {

/// A x = value x; the columns of `vectors` have norm 1.
struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};

/// Throws : ComputationFailed if the QR iteration does not converge; as all below for eigenvalues
KREISEL_API [[nodiscard]] Eigenpairs eigenpairs(const Eigen::MatrixXd& A);

/// As eigenpairs(), without vectors.
KREISEL_API [[nodiscard]] Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// Of a symmetric or Hermitian matrix, whose values are real and whose vectors are orthonormal.
template <class Matrix>
struct RealEigenpairs {
  Eigen::VectorXd values;  ///< rising
  Matrix vectors;
};

/// Only the lower triangle is read.
KREISEL_API [[nodiscard]] RealEigenpairs<Eigen::MatrixXd> symmetric_eigenpairs(
    const Eigen::MatrixXd& A);
KREISEL_API [[nodiscard]] RealEigenpairs<Eigen::MatrixXcd> hermitian_eigenpairs(
    const Eigen::MatrixXcd& A);

/// A = U diag(values) V^*, with square U and V.
template <class Matrix>
struct SingularValues {
  Eigen::VectorXd values;  ///< falling
  Matrix U;
  Matrix V;
};

KREISEL_API [[nodiscard]] SingularValues<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A);
KREISEL_API [[nodiscard]] SingularValues<Eigen::MatrixXcd> singular_values(
    const Eigen::MatrixXcd& A);

/// By full pivoting; nothing where A has not its full rank, to rounding.
KREISEL_API [[nodiscard]] std::optional<Eigen::MatrixXcd> inverse(const Eigen::MatrixXcd& A);

/// A^-1 b, by full pivoting.
KREISEL_API [[nodiscard]] Eigen::VectorXcd solution(const Eigen::MatrixXcd& A,
                                                    const Eigen::VectorXcd& b);

/// The shortest of all x that come nearest to  A x = b.
struct ShortestSolution {
  Eigen::VectorXd x;
  int rank = 0;  ///< of A
};

/// By a complete orthogonal decomposition.
///
/// threshold : a pivot is 0 below so much of the greatest
KREISEL_API [[nodiscard]] ShortestSolution shortest_solution(const Eigen::MatrixXd& A,
                                                             const Eigen::VectorXd& b,
                                                             double threshold);

}  // namespace kreisel::detail
