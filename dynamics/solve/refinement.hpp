#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <dynamics/solve/levels.hpp>
#include <dynamics/solve/report.hpp>
#include <motor/api.hpp>

namespace kreisel::detail {

/// The first try with too great an error, and the error of later tries at the same output.
struct Missed {
  double accuracy;
  std::size_t output = 0;
  double error = 0;  ///< 0 if there is none
  double now = 0;

  void note(std::size_t done, double error_there) {
    if (done <= output) now = error_there;
  }

  /// True if the error at finer steps is more than ten times the expected one. It is then rounding,
  /// which even finer steps do not reduce. An error as great as the motion proves nothing.
  [[nodiscard]] bool stays(double at) const {
    constexpr double as_great_as_the_motion = 0.1;
    return error > 0 && now < as_great_as_the_motion &&
           now > rules::departs * error * (at / accuracy);
  }

  /// True if the error at finer steps is less than a tenth of the expected one, which decreases with
  /// a power of the accuracy. It was rounding then, and two runs agree by chance.
  [[nodiscard]] bool falls_by_chance(double at, double power) const {
    return error > 0 && now < error * std::pow(at / accuracy, power) / rules::departs;
  }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(accuracy, output, error, now);
  }
};

/// The accuracy of the cheap runs that estimate the growth of rounding, from one try to the next.
///
/// Coarse steps limited by stability diverge when perturbed, without any growth of rounding. If
/// rounding seems to grow too much, finer steps are tried, as long as they find much less.
class CheapSteps {
 public:
  /// The accuracy beside runs at `accuracy`; it never becomes coarser again.
  [[nodiscard]] double beside(const Levels& levels, double accuracy) {
    accuracy_ = std::min(accuracy_, levels.cheap(accuracy));
    return accuracy_;
  }

  /// Makes the steps finer if rounding seems to grow to `suspected`; true if finer steps may find
  /// less.
  [[nodiscard]] bool refine(double suspected, double accuracy) {
    constexpr double much_less = 1e-2;
    const bool falls = suspected_ == 0 || suspected < much_less * suspected_;
    if (!falls || accuracy_ <= accuracy) return false;
    constexpr double finer = 1e-3;
    accuracy_ = std::max(accuracy_ * finer, accuracy);
    suspected_ = suspected;
    return true;
  }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint) {
    checkpoint(accuracy_, suspected_);
  }

 private:
  double accuracy_ = std::numeric_limits<double>::max();
  double suspected_ = 0;  ///< by coarser steps
};

/// The expected error at the end, from the error at time t: proportional to time, up to a limit.
KREISEL_API [[nodiscard]] double forecast(const SolveOptions& options, double t, double error);

/// The result of one try: two or more runs side by side.
struct TryResult {
  bool complete;         ///< at the last output
  bool too_coarse;       ///< ended early: the error is above the tolerance, or will be
  bool is_implicit;      ///< the last steps were implicit
  bool knows_growth;     ///< RoundingGrowth ran beside it
  bool rounds_too_much;  ///< rounding may exceed the tolerance
  double error;          ///< the greatest so far
  ErrorParts error_parts;
  double expected;  ///< error at the end
  double steps;
  std::size_t output;  ///< number of outputs reached
};

/// The decision after a try.
enum class Next {
  accept,             ///< the result
  look_for_rounding,  ///< the same runs again, with RoundingGrowth beside them
  shift,              ///< the finer run takes the coarser one's place beside a still finer one
  begin_again,        ///< with new runs
};

/// The accuracy of a pair of runs, from one try to the next. The states and their transitions are
/// drawn in docs/site/errors.md.
///
/// Where rounding grows to the tolerance, two runs may agree by chance.
/// - Explicit steps: one run of the first pair is perturbed by more digits than are rounded. If the
///   pair does not agree to a part of the tolerance, RoundingGrowth estimates the growth of
///   rounding. Both runs then continue, the perturbed one anew if its perturbation is the cause. If
///   rounding may exceed the tolerance, or the error does not decrease with the steps, the finest
///   steps are taken at once.
/// - Other steps: to try pairs until two agree would prove nothing. After a miss, a third run is
///   compared if steps are so fine that their error may be rounding. An error that decreases much
///   faster than the steps counts as rounding too. The finest runs are four, or six where rounding
///   grows to more than the tolerance.
class KREISEL_API Refinement {
 public:
  /// has_other : the scene has a perturbed copy. Runs are compared with the copy's: cheap steps
  ///             cannot estimate the effect of stiff springs
  Refinement(const SolveOptions& options, const Levels& levels, bool has_other);

