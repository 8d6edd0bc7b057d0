#include "judge.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <regex>

namespace differential {

namespace {

constexpr double pi = 3.14159265358979323846;

/// Numbers are replaced by #, so that messages of one kind are equal.
std::string without_numbers(const std::string& text) {
  static const std::regex number("[-+]?[0-9]+(\\.[0-9]*)?(e[-+]?[0-9]+)?");
  return std::regex_replace(text, number, "#").substr(0, 160);
}

bool finite(const Answer& answer) {
  const auto all = [](const JointValues& y) {
    return std::all_of(y.begin(), y.end(), [](double x) { return std::isfinite(x); });
  };
  return std::isfinite(answer.estimate) &&
         std::all_of(answer.states.begin(), answer.states.end(), all) &&
         std::all_of(answer.drifts.begin(), answer.drifts.end(), [](const Drift& drift) {
           return std::isfinite(drift.start) && std::isfinite(drift.largest);
         });
}

/// The state of an answer at one of its times.
const JointValues* state_at(const Answer& answer, double t) {
  const auto found = std::find(answer.times.begin(), answer.times.end(), t);
  if (found == answer.times.end()) return nullptr;
  return &answer.states[static_cast<std::size_t>(found - answer.times.begin())];
}

class Judge {
 public:
  Judge(const Scene& scene, const Answers& answers, const ReferenceMotion& reference)
      : scene_(scene), answers_(answers), reference_(reference) {}

  std::vector<Fault> all() {
    if (!answers_.refused.empty()) {
      const std::string& why = answers_.refused;
      if (why.find("moves no inertia") != std::string::npos && has_idle_motion(scene_)) return {};
      add("refused: " + without_numbers(why.substr(why.find(": ") + 2)), why);
      return faults_;
    }
    for (const std::string& term : answers_.contradictions) {
      add("report: a term is both kept and dropped", term);
    }
    if (answers_.misread) add("reader: title, method or report differs from the file", "");
    judge_reactions();
    judge_readings();
    judge_increments();
    if (answers_.wrongly_random) add("sensors: errors do not depend on the seed alone", "");
    for (const Answer& answer : answers_.by_method) {
      judge_failure(answer);
      if (!answer.answered) continue;
      judge_report(answer);
      if (!finite(answer)) continue;
      judge_invariants(answer);
      judge_by_reference(answer);
    }
    if (faults_.empty()) judge_pairs();
    judge_reach();
    judge_cost();
    judge_outputs();
    judge_model();
    return faults_;
  }

 private:
  void add(const std::string& kind, const std::string& detail) {
    faults_.push_back({kind, detail});
  }

  [[nodiscard]] bool another_answers(const Answer& than) const {
    return reference_.complete ||
           std::any_of(answers_.by_method.begin(), answers_.by_method.end(),
                       [&than](const Answer& other) {
                         return &other != &than && other.answered && other.kept;
                       });
  }

  /// Beyond this limit the scene has no physical meaning any more.
  [[nodiscard]] bool stays_within_reason() const {
    constexpr double reason = 1e12;  // m, rad, and per second
    const auto within = [](const JointValues& y) {
      return std::all_of(y.begin(), y.end(), [](double x) { return std::abs(x) < reason; });
    };
    return std::all_of(answers_.by_method.begin(), answers_.by_method.end(),
                       [&](const Answer& answer) {
                         return std::all_of(answer.states.begin(), answer.states.end(), within);
                       });
  }

  void judge_failure(const Answer& answer) {
    if (answer.answered || answer.out_of_budget || !another_answers(answer)) return;
    const bool applies = answer.message.find("does not apply") == std::string::npos;
    if (!applies || !stays_within_reason()) return;
    add(answer.asked + " fails: " + without_numbers(answer.message), answer.message);
  }

  void judge_report(const Answer& answer) {
    if (!finite(answer)) {
      add(answer.asked + ": complete but not finite", fmt::format("{}", answer.estimate));
    }
    if (answer.kept != (answer.estimate <= answer.tolerance)) {
      add("report: tolerance_kept contradicts the estimate",
          fmt::format("{} {}", answer.estimate, answer.tolerance));
    }
    if (answer.states.size() < scene_.times().size()) {
      add("report: complete but outputs are missing", fmt::format("{}", answer.states.size()));
    }
  }

