#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <dynamics/guide/series.hpp>

namespace kreisel {

/// A truncated power series as a number type: a function of time by its coefficients in powers of
/// (time - t)/h. A formula written for any number type then gives the coefficients of its result.
///
/// Only analytic functions exist for it: no comparisons, no abs, min, max.
///
/// Source : the recurrences of each function: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
///          Differential Equations I, I.8
/// Error  : of series summed to values about 1 <= 100u   (tests/dynamics/guide/analytic.cpp)
class PowerSeries {
 public:
  /// One order more than a scene's series, because a guide's u needs one derivative more.
  static constexpr int most_order = most_series_order + 1;

  PowerSeries(double constant = 0) {  // NOLINT: numbers are constants
    coefficient_.setZero();
    (*this)[0] = constant;
  }

  /// The time itself as a series about t, up to an order.
  [[nodiscard]] static PowerSeries time(double t, double h, int order) {
    PowerSeries result(t);
    result.order_ = order;
    result[1] = h;
    return result;
  }

  /// The series up to `order` with the coefficients that `coefficient(k)` returns.
  template <class Coefficient>
  [[nodiscard]] static PowerSeries of(int order, const Coefficient& coefficient) {
    PowerSeries result;
    result.order_ = order;
    for (int k = 0; k <= order; ++k) result[k] = coefficient(static_cast<std::size_t>(k));
    return result;
  }

  /// The coefficient of order k; coefficients above order() are 0.
  [[nodiscard]] double operator[](int k) const { return coefficient_[zeros + k]; }
  [[nodiscard]] int order() const { return order_; }

  PowerSeries& operator+=(const PowerSeries& b) { return *this = *this + b; }
  PowerSeries& operator-=(const PowerSeries& b) { return *this = *this - b; }
  PowerSeries& operator*=(const PowerSeries& b) { return *this = *this * b; }
  PowerSeries& operator/=(const PowerSeries& b) { return *this = *this / b; }

  friend PowerSeries operator-(const PowerSeries& a) { return {-a.coefficient_, a.order_}; }
  friend PowerSeries operator+(const PowerSeries& a, const PowerSeries& b) {
    return {a.coefficient_ + b.coefficient_, std::max(a.order_, b.order_)};
  }
  friend PowerSeries operator-(const PowerSeries& a, const PowerSeries& b) {
    return {a.coefficient_ - b.coefficient_, std::max(a.order_, b.order_)};
  }
  friend PowerSeries operator*(const PowerSeries& a, const PowerSeries& b) {
    if (a.order_ == 0) return {a[0] * b.coefficient_, b.order_};
    if (b.order_ == 0) return {b[0] * a.coefficient_, a.order_};
    PowerSeries c;
    c.order_ = std::max(a.order_, b.order_);
    // Four coefficients at a time. Memory before the first coefficient of b is 0. Each has
    // two sums, because an addition waits for the one before it.
    for (int k = 0; k <= c.order_; k += 4) {
      Eigen::Array4d even = Eigen::Array4d::Zero();
      Eigen::Array4d odd = Eigen::Array4d::Zero();
      for (int i = 0; i <= k + 3; i += 2) {
        even += a[i] * b.coefficient_.segment<4>(zeros + k - i);
        odd += a[i + 1] * b.coefficient_.segment<4>(zeros + k - i - 1);
      }
      c.coefficient_.segment<4>(zeros + k) = even + odd;
    }
    for (int k = c.order_ + 1; k < places - zeros; ++k) c[k] = 0;
    return c;
  }
  friend PowerSeries operator/(const PowerSeries& a, const PowerSeries& b) {
    PowerSeries c = a;
    c.order_ = std::max(a.order_, b.order_);
    for (int k = 0; k <= c.order_; ++k) {
      for (int i = 0; i < k; ++i) c[k] -= c[i] * b[k - i];
      c[k] /= b[0];
    }
    return c;
  }

