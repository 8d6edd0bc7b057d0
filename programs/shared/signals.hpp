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

/// A thread that requests a stop when a signal arrives. It blocks all signals itself.
class Waiter {
 public:
  Waiter() {
    sigset_t all;
    sigset_t before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([this] {
      while (::sem_wait(&arrived) != 0) {
      }
      source_.request_stop();
    });
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  ~Waiter() {
    ::sem_post(&arrived);
    thread_.join();
  }
  Waiter(const Waiter&) = delete;
  Waiter& operator=(const Waiter&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::thread thread_;
};

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

/// A token whose stop SIGINT and SIGTERM request. Needs watch(); the first call starts a thread.
[[nodiscard]] inline std::stop_token token() {
  static const internal::Waiter waiter;
  return waiter.token();
}

}  // namespace signals
