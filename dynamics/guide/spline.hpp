#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/piecewise.hpp>

namespace kreisel::detail {

/// The spline of odd degree p through given components at strictly increasing times, in p - 1
/// continuous derivatives; its knots are the times but for (p - 1)/2 inner ones at either end (not
/// a knot), so that no derivative has to be guessed there. Spacing may be uneven.
///
/// Source : C. de Boor, A Practical Guide to Splines: the collocation matrix in B-splines is banded
///          and totally positive, so elimination needs no pivots
/// Cost   : O(n p^2)
/// Error  : O(h^(p+1)) of the value, a power less for each derivative
template <class S>
class SplineInterpolation {
  using Components = typename PiecewisePose<S>::Components;

 public:
  SplineInterpolation(const std::vector<S>& times, std::vector<Components> values,
                      std::size_t degree)
      : p_(degree),
        n_(times.size()),
        origin_(times.front()),
        first_value_(values.front()),
        points_(std::move(values)) {
    // What is interpolated is the distance from the first value: what rests then rests exactly.
    for (Components& point : points_) point -= first_value_;
    std::vector<S> x(n_);
    std::transform(times.begin(), times.end(), x.begin(),
                   [this](const S& t) { return t - origin_; });
    knots_.assign(p_ + 1, x.front());
    const std::size_t skipped = (p_ + 1) / 2;
    knots_.insert(knots_.end(), x.begin() + static_cast<std::ptrdiff_t>(skipped),
                  x.end() - static_cast<std::ptrdiff_t>(skipped));
    knots_.insert(knots_.end(), p_ + 1, x.back());
    solve_for_control_points(x);
  }

  /// The same spline by powers of time in each piece.
  [[nodiscard]] PiecewisePose<S> pieces(const std::string& name) const {
    PiecewisePose<S> result(name, static_cast<int>(p_));
    for (std::size_t k = p_; k < n_; ++k) {
      std::vector<Components> coefficients = taylor(k);
      coefficients.front() += first_value_;
      result.append(origin_ + knots_[k], coefficients);
    }
    result.end_at(origin_ + knots_[n_]);
    return result;
  }

 private:
  /// The p + 1 B-splines that do not vanish in the span k, at x (Cox and de Boor).
  [[nodiscard]] std::vector<S> basis(std::size_t k, const S& x) const {
    std::vector<S> value(p_ + 1, S(0));
    value[0] = S(1);
    for (std::size_t degree = 1; degree <= p_; ++degree) {
      S carried(0);
      for (std::size_t r = 0; r < degree; ++r) {
        const S& right = knots_[k + r + 1];
        const S& left = knots_[k + r + 1 - degree];
        const S share = value[r] / (right - left);
        value[r] = carried + (right - x) * share;
        carried = (x - left) * share;
      }
      value[degree] = carried;
    }
    return value;
  }

  /// The span k with knots[k] <= x < knots[k+1]; the last one holds its right end too.
  [[nodiscard]] std::size_t span(const S& x) const {
    const auto first = knots_.begin() + static_cast<std::ptrdiff_t>(p_) + 1;
    const auto last = knots_.begin() + static_cast<std::ptrdiff_t>(n_);
    return static_cast<std::size_t>(std::upper_bound(first, last, x) - knots_.begin()) - 1;
  }

  /// Replaces the values in points_ by the control points, by elimination in a band of width 2p +
  /// 1.
  void solve_for_control_points(const std::vector<S>& x) {
    const std::size_t width = 2 * p_ + 1;  // column j of row i is kept at i * width + (j + p - i)
    std::vector<S> band(n_ * width, S(0));
    const auto at = [&](std::size_t i, std::size_t j) -> S& {
      return band[i * width + j + p_ - i];
    };
    for (std::size_t i = 0; i < n_; ++i) {
      const std::size_t k = span(x[i]);
      const std::vector<S> row = basis(k, x[i]);
      for (std::size_t r = 0; r <= p_; ++r) at(i, k - p_ + r) = row[r];
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t below = i + 1; below <= std::min(i + p_, n_ - 1); ++below) {
        const S factor = at(below, i) / at(i, i);
        if (factor == S(0)) continue;
        for (std::size_t j = i; j <= std::min(i + p_, n_ - 1); ++j)
          at(below, j) -= factor * at(i, j);
        points_[below] -= factor * points_[i];
      }
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t j = i + 1; j <= std::min(i + p_, n_ - 1); ++j) {
        points_[i] -= at(i, j) * points_[j];
      }
      points_[i] /= at(i, i);
    }
  }

  /// Value and derivatives over factorials at the left end of the span k: the control points of
  /// each derivative are differences of those before, evaluated by de Boor's scheme.
  [[nodiscard]] std::vector<Components> taylor(std::size_t k) const {
    const S& x = knots_[k];
    std::vector<Components> control(points_.begin() + static_cast<std::ptrdiff_t>(k - p_),
                                    points_.begin() + static_cast<std::ptrdiff_t>(k) + 1);
    std::vector<Components> result;
    S factorial(1);
    for (std::size_t order = 0; order <= p_; ++order) {
      const std::size_t degree = p_ - order;
      std::vector<Components> d = control;
      for (std::size_t level = 1; level <= degree; ++level) {
        for (std::size_t r = degree; r >= level; --r) {
          const S& left = knots_[k - degree + r];
          const S& right = knots_[k + 1 + r - level];
          const S weight = (x - left) / (right - left);
          d[r] = (S(1) - weight) * d[r - 1] + weight * d[r];
        }
      }
      result.push_back(d[degree] / factorial);
      factorial *= S(static_cast<double>(order + 1));
      for (std::size_t r = 0; r < degree; ++r) {
        const S distance = knots_[k + 1 + r] - knots_[k + 1 + r - degree];
        control[r] = S(static_cast<double>(degree)) / distance * (control[r + 1] - control[r]);
      }
      control.pop_back();
    }
    return result;
  }

  std::size_t p_;
  std::size_t n_;
  S origin_;
  Components first_value_;
  std::vector<S> knots_;
  std::vector<Components> points_;
};

}  // namespace kreisel::detail