  /// Forces that joints carry at the start, by the balance of each body.
  void judge_reactions() {
    if (answers_.reactions.empty()) return;
    const std::vector<double> right = start_reactions(scene_);
    double size = 1;
    for (const double x : right) size = std::max(size, std::abs(x));
    for (std::size_t i = 0; i < right.size(); ++i) {
      const double off = std::abs(answers_.reactions[i] - right[i]);
      if (off <= (1e-9 + unknown()) * size) continue;
      add("reactions are wrong", fmt::format("number {} of body {}: {} instead of {}", i % 6, i / 6,
                                             answers_.reactions[i], right[i]));
      return;
    }
  }

  /// Numbers of a reading that belong together.
  struct Part {
    SensorKind kind;
    std::size_t begin;
    std::size_t count;
    bool is_place;  ///< or a velocity, which is large on the earth
    bool is_force;  ///< or an acceleration
  };

  [[nodiscard]] std::vector<Part> parts_of_readings() const {
    std::vector<Part> parts;
    std::size_t begin = 0;
    for (const Sensor& sensor : scene_.sensors) {
      const std::vector<int> counts = parts_of(scene_, sensor);
      const bool is_point = sensor.kind == SensorKind::point;
      for (std::size_t k = 0; k < counts.size(); ++k) {
        const bool is_force = sensor.kind == SensorKind::accelerometer ||
                              sensor.kind == SensorKind::reaction ||
                              sensor.kind == SensorKind::azimuth || (is_point && k == 2);
        const Part part{sensor.kind, begin, std::size_t(counts[k]),
                        (is_point && k < 2) || sensor.kind == SensorKind::joint, is_force};
        begin += part.count;
        if (sensor.increments.empty()) parts.push_back(part);  // increments are 0 at the start
      }
    }
    return parts;
  }

  /// True if springs are so stiff that their cancelling forces exceed the judged differences.
  [[nodiscard]] bool is_stiff() const {
    return std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& body) {
      return !body.stiffness.empty() && body.stiffness.front() > 1e6;
    });
  }

  /// Judges the readings of sensors at the start. A vector's error is in proportion to its size. As
  /// terms of accelerations may cancel, it also grows with the size of all others except positions.
  void judge_readings() {
    if (answers_.readings.empty()) return;
    const std::vector<double> right = start_readings(scene_);
    const std::vector<Part> parts = parts_of_readings();
    const auto norm = [&right](const Part& part) {
      return Eigen::Map<const Eigen::VectorXd>(right.data() + part.begin,
                                               static_cast<Eigen::Index>(part.count))
          .norm();
    };
    double size = 1;
    for (const Part& part : parts) {
      const double own = norm(part);
      if (!part.is_place && std::isfinite(own)) size = std::max(size, own);
    }
    for (const Part& part : parts) {
      if ((part.is_force && is_stiff()) || std::isnan(norm(part))) continue;
      double off = 0;
      double turned = 0;  // the other quaternion of an attitude
      for (std::size_t i = part.begin; i < part.begin + part.count; ++i) {
        off = std::max(off, std::abs(answers_.readings[i] - right[i]));
        turned = std::max(turned, std::abs(answers_.readings[i] + right[i]));
      }
      if (part.count == 4) off = std::min(off, turned);
      if (part.kind == SensorKind::azimuth) off = std::abs(std::remainder(off, pi));
      if (off <= (1e-9 + unknown()) * (size + norm(part))) continue;
      add("a sensor is wrong", fmt::format("number {}, kind {}, by {:.3g} of {:.3g}", part.begin,
                                           static_cast<int>(part.kind), off, norm(part)));
    }
  }

  void judge_increments() {
    if (!answers_.wrong_increments) return;
    const auto& [sensor, off, size] = *answers_.wrong_increments;
    add("increments are wrong", fmt::format("of {} by {:.3g} of {:.3g}", sensor, off, size));
  }

