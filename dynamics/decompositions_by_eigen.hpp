#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <dynamics/decompositions.hpp>

// What <dynamics/decompositions.hpp> declares: included by it, or compiled once.

#ifdef KREISEL_DECOMPOSITIONS_COMPILED
#define KREISEL_INLINE
#else
#define KREISEL_INLINE inline
#endif

namespace kreisel::detail {

inline void check_convergence(Eigen::ComputationInfo info) {
  if (info == Eigen::Success) return;
  throw ComputationFailed("the QR iteration for eigenvalues does not converge");
}

KREISEL_INLINE Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_INLINE Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, false);
  check_convergence(solver.info());
  return solver.eigenvalues();
}

KREISEL_INLINE RealEigenpairs<Eigen::MatrixXd> symmetric_eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_INLINE RealEigenpairs<Eigen::MatrixXcd> hermitian_eigenpairs(const Eigen::MatrixXcd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_INLINE SingularValues<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

KREISEL_INLINE SingularValues<Eigen::MatrixXcd> singular_values(const Eigen::MatrixXcd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

KREISEL_INLINE std::optional<Eigen::MatrixXcd> inverse(const Eigen::MatrixXcd& A) {
  const Eigen::FullPivLU<Eigen::MatrixXcd> factors(A);
  if (!factors.isInvertible()) return std::nullopt;
  return Eigen::MatrixXcd(factors.inverse());
}

KREISEL_INLINE Eigen::VectorXcd solution(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return A.fullPivLu().solve(b);
}

}  // namespace kreisel::detail

#undef KREISEL_INLINE
