#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

#include <motor/lanes.hpp>
#include <motor/simd.hpp>

namespace kreisel::detail {

/// The stages of an explicit method and its temporary vectors.
///
/// Stages of fixed size, padded with zeros to multiples of four. They are stored, read and summed
/// in groups of four. Eigen would read groups of eight from two stores where it can, and wait for
/// both. Temporaries stay in registers and on the stack.
template <class Vector, std::size_t stages, int components = int(Vector::RowsAtCompileTime)>
class StageMemory {
  using Scalar = typename Vector::Scalar;
  // Longer stages are filled by loops, whose stores are as wide as the reads.
  static constexpr bool by_fours = std::is_same_v<Scalar, double> && components <= 16;

 public:
  static constexpr bool fixed = true;
  /// So few that a call of their field costs as much as its work.
  static constexpr bool few = components < 4;
  static constexpr int padded = few && !by_fours ? components : (components + 3) / 4 * 4;
  using Stage = Eigen::Matrix<Scalar, padded, 1>;
  using Passing = Vector;

  explicit StageMemory(const Vector& /*y*/) { stage_.fill(Stage::Zero()); }

  [[nodiscard]] const Stage& operator[](std::size_t k) const { return stage_[k]; }

  /// Puts the result of `make` into stage k.
  template <class Make>
  [[gnu::always_inline]] void keep(std::size_t k, const Make& make) {
    alignas(few ? 1 : alignof(Vec4d)) alignas(Vector) const Vector rate = make();
    if constexpr (by_fours) {
      keep_fours(stage_[k], rate, std::make_integer_sequence<int, padded / 4>());
    } else {
      for (int i = 0; i < components; ++i) stage_[k][i] = rate[i];
    }
  }

  [[nodiscard]] static Vector point() { return {}; }
  [[nodiscard]] static Vector change() { return {}; }
  [[nodiscard]] static Vector error() { return {}; }

  /// result = a sum of multiples of stages and states: terms(part) sums up part() of each. In
  /// groups of four the sum stays in registers. That holds also if the compiler inlines so much
  /// that it calls Eigen's assignments as functions.
  template <class Terms>
  [[gnu::always_inline]] static void put(Vector& result, const Terms& terms) {
    if constexpr (by_fours) {
      put_fours(result, terms, std::make_integer_sequence<int, padded / 4>());
    } else {
      result = terms([](const auto& v) { return own(v); });
    }
  }

  /// The part of a stage that corresponds to the state.
  template <class V>
  [[nodiscard]] static auto own(const V& v) {
    return v.template head<components>();
  }

 private:
  /// Four numbers of a vector, padded with zeros.
  template <int first, class V>
  [[nodiscard, gnu::always_inline]] static Vec4d vec4d_of(const V& v) {
    constexpr int left = int(V::RowsAtCompileTime) - first;
    if constexpr (left >= 4) {
      return Vec4d::from(v.data() + first);
    } else {
      return {v[first], left > 1 ? v[first + 1] : 0, left > 2 ? v[first + 2] : 0, 0};
    }
  }

  template <int... group>
  [[gnu::always_inline]] static void keep_fours(Stage& stage, const Vector& rate,
                                                std::integer_sequence<int, group...> /*all*/) {
    (vec4d_of<4 * group>(rate).to(stage.data() + 4 * group), ...);
  }

  template <class Terms, int... group>
  [[gnu::always_inline]] static void put_fours(Vector& result, const Terms& terms,
                                               std::integer_sequence<int, group...> /*all*/) {
    (put_four<4 * group>(result, terms), ...);
  }
  template <int first, class Terms>
  [[gnu::always_inline]] static void put_four(Vector& result, const Terms& terms) {
    const Vec4d sum = terms([](const auto& v) { return vec4d_of<first>(v); });
    if constexpr (components - first >= 4) {
      sum.to(result.data() + first);
    } else {
      for (int i = 0; first + i < components; ++i) result[first + i] = sum[i];
    }
  }

  std::array<Stage, stages> stage_;
};

/// Stages of packs. A field writes its rates directly to their final place. Copies are no wider
/// than the compiler likes, and the processor waits if two of its stores make one pack. For the
/// same reason a sum of stages is computed component by component when it is used, and never stored
/// as a vector.
template <class Vector, std::size_t stages, int components>
requires is_pack<typename Vector::Scalar>
class StageMemory<Vector, stages, components> {
  using Pack = typename Vector::Scalar;

 public:
  static constexpr bool fixed = true;
  static constexpr bool few = false;
  using Passing = Vector;

  explicit StageMemory(const Vector& /*y*/) { stage_.fill(Vector::Zero()); }

  [[nodiscard]] const Vector& operator[](std::size_t k) const { return stage_[k]; }

  template <class Make>
  [[gnu::always_inline]] void keep(std::size_t k, const Make& make) {
    ::new (&stage_[k]) Vector(make());
  }

  [[nodiscard]] static Vector point() { return {}; }
  [[nodiscard]] static Vector change() { return {}; }
  [[nodiscard]] static Vector error() { return {}; }

  template <class Terms>
  static void put(Vector& result, const Terms& terms) {
    for (int i = 0; i < components; ++i) {
      result[i] = terms([i](const Vector& v) -> const Pack& { return v[i]; });
    }
  }

  [[nodiscard]] static const Vector& own(const Vector& stage) { return stage; }

 private:
  std::array<Vector, stages> stage_;
};

/// Stages of dynamic size. All memory is allocated at the beginning, none by the steps. A sum of
/// stages is computed when it is used, in one pass.
template <class Vector, std::size_t stages>
class StageMemory<Vector, stages, Eigen::Dynamic> {
 public:
  static constexpr bool fixed = false;
  static constexpr bool few = false;
  using Passing = Vector&;

  explicit StageMemory(const Vector& y) : point_(y), change_(y), error_(y) { stage_.fill(y); }

  [[nodiscard]] const Vector& operator[](std::size_t k) const { return stage_[k]; }

  [[nodiscard]] Vector& rate(std::size_t k) { return stage_[k]; }

  [[nodiscard]] Vector& point() { return point_; }
  [[nodiscard]] Vector& change() { return change_; }
  [[nodiscard]] Vector& error() { return error_; }

  template <class Terms>
  static void put(Vector& result, const Terms& terms) {
    result = terms([](const Vector& v) -> const Vector& { return v; });
  }

  [[nodiscard]] static const Vector& own(const Vector& stage) { return stage; }

 private:
  std::array<Vector, stages> stage_;
  Vector point_;
  Vector change_;
  Vector error_;
};

}  // namespace kreisel::detail
