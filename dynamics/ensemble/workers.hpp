#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>
#include <system_error>
#include <thread>
#include <vector>

namespace kreisel {

/// Options of parallel_for().
struct Workers {
  int threads = 0;  ///< including the caller's; 0: as many as the hardware runs at once

  /// Called with the completed share, never by two threads at once. If it returns false, all stop.
  std::function<bool(double share)> progress = nullptr;

  std::stop_token stop = {};  ///< stops all threads
};

/// Calls `work(i, stop)` for i from 0 to count - 1. A free thread takes the next i. Returns true if all
/// calls were made.
///
/// stop   : token of a stop that `workers` requests, or that follows an exception of work or progress;
///          no further call begins then
/// Throws : the first exception of work or progress, after all threads have ended
template <class Work>
bool parallel_for(std::size_t count, const Workers& workers, const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::stop_source source;
  const std::stop_callback pass_on(workers.stop, [&source] { source.request_stop(); });
  const std::stop_token stop = source.get_token();
  std::mutex reporting;
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto take_turns = [&] {
    try {
      while (!stop.stop_requested()) {
        const std::size_t i = next++;
        if (i >= count) return;
        work(i, stop);
        const std::lock_guard lock(reporting);
        if (stop.stop_requested()) return;
        ++done;
        const double share = static_cast<double>(done) / static_cast<double>(count);
        if (workers.progress && !workers.progress(share)) source.request_stop();
      }
    } catch (...) {
      const std::lock_guard lock(reporting);
      if (!failure) failure = std::current_exception();
      source.request_stop();
    }
  };
  {
    const std::size_t wanted = workers.threads > 0
                                   ? static_cast<std::size_t>(workers.threads)
                                   : std::max(1U, std::thread::hardware_concurrency());
    std::vector<std::jthread> others;
    try {
      while (others.size() + 1 < std::min(wanted, count)) others.emplace_back(take_turns);
    } catch (const std::system_error&) {
      // The system grants no more threads: fewer do the same work.
    }
    take_turns();
  }
  if (failure) std::rethrow_exception(failure);
  return done == count;
}

}  // namespace kreisel
