#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <dynamics/step/shared.hpp>
#include <motor/lanes.hpp>

namespace kreisel {

/// Accuracy and limits of an integration.
struct Accuracy {
  /// Bound of the error made in one step, relative to each block of the state; 1e-16 to 1e-2.
  /// ExplicitRungeKutta and TaylorSteps accept values down to 1e-20: truncation errors add up over
  /// the steps, rounding errors hardly do.
  double relative = 1e-14;

  /// Smallest size of a block for relative errors, in the block's SI unit. Set it to the size of
  /// the signal if that is smaller.
  double absolute_scale = 1e-3;

  /// The integration gives up after so many evaluations of the field.
  double max_evaluations = 1e8;

  /// Perturbation of the change in each step, in units of its last digit, up or down at random
  /// (ExplicitRungeKutta, TaylorSteps). The difference to an unperturbed run shows the growth of
  /// rounding.
  double perturbed = 0;
};

/// Cost of an integration so far.
struct IntegrationStatistics {
  double steps = 0;
  double rejected = 0;
  double evaluations = 0;
  double jacobians = 0;
};

namespace detail {

/// Smallest Accuracy::relative of methods without inner iterations.
inline constexpr double least_over_long_ways = 1e-20;

inline void check(const Accuracy& accuracy, double least = 1e-16) {
  if (!(accuracy.relative >= least && accuracy.relative <= 1e-2)) {
    refuse_steps("accuracy.relative = ", accuracy.relative, " lies outside [", least,
                 ", 1e-2], what these steps can keep");
  }
  if (!(accuracy.absolute_scale >= 0)) {
    refuse_steps("accuracy.absolute_scale = ", accuracy.absolute_scale, " must be 0 or above");
  }
  if (!(accuracy.max_evaluations > 0)) {
    refuse_steps("accuracy.max_evaluations = ", accuracy.max_evaluations, " must be above 0");
  }
  if (!(accuracy.perturbed >= 0 && std::isfinite(accuracy.perturbed))) {
    refuse_steps("accuracy.perturbed = ", accuracy.perturbed,
                 " must be a finite number of 0 or above");
  }
}

/// |v| of the components from `begin` on, also if their squares overflow or underflow;
/// for packs lane by lane.
template <class Vector>
[[nodiscard]] typename Vector::Scalar norm(const Vector& v, int begin, int components) {
  using std::abs;
  using std::sqrt;
  using Number = typename Vector::Scalar;
  using Limits = std::numeric_limits<ScalarOf<Number>>;
  if (components == 1) return abs(v[begin]);
  Number sum(0);  // a loop: g++ 12 warns that v.segment().norm() reads past the end of v
  for (int i = begin; i < begin + components; ++i) sum += v[i] * v[i];
  const Number smallest(Limits::min() / Limits::epsilon());
  const Number most(Limits::max());
  if (all(sum > smallest && sum < most)) return sqrt(sum);
  Number largest(0);
  for (int i = begin; i < begin + components; ++i) {
    const Number size = abs(v[i]);
    largest = select(size <= largest, largest, size);  // a NaN stays
  }
  sum = Number(0);
  for (int i = begin; i < begin + components; ++i) {
    sum += (v[i] / largest) * (v[i] / largest);
  }
  return select(largest > Number(0) && largest <= most, Number(largest * sqrt(sum)), largest);
}

/// The blocks of a state (parts that share unit and size) and the greatest size of each so far.
/// Errors are measured relative to these sizes.
///
/// Vector : of numbers, or of packs: each lane then has its own sizes, and the worst lane counts
template <class Vector>
class BlockSizes {
  using Number = typename Vector::Scalar;

 public:
  using Scalar = ScalarOf<Number>;

  /// Without blocks the whole of y is one block.
  BlockSizes(std::span<const int> blocks, const Scalar& absolute_scale, const Vector& y)
      : absolute_scale_(absolute_scale) {
    const int all = static_cast<int>(y.size());
    if (blocks.empty()) blocks = {&all, 1};
    require_blocks(blocks, all);
    int begin = 0;
    for (const int size : blocks) {
      blocks_.push_back({begin, size, Number(0), Number(0), Number(0)});
      begin += size;
    }
    note(y);
  }

  /// Must be called with every accepted state.
  void note(const Vector& y) {
    for (Block& block : blocks_) block.size = larger(block.size, norm(y, block));
  }

