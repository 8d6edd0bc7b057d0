#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>

#include <dynamics/step/lanes.hpp>
#include <motor/four.hpp>

namespace kreisel::detail {

/// The stages of an explicit method, and the vectors that it needs only in passing.
///
/// Of a size known to the compiler: stages are filled up with zeros to whole fours, which are stored,
/// read and summed up as such (Eigen would take eight at once where it can, read from two stores, and
/// wait for them); what passes stays in registers and on the stack.
template <class Vector, std::size_t stages, int components = int(Vector::RowsAtCompileTime)>
class StageMemory {
  using Scalar = typename Vector::Scalar;
  // Longer ones are filled by loops, which store as much at once as is read.
  static constexpr bool by_fours = std::is_same_v<Scalar, double> && components <= 16;

 public:
  static constexpr bool fixed = true;
  static constexpr int padded = components < 3 && !by_fours ? components : (components + 3) / 4 * 4;
  using Stage = Eigen::Matrix<Scalar, padded, 1>;
  using Passing = Vector;

  explicit StageMemory(const Vector& /*y*/) { stage_.fill(Stage::Zero()); }

  [[nodiscard]] const Stage& operator[](std::size_t k) const { return stage_[k]; }

  /// Puts what `make` returns into stage k.
  template <class Make>
  [[gnu::always_inline]] void keep(std::size_t k, const Make& make) {
    alignas(Four) alignas(Vector) const Vector rate = make();
    if constexpr (by_fours) {
      const auto number = [&rate](int i) { return i < components ? rate[i] : 0.0; };
      [&]<int... i>(std::integer_sequence<int, i...>) {
        (Four(number(4 * i), number(4 * i + 1), number(4 * i + 2), number(4 * i + 3))
             .to(stage_[k].data() + 4 * i),
         ...);
      }
      (std::make_integer_sequence<int, padded / 4>());
    } else {
      for (int i = 0; i < components; ++i) stage_[k][i] = rate[i];
    }
  }

  [[nodiscard]] static Vector point() { return {}; }
  [[nodiscard]] static Vector change() { return {}; }
  [[nodiscard]] static Vector error() { return {}; }

  [[nodiscard]] static Stage nothing() { return Stage::Zero(); }

  /// A sum of multiples of stages: terms(part) sums up what part(stage) takes of each.
  template <class Terms>
  [[nodiscard]] static Stage sum(const Terms& terms) {
    if constexpr (by_fours) {
      Stage total;
      for (int i = 0; i < padded; i += 4) {
        terms([i](const Stage& stage) {
          return Four::from(stage.data() + i);
        }).to(total.data() + i);
      }
      return total;
    } else {
      return terms([](const Stage& stage) -> const Stage& { return stage; });
    }
  }

  /// The part of a stage that is the state's own.
  [[nodiscard]] static auto own(const Stage& v) { return v.template head<components>(); }

 private:
  std::array<Stage, stages> stage_;
};

/// Of packs. A field writes its rates where they will be read: copies are no wider than the compiler
/// likes, and the processor waits where two of its stores make one pack. For the same reason a sum
/// of stages is computed component by component where it is used, and never stored as a vector.
template <class Vector, std::size_t stages, int components>
requires is_pack<typename Vector::Scalar>
class StageMemory<Vector, stages, components> {
  using Pack = typename Vector::Scalar;

 public:
  static constexpr bool fixed = true;
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

  [[nodiscard]] static auto nothing() { return Vector::Zero(); }

  template <class Terms>
  [[nodiscard]] static auto sum(const Terms& terms) {
    return Vector::NullaryExpr([terms](Eigen::Index i) -> Pack {
      return terms([i](const Vector& stage) -> const Pack& { return stage[i]; });
    });
  }

  template <class Terms>
  [[nodiscard]] static const Terms& own(const Terms& terms) {
    return terms;
  }

 private:
  std::array<Vector, stages> stage_;
};

/// Of a size known at run time: all are kept from the beginning, so that no step asks for memory,
/// and a sum of stages is computed where it is used, in one pass with what is done to it.
template <class Vector, std::size_t stages>
class StageMemory<Vector, stages, Eigen::Dynamic> {
 public:
  static constexpr bool fixed = false;
  using Passing = Vector&;

  explicit StageMemory(const Vector& y) : point_(y), change_(y), error_(y) { stage_.fill(y); }

  [[nodiscard]] const Vector& operator[](std::size_t k) const { return stage_[k]; }

  [[nodiscard]] Vector& rate(std::size_t k) { return stage_[k]; }

  [[nodiscard]] Vector& point() { return point_; }
  [[nodiscard]] Vector& change() { return change_; }
  [[nodiscard]] Vector& error() { return error_; }

  [[nodiscard]] auto nothing() const { return Vector::Zero(point_.size()); }

  template <class Terms>
  [[nodiscard]] static auto sum(const Terms& terms) {
    return terms([](const Vector& stage) -> const Vector& { return stage; });
  }

  template <class Terms>
  [[nodiscard]] static const Terms& own(const Terms& terms) {
    return terms;
  }

 private:
  std::array<Vector, stages> stage_;
  Vector point_;
  Vector change_;
  Vector error_;
};

}  // namespace kreisel::detail
