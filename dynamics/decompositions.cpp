#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

#include <cmath>
#include <complex>

#include <dynamics/decompositions.hpp>

namespace kreisel {

namespace detail {

inline void check_convergence(Eigen::ComputationInfo info) {
  if (info == Eigen::Success) return;
  throw ComputationFailed("the QR iteration for eigenvalues does not converge");
}

}  // namespace detail

// As Eigen::EigenSolver has it, which takes the compiler twice as long: it also compiles what makes
// vectors.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  if (!A.allFinite()) detail::check_convergence(Eigen::NoConvergence);
  const Eigen::Index n = A.rows();
  const double scale = A.isZero(0) ? 1 : A.cwiseAbs().maxCoeff();  // lest anything overflow
  Eigen::RealSchur<Eigen::MatrixXd> schur(n);
  const auto compute = [&schur](const Eigen::MatrixXd& scaled) {
    const Eigen::HessenbergDecomposition<Eigen::MatrixXd> hessenberg(scaled);
    schur.computeFromHessenberg(hessenberg.matrixH(), Eigen::MatrixXd(), false);
  };
  compute(A / scale);
  // Eigen's iteration goes round in circles on some matrices with equal pairs of eigenvalues. In the
  // reverse order of rows and columns it takes another path.
  if (schur.info() != Eigen::Success) compute(A.reverse() / scale);
  detail::check_convergence(schur.info());
  const Eigen::MatrixXd& T = schur.matrixT();  // triangular but for a block of each complex pair
  Eigen::VectorXcd values(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (i + 1 == n || T(i + 1, i) == 0) {
      values[i] = scale * T(i, i);
      continue;
    }
    const double mean = (T(i, i) + T(i + 1, i + 1)) / 2;
    const double apart = (T(i, i) - T(i + 1, i + 1)) / 2;
    const double turn = std::sqrt(std::abs(apart * apart + T(i, i + 1) * T(i + 1, i)));
    values[i] = scale * std::complex<double>(mean, turn);
    values[i + 1] = std::conj(values[i]);
    ++i;
  }
  return values;
}

namespace detail {

Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  if (solver.info() == Eigen::Success) return {solver.eigenvalues(), solver.eigenvectors()};
  solver.compute(A.reverse());  // as in eigenvalues()
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors().colwise().reverse()};
}

RealEigenpairs<Eigen::MatrixXd> symmetric_eigenpairs(const Eigen::MatrixXd& A) {
  if (A.size() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

RealEigenpairs<Eigen::MatrixXcd> hermitian_eigenpairs(const Eigen::MatrixXcd& A) {
  if (A.size() == 0) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver(A);
  check_convergence(solver.info());
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SingularValues<Eigen::MatrixXd> singular_values(const Eigen::MatrixXd& A) {
  if (A.size() == 0) {
    return {{},
            Eigen::MatrixXd::Identity(A.rows(), A.rows()),
            Eigen::MatrixXd::Identity(A.cols(), A.cols())};
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

SingularValues<Eigen::MatrixXcd> singular_values(const Eigen::MatrixXcd& A) {
  if (A.size() == 0) {
    return {{},
            Eigen::MatrixXcd::Identity(A.rows(), A.rows()),
            Eigen::MatrixXcd::Identity(A.cols(), A.cols())};
  }
  const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.singularValues(), svd.matrixU(), svd.matrixV()};
}

std::optional<Eigen::MatrixXcd> inverse(const Eigen::MatrixXcd& A) {
  if (A.size() == 0) return A;
  const Eigen::FullPivLU<Eigen::MatrixXcd> factors(A);
  if (!factors.isInvertible()) return std::nullopt;
  return Eigen::MatrixXcd(factors.inverse());
}

Eigen::VectorXcd solution(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& b) {
  if (A.size() == 0) return Eigen::VectorXcd::Zero(A.cols());
  return A.fullPivLu().solve(b);
}

Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
  return A.size() == 0 ? A : Eigen::MatrixXd(A.exp());
}

ShortestSolution shortest_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                   double threshold) {
  if (A.size() == 0) return {Eigen::VectorXd::Zero(A.cols()), 0};
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(threshold);
  factors.compute(A);
  return {factors.solve(b), static_cast<int>(factors.rank())};
}

}  // namespace detail

}  // namespace kreisel
