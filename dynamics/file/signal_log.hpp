#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include <dynamics/file/scene_file.hpp>

namespace kreisel::detail {

/// The logs and the frequencies of the functions of time in a scene, in the order in which they are
/// read.
class SignalLogs {
 public:
  /// Paths are relative to `folder`. Logs in `given` replace those of the files.
  SignalLogs(std::filesystem::path folder, std::vector<SceneSignalLog> given)
      : folder_(std::move(folder)), given_(std::move(given)) {}

  /// Sets [from, to] of the run in seconds.
  void set_run(const std::array<double, 2>& run) { run_ = run; }
  [[nodiscard]] const std::array<double, 2>& run() const { return run_; }
  [[nodiscard]] std::filesystem::path place(const std::filesystem::path& name) const {
    return folder_ / name;
  }

  /// The log that replaces the next one; null if there is none.
  [[nodiscard]] const SceneSignalLog* replacement() const {
    return read_.size() < given_.size() ? &given_[read_.size()] : nullptr;
  }

  void add(SceneSignalLog log) { read_.push_back(std::move(log)); }
  [[nodiscard]] const std::vector<SceneSignalLog>& read() const { return read_; }

  /// The frequencies of all oscillations, in rad/s, as they are read.
  void add_frequency(double frequency) { frequencies_.push_back(frequency); }
  [[nodiscard]] const std::vector<double>& frequencies() const { return frequencies_; }

 private:
  std::filesystem::path folder_;
  std::vector<SceneSignalLog> given_;
  std::array<double, 2> run_ = {0, 0};
  std::vector<SceneSignalLog> read_;
  std::vector<double> frequencies_;
};

}  // namespace kreisel::detail
