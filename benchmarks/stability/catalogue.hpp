#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace stability {

/// The outcome of a run.
enum class Verdict {
  accurate,  ///< within the tolerance, as reported
  reported,  ///< error above the tolerance, but within the estimate
  refused,   ///< a clear error: what, where, and until when all was well
  failed     ///< a silently wrong number, no answer in time, a crash, or an empty error message
};

[[nodiscard]] constexpr const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::accurate: return "accurate";
    case Verdict::reported: return "accurate with reported error";
    case Verdict::refused: return "refused with a clear error";
    case Verdict::failed: return "FAILED";
  }
  return "none";
}

/// One run of a case. Fields that do not apply are NaN.
struct Row {
  std::string variant;  ///< the scene, and how extreme
  std::string method;
  Verdict verdict = Verdict::failed;
  double error = NAN;     ///< true, by the measure of RunReport::error_estimate
  double estimate = NAN;  ///< estimate of the run, or a bound
  double drift = NAN;     ///< of the invariant that changed most, relative
  double steps = NAN;
  double evaluations = NAN;
  double seconds = NAN;
  std::string note = "";
};

/// The sink of a case's rows. A case runs in a process of its own, so that its rows are known even
/// if it crashes or never ends.
class Recorder {
 public:
  Recorder(int pipe, bool quick) : pipe_(pipe), quick_(quick) {}

  [[nodiscard]] bool quick() const { return quick_; }

  /// Called before a run: its text is reported if the run never returns.
  void begin(const std::string& variant, const std::string& method) const;
  void add(const Row& row) const;

  /// A point of the picture of drift: |drift| of `series` after the time t.
  void drift(const std::string& series, double t, double value) const;

 private:
  void send(const std::string& line) const;

  int pipe_;
  bool quick_;
};

struct Case {
  std::string name;
  std::string extreme;  ///< what about it is
  std::function<void(const Recorder&)> run;
  double time_limit = 10;  ///< s one run may compute when quick; twenty times that when not
};

[[nodiscard]] inline double seconds_since(const std::chrono::steady_clock::time_point& begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Each function adds its cases.
using AddCases = void (*)(std::vector<Case>&);

void tops(std::vector<Case>& cases);
void heavy_tops(std::vector<Case>& cases);
void held_bodies(std::vector<Case>& cases);
void free_bodies(std::vector<Case>& cases);
void fast_bodies(std::vector<Case>& cases);
void gyros(std::vector<Case>& cases);
void rotors(std::vector<Case>& cases);
void systems(std::vector<Case>& cases);
void plane_motions(std::vector<Case>& cases);
void pendulum_scene(std::vector<Case>& cases);
void steppers(std::vector<Case>& cases);
void guides(std::vector<Case>& cases);
void inputs(std::vector<Case>& cases);

}  // namespace stability
