#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace kreisel {

/// The random numbers of one member of an ensemble. They depend only on the seed, the member's
/// index and the count of numbers taken before. No two members share a sequence.
///
/// Source : Philox4x32-10: J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw, Parallel random
///          numbers: as easy as 1, 2, 3, SC11 (2011); key: the seed, counter: the block and the
///          index. Held against the authors' known answers (tests/dynamics/random.cpp)
class MemberRandom {
 public:
  using Block = std::array<std::uint32_t, 4>;

  MemberRandom(std::uint64_t seed, std::uint64_t index) : seed_(seed), index_(index) {}

  /// Four words of 32 bits from counter and key.
  [[nodiscard]] static constexpr Block philox(Block counter, std::array<std::uint32_t, 2> key) {
    for (int round = 0; round < 10; ++round) {
      const std::uint64_t even = std::uint64_t{0xD2511F53} * counter[0];
      const std::uint64_t odd = std::uint64_t{0xCD9E8D57} * counter[2];
      counter = {high(odd) ^ counter[1] ^ key[0], low(odd), high(even) ^ counter[3] ^ key[1],
                 low(even)};
      key = {key[0] + 0x9E3779B9, key[1] + 0xBB67AE85};
    }
    return counter;
  }

  /// 64 random bits.
  [[nodiscard]] std::uint64_t bits() {
    if (taken_ % 2 == 0) {
      const std::uint64_t block = taken_ / 2;
      words_ =
          philox({low(block), high(block), low(index_), high(index_)}, {low(seed_), high(seed_)});
    }
    const std::size_t at = taken_++ % 2 == 0 ? 0 : 2;
    return std::uint64_t{words_[at]} | std::uint64_t{words_[at + 1]} << 32;
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  [[nodiscard]] double uniform(double from, double to) { return from + (to - from) * uniform(); }

  /// Gauss's distribution, by Box and Muller's formula; takes two uniform numbers.
  [[nodiscard]] double normal(double mean = 0, double deviation = 1) {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return mean + deviation * radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t low(std::uint64_t x) {
    return static_cast<std::uint32_t>(x & 0xFFFFFFFF);
  }
  [[nodiscard]] static constexpr std::uint32_t high(std::uint64_t x) {
    return static_cast<std::uint32_t>(x >> 32);
  }

  std::uint64_t seed_;
  std::uint64_t index_;
  std::uint64_t taken_ = 0;
  Block words_{};
};

}  // namespace kreisel
