#include <Eigen/SVD>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <utility>

#include <dynamics/decompositions.hpp>

#include <support/near.hpp>

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(decompositions)

// Each eigenvalue makes A - value 1 singular, up to the effect of rounding A. All together they
// have the traces of A and of A A.
BOOST_AUTO_TEST_CASE(eigenvalues_make_singular) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto entry = [&] { return normal(random); };
  for (int i = 0; i < 300; ++i) {
    const int n = 1 + i % 12;
    Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, entry);
    if (i % 3 == 1) A -= A.transpose().eval();  // all on the imaginary axis
    if (i % 3 == 2) A.row(n - 1) = A.row(0);    // singular
    if (i % 5 == 1) A.leftCols(n / 2) *= 1e-6;  // unbalanced
    const double size = A.norm();
    const double bound = 20 * n * test::u<> * size;
    for (const double unit : {1.0, 0x1p-700, 0x1p700}) {
      const Eigen::VectorXcd values = eigenvalues(unit * A) / unit;
      BOOST_REQUIRE_EQUAL(values.size(), n);
      for (const std::complex<double> value : values) {
        const Eigen::MatrixXcd shifted = A - value * Eigen::MatrixXcd::Identity(n, n);
        const Eigen::JacobiSVD<Eigen::MatrixXcd> svd(shifted);
        BOOST_TEST(svd.singularValues()[n - 1] <= bound, "eigenvalue " << value << " of\n" << A);
      }
      BOOST_TEST(std::abs(values.sum() - A.trace()) <= bound);
      BOOST_TEST(values.squaredNorm() <= (1 + bound) * A.squaredNorm());  // Schur
      BOOST_TEST(std::abs(values.array().square().sum() - (A * A).trace()) <= bound * size);
    }
  }
}

// Matrices for which the shifts of the QR iteration would cycle, and those with one multiple
// eigenvalue.
BOOST_AUTO_TEST_CASE(eigenvalues_of_special_matrices) {
  Eigen::MatrixXd cyclic = Eigen::MatrixXd::Zero(6, 6);
  for (int i = 0; i < 6; ++i) cyclic(i, (i + 5) % 6) = 1;
  const Eigen::VectorXd sizes = eigenvalues(cyclic).cwiseAbs();
  BOOST_TEST((sizes.array() - 1).abs().maxCoeff() <= 40 * test::u<>);
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(5, 5);
  for (int i = 0; i + 1 < 5; ++i) block(i, i + 1) = 1;
  BOOST_TEST(eigenvalues(block).cwiseAbs().maxCoeff() == 0);
}

BOOST_AUTO_TEST_CASE(empty_matrices_have_no_eigenvalues) {
  BOOST_TEST(eigenvalues(Eigen::MatrixXd(0, 0)).size() == 0);
  BOOST_TEST(eigenvalues(Eigen::MatrixXd::Zero(3, 3)).isZero(0));
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL}) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(3, 3);
    A(1, 2) = wrong;
    BOOST_CHECK_THROW((void)eigenvalues(A), ComputationFailed);
  }
}

BOOST_AUTO_TEST_CASE(empty_matrices_have_no_decomposition) {
  for (const auto& [rows, columns] : {std::pair(0, 0), {0, 3}, {3, 0}}) {
    const Eigen::MatrixXd A(rows, columns);
    const Eigen::MatrixXcd C(rows, columns);
    for (const auto& identity : {detail::singular_values(A).U, detail::singular_values(A).V}) {
      BOOST_TEST(identity.isIdentity(0));
    }
    BOOST_TEST(detail::singular_values(A).values.size() == 0);
    BOOST_TEST(detail::singular_values(C).values.size() == 0);
    BOOST_TEST(detail::singular_values(A).U.rows() == rows);
    BOOST_TEST(detail::singular_values(C).V.rows() == columns);
    const auto shortest = detail::shortest_solution(A, Eigen::VectorXd::Zero(rows), 1e-16);
    BOOST_TEST(shortest.rank == 0);
    BOOST_TEST((shortest.x == Eigen::VectorXd::Zero(columns)));
  }
  const Eigen::MatrixXd none;
  BOOST_TEST(eigenvalues(none).size() == 0);
  BOOST_TEST(detail::eigenpairs(none).values.size() == 0);
  BOOST_TEST(detail::symmetric_eigenpairs(none).values.size() == 0);
  BOOST_TEST(detail::hermitian_eigenpairs(none).values.size() == 0);
  BOOST_TEST(detail::inverse(none)->size() == 0);
  BOOST_TEST(detail::solution(none, Eigen::VectorXcd()).size() == 0);
}

BOOST_AUTO_TEST_SUITE_END()
