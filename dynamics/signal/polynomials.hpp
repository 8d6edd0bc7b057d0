#pragma once

#include <cstddef>
#include <vector>

#include <motor/api.hpp>

namespace kreisel {

/// A function of time as polynomials, piece by piece: a spline.
///
///   f(t) = sum c_n (t - begin)^n,  begin of the piece that contains t
///
/// Value  : double, or Vector3<double>
template <class Value>
struct KREISEL_API Polynomials {
  std::vector<double> begins;       ///< of the pieces, increasing
  double end = 0;                   ///< of the last piece
  std::size_t terms = 1;            ///< coefficients of a piece
  std::vector<Value> coefficients;  ///< piece by piece, lowest power first

  /// The derivative of the given order; at a knot that of the later piece.
  ///
  /// Throws : InvalidInput outside [first begin, end], except for rounding of t
  [[nodiscard]] Value derivative(double t, int order) const;

 private:
  void require(double t) const;
};

}  // namespace kreisel
