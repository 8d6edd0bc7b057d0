#pragma once

namespace kreisel::test {

/// The greatest of errors, and NaN if one of them is. std::max ignores a NaN in second position,
/// which would hide an invalid error.
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
