#pragma once

#include <stop_token>

namespace kreisel {

/// Thrown by steps whose stop token was asked to stop. It is no error, and so no std::exception.
struct StopRequested {};

namespace detail {

/// Throws : StopRequested
inline void stop_if_requested(const std::stop_token& stop) {
  if (stop.stop_requested()) throw StopRequested{};
}

}  // namespace detail

}  // namespace kreisel
