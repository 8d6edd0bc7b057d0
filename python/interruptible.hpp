#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <pybind11/pybind11.h>
#include <stop_token>

/// Calls `work(stop, share)` in a thread of its own, without Python's lock. Ten times a second it
/// checks Python's signals and calls `progress(share)`, unless that is None. A signal or an
/// exception of `progress` requests the stop. `work` writes the share that is done, in [0, 1].
///
/// Throws : the exceptions of the work, of the signal and of `progress`
template <class Work>
void run_interruptibly(const pybind11::object& progress, const Work& work) {
  namespace py = pybind11;
  std::stop_source source;
  std::atomic<double> share = 0;
  const auto report = [&] {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!progress.is_none()) progress(share.load());
  };
  const py::gil_scoped_release released;
  auto done = std::async(std::launch::async, [&] { work(source.get_token(), share); });
  try {
    while (done.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
      const py::gil_scoped_acquire lock;
      report();
    }
  } catch (...) {
    source.request_stop();
    done.wait();
    throw;
  }
  done.get();
}
