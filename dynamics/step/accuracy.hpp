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

/// How exact an integration is to be.
struct Accuracy {
  /// Bound of the error made in one step, relative to each block of the state; 1e-16 to 1e-2. ExplicitRungeKutta
  /// and TaylorSteps go down to 1e-20: what a method errs by adds up, what is rounded hardly does.
  double relative = 1e-14;

  /// A block smaller than this (in its SI unit) counts as being so large. Set it to the size of the
  /// signal where that is smaller.
  double absolute_scale = 1e-3;

  /// Evaluations of the field after which the integration gives up.
  double max_evaluations = 1e8;

  /// By how many of its last digits the change in each step is made wrong, up or down at random
  /// (ExplicitRungeKutta, TaylorSteps). Beside a run that is not shaken, one that is tells what rounding
  /// grows to.
  double shaken = 0;
};

/// What an integration has cost so far.
struct IntegrationStatistics {
  double steps = 0;
  double rejected = 0;
  double evaluations = 0;
  double jacobians = 0;
};

namespace detail {

/// Accuracy::relative of methods that have no iterations of their own to end.
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
  if (!(accuracy.shaken >= 0 && std::isfinite(accuracy.shaken))) {
    refuse_steps("accuracy.shaken = ", accuracy.shaken, " must be a finite number of 0 or above");
  }
}

/// |v| of the components from `begin` on, also where their squares would leave the range; of each
/// lane, if v holds those of packs.
template <class Vector>
[[nodiscard]] typename Vector::Scalar norm(const Vector& v, int begin, int components) {
  using std::abs;
  using std::sqrt;
  using Number = typename Vector::Scalar;
  using Limits = std::numeric_limits<ScalarOf<Number>>;
  if (components == 1) return abs(v[begin]);
  Number sum(0);  // a loop, because g++ 12 sees v.segment().norm() read past the end of v
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

/// The parts of a state that share unit and size, and how large each has been so far: what an error
/// in it is measured by.
///
/// Vector : of numbers, or of packs: then each lane is measured by its own sizes, and the worst counts
template <class Vector>
class BlockSizes {
  using Number = typename Vector::Scalar;

 public:
  using Scalar = ScalarOf<Number>;

  /// Without any blocks all of y is one.
  BlockSizes(std::span<const int> blocks, const Scalar& smallest, const Vector& y)
      : smallest_(smallest) {
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

  /// To be called with every state that stands.
  void note(const Vector& y) {
    for (Block& block : blocks_) block.size = larger(block.size, norm(y, block));
  }

  /// Takes over the sizes that blocks have had before.
  void know(std::span<const double> sizes) {
    for (std::size_t i = 0; i < std::min(sizes.size(), blocks_.size()); ++i) {
      blocks_[i].size = larger(blocks_[i].size, Number(Scalar(sizes[i])));
    }
  }

  /// The greatest size of each block so far, at least the smallest that counts; of packs the greatest
  /// lane's.
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
    for (Block& block : blocks_) checkpoint(block.size, block.noise, block.wander);
  }

  /// What rounding of the state leaves uncertain of its rate. Each step makes an error of that times
  /// its length; `squares` is the sum of those lengths squared since this was noted last.
  void note_noise(const Vector& rate, const Scalar& squares) {
    for (Block& block : blocks_) {
      block.wander += squares * block.noise * block.noise;
      block.noise = norm(rate, block);
    }
  }

  /// How far noise has led a block off by now, a random walk in proportion to its size.
  [[nodiscard]] Scalar wander(const Scalar& squares) const {
    using std::sqrt;
    Number worst(0);
    for (const Block& block : blocks_) {
      const Number way = sqrt(block.wander + squares * block.noise * block.noise);
      const Number ratio = way / scale(block);
      worst = select(way > Number(0) && ratio > worst, ratio, worst);
    }
    return greatest_lane(worst);
  }

  /// The largest of the blocks' |error|, each in proportion to its size, which is |change| where
  /// the step has made that. What `span` of noise in the rate makes is no error of the step. The
  /// worst lane decides. A NaN stays.
  template <class Error, class Change>
  [[nodiscard]] Scalar relative(const Error& error, const Change& change,
                                const Scalar& span = Scalar(0)) const {
    Number worst(0);
    for (const Block& block : blocks_) {
      const Number off = norm(error, block) - span * block.noise;
      const auto none = off <= Number(0);
      if (all(none)) continue;
      const Number ratio = off / larger(scale(block), norm(change, block));
      worst = select(none || ratio <= worst || worst != worst, worst, ratio);
    }
    return greatest_lane(worst);
  }

  /// A hundredth of the time in which a block changes by its own size, if it has one already.
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

  /// The time in which a rate that changes by `bend` within h leads a block off its way by as much
  /// as the block or its way are long. Infinite where no rate changes.
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
    Number noise;
    Number wander;  ///< squared
  };

  template <class Components>
  [[nodiscard]] static Number norm(const Components& v, const Block& block) {
    return detail::norm(v, block.begin, block.components);
  }

  /// As std::max: of a NaN behind nothing stays.
  [[nodiscard]] static Number larger(const Number& a, const Number& b) {
    return select(a < b, b, a);
  }

  [[nodiscard]] Number scale(const Block& block) const {
    return larger(block.size, Number(smallest_));
  }

  Scalar smallest_;
  std::vector<Block> blocks_;
};

}  // namespace detail

}  // namespace kreisel