  /// For runs that cannot be perturbed beside others or continued: the lanes of an ensemble.
  [[nodiscard]] static Refinement of_lanes(const SolveOptions& options, const Levels& levels);

  [[nodiscard]] const Levels& levels() const { return levels_; }
  [[nodiscard]] double accuracy() const { return accuracy_; }
  [[nodiscard]] bool is_last() const { return levels_.last(accuracy_); }
  /// The last digits by which one run's start is moved.
  [[nodiscard]] double digits() const { return digits_; }
  /// True if the coarser run's start is moved, false if the finer one's is.
  [[nodiscard]] bool coarse_starts_off() const { return coarse_starts_off_; }
  /// True if one run of the pair is perturbed in each step.
  [[nodiscard]] bool pair_is_perturbed() const { return pair_is_perturbed_; }
  /// The error at this accuracy, from a try with fewer digits.
  [[nodiscard]] const ErrorParts& known() const { return known_; }
  /// Prepares a try. If only rounding is left, a start that is moved is a sample of its effect.
  void begin_try();
  /// True if RoundingGrowth shall run beside the pair.
  [[nodiscard]] bool looks_for_rounding() const;
  [[nodiscard]] double cheap_accuracy() { return cheap_.beside(levels_, accuracy_); }
  /// The number of runs beside the pair. If only rounding is left, two runs may agree by chance;
  /// more runs, each with steps of its own, do so less often.
  [[nodiscard]] int more_runs() const;

  void note_growth(double grown_to) { grown_to_ = grown_to > grown_to_ ? grown_to : grown_to_; }
  [[nodiscard]] double grown_to() const { return grown_to_; }
  /// Notes the error after so many outputs.
  void note(std::size_t done, double error) { missed_.note(done, error); }

  /// True if a try must end: the error is above the tolerance, or will be, or rounding is.
  [[nodiscard]] bool is_too_coarse(double error, double expected, bool rounds_too_much) const;
  /// Decides on the result of a try, and sets the accuracy of the next one.
  [[nodiscard]] Next next(const TryResult& tried);
  /// True, after look_for_rounding, if the perturbed run itself causes a third of the error or more
  /// and must begin anew.
  [[nodiscard]] bool drops_perturbed() const { return drops_perturbed_; }

  template <class Checkpoint>
  void pass(Checkpoint& checkpoint);

 private:
  [[nodiscard]] bool looks_again(const TryResult& tried);
  [[nodiscard]] bool is_by_chance(const TryResult& tried) const;
  [[nodiscard]] bool is_implicit(const TryResult& tried) const;
  void confirm(const TryResult& tried);
  [[nodiscard]] bool only_rounds(const TryResult& tried) const;
  void begin_with_another_method();

  const SolveOptions* options_;
  Levels levels_;
  bool has_other_;
  bool may_shift_ = true;
  double accuracy_;
  Missed missed_;
  double digits_;
  double grown_to_ = 0;
  ErrorParts known_ = {};
  CheapSteps cheap_;
  bool pair_is_perturbed_;
  bool looks_for_rounding_;
  bool coarse_starts_off_ = false;
  bool drops_perturbed_ = false;
};

template <class Checkpoint>
void Refinement::pass(Checkpoint& checkpoint) {
  auto method = static_cast<double>(levels_.method());
  checkpoint(method, accuracy_, missed_, digits_, grown_to_, coarse_starts_off_, pair_is_perturbed_,
             looks_for_rounding_, cheap_);
  if (method == static_cast<double>(Method::verner98)) (void)levels_.round_less();
  if (method != static_cast<double>(levels_.method())) {
    refuse_task("the checkpoint is of another method");
  }
}

}  // namespace kreisel::detail
