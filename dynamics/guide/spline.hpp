#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/piecewise.hpp>

namespace kreisel::detail {

/// The spline of odd degree p through given components at strictly increasing times, with p - 1
/// continuous derivatives. Its knots are the times except (p - 1)/2 inner ones at either end
/// (not-a-knot), so that no derivative has to be guessed there. Spacing may be uneven.
///
/// With a knot only at every m-th sample the spline smooths. It has the least sum of squared
/// distances from the samples of all splines on these knots. Noise e of the samples then causes
/// about e/sqrt(m) in the value and e/(sqrt(m) (m h)^k) in the k-th derivative.
///
/// Source : C. de Boor, A Practical Guide to Splines: the collocation matrix in B-splines is banded
///          and totally positive, so elimination needs no pivots. Least squares by Givens rotations
///          row by row, which do not square the condition number
/// Cost   : O(n p^2)
/// Error  : O(h^(p+1)) of the value, one power less for each derivative, h the spacing of the knots
template <class S>
class SplineInterpolation {
  using Components = typename PiecewisePose<S>::Components;

 public:
  SplineInterpolation(const std::vector<S>& times, std::vector<Components> values,
                      std::size_t degree, std::size_t every = 1)
      : p_(degree),
        n_(times.size()),
        origin_(times.front()),
        first_value_(values.front()),
        points_(std::move(values)) {
    // The distance from the first value is interpolated, so a motion at rest stays exactly at rest.
    for (Components& point : points_) point -= first_value_;
    std::vector<S> x(n_);
    std::transform(times.begin(), times.end(), x.begin(),
                   [this](const S& t) { return t - origin_; });
    place_knots(x, every);
    if (every == 1) {
      solve_for_control_points(x);
    } else {
      fit_control_points(x);
    }
  }

  /// The same spline as polynomials of time, piece by piece.
  [[nodiscard]] PiecewisePose<S> pieces(const std::string& name) const {
    PiecewisePose<S> result(name, static_cast<int>(p_));
    for (std::size_t k = p_; k < n_; ++k) {
      const std::vector<Components> coefficients = taylor(k, knots_[k]);
      result.append(origin_ + knots_[k], coefficients);
    }
    result.end_at(origin_ + knots_[n_]);
    return result;
  }

  [[nodiscard]] Components value(const S& t) const {
    const S x = t - origin_;
    const std::size_t k = span(x);
    const std::vector<S> weight = basis(k, x);
    Components sum = Components::Zero();
    for (std::size_t r = 0; r <= p_; ++r) sum += weight[r] * points_[k - p_ + r];
    return first_value_ + sum;
  }

  /// The number of control points, equal to the number of values that the spline can interpolate.
  [[nodiscard]] std::size_t controls() const { return n_; }

  /// The first four components of this spline with the last three of another spline of the same
  /// degree, begin and end.
  [[nodiscard]] PiecewisePose<S> pieces_with(const SplineInterpolation& other,
                                             const std::string& name) const {
    PiecewisePose<S> result(name, static_cast<int>(p_));
    std::vector<S> breaks;
    const auto inner = [](const SplineInterpolation& of) {
      const auto begin = of.knots_.begin();
      return std::pair{begin + static_cast<std::ptrdiff_t>(of.p_),
                       begin + static_cast<std::ptrdiff_t>(of.n_)};
    };
    const auto [first, last] = inner(*this);
    const auto [other_first, other_last] = inner(other);
    std::set_union(first, last, other_first, other_last, std::back_inserter(breaks));
    for (const S& x : breaks) {
      std::vector<Components> coefficients = taylor(span(x), x);
      const std::vector<Components> others = other.taylor(other.span(x), x);
      for (std::size_t i = 0; i <= p_; ++i) {
        coefficients[i].template tail<3>() = others[i].template tail<3>();
      }
      result.append(origin_ + x, coefficients);
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

  /// The span k with knots[k] <= x < knots[k+1]; the last span includes its right end.
  [[nodiscard]] std::size_t span(const S& x) const {
    const auto first = knots_.begin() + static_cast<std::ptrdiff_t>(p_) + 1;
    const auto last = knots_.begin() + static_cast<std::ptrdiff_t>(n_);
    return static_cast<std::size_t>(std::upper_bound(first, last, x) - knots_.begin()) - 1;
  }

  /// Sets the knots, and n_ to the number of control points.
  void place_knots(const std::vector<S>& x, std::size_t every) {
    const std::size_t n = x.size();
    const std::size_t pieces = (n - 1) / every;
    const std::size_t skipped = (p_ + 1) / 2;
    knots_.assign(p_ + 1, x.front());
    for (std::size_t i = skipped; i + skipped <= pieces; ++i) {
      knots_.push_back(x[(i * (n - 1) + pieces / 2) / pieces]);
    }
    knots_.insert(knots_.end(), p_ + 1, x.back());
    n_ = knots_.size() - p_ - 1;
  }

  /// Replaces the values in points_ by the control points of the spline nearest to the values.
  void fit_control_points(const std::vector<S>& x) {
    using std::sqrt;
    const std::size_t width = p_ + 1;
    std::vector<S> triangle(n_ * width, S(0));  // row i begins at its diagonal
    std::vector<Components> right(n_, Components::Zero());
    for (std::size_t i = 0; i < x.size(); ++i) {
      const std::size_t k = span(x[i]);
      std::vector<S> row = basis(k, x[i]);
      Components value = points_[i];
      for (std::size_t r = 0; r <= p_; ++r) {
        const std::size_t pivot = k - p_ + r;
        S* const upper = triangle.data() + pivot * width;
        if (row[r] == S(0)) continue;
        const S length = sqrt(upper[0] * upper[0] + row[r] * row[r]);
        const S c = upper[0] / length;
        const S s = row[r] / length;
        for (std::size_t j = r; j <= p_; ++j) {
          const S above = upper[j - r];
          upper[j - r] = c * above + s * row[j];
          row[j] = c * row[j] - s * above;
        }
        const Components above = right[pivot];
        right[pivot] = c * above + s * value;
        value = c * value - s * above;
      }
    }
    for (std::size_t i = n_; i-- > 0;) {
      for (std::size_t j = 1; j <= p_ && i + j < n_; ++j) {
        right[i] -= triangle[i * width + j] * right[i + j];
      }
      right[i] /= triangle[i * width];
    }
    points_ = std::move(right);
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

  /// Value and derivatives over factorials at x in the span k. The control points of each
  /// derivative are differences of those of the derivative below, evaluated by de Boor's scheme.
  [[nodiscard]] std::vector<Components> taylor(std::size_t k, const S& x) const {
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
    result.front() += first_value_;
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