  void judge_invariants(const Answer& answer) {
    if (!reference_.complete || !answer.kept) return;
    for (const Drift& drift : answer.drifts) {
      const bool energy = drift.name.find("energy") != std::string::npos;
      const auto size =
          static_cast<double>(energy ? reference_.sizes.energy : reference_.sizes.momentum);
      const double scale = std::max(std::abs(drift.start), size) + 1e-6;
      if (drift.largest <= 1e3 * std::max(answer.tolerance, 1e-13) * scale) continue;
      add("report: an invariant drifts: " + drift.name,
          fmt::format("{} by {}, {} from {}, kept to {}", answer.asked, answer.method,
                      drift.largest, drift.start, answer.tolerance));
    }
  }

  /// Uncertainty of a log's motion that its samples leave.
  [[nodiscard]] double unknown() const { return scene_.has_log() ? 1e-5 : 0; }

  /// Errors are measured relative to the sizes in all steps, not only at the outputs.
  void note_way(Distance& distance, double to) const {
    const Answer& way = answers_.way;
    for (std::size_t i = 0; i < way.states.size() && way.times[i] <= to; ++i) {
      distance.note(way.states[i]);
    }
  }

  void judge_by_reference(const Answer& answer) {
    Distance distance(scene_);
    for (std::size_t i = 0; i < reference_.others.size(); ++i) {
      note_way(distance, reference_.times[i]);
      const JointValues* const y = state_at(answer, reference_.times[i]);
      const JointValues& truth = reference_.others[i];
      distance.note(truth);
      if (y == nullptr) continue;
      const double own = 5 * distance(reference_.states[i], truth) + 1e-13 + unknown();
      const double off = distance(*y, truth);
      if (off <= own || !(own <= 0.1)) continue;
      if (is_covered(answer, off - own)) continue;
      add(fmt::format("{} is wrong{}{}", name(answer), answer.kept ? " and reported as kept" : "",
                      finest(answer)),
          fmt::format("at t = {} off by {:.3g} from the independent motion (known to {:.1g}), "
                      "reported {:.3g}, tolerance {:.1g}",
                      reference_.times[i], off, own, answer.estimate, answer.tolerance));
      return;
    }
  }

  /// True if an error is within the reported one.
  [[nodiscard]] static bool is_covered(const Answer& answer, double off) {
    if (!answer.kept) return off <= 10 * answer.estimate;
    return off <= 2 * answer.tolerance || off <= 2 * answer.estimate;
  }

  /// Faults at the finest tolerance are a kind of their own: rounding causes most of them.
  [[nodiscard]] static std::string finest(const Answer& answer) {
    return answer.tolerance <= 1e-12 ? " at 1e-12" : "";
  }

  [[nodiscard]] static std::string name(const Answer& answer) {
    return answer.asked == answer.method ? answer.asked : answer.asked + " (" + answer.method + ")";
  }

