#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Packed vectors and matrices of doubles: every part of the library that is tuned for a processor
/// or a compiler.
///
/// A processor reads two or four doubles with one instruction. Doubles that were stored one by one
/// a moment before cannot be read together without a wait until they have reached the cache.
/// Eigen's fixed-size arrays are filled in this way. g++ -O2 moreover makes calls and loops of
/// Eigen's sums and products of three numbers.
///
/// The types of this file are therefore filled in registers. The kernels of motor/ and
/// dynamics/inertia.hpp are written component by component and always inlined.
///
/// Cost     : measured in benchmarks/kernels.cpp, reported in benchmarks/report.md
/// Fallback : arrays in place of the vector extension of g++ and clang++, for other compilers and
///            with KREISEL_PORTABLE_SIMD; the same results (tests/motor/simd_portable.cpp)

#if !defined(__GNUC__) && !defined(KREISEL_PORTABLE_SIMD)
#define KREISEL_PORTABLE_SIMD
#endif

namespace kreisel::detail {

#ifdef KREISEL_PORTABLE_SIMD

/// n doubles, or n masks of 64 bits, in an array, with the operators of the vector extension that
/// are used here.
template <int n, class Number = double>
struct Lanes {
  Number numbers[n];

  [[nodiscard]] const Number& operator[](int i) const { return numbers[i]; }
  [[nodiscard]] Number& operator[](int i) { return numbers[i]; }

  friend Lanes operator-(const Lanes& a) {
    return each([&](int i) { return -a[i]; });
  }
  friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] + b[i]; });
  }
  friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] - b[i]; });
  }
  friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] * b[i]; });
  }
  friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] / b[i]; });
  }
  friend Lanes operator*(Number a, const Lanes& b) {
    return each([&](int i) { return a * b[i]; });
  }
  friend Lanes operator&(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] & b[i]; });
  }
  friend Lanes operator|(const Lanes& a, const Lanes& b) {
    return each([&](int i) { return a[i] | b[i]; });
  }
  friend Lanes operator~(const Lanes& a) {
    return each([&](int i) { return ~a[i]; });
  }

  friend auto operator<(const Lanes& a, const Lanes& b) {
    return compared([&](int i) { return a[i] < b[i]; });
  }
  friend auto operator>(const Lanes& a, const Lanes& b) { return b < a; }
  friend auto operator<=(const Lanes& a, const Lanes& b) {
    return compared([&](int i) { return a[i] <= b[i]; });
  }
  friend auto operator>=(const Lanes& a, const Lanes& b) { return b <= a; }
  friend auto operator==(const Lanes& a, const Lanes& b) {
    return compared([&](int i) { return a[i] == b[i]; });
  }
  friend auto operator!=(const Lanes& a, const Lanes& b) { return ~(a == b); }

 private:
  template <class Of>
  [[nodiscard]] static Lanes each(const Of& of) {
    Lanes result;
    for (int i = 0; i < n; ++i) result.numbers[i] = of(i);
    return result;
  }
  /// All bits where true, as the vector extension has it.
  template <class Of>
  [[nodiscard]] static Lanes<n, std::int64_t> compared(const Of& of) {
    Lanes<n, std::int64_t> result;
    for (int i = 0; i < n; ++i) result.numbers[i] = of(i) ? -1 : 0;
    return result;
  }
};

template <int n>
using LanesOfDouble = Lanes<n>;
template <int n>
using LanesOfBool = Lanes<n, std::int64_t>;

#else

/// Vectors of n doubles and of n masks of 64 bits. The masks are the results of comparisons.
template <int n>
struct VectorExtension {
  using Doubles [[gnu::vector_size(n * sizeof(double))]] = double;
  using Bools [[gnu::vector_size(n * sizeof(double))]] = std::int64_t;
};

template <int n>
using LanesOfDouble = typename VectorExtension<n>::Doubles;
template <int n>
using LanesOfBool = typename VectorExtension<n>::Bools;

#endif

using Double2 = LanesOfDouble<2>;
using Double4 = LanesOfDouble<4>;

/// The doubles that an instruction of the processor takes; 2 if it takes single ones.
#if defined(__AVX512F__)
inline constexpr int native_lanes = 8;
#elif defined(__AVX__)
inline constexpr int native_lanes = 4;
#else
inline constexpr int native_lanes = 2;
#endif

template <int n>
[[nodiscard, gnu::always_inline]] inline LanesOfDouble<n> same_in_all_lanes(double x) {
  LanesOfDouble<n> result = {};
  for (int i = 0; i < n; ++i) result[i] = x;
  return result;
}

/// True if all lanes of a mask are.
template <class Bools>
[[nodiscard, gnu::always_inline]] inline bool all_lanes(const Bools& mask) {
  constexpr int n = int(sizeof(Bools) / sizeof(std::int64_t));
#if defined(__SSE2__) && !defined(KREISEL_PORTABLE_SIMD)
  if constexpr (n == 2) return _mm_movemask_pd((__m128d)mask) == 0x3;
#endif
#if defined(__AVX__) && !defined(KREISEL_PORTABLE_SIMD)
  if constexpr (n == 4) return _mm256_movemask_pd((__m256d)mask) == 0xf;
#endif
  std::int64_t common = -1;
  for (int i = 0; i < n; ++i) common &= std::int64_t(mask[i]);
  return common != 0;
}

