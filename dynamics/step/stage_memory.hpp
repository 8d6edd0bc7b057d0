#pragma once

#include <Eigen/Core>

#include <array>
#include <cstddef>

namespace kreisel::detail {

/// The stages of an explicit method, and the vectors that it needs only in passing.
///
/// Of a size known to the compiler: stages are filled up with zeros to whole packets of 4, for 7
/// numbers would be added one by one; what passes stays in registers and on the stack.
template <class Vector, std::size_t stages, int components = int(Vector::RowsAtCompileTime)>
class StageMemory {
 public:
  static constexpr bool fixed = true;
  static constexpr int padded = components < 3 ? components : (components + 3) / 4 * 4;
  using Stage = Eigen::Matrix<typename Vector::Scalar, padded, 1>;
  using Passing = Vector;

  explicit StageMemory(const Vector& /*y*/) { stage_.fill(Stage::Zero()); }

  [[nodiscard]] const Stage& operator[](std::size_t k) const { return stage_[k]; }

  /// Where the field writes stage k, which then is to be kept.
  [[nodiscard]] static Vector rate(std::size_t /*k*/) { return {}; }
  void keep(std::size_t k, const Vector& rate) {
    for (int i = 0; i < components; ++i) stage_[k][i] = rate[i];
  }

  [[nodiscard]] static Vector point() { return {}; }
  [[nodiscard]] static Vector change() { return {}; }
  [[nodiscard]] static Vector error() { return {}; }

  [[nodiscard]] static Stage nothing() { return Stage::Zero(); }

  /// A sum of multiples of stages, computed at once.
  template <class Terms>
  [[nodiscard]] static Stage sum(const Terms& terms) {
    return terms;
  }

  /// The part of a stage that is the state's own.
  [[nodiscard]] static auto own(const Stage& v) { return v.template head<components>(); }

 private:
  std::array<Stage, stages> stage_;
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
  void keep(std::size_t k, const Vector& rate) { stage_[k] = rate; }

  [[nodiscard]] Vector& point() { return point_; }
  [[nodiscard]] Vector& change() { return change_; }
  [[nodiscard]] Vector& error() { return error_; }

  [[nodiscard]] auto nothing() const { return Vector::Zero(point_.size()); }

  template <class Terms>
  [[nodiscard]] static Terms sum(const Terms& terms) {
    return terms;
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
