#pragma once

#include <Eigen/Core>

#include <cstring>
#include <type_traits>
#include <utility>

#include <motor/static_zero.hpp>

namespace kreisel::detail {

/// A vector (x, y, z) and a fourth number w, which the processor takes all at once, or two at a time.
///
/// What has just been stored number by number cannot be read as four without a wait. That is what
/// becomes of arrays of Eigen's that are put together from numbers; these are put together in
/// registers. For the same reason what is to be read at once should not lie across two lines of the
/// cache: alignas(Four).
class Four {
 public:
  Four() = default;  // any numbers
#ifdef __AVX__
  Four(double x, double y, double z, double w) : part_{{x, y, z, w}} {}
#else
  Four(double x, double y, double z, double w) : part_{{x, y}, {z, w}} {}
#endif

  [[nodiscard]] static Four from(const double* numbers) {
    Four result;
    std::memcpy(&result.part_, numbers, sizeof result.part_);
    return result;
  }
  void to(double* numbers) const { std::memcpy(numbers, &part_, sizeof part_); }

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

/// Numbers that were computed one by one, stored as they will be read: four at once, or two.
template <class N, class... X>
[[nodiscard, gnu::always_inline]] inline auto gathered(const X&... numbers) {
  constexpr int count = int(sizeof...(X));
  Eigen::Matrix<N, count, 1> result;
  if constexpr (std::is_same_v<N, double>) {
    const double all[] = {double(numbers)...};
    // Not loops, which the compiler would unroll only after it has stored all[].
    [&]<int... i>(std::integer_sequence<int, i...>) {
      (Four(all[4 * i], all[4 * i + 1], all[4 * i + 2], all[4 * i + 3]).to(result.data() + 4 * i),
       ...);
    }
    (std::make_integer_sequence<int, count / 4>());
    constexpr int left = count % 4;
    if constexpr (left >= 2) {
      using Pair = double __attribute__((vector_size(2 * sizeof(double))));
      const Pair pair{all[count - left], all[count - left + 1]};
      std::memcpy(result.data() + count - left, &pair, sizeof pair);
    }
    if constexpr (left % 2 == 1) result[count - 1] = all[count - 1];
  } else {
    int i = 0;
    ((result[i++] = N(numbers)), ...);
  }
  return result;
}

/// StaticZero components come out as 0, and so does w.
template <class X, class Y, class Z>
[[nodiscard]] Four four(const Components<X, Y, Z>& a) {
  return {0.0 + a.x, 0.0 + a.y, 0.0 + a.z, 0};
}

/// Of the vectors in a and b, with w = 0.
[[nodiscard]] inline Four cross(const Four& a, const Four& b) {
  return a.next() * b.after() - a.after() * b.next();
}

}  // namespace kreisel::detail