/// yes where the mask is true, else no.
template <class Bools, class Doubles>
[[nodiscard, gnu::always_inline]] inline Doubles lanes_select(const Bools& mask, const Doubles& yes,
                                                              const Doubles& no) {
#ifdef KREISEL_PORTABLE_SIMD
  Doubles result = {};
  for (int i = 0; i < int(sizeof(Doubles) / sizeof(double)); ++i) {
    result[i] = mask[i] != 0 ? yes[i] : no[i];
  }
  return result;
#else
  return (Doubles)((mask & (Bools)yes) | (~mask & (Bools)no));
#endif
}

template <class Doubles>
[[nodiscard, gnu::always_inline]] inline Doubles lanes_abs(const Doubles& x) {
#ifdef KREISEL_PORTABLE_SIMD
  Doubles result = {};
  for (int i = 0; i < int(sizeof(Doubles) / sizeof(double)); ++i) result[i] = std::abs(x[i]);
  return result;
#else
  using Bools = decltype(x < x);
  constexpr std::int64_t without_sign = std::numeric_limits<std::int64_t>::max();
  return (Doubles)((Bools)x & without_sign);
#endif
}

template <class Doubles>
[[nodiscard, gnu::always_inline]] inline Doubles lanes_sqrt(const Doubles& x) {
  constexpr int n = int(sizeof(Doubles) / sizeof(double));
#if defined(__SSE2__) && !defined(KREISEL_PORTABLE_SIMD)
  if constexpr (n == 2) return (Doubles)_mm_sqrt_pd((__m128d)x);
#endif
#if defined(__AVX__) && !defined(KREISEL_PORTABLE_SIMD)
  if constexpr (n == 4) return (Doubles)_mm256_sqrt_pd((__m256d)x);
#endif
#if defined(__AVX512F__) && !defined(KREISEL_PORTABLE_SIMD)
  if constexpr (n == 8) return (Doubles)_mm512_sqrt_pd((__m512d)x);
#endif
  Doubles result;
  for (int i = 0; i < n; ++i) result[i] = std::sqrt(x[i]);
  return result;
}

/// The vector (x, y, z), where x and y are read and written together.
template <class S>
[[nodiscard, gnu::always_inline]] inline Eigen::Matrix<S, 3, 1> by_two(const S& x, const S& y,
                                                                       const S& z) {
  // Six numbers in a row would be packed by four, and the packing would take longer than their
  // products.
  if constexpr (std::is_same_v<S, double>) {
    const Double2 xy{x, y};
    Eigen::Matrix<S, 3, 1> result;
    std::memcpy(result.data(), &xy, sizeof xy);
    result[2] = z;
    return result;
  } else {
    return {x, y, z};
  }
}

/// A vector of three doubles: (x, y) in one register, z in another.
class Vec3d {
 public:
  [[nodiscard, gnu::always_inline]] static Vec3d from(const double* numbers) {
    Vec3d result;
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

  [[gnu::always_inline]] friend Vec3d operator+(const Vec3d& a, const Vec3d& b) {
    return {a.xy_ + b.xy_, a.z_ + b.z_};
  }
  [[gnu::always_inline]] friend Vec3d operator*(const Vec3d& a, double k) {
    return {a.xy_ * Double2{k, k}, a.z_ * k};
  }

 private:
  Vec3d() = default;  // any numbers
  Vec3d(const Double2& xy, double z) : xy_(xy), z_(z) {}

  Double2 xy_;
  double z_;
};

/// A 3x3 matrix R, kept in registers by its columns while it multiplies several vectors.
///
/// A compiler cannot see that storing a product leaves R unchanged. Without this class R would be
/// read again for each number.
class Mat3dByColumns {
 public:
  /// R from nine numbers, column by column.
  [[gnu::always_inline]] explicit Mat3dByColumns(const double* R)
      : a_(Vec3d::from(R)), b_(Vec3d::from(R + 3)), c_(Vec3d::from(R + 6)) {}

  /// R v
  [[nodiscard, gnu::always_inline]] Vec3d combined(const double* v) const {
    return a_ * v[0] + b_ * v[1] + c_ * v[2];
  }

 private:
  Vec3d a_, b_, c_;
};

/// A vector (x, y, z) and a fourth number w, in one register of four doubles or two of two.
///
/// Memory that is read as a Vec4d should not lie across two lines of the cache: alignas(Vec4d).
class Vec4d {
 public:
  Vec4d() = default;  // any numbers
#ifdef __AVX__
  Vec4d(double x, double y, double z, double w) : part_{{x, y, z, w}} {}
#else
  Vec4d(double x, double y, double z, double w) : part_{{x, y}, {z, w}} {}
#endif