  void judge_pairs() {
    const auto& all = answers_.by_method;
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t k = i + 1; k < all.size(); ++k) {
        if (all[i].answered && all[k].answered) judge_pair(all[i], all[k]);
      }
    }
  }

  void judge_pair(const Answer& a, const Answer& b) {
    Distance distance(scene_);
    for (std::size_t i = 0; i < std::min(a.states.size(), b.states.size()); ++i) {
      note_way(distance, a.times[i]);
      distance.note(a.states[i]);
      distance.note(b.states[i]);
      const double off = distance(a.states[i], b.states[i]);
      const double told = std::max(a.estimate, a.kept ? a.tolerance : 0) +
                          std::max(b.estimate, b.kept ? b.tolerance : 0);
      const double times = a.kept && b.kept ? 3 : 10;
      if (off <= times * told + 1e-13) continue;
      add(fmt::format("{} and {} differ{}", name(a), name(b), finest(a)),
          fmt::format("at t = {} by {:.3g}, reported {:.3g} and {:.3g}, tolerance {:.1g}",
                      a.times[i], off, a.estimate, b.estimate, a.tolerance));
      return;
    }
  }

  /// Tests that auto reaches the end if another method does, unless that method is wrong or the
  /// only one.
  void judge_reach() {
    const auto& all = answers_.by_method;
    const Answer& automatic = all.front();
    if (!faults_.empty() || automatic.asked != "auto" || !automatic.answered) return;
    if (automatic.estimate <= 100 * automatic.tolerance) return;
    for (const Answer& answer : all) {
      if (!answer.answered || !answer.kept || !another_answers(answer)) continue;
      add(fmt::format("{} does not keep the tolerance, {} does{}", name(automatic), answer.asked,
                      finest(automatic)),
          fmt::format("told {:.3g} and {:.3g}, asked {:.1g}", automatic.estimate, answer.estimate,
                      answer.tolerance));
      return;
    }
  }

  /// Tests the reported error and the order of an approximation. A first-order mistake in its
  /// equations would make the error fall only in proportion.
  void judge_model() {
    if (!answers_.approximate) return;
    const auto& [answer, model_error, off, nearer_off] = *answers_.approximate;
    if (!answer.answered) {
      add("model " + scene_.model + " fails: " + without_numbers(answer.message), answer.message);
      return;
    }
    judge_model_error(answer, model_error);
    const bool is_small = model_error <= 0.1 && off > 1e4 * answer.tolerance;
    // Halves for third and second order; the nutations fall with the square of the speed.
    const bool is_second = scene_.model != "foeppl" && scene_.model != "fuchs-weigand";
    const double most = is_second ? 0.35 : 0.2;
    if (!is_small || nearer_off <= most * off) return;
    add("model " + scene_.model + " has another order",
        fmt::format("off by {:.3g}, nearer by {:.3g}", off, nearer_off));
  }

  void judge_model_error(const Answer& answer, double model_error) {
    if (!reference_.complete) return;
    Distance distance(scene_);
    note_way(distance, scene_.t_end);
    for (const JointValues& truth : reference_.others) distance.note(truth);
    double off = 0;
    for (std::size_t i = 0; i < reference_.others.size(); ++i) {
      const JointValues* const y = state_at(answer, reference_.times[i]);
      if (y != nullptr) off = std::max(off, distance(*y, reference_.others[i]));
    }
    const double slack = 10 * answer.tolerance;
    if (off <= 1.2 * model_error + slack && off >= 0.1 * model_error - slack) return;
    add("model " + scene_.model + " reports another error",
        fmt::format("{:.3g}, and is off by {:.3g}", model_error, off));
  }

  /// Tests that the report of a kept tolerance does not depend on the requested outputs. This holds
  /// for sizes, and for the error at the end as far as the steps are the same.
  void judge_outputs() {
    const Answer& many = answers_.way;
    const Answer& one = answers_.end;
    if (!many.answered || !one.answered || !finite(many) || !finite(one)) return;
    if (!many.kept || !one.kept) return;
    constexpr double most = 1.5;
    for (std::size_t i = 0; i < std::min(many.sizes.size(), one.sizes.size()); ++i) {
      const auto [less, more] = std::minmax(one.sizes[i], many.sizes[i]);
      if (more <= most * less) continue;
      add("report: sizes depend on the outputs",
          fmt::format("part {}: {:.3g} for the end alone, {:.3g} for {} outputs", i, one.sizes[i],
                      many.sizes[i], many.states.size()));
      return;
    }
    // The error of steps across a spline's knots depends on the position of the steps.
    if (scene_.has_log() || one.method != many.method || one.steps != many.steps) return;
    const double told = std::max(one.estimate, many.estimate);
    const double off = std::abs(one.end_error - many.end_error);
    if (off <= (1 - 1 / most) * told + noise_of_pairs(one.steps)) return;
    add("report: errors depend on the outputs",
        fmt::format("of the end {:.3g} for itself alone, {:.3g} for {} outputs, {:.3g} at most",
                    one.end_error, many.end_error, many.states.size(), told));
  }

  /// Rounding of the difference of two reported errors. Each is 1.55 times the distance of two
  /// runs. Each of these four runs walks by 2.5 units of 2^-53 a step at random. Three times their
  /// standard deviation.
  [[nodiscard]] static double noise_of_pairs(double steps) {
    return 3 * 1.55 * 2.5 * 0x1p-53 * std::sqrt(4 * steps);
  }

  /// A spring without a damper oscillates for ever and must be resolved. If radau13 does not
  /// resolve a small oscillation, that is no advantage.
  [[nodiscard]] bool oscillates() const {
    const bool by_element =
        std::any_of(scene_.elements.begin(), scene_.elements.end(), [](const Element& e) {
          return e.damping == 0 && e.linear_damping.isZero(0) && e.turning_damping.isZero(0);
        });
    return by_element ||
           std::any_of(scene_.bodies.begin(), scene_.bodies.end(), [](const Body& body) {
             return !body.stiffness.empty() &&
                    (body.damping.empty() ||
                     *std::min_element(body.damping.begin(), body.damping.end()) <= 0);
           });
  }

  void judge_cost() {
    const auto& all = answers_.by_method;
    const auto automatic =
        std::find_if(all.begin(), all.end(), [](const Answer& a) { return a.asked == "auto"; });
    if (automatic == all.end()) return;
    const bool near = !automatic->answered || automatic->estimate <= 100 * automatic->tolerance;
    const Answer* best = nullptr;
    for (const Answer& answer : all) {
      if (answer.asked == "auto" || !answer.answered || !answer.kept) continue;
      if (answer.asked == "radau13" && oscillates()) continue;
      if (!near && !another_answers(answer)) continue;
      if (best == nullptr || answer.evaluations < best->evaluations) best = &answer;
    }
    constexpr double few = 3e4;  // a tenth of a second
    if (best == nullptr || !(automatic->evaluations > 8 * best->evaluations + few)) return;
    add(fmt::format("auto costs over 8 times what {} costs", best->asked),
        fmt::format("{:.3g}{} evaluations by {}, {:.3g} by {}", automatic->evaluations,
                    automatic->answered ? "" : " (and no answer)", automatic->method,
                    best->evaluations, best->asked));
  }

  const Scene& scene_;
  const Answers& answers_;
  const ReferenceMotion& reference_;
  std::vector<Fault> faults_;
};

}  // namespace