  friend PowerSeries sin(const PowerSeries& a) { return sine_and_cosine(a)[0]; }
  friend PowerSeries cos(const PowerSeries& a) { return sine_and_cosine(a)[1]; }
  friend PowerSeries tan(const PowerSeries& a) {
    const auto [s, c] = sine_and_cosine(a);
    return s / c;
  }
  friend PowerSeries exp(const PowerSeries& a) {
    PowerSeries e(std::exp(a[0]));
    e.order_ = a.order_;
    for (int k = 1; k <= a.order_; ++k) {
      double sum = 0;
      for (int i = 1; i <= k; ++i) sum += i * a[i] * e[k - i];
      e[k] = sum / k;
    }
    return e;
  }
  friend PowerSeries sinh(const PowerSeries& a) { return (exp(a) - exp(-a)) / 2; }
  friend PowerSeries cosh(const PowerSeries& a) { return (exp(a) + exp(-a)) / 2; }
  friend PowerSeries tanh(const PowerSeries& a) { return 1 - 2 / (exp(2 * a) + 1); }
  friend PowerSeries log(const PowerSeries& a) {
    // a l' = a'
    PowerSeries l(std::log(a[0]));
    l.order_ = a.order_;
    for (int k = 1; k <= a.order_; ++k) {
      double sum = k * a[k];
      for (int i = 1; i < k; ++i) sum -= i * l[i] * a[k - i];
      l[k] = sum / (k * a[0]);
    }
    return l;
  }
  friend PowerSeries pow(const PowerSeries& a, double exponent) {
    // a p' = exponent p a'
    PowerSeries p(std::pow(a[0], exponent));
    p.order_ = a.order_;
    for (int k = 1; k <= a.order_; ++k) {
      double sum = 0;
      for (int i = 0; i < k; ++i) sum += (exponent * (k - i) - i) * p[i] * a[k - i];
      p[k] = sum / (k * a[0]);
    }
    return p;
  }
  friend PowerSeries sqrt(const PowerSeries& a) { return pow(a, 0.5); }

  /// The derivative by time.
  [[nodiscard]] PowerSeries derivative(double h) const {
    PowerSeries result;
    result.order_ = std::max(order_ - 1, 0);
    for (int k = 0; k < order_; ++k) result[k] = (k + 1) * (*this)[k + 1] / h;
    return result;
  }

 private:
  static constexpr int zeros = 4;
  static constexpr int places = (zeros + most_order + 1 + 6) / 4 * 4;  ///< up to 3 are read beyond
  using Coefficients = Eigen::Array<double, places, 1>;

  PowerSeries(const Coefficients& coefficient, int order)
      : coefficient_(coefficient), order_(order) {}

  double& operator[](int k) { return coefficient_[zeros + k]; }

  [[nodiscard]] static std::array<PowerSeries, 2> sine_and_cosine(const PowerSeries& a) {
    PowerSeries s(std::sin(a[0]));
    PowerSeries c(std::cos(a[0]));
    s.order_ = c.order_ = a.order_;
    int bends = a.order_;  // the last coefficient of a that is not 0
    while (bends > 1 && a[bends] == 0) --bends;
    PowerSeries slope;  // h da/dt, an index higher
    for (int i = 1; i <= bends; ++i) slope[i] = i * a[i];
    for (int k = 1; k <= a.order_; ++k) {
      double s_odd = 0, s_even = 0, c_odd = 0, c_even = 0;
      // The last term may be one too many: there the slope is 0, or the coefficient before the
      // first.
      for (int i = 1; i <= std::min(k, bends); i += 2) {
        s_odd += slope[i] * c[k - i];
        c_odd -= slope[i] * s[k - i];
        s_even += slope[i + 1] * c[k - i - 1];
        c_even -= slope[i + 1] * s[k - i - 1];
      }
      s[k] = (s_odd + s_even) / k;
      c[k] = (c_odd + c_even) / k;
    }
    return {s, c};
  }

  Coefficients coefficient_;
  int order_ = 0;
};

}  // namespace kreisel

template <>
struct Eigen::NumTraits<kreisel::PowerSeries> : Eigen::NumTraits<double> {
  using Real = kreisel::PowerSeries;
  using NonInteger = kreisel::PowerSeries;
  using Nested = kreisel::PowerSeries;
  enum {
    RequireInitialization = 1,
    ReadCost = 25,
    AddCost = 25,
    MulCost = 300,
  };
};
