#pragma once

#include <cstring>

namespace kreisel::detail {

/// A vector as the processor takes it: (x, y) at once, then z.
class Three {
  using Two = double __attribute__((vector_size(2 * sizeof(double))));  // g++ and clang++

 public:
  [[nodiscard, gnu::always_inline]] static Three from(const double* numbers) {
    Three result;
    std::memcpy(&result.xy_, numbers, sizeof result.xy_);
    result.z_ = numbers[2];
    return result;
  }
  [[gnu::always_inline]] void to(double* numbers) const {
    std::memcpy(numbers, &xy_, sizeof xy_);
    numbers[2] = z_;
  }

  [[nodiscard, gnu::always_inline]] double x() const { return xy_[0]; }
  [[nodiscard, gnu::always_inline]] double y() const { return xy_[1]; }
  [[nodiscard, gnu::always_inline]] double z() const { return z_; }

  [[gnu::always_inline]] friend Three operator+(const Three& a, const Three& b) {
    return {a.xy_ + b.xy_, a.z_ + b.z_};
  }
  [[gnu::always_inline]] friend Three operator*(const Three& a, double k) {
    return {a.xy_ * Two{k, k}, a.z_ * k};
  }

 private:
  Three() = default;  // any numbers
  Three(const Two& xy, double z) : xy_(xy), z_(z) {}

  Two xy_;
  double z_;
};

/// The columns of a matrix R, in registers, to be combined again and again: the compiler cannot tell
/// that what is stored of a product leaves R as it is, and would read it again for each number.
class Columns {
 public:
  /// Of its nine numbers, column by column.
  [[gnu::always_inline]] explicit Columns(const double* R)
      : a_(Three::from(R)), b_(Three::from(R + 3)), c_(Three::from(R + 6)) {}

  /// R v
  [[nodiscard, gnu::always_inline]] Three combined(const double* v) const {
    return a_ * v[0] + b_ * v[1] + c_ * v[2];
  }

 private:
  Three a_, b_, c_;
};

}  // namespace kreisel::detail
