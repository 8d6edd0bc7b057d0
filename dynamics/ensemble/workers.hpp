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

/// Does `work(i, stop)` for i from 0 to count - 1 on so many threads, the caller's among them (0: as
/// many as the machine runs at once); whoever is free takes the next. Says whether all was done.
///
/// progress : called with the share done after each, never by two threads at once; false, or an
///            exception of work or progress, lets `stop` become true and nothing more begin
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
      // The machine gives no more: fewer do the same.
    }
    take_turns();
  }
  if (failure) std::rethrow_exception(failure);
  return done == count;
}

}  // namespace kreisel::detail
