#pragma once

#include <csignal>
#include <semaphore.h>
#include <stop_token>
#include <thread>

/// SIGINT and SIGTERM end a program early, with the results so far.
namespace signals {

namespace internal {

inline volatile std::sig_atomic_t caught = 0;
inline sem_t arrived = {};

extern "C" inline void on_signal(int signal) {
  caught = signal;
  ::sem_post(&arrived);  // all that POSIX allows here; a stop_source is not among it
}

/// Never destroyed: its thread waits for signals until the program ends.
inline std::stop_source& source() {
  static auto* const one = new std::stop_source;
  return *one;
}

}  // namespace internal

/// Records SIGINT and SIGTERM instead of ending the program. A wait of the calling thread in the
/// kernel then ends with EINTR.
inline void watch() {
  ::sem_init(&internal::arrived, 0, 0);
  struct sigaction action = {};
  action.sa_handler = internal::on_signal;  // and no SA_RESTART
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

/// The last signal; 0 if there was none.
[[nodiscard]] inline int caught() { return internal::caught; }

/// A token whose stop SIGINT and SIGTERM request. The first call starts a thread for that, which
/// itself blocks all signals.
[[nodiscard]] inline std::stop_token token() {
  [[maybe_unused]] static const bool started = [] {
    sigset_t all;
    sigset_t before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread([] {
      while (::sem_wait(&internal::arrived) != 0) {
      }
      internal::source().request_stop();
    }).detach();
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return true;
  }();
  return internal::source().get_token();
}

}  // namespace signals