  /// Takes over the sizes of an earlier integration.
  void set(std::span<const double> sizes) {
    for (std::size_t i = 0; i < std::min(sizes.size(), blocks_.size()); ++i) {
      blocks_[i].size = larger(blocks_[i].size, Number(Scalar(sizes[i])));
    }
  }

  /// The greatest size of each block so far, at least absolute_scale. In packs the greatest lane
  /// counts.
  [[nodiscard]] std::vector<Scalar> sizes() const {
    std::vector<Scalar> result;
    for (const Block& block : blocks_) result.push_back(greatest_lane(scale(block)));
    return result;
  }

  /// Writes to each component the size of its block.
  void put(Vector& sizes) const {
    for (const Block& block : blocks_) {
      for (int i = 0; i < block.components; ++i) sizes[block.begin + i] = scale(block);
    }
  }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    for (Block& block : blocks_) checkpoint(block.size, block.rounding, block.wander);
  }

  /// Records the uncertainty of the rate due to rounding of the state. The error of a step is this
  /// uncertainty times the step's length. `squares` is the sum of squared step lengths since the
  /// last call.
  void note_rounding(const Vector& rate, const Scalar& squares) {
    for (Block& block : blocks_) {
      block.wander += squares * block.rounding * block.rounding;
      block.rounding = norm(rate, block);
    }
  }

  /// Deviation of a block due to rounding so far: a random walk, relative to the block's size.
  [[nodiscard]] Scalar wander(const Scalar& squares) const {
    using std::sqrt;
    Number worst(0);
    for (const Block& block : blocks_) {
      const Number way = sqrt(block.wander + squares * block.rounding * block.rounding);
      const Number ratio = way / scale(block);
      worst = select(way > Number(0) && ratio > worst, ratio, worst);
    }
    return greatest_lane(worst);
  }

  /// The largest |error| of all blocks, relative to the block's size or to |change| if the step
  /// changed the block by more. Rounding of the rate over `span` is not counted. The worst lane
  /// decides. A NaN stays.
  template <class Error, class Change>
  [[nodiscard]] Scalar relative(const Error& error, const Change& change,
                                const Scalar& span = Scalar(0)) const {
    Number worst(0);
    for (const Block& block : blocks_) {
      const Number off = norm(error, block) - span * block.rounding;
      const auto none = off <= Number(0);
      if (all(none)) continue;
      const Number ratio = off / larger(scale(block), norm(change, block));
      worst = select(none || ratio <= worst || worst != worst, worst, ratio);
    }
    return greatest_lane(worst);
  }

  /// A hundredth of the time in which a block changes by its own size, without blocks of size 0.
  [[nodiscard]] Scalar first_step(const Vector& rate) const {
    Number all_rates(0);
    for (const Block& block : blocks_) {
      const Number size = scale(block);
      const Number speed = select(size == Number(0), Number(0), Number(norm(rate, block) / size));
      all_rates = larger(all_rates, speed);
    }
    const Scalar fastest = greatest_lane(all_rates);
    return fastest > Scalar(0) ? Scalar(Scalar(0.01) / fastest) : Scalar(1);
  }

  /// The time in which the curvature of the path deviates a block by its own size or by its path
  /// length. `bend` is the change of the rate within h. Infinite if no rate changes.
  [[nodiscard]] Scalar bending_time(const Vector& rate, const Vector& bend, const Scalar& h) const {
    using std::sqrt;
    Number shortest(std::numeric_limits<Scalar>::infinity());
    for (const Block& block : blocks_) {
      const Number bends = norm(bend, block) / Number(h);
      const Number bent = sqrt(Number(scale(block) / bends));
      const Number time = larger(bent, Number(norm(rate, block) / bends));
      shortest = select(time > Number(0) && time < shortest, time, shortest);
    }
    return -greatest_lane(Number(-shortest));
  }

 private:
  struct Block {
    int begin;
    int components;
    Number size;
    Number rounding;
    Number wander;  ///< squared
  };

  template <class Components>
  [[nodiscard]] static Number norm(const Components& v, const Block& block) {
    return detail::norm(v, block.begin, block.components);
  }

  /// Like std::max, but a NaN in either argument stays.
  [[nodiscard]] static Number larger(const Number& a, const Number& b) {
    return select(a < b, b, a);
  }

  [[nodiscard]] Number scale(const Block& block) const {
    return larger(block.size, Number(absolute_scale_));
  }

  Scalar absolute_scale_;
  std::vector<Block> blocks_;
};

}  // namespace detail

}  // namespace kreisel
