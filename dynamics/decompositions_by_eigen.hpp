#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include <dynamics/decompositions.hpp>

// What <dynamics/decompositions.hpp> declares: included by it, or compiled once.

#ifdef KREISEL_DECOMPOSITIONS_COMPILED
#define KREISEL_IF_CALLED
#else
#define KREISEL_IF_CALLED template <int>
#endif

namespace kreisel::detail {

inline void check_convergence(Eigen::ComputationInfo info) {
  if (info == Eigen::Success) return;
  throw ComputationFailed("the QR iteration for eigenvalues does not converge");
}

KREISEL_IF_CALLED Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_IF_CALLED Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A, false);
  check_convergence(solver.info());
  return solver.eigenvalues();
}

KREISEL_IF_CALLED RealEigenpairs<Eigen::MatrixXd> symmetric_eigenpairs(const Eigen::MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_IF_CALLED RealEigenpairs<Eigen::MatrixXcd> hermitian_eigenpairs(const Eigen::MatrixXcd& A) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

KREISEL_IF_CALLED SingularValues<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

KREISEL_IF_CALLED SingularValues<Eigen::MatrixXcd> singular_values(const Eigen::MatrixXcd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

KREISEL_IF_CALLED std::optional<Eigen::MatrixXcd> inverse(const Eigen::MatrixXcd& A) {
  const Eigen::FullPivLU<Eigen::MatrixXcd> factors(A);
  if (!factors.isInvertible()) return std::nullopt;
  return Eigen::MatrixXcd(factors.inverse());
}

KREISEL_IF_CALLED Eigen::VectorXcd solution(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  return A.fullPivLu().solve(b);
}

}  // namespace kreisel::detail

#undef KREISEL_IF_CALLED
