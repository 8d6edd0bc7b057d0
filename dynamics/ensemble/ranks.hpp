#pragma once

#include <cstddef>
#include <mpi.h>

#include <motor/error.hpp>

namespace kreisel {

/// The processes of an MPI program, with a counter at rank 0 from which each takes its next task.
/// Rank 0 computes too and need not answer the others.
///
/// One object in a program, for its whole life. Used by one thread.
///
/// Throws : ComputationFailed if MPI cannot be started
class Ranks {
 public:
  Ranks(int& argc, char**& argv) {
    int level = 0;
    if (MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &level) != MPI_SUCCESS ||
        level < MPI_THREAD_FUNNELED) {
      throw ComputationFailed("MPI: cannot be started for a program with threads");
    }
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    const MPI_Aint bytes = rank_ == 0 ? sizeof(unsigned long long) : 0;
    MPI_Win_allocate(bytes, sizeof(unsigned long long), MPI_INFO_NULL, MPI_COMM_WORLD,
                     static_cast<void*>(&counter_), &window_);
    if (rank_ == 0) {
      MPI_Win_lock(MPI_LOCK_EXCLUSIVE, 0, 0, window_);
      *counter_ = 0;
      MPI_Win_unlock(0, window_);
    }
    wait_for_all();
  }
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  ~Ranks() {
    MPI_Win_free(&window_);
    MPI_Finalize();
  }

  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  /// 0, 1, 2, ...: each number goes to one rank only.
  [[nodiscard]] std::size_t next() {
    const unsigned long long one = 1;
    unsigned long long taken = 0;
    MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, window_);
    MPI_Fetch_and_op(&one, &taken, MPI_UNSIGNED_LONG_LONG, 0, 0, MPI_SUM, window_);
    MPI_Win_unlock(0, window_);
    return static_cast<std::size_t>(taken);
  }

  /// Ends all ranks, which would otherwise wait for this one.
  void give_up(int status) { MPI_Abort(MPI_COMM_WORLD, status); }

  /// Returns after all ranks have called it.
  void wait_for_all() { MPI_Barrier(MPI_COMM_WORLD); }

 private:
  int rank_ = 0;
  int size_ = 1;
  unsigned long long* counter_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
};

}  // namespace kreisel
