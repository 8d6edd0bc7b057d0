#pragma once

#include <span>
#include <vector>

#include <dynamics/solve/report.hpp>
#include <dynamics/solve/run.hpp>

namespace kreisel::detail {

/// Records the largest drift of each conserved quantity of a scene.
class InvariantWatch {
 public:
  explicit InvariantWatch(const SteppedScene& scene) : scene_(scene) {}

  void note(double t, std::span<const double> y) { scene_.note_invariants(t, y, drifts_); }

  /// The least error of the state that explains the drifts: |drift| / sum of |change of the
  /// invariant| for changes of the state's components by their sizes. 0 if rounding explains the
  /// drifts.
  ///
  /// sizes : of blocks
  [[nodiscard]] double least_error(double t, std::span<const double> y,
                                   std::span<const double> sizes) const;

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    for (InvariantDrift& drift : drifts_) checkpoint(drift.start, drift.largest);
  }

  [[nodiscard]] const std::vector<InvariantDrift>& drifts() const { return drifts_; }

 private:
  const SteppedScene& scene_;
  std::vector<InvariantDrift> drifts_;
};

}  // namespace kreisel::detail
