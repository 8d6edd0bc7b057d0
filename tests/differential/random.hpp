#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <vector>

namespace differential {

/// Random numbers that are the same on every machine: splitmix64.
///
/// Source : G. Steele, D. Lea, C. Flood, Fast splittable pseudorandom number generators (2014)
class Random {
 public:
  /// The numbers of the scene `index` of a series of scenes.
  Random(std::uint64_t seed, std::uint64_t index) : state_(seed * 0x9E3779B97F4A7C15U) {
    state_ = bits() ^ (index * 0xD1342543DE82EF95U);
  }

  [[nodiscard]] std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
  }

  /// In [0, 1).
  [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
  [[nodiscard]] double between(double least, double most) {
    return least + (most - least) * uniform();
  }
  /// With uniformly distributed logarithm.
  [[nodiscard]] double spread(double least, double most) {
    return std::exp(between(std::log(least), std::log(most)));
  }
  [[nodiscard]] bool chance(double probability) { return uniform() < probability; }
  [[nodiscard]] int below(int n) { return static_cast<int>(uniform() * n); }

  template <class T>
  [[nodiscard]] T pick(std::initializer_list<T> list) {
    return *(list.begin() + below(static_cast<int>(list.size())));
  }

 private:
  std::uint64_t state_;
};

}  // namespace differential
