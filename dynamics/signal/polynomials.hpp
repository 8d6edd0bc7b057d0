#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <vector>

#include <motor/error.hpp>

namespace kreisel {

/// A function of time as polynomials, piece by piece: a spline.
///
///   f(t) = sum c_n (t - begin)^n,  begin of the piece that contains t
///
/// Value  : double, or Vector3<double>
template <class Value>
struct Polynomials {
  std::vector<double> begins;       ///< of the pieces, increasing
  double end = 0;                   ///< of the last piece
  std::size_t terms = 1;            ///< coefficients of a piece
  std::vector<Value> coefficients;  ///< piece by piece, lowest power first

  /// The derivative of the given order; at a knot that of the later piece.
  ///
  /// Throws : InvalidInput outside [first begin, end], except for rounding of t
  [[nodiscard]] Value derivative(double t, int order) const {
    require(t);
    const auto next = std::upper_bound(begins.begin() + 1, begins.end(), t);
    const auto piece = static_cast<std::size_t>(next - begins.begin()) - 1;
    const double s = t - begins[piece];
    const Value* const c = coefficients.data() + piece * terms;
    Value sum = 0 * c[0];
    for (std::size_t n = terms; n-- > static_cast<std::size_t>(order);) {
      double factor = 1;
      for (int i = 0; i < order; ++i) factor *= static_cast<double>(n) - i;
      sum = s * sum + factor * c[n];
    }
    return sum;
  }

 private:
  void require(double t) const {
    const double slack = 1e-12 * std::max(std::abs(begins.front()), std::abs(end));
    if (t >= begins.front() - slack && t <= end + slack) return;
    std::ostringstream text;
    text.precision(10);
    text << "signal: t = " << t << " s lies outside [" << begins.front() << ", " << end
         << "] s, for which the signal is known";
    throw InvalidInput(text.str());
  }
};

}  // namespace kreisel
