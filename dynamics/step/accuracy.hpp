#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <dynamics/step/shared.hpp>

namespace kreisel {

/// How exact an integration is to be.
struct Accuracy {
  /// Of the error made in one step, relative to each block of the state; 1e-16 to 1e-2.
  double relative = 1e-14;

  /// A block smaller than this (in its SI unit) counts as being so large. Set it to the size of the
  /// signal where that is smaller.
  double smallest = 1e-3;

  /// Evaluations of the field after which the integration gives up.
  double most_evaluations = 1e8;
};

/// What an integration has cost so far.
struct Effort {
  double steps = 0;
  double rejected = 0;
  double evaluations = 0;
  double jacobians = 0;
};

namespace detail {

inline void check(const Accuracy& accuracy) {
  if (!(accuracy.relative >= 1e-16 && accuracy.relative <= 1e-2)) {
    refuse_steps("accuracy.relative = ", accuracy.relative,
                 " lies outside [1e-16, 1e-2], what steps in double precision can keep");
  }
  if (!(accuracy.smallest >= 0)) {
    refuse_steps("accuracy.smallest = ", accuracy.smallest, " must be 0 or above");
  }
}

/// The parts of a state that share unit and size, and how large each has been so far: what an error
/// in it is measured by.
template <class Vector>
class BlockSizes {
 public:
  using Scalar = typename Vector::Scalar;

  /// Without any blocks all of y is one.
  BlockSizes(std::span<const int> blocks, const Scalar& smallest, const Vector& y)
      : smallest_(smallest) {
    const int all = static_cast<int>(y.size());
    if (blocks.empty()) blocks = {&all, 1};
    require_blocks(blocks, all);
    int begin = 0;
    for (const int size : blocks) {
      blocks_.push_back({begin, size, Scalar(0)});
      begin += size;
    }
    note(y);
  }

  /// To be called with every state that stands.
  void note(const Vector& y) {
    for (Block& block : blocks_) block.size = std::max(block.size, norm(y, block));
  }

  /// The largest of the blocks' |error|, each in proportion to its size, which is |change| where
  /// the step has made that. A NaN stays.
  [[nodiscard]] Scalar relative(const Vector& error, const Vector& change) const {
    Scalar worst(0);
    for (const Block& block : blocks_) {
      const Scalar off = norm(error, block);
      if (off == Scalar(0)) continue;
      const Scalar ratio = off / std::max(scale(block), norm(change, block));
      worst = ratio <= worst || worst != worst ? worst : ratio;
    }
    return worst;
  }

  /// A hundredth of the time in which a block changes by its own size, if it has one already.
  [[nodiscard]] Scalar first_step(const Vector& rate) const {
    Scalar fastest(0);
    for (const Block& block : blocks_) {
      if (scale(block) == Scalar(0)) continue;
      fastest = std::max(fastest, Scalar(norm(rate, block) / scale(block)));
    }
    return fastest > Scalar(0) ? Scalar(Scalar(0.01) / fastest) : Scalar(1);
  }

 private:
  struct Block {
    int begin;
    int components;
    Scalar size;
  };

  [[nodiscard]] static Scalar norm(const Vector& v, const Block& block) {
    Scalar sum(0);  // a loop, because g++ 12 sees v.segment().norm() read past the end of v
    for (int i = block.begin; i < block.begin + block.components; ++i) sum += v[i] * v[i];
    return std::sqrt(sum);
  }

  [[nodiscard]] Scalar scale(const Block& block) const { return std::max(block.size, smallest_); }

  Scalar smallest_;
  std::vector<Block> blocks_;
};

}  // namespace detail

}  // namespace kreisel