  [[nodiscard]] static Vec4d from(const double* numbers) {
    Vec4d result;
    std::memcpy(&result.part_, numbers, sizeof result.part_);
    return result;
  }
  void to(double* numbers) const { std::memcpy(numbers, &part_, sizeof part_); }

  [[nodiscard]] double operator[](int i) const { return part_[i / width][i % width]; }

  /// (y, z, x, w)
  [[nodiscard]] Vec4d next() const {
    const Vec4d& a = *this;
    return {a[1], a[2], a[0], a[3]};
  }
  /// (z, x, y, w)
  [[nodiscard]] Vec4d after() const {
    const Vec4d& a = *this;
    return {a[2], a[0], a[1], a[3]};
  }

  Vec4d& operator+=(const Vec4d& b) { return *this = *this + b; }

  friend Vec4d operator+(const Vec4d& a, const Vec4d& b) {
    return each([&](int i) { return a.part_[i] + b.part_[i]; });
  }
  friend Vec4d operator-(const Vec4d& a, const Vec4d& b) {
    return each([&](int i) { return a.part_[i] - b.part_[i]; });
  }
  friend Vec4d operator*(const Vec4d& a, const Vec4d& b) {
    return each([&](int i) { return a.part_[i] * b.part_[i]; });
  }
  friend Vec4d operator/(const Vec4d& a, const Vec4d& b) {
    return each([&](int i) { return a.part_[i] / b.part_[i]; });
  }
  friend Vec4d operator*(double a, const Vec4d& b) {
    return each([&](int i) { return a * b.part_[i]; });
  }

 private:
#ifdef __AVX__
  using Part = Double4;
#else
  using Part = Double2;
#endif
  static constexpr int width = int(sizeof(Part) / sizeof(double));
  static constexpr int parts = 4 / width;

  template <class Of>
  [[nodiscard]] static Vec4d each(const Of& of) {
    Vec4d result;
    for (int i = 0; i < parts; ++i) result.part_[i] = of(i);
    return result;
  }

  Part part_[parts];
};

/// The cross product of the vectors in a and b, with w = 0.
[[nodiscard]] inline Vec4d cross(const Vec4d& a, const Vec4d& b) {
  return a.next() * b.after() - a.after() * b.next();
}

/// A vector and its two cyclic permutations.
struct CyclicVec4d {
  Vec4d as_is, next, after;

  CyclicVec4d() = default;
  explicit CyclicVec4d(const Vec4d& v) : as_is(v), next(v.next()), after(v.after()) {}
};

/// A 3x3 matrix by its three cyclic diagonals, which multiply the permutations of a vector.
struct Mat3dByDiagonals {
  Vec4d main, upper, lower;

  [[nodiscard]] static Mat3dByDiagonals of(const Eigen::Matrix3d& m) {
    return {Vec4d(m(0, 0), m(1, 1), m(2, 2), 0), Vec4d(m(0, 1), m(1, 2), m(2, 0), 0),
            Vec4d(m(0, 2), m(1, 0), m(2, 1), 0)};
  }

  /// R^t of a quaternion q, by the products (xx, yy, zz, ww), (xy, yz, zx) and (xw, yw, zw) of its
  /// components; scale = 1/|q|^2.
  [[nodiscard]] static Mat3dByDiagonals rotation_back(const Vec4d& square, const Vec4d& next,
                                                      const Vec4d& by_w, double scale) {
    const double ww = square[3];
    const Vec4d zw = by_w.after();
    return {scale * ((square + Vec4d(ww, ww, ww, ww)) - (square.next() + square.after())),
            2 * scale * (next + zw), (2 * scale * (next - zw)).after()};
  }

  [[nodiscard]] Mat3dByDiagonals transposed() const { return {main, lower.next(), upper.after()}; }

  [[nodiscard]] friend Vec4d operator*(const Mat3dByDiagonals& m, const CyclicVec4d& v) {
    return m.main * v.as_is + m.upper * v.next + m.lower * v.after;
  }
};

/// A vector of the given numbers, stored four at a time and the rest two at a time, as it is read.
template <class N, class... X>
[[nodiscard, gnu::always_inline]] inline auto gathered(const X&... numbers) {
  constexpr int count = int(sizeof...(X));
  Eigen::Matrix<N, count, 1> result;
  if constexpr (std::is_same_v<N, double>) {
    const double all[] = {double(numbers)...};
    // Not loops, which the compiler would unroll only after it has stored all[].
    [&]<int... i>(std::integer_sequence<int, i...>) {
      (Vec4d(all[4 * i], all[4 * i + 1], all[4 * i + 2], all[4 * i + 3]).to(result.data() + 4 * i),
       ...);
    }
    (std::make_integer_sequence<int, count / 4>());
    constexpr int left = count % 4;
    if constexpr (left >= 2) {
      const Double2 pair{all[count - left], all[count - left + 1]};
      std::memcpy(result.data() + count - left, &pair, sizeof pair);
    }
    if constexpr (left % 2 == 1) result[count - 1] = all[count - 1];
  } else {
    int i = 0;
    ((result[i++] = N(numbers)), ...);
  }
  return result;
}

}  // namespace kreisel::detail
