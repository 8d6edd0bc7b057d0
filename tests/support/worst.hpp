#pragma once

namespace kreisel::test {

/// The greatest of errors, and NaN once one of them is: std::max forgets a NaN that comes second, and
/// what is no number would pass for no error.
template <class S, class... More>
[[nodiscard]] S worst_of(const S& first, const More&... others) {
  S worst = first;
  const auto take_in = [&worst](const S& error) {
    if (!(error <= worst) && worst == worst) worst = error;
  };
  (take_in(others), ...);
  return worst;
}

}  // namespace kreisel::test
