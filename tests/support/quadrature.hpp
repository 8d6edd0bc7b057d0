#pragma once

#include <utility>

namespace kreisel::test {

/// The integral of f from a to b by Gauss' formula of 10 nodes, for S = double or long double.
///
/// Error : |b - a|^21 |f^(20)|/1.7e30, and rounding
template <class S, class F>
[[nodiscard]] S integral(S a, S b, const F& f) {
  constexpr std::pair<long double, long double> nodes[] = {
      {0.148874338981631210884826001129719985L, 0.295524224714752870173892994651338329L},
      {0.433395394129247190799265943165784162L, 0.269266719309996355091226921569469353L},
      {0.679409568299024406234327365114873576L, 0.219086362515982043995534934228163192L},
      {0.865063366688984510732096688423493048L, 0.149451349150580593145863397657697332L},
      {0.973906528517171720077964012084452053L, 0.0666713443086881375935688098933317929L}};
  S sum = 0;
  for (const auto& [x, weight] : nodes) {
    for (const S sign : {S(-1), S(1)}) sum += S(weight) * f((a + b + sign * S(x) * (b - a)) / 2);
  }
  return sum * (b - a) / 2;
}

}  // namespace kreisel::test
