#pragma once

#include <csignal>

/// SIGINT and SIGTERM, which end a program early with what has been computed so far.
namespace signals {

namespace detail {

inline volatile std::sig_atomic_t caught = 0;

extern "C" inline void on_signal(int signal) { caught = signal; }

}  // namespace detail

/// Has SIGINT and SIGTERM noted instead of ending the program. A wait in the kernel then ends with
/// EINTR.
inline void watch() {
  struct sigaction action = {};
  action.sa_handler = detail::on_signal;  // and no SA_RESTART
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

/// The signal that came last; 0 if none did.
[[nodiscard]] inline int caught() { return detail::caught; }

}  // namespace signals
