#include <boost/math/special_functions/ellint_rf.hpp>
#include <boost/math/special_functions/ellint_rj.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <iostream>
#include <vector>

#include <dynamics/exact/elliptic.hpp>

#include <support/sample.hpp>
#include <support/worst.hpp>

using kreisel::exact::EllipticFunctions;
using kreisel::exact::Jacobi;
using kreisel::exact::Real;
namespace carlson = kreisel::exact::carlson;
namespace test = kreisel::test;

namespace {

using Exact = boost::multiprecision::cpp_bin_float_50;

Exact exact(const Real& x) { return Exact(x.hi) + x.lo; }

double relative(const Real& value, const Exact& truth) {
  return static_cast<double>(abs(exact(value) - truth) / abs(truth));
}

/// A positive number of all its digits.
Real positive(test::Sample& sample, double low, double high) {
  const double first = sample.magnitude(low, high);
  return Real(first) + first * sample.uniform(-1, 1) * 0x1p-54;
}

/// sn, cn, dn in 50 digits, by the amplitude and the descending Landen transformation.
struct Truth {
  Truth(const Exact& m1, const Exact& u) {
    Exact a = 1;
    Exact b = sqrt(m1);
    std::vector<Exact> ratios;
    while (abs(a - b) > Exact("1e-30")) {
      const Exact mean = (a + b) / 2;
      ratios.push_back((a - b) / 2 / mean);
      b = sqrt(a * b);
      a = mean;
    }
    Exact amplitude = ldexp(a * u, static_cast<int>(ratios.size()));
    for (auto ratio = ratios.rbegin(); ratio != ratios.rend(); ++ratio) {
      amplitude = (amplitude + asin(*ratio * sin(amplitude))) / 2;
    }
    sn = sin(amplitude);
    cn = cos(amplitude);
    dn = sqrt(cn * cn + m1 * sn * sn);
  }

  [[nodiscard]] double distance(const Jacobi& j) const {
    return static_cast<double>(abs(exact(j.sn) - sn) + abs(exact(j.cn) - cn) +
                               abs(exact(j.dn) - dn));
  }

  Exact sn;
  Exact cn;
  Exact dn;
};

}  // namespace

// Boost.Math computes the same integrals in 50 digits.
BOOST_AUTO_TEST_CASE(integrals_have_63_bits) {
  test::Sample sample(1);
  double first = 0;
  double third = 0;
  for (int i = 0; i < 4000; ++i) {
    const Real x = sample.once_in(8) ? Real(0) : positive(sample, -12, 6);
    const Real y = positive(sample, -12, 6);
    const Real z = positive(sample, -12, 6);
    const Real p = positive(sample, -12, 6);
    first = test::worst_of(first, relative(carlson::rf(x, y, z),
                                           boost::math::ellint_rf(exact(x), exact(y), exact(z))));
    third = test::worst_of(
        third, relative(carlson::rj(x, y, z, p),
                        boost::math::ellint_rj(exact(x), exact(y), exact(z), exact(p))));
  }
  BOOST_TEST(first <= 0x1p-63);
  BOOST_TEST(third <= 0x1p-63);
  std::cout << "R_F " << first * 0x1p64 << ", R_J " << third * 0x1p64 << " of 2^-64\n";
}

// The functions change by no more than the argument does: |sn'|, |cn'|, |dn'| <= 1.
BOOST_AUTO_TEST_CASE(functions_keep_their_digits) {
  test::Sample sample(2);
  double worst = 0;
  for (int i = 0; i < 1000; ++i) {
    const Real small = positive(sample, -25, -0.31);
    const Real other = 1 - small;
    const EllipticFunctions of =
        sample.once_in(2) ? EllipticFunctions(small, other) : EllipticFunctions(other, small);
    const Real u = of.quarter() * sample.uniform(-20, 20);
    worst = test::worst_of(worst, Truth(exact(of.m1()), exact(u)).distance(of.phase(u).at) /
                                      (abs(u) + of.quarter()).hi);
  }
  BOOST_TEST(worst <= 0x1p-75);
  std::cout << "Jacobi's functions: " << worst * 0x1p75 << " of 2^-75 of |u| + K\n";
}
