#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runs.hpp"

namespace differential {

/// A fault in the library's answer for a scene.
struct Fault {
  std::string kind;    ///< the same text for all faults of one kind, whatever the numbers
  std::string detail;  ///< with numbers
};

/// The distance of two states in the measure of RunReport::error_estimate. Sizes are the greatest
/// so far of either state.
class Distance {
 public:
  explicit Distance(const Scene& scene) : blocks_(blocks(scene)), sizes_(blocks_.size(), 1e-3) {}

  void note(const JointValues& y);
  [[nodiscard]] double operator()(const JointValues& a, const JointValues& b) const;

 private:
  std::vector<int> blocks_;
  std::vector<double> sizes_;
};

/// The greatest deviation of an answer from the independent motion, and its uncertainty. Empty if
/// either does not reach the end.
///
/// way : the same motion at many times, for the sizes of its parts
[[nodiscard]] std::optional<std::pair<double, double>> greatest_off(
    const Scene& scene, const Answer& answer, const Answer& way, const ReferenceMotion& reference);

/// Compares the answers with each other and with the independent motion.
[[nodiscard]] std::vector<Fault> judge(const Scene& scene, const Answers& answers,
                                       const ReferenceMotion& reference);

}  // namespace differential
