#pragma once

#include <motor/absent.hpp>

namespace kreisel::detail {

/// A vector (x, y, z) and a fourth number w, which the processor takes all at once, or two at a time.
///
/// Not Eigen's: the compiler puts such an array together in memory, number by number, and the
/// processor has to wait where it is read at once as four.
class Four {
 public:
  Four() = default;  // any numbers
#ifdef __AVX__
  Four(double x, double y, double z, double w) : part_{{x, y, z, w}} {}
#else
  Four(double x, double y, double z, double w) : part_{{x, y}, {z, w}} {}
#endif

  [[nodiscard]] double operator[](int i) const { return part_[i / width][i % width]; }

  /// (y, z, x, w)
  [[nodiscard]] Four next() const {
    const Four& a = *this;
    return {a[1], a[2], a[0], a[3]};
  }
  /// (z, x, y, w)
  [[nodiscard]] Four after() const {
    const Four& a = *this;
    return {a[2], a[0], a[1], a[3]};
  }

  Four& operator+=(const Four& b) { return *this = *this + b; }

  friend Four operator+(const Four& a, const Four& b) {
    return each([&](int i) { return a.part_[i] + b.part_[i]; });
  }
  friend Four operator-(const Four& a, const Four& b) {
    return each([&](int i) { return a.part_[i] - b.part_[i]; });
  }
  friend Four operator*(const Four& a, const Four& b) {
    return each([&](int i) { return a.part_[i] * b.part_[i]; });
  }
  friend Four operator/(const Four& a, const Four& b) {
    return each([&](int i) { return a.part_[i] / b.part_[i]; });
  }
  friend Four operator*(double a, const Four& b) {
    return each([&](int i) { return a * b.part_[i]; });
  }

 private:
#ifdef __AVX__
  static constexpr int width = 4;
#else
  static constexpr int width = 2;
#endif
  static constexpr int parts = 4 / width;

  using Part = double __attribute__((vector_size(width * sizeof(double))));  // g++ and clang++

  template <class Of>
  [[nodiscard]] static Four each(const Of& of) {
    Four result;
    for (int i = 0; i < parts; ++i) result.part_[i] = of(i);
    return result;
  }

  Part part_[parts];
};

/// Absent components come out as 0, and so does w.
template <class X, class Y, class Z>
[[nodiscard]] Four four(const Components<X, Y, Z>& a) {
  return {0.0 + a.x, 0.0 + a.y, 0.0 + a.z, 0};
}

/// Of the vectors in a and b; w comes out as 0.
[[nodiscard]] inline Four cross(const Four& a, const Four& b) {
  return a.next() * b.after() - a.after() * b.next();
}

}  // namespace kreisel::detail
