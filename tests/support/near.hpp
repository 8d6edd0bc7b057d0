#pragma once

#include <Eigen/Core>
#include <boost/test/tools/assertion_result.hpp>

#include <cmath>
#include <iomanip>
#include <limits>

#include <motor/motor.hpp>

#include <support/terms.hpp>

namespace kreisel::test {

using Verdict = boost::test_tools::assertion_result;

/// The unit roundoff: half a unit in the last place of 1.
template <class S = double>
inline const S u = std::numeric_limits<S>::epsilon() / S(2);

/// The length of a motor, with the metre as the unit that makes its halves comparable.
template <class S>
[[nodiscard]] S size(const Motor<S>& a) {
  using std::sqrt;
  return sqrt(a.resultant.squaredNorm() + a.moment.squaredNorm());
}

namespace detail {

template <class S>
[[nodiscard]] Verdict verdict(bool within, const char* what, const S& x, const S& y,
                              const S& bound) {
  Verdict verdict(within);
  verdict.message().stream() << std::scientific << std::setprecision(17) << what << x << " is not "
                             << y << ": error " << std::setprecision(3) << x - y << ", bound "
                             << bound;
  return verdict;
}

}  // namespace detail

/// |x - y| <= k u scale. Says value, error and bound where that fails; a NaN fails.
template <class S>
[[nodiscard]] Verdict near(const S& x, const S& y, const S& scale, double k,
                           const char* what = "") {
  using std::abs;
  const S bound = S(k) * u<S> * scale;
  const bool within = abs(x - y) <= bound;
  if (within) return Verdict(true);
  return detail::verdict(false, what, x, y, bound);
}

/// Every entry of two matrices, all on one scale.
template <class S, int Rows, int Columns>
[[nodiscard]] Verdict near(const Eigen::Matrix<S, Rows, Columns>& x,
                           const Eigen::Matrix<S, Rows, Columns>& y, const S& scale, double k,
                           const char* what = "") {
  for (int i = 0; i < x.size(); ++i) {
    const Verdict verdict = near(x(i % Rows, i / Rows), y(i % Rows, i / Rows), scale, k, what);
    if (!verdict) return verdict;
  }
  return Verdict(true);
}

/// Every entry of two matrices, each on the scale of its own terms.
template <int Rows, int Columns>
[[nodiscard]] Verdict near(const Eigen::Matrix<double, Rows, Columns>& x,
                           const Eigen::Matrix<double, Rows, Columns>& y,
                           const Eigen::Matrix<Terms, Rows, Columns>& terms, double k,
                           const char* what = "") {
  for (int i = 0; i < x.size(); ++i) {
    const int row = i % Rows;
    const int column = i / Rows;
    const Verdict verdict = near(x(row, column), y(row, column), terms(row, column).size, k, what);
    if (!verdict) return verdict;
  }
  return Verdict(true);
}

[[nodiscard]] inline Verdict near(double x, double y, Terms terms, double k,
                                  const char* what = "") {
  return near(x, y, terms.size, k, what);
}

/// Both halves of two motors, each half on its own scale: {size of resultant; size of moment}, or
/// the sizes of each component's terms.
template <class S, class Scale>
[[nodiscard]] Verdict near(const Motor<S>& x, const Motor<S>& y, const Motor<Scale>& scale,
                           double k) {
  const Verdict resultant = near(x.resultant, y.resultant, scale.resultant, k, "resultant ");
  return resultant ? near(x.moment, y.moment, scale.moment, k, "moment ") : resultant;
}

/// Both halves of two motors on one scale.
template <class S>
[[nodiscard]] Verdict near(const Motor<S>& x, const Motor<S>& y, const S& scale, double k) {
  const Verdict resultant = near(x.resultant, y.resultant, scale, k, "resultant ");
  return resultant ? near(x.moment, y.moment, scale, k, "moment ") : resultant;
}

/// Equal to the last bit.
template <class X, class Y>
[[nodiscard]] Verdict same(const X& x, const Y& y) {
  if constexpr (requires { x.resultant; }) {
    const Verdict resultant = same(x.resultant, y.resultant);
    return resultant ? same(x.moment, y.moment) : resultant;
  } else {
    Verdict verdict(x == y);
    verdict.message().stream() << std::setprecision(17) << '\n' << x << "\nis not\n" << y;
    return verdict;
  }
}

}  // namespace kreisel::test
