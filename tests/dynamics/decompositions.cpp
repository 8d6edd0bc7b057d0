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

// The Jacobian of a top, with an equal pair of eigenvalues: Eigen's QR iteration does not end on it.
BOOST_AUTO_TEST_CASE(eigenvalues_of_an_equal_pair) {
  constexpr double a = 0x1.979e58975b0dcp+0, b = 0x1.5d2ab2c65091ep-1, c = 0x1.8ec609545c35ap-1;
  constexpr double d = 0x1.f67bbbc1e95fap-2, e = 0x1.14b178af01fbp-5, f = 0x1.6f1d2d01c8b24p-7;
  constexpr double g = 0x1.6d007b50d5b2cp-4, h = 0x1.31b6c271844a5p+1, i = 0x1.2b1486ff45284p+0;
  constexpr double k = 0x1.17555bd1da0e5p-1, l = 0x1.3f04d4437cf7cp-1;
  Eigen::MatrixXd A(7, 7);
  A << 0, a, -b, c, -d, e, f,   //
      -a, 0, c, b, -e, -d, g,   //
      b, -c, 0, a, -f, -g, -d,  //
      -c, -b, -a, 0, g, -f, e,  //
      0, 0, 0, 0, 0, -a, -b,    //
      0, 0, 0, 0, h, 0, i,      //
      0, 0, 0, 0, -k, -l, 0;
  const double bound = 20 * 7 * test::u<> * A.squaredNorm();
  const Eigen::VectorXcd values = eigenvalues(A);
  BOOST_TEST(std::abs(values.sum()) <= bound);
  BOOST_TEST(std::abs(values.array().square().sum() - (A * A).trace()) <= bound);
  const auto pairs = detail::eigenpairs(A);
  const Eigen::MatrixXcd off = A * pairs.vectors - pairs.vectors * pairs.values.asDiagonal();
  BOOST_TEST(off.norm() <= bound);
}

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
