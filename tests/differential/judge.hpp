#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runs.hpp"

namespace differential {

/// Something wrong with what the library says of a scene.
struct Fault {
  std::string kind;    ///< the same words for the same kind, whatever the numbers
  std::string detail;  ///< with numbers
};

/// The distance of two states in the measure of RunReport::error_estimate, sizes being the greatest
/// so far of either.
class Distance {
 public:
  explicit Distance(const Scene& scene) : blocks_(blocks(scene)), sizes_(blocks_.size(), 1e-3) {}

  void note(const JointValues& y);
  [[nodiscard]] double operator()(const JointValues& a, const JointValues& b) const;

 private:
  std::vector<int> blocks_;
  std::vector<double> sizes_;
};

/// How far the end of an answer is off the independent motion, and how well that is known; nothing
/// where either does not come to the end.
[[nodiscard]] std::optional<std::pair<double, double>> off_at_end(const Scene& scene,
                                                                  const Answer& answer,
                                                                  const ReferenceMotion& reference);

/// Holds the answers against each other and against the independent motion.
[[nodiscard]] std::vector<Fault> judge(const Scene& scene, const Answers& answers,
                                       const ReferenceMotion& reference);

}  // namespace differential
