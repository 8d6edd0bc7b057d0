#pragma once

#include <fmt/core.h>

#include <cstdint>
#include <string_view>

/// The hash FNV-1a of Fowler, Noll and Vo, 64 bits, of texts and numbers added one by one.
class Hash {
 public:
  Hash() = default;
  explicit Hash(std::uint64_t value) : value_(value) {}

  void add(std::string_view text) {
    for (const char c : text) {
      value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211U;
    }
  }
  void add(double x) { add(std::string_view(fmt::format("{:a};", x))); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

  friend bool operator==(const Hash&, const Hash&) = default;

 private:
  std::uint64_t value_ = 14695981039346656037U;
};
