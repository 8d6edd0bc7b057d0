#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace kreisel::detail {

/// Calls `work(i, stop)` for i from 0 to count - 1 on the given number of threads, including the
/// caller's. 0 threads: as many as the hardware runs at once. A free thread takes the next i.
/// Returns true if all calls were made.
///
/// progress : called with the completed share, never by two threads at once. If it returns false,
///            or if work or progress throws, `stop` becomes true and no further call begins
/// Throws   : the first exception of work or progress, after all threads have ended
template <class Work>
bool parallel_for(std::size_t count, int threads, const std::function<bool(double)>& progress,
                  const Work& work) {
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> stop = false;
  std::mutex reporting;
  std::size_t done = 0;
  std::exception_ptr failure;
  const auto take_turns = [&] {
    try {
      while (!stop) {
        const std::size_t i = next++;
        if (i >= count) return;
        work(i, stop);
        const std::lock_guard lock(reporting);
        if (stop) return;
        ++done;
        const double share = static_cast<double>(done) / static_cast<double>(count);
        if (progress && !progress(share)) stop = true;
      }
    } catch (...) {
      const std::lock_guard lock(reporting);
      if (!failure) failure = std::current_exception();
      stop = true;
    }
  };
  {
    const std::size_t wanted = threads > 0 ? static_cast<std::size_t>(threads)
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

}  // namespace kreisel::detail