void Distance::note(const JointValues& y) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    double square = 0;
    for (int k = 0; k < blocks_[i]; ++k) square += y[begin] * y[begin], ++begin;
    sizes_[i] = std::max(sizes_[i], std::sqrt(square));
  }
}

double Distance::operator()(const JointValues& a, const JointValues& b) const {
  // Effect of rounding in forces of order 10 on a body of order 1 within seconds.
  constexpr double rounding = 2e-14;
  double worst = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const auto n = static_cast<Eigen::Index>(blocks_[i]);
    const Eigen::Map<const Eigen::VectorXd> x(a.data() + begin, n);
    const Eigen::Map<const Eigen::VectorXd> y(b.data() + begin, n);
    const double off =
        n == 4 ? 4 * std::asin(std::min(1.0, std::min((x.normalized() - y.normalized()).norm(),
                                                      (x.normalized() + y.normalized()).norm()) /
                                                 2))
               : std::max((x - y).norm() - rounding, 0.0) / sizes_[i];
    if (!(off <= worst)) worst = off;
    begin += static_cast<std::size_t>(n);
  }
  return worst;
}

std::optional<std::pair<double, double>> greatest_off(const Scene& scene, const Answer& answer,
                                                      const Answer& way,
                                                      const ReferenceMotion& reference) {
  if (!reference.complete || !answer.answered) return std::nullopt;
  Distance distance(scene);
  for (const JointValues& y : way.states) distance.note(y);
  for (const JointValues& y : reference.others) distance.note(y);
  std::pair<double, double> greatest{0, 0};
  for (std::size_t i = 0; i < reference.others.size(); ++i) {
    const JointValues* const y = state_at(answer, reference.times[i]);
    const JointValues& truth = reference.others[i];
    if (y != nullptr) greatest.first = std::max(greatest.first, distance(*y, truth));
    greatest.second = std::max(greatest.second, distance(reference.states[i], truth));
  }
  return greatest;
}

std::vector<Fault> judge(const Scene& scene, const Answers& answers,
                         const ReferenceMotion& reference) {
  return Judge(scene, answers, reference).all();
}

}  // namespace differential
