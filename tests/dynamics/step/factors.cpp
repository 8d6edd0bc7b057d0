#include <Eigen/LU>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <limits>

#include <dynamics/step/factors.hpp>

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(factors)

// Solutions against Eigen's with complete pivoting, of systems whose first pivot is 0.
template <class Number>
void solve_systems() {
  using Factors = LuFactors<Number>;
  for (const int n : {1, 2, 3, 7, 20, 60}) {
    for (int system = 0; system < 20; ++system) {
      typename Factors::Matrix A = Factors::Matrix::Random(n, n);
      if (n > 1) A(0, 0) = 0;
      const typename Factors::Vector b = Factors::Vector::Random(n);
      Factors f;
      f.matrix = A;
      f.compute();
      typename Factors::Vector x = b;
      f.solve(x);
      const typename Factors::Vector expected = A.fullPivLu().solve(b);
      // Partial pivoting loses the digits of the condition; these matrices have up to 1e4 or so.
      const double condition = A.norm() * A.inverse().norm();
      const double bound = 10 * std::numeric_limits<double>::epsilon() * condition;
      BOOST_TEST(
          (x - expected).norm() <= bound * expected.norm(),
          "n = " << n << ": off by " << (x - expected).norm() / expected.norm() << " > " << bound);
    }
  }
}

BOOST_AUTO_TEST_CASE(solve_real_systems) { solve_systems<double>(); }
BOOST_AUTO_TEST_CASE(solve_complex_systems) { solve_systems<std::complex<double>>(); }

BOOST_AUTO_TEST_CASE(give_no_solution_of_singular_systems) {
  LuFactors<double> f;
  f.matrix = Eigen::MatrixXd::Ones(3, 3);
  f.compute();
  Eigen::VectorXd x(3);
  x << 1, 2, 3;
  f.solve(x);
  BOOST_TEST(!x.allFinite());
}

BOOST_AUTO_TEST_SUITE_END()
