#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include <dynamics/file/periodic_motions.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/floquet_bodies.hpp>

namespace kreisel {

using namespace steady_motion;
using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXcd, Eigen::VectorXd;

namespace {

constexpr double turn = 2 * std::numbers::pi;

/// The frequencies of functions of time and of guides.
std::vector<double> frequencies_in_time(const SceneFile& scene) {
  std::vector<double> all = scene.frequencies;
  const bool in_inertial_field = std::holds_alternative<UniformGravity<Inertial>>(scene.gravity);
  for (const scene_guide::Link& link : scene.guide) {
    if (const auto* const harmonic = std::get_if<scene_guide::Harmonic>(&link)) {
      for (const auto& term : harmonic->angular_velocity.terms) all.push_back(term.frequency);
      for (const auto& term : harmonic->origin_acceleration.terms) all.push_back(term.frequency);
    }
    const auto* const rotating = std::get_if<scene_guide::Rotating>(&link);
    if (rotating && in_inertial_field) all.push_back(rotating->angular_velocity.norm());
  }
  return all;
}

bool runs_steadily(const BodyDescription& body) {
  return body.rule == JointRule::driven && !body.acceleration &&
         joint_type(body.joint.kind).rates.front().unit == "rad/s";
}

/// The reason why a scene has no period at all; empty if it may have one.
std::string obstacle_to_period(const SceneFile& scene) {
  if (scene.guide_follows_log()) return "the guide follows a log";
  if (scene.follows_log()) return "a function of time follows a log";
  if (scene.discontinuities.empty()) return "";
  return fmt::format("a function of time jumps or bends at {:.9g} s",
                     scene.discontinuities.front());
}

/// The shortest common period of frequencies.
FoundPeriod common_period_of(const std::vector<double>& frequencies) {
  std::vector<double> periods;
  for (const double w : frequencies) {
    if (std::abs(w) > 0) periods.push_back(turn / std::abs(w));
  }
  if (periods.empty()) {
    return {0, "no joint at a constant rate and no oscillating function of time gives one"};
  }
  if (const auto period = detail::common_multiple(periods)) {
    const auto is_whole = [&period](double own) { return own > 0.99 * *period; };
    return {*period, "", std::all_of(periods.begin(), periods.end(), is_whole)};
  }
  return {0,
          "the equations change with several frequencies, and their periods have no common "
          "multiple up to 1000 times the longest"};
}

/// Coordinates on which nothing depends, at a time at which the guide is defined.
Places cyclic_at(const StudySystem& system, double t, const VectorXd& y) {
  return Directions(system).cyclic(linearized(system, t, y), linearized(system, t, off(system, y)));
}

/// The state and the transition matrix at a time of a periodic motion.
struct Moment {
  VectorXd state;
  MatrixXd matrix;
};

/// The moments at equal parts of the period, from the start on.
std::vector<Moment> moments_of(const StudySystem& system, const FloquetMotion& motion, int parts) {
  const Tangent tangent = tangent_of(system, motion.start);
  const Index n = motion.start.size(), d = tangent.dimension();
  std::vector<Moment> all{{motion.start, MatrixXd::Identity(d, d)}};
  for (int j = 1; j < parts; ++j) {
    const double from = system.begin() + motion.period * (j - 1) / parts;
    const double to = system.begin() + motion.period * j / parts;
    const VectorXd z =
        detail::with_tangents(system, from, all.back().state, to, {.relative = 1e-11});
    const MatrixXd step = Eigen::Map<const MatrixXd>(z.data() + n, d, d);
    all.push_back({z.head(n), step * all.back().matrix});
  }
  return all;
}

/// The k-th harmonic of the periodic part of a mode, in all directions.
VectorXcd harmonic_of(const std::vector<Moment>& moments, double period,
                      const std::complex<double>& root, const VectorXcd& shape, int k) {
  const auto parts = static_cast<double>(moments.size());
  VectorXcd sum = VectorXcd::Zero(shape.size());
  for (std::size_t j = 0; j < moments.size(); ++j) {
    const double share = static_cast<double>(j) / parts;
    const std::complex<double> factor =
        std::exp(-share * (root * period + std::complex<double>(0, turn * k)));
    sum += factor / parts * (moments[j].matrix * shape);
  }
  return sum;
}

/// The mode of a multiplier.
WhirlingMode mode_of(const Mode& multiplier, const FloquetMotion& motion,
                     const std::vector<Moment>& moments, const std::vector<SpinningBody>& spinning,
                     int rates) {
  WhirlingMode mode;
  mode.root = std::log(multiplier.root) / motion.period;
  mode.error = multiplier.error / std::abs(multiplier.root) / motion.period;
  VectorXcd start = VectorXcd::Zero(moments.front().matrix.rows());
  start(motion.kept) = multiplier.shape;
  const int most = static_cast<int>(moments.size()) / 2 - 1;
  double greatest = -1;
  for (int k = -most; k <= most; ++k) {
    const VectorXcd part = harmonic_of(moments, motion.period, mode.root, start, k);
    double size = 0;
    for (const int i : motion.kept) size += i < rates ? std::norm(part[i]) : 0;
    if (size <= greatest * (1 + 1e-9)) continue;
    greatest = size;
    mode.harmonic = k;
    mode.shape = part;
  }
  if (mode.root.imag() + mode.harmonic * turn / motion.period < 0) {
    mode.root = std::conj(mode.root);
    mode.harmonic = -mode.harmonic;
    mode.shape = mode.shape.conjugate().eval();
  }
  detail::take_phase_out(mode.shape);
  mode.whirl = whirl(spinning, mode.root.imag() + mode.harmonic * turn / motion.period, mode.shape);
  return mode;
}

}  // namespace

FoundPeriod find_period(const StudySystem& system, const SceneFile& scene, const VectorXd& y) {
  if (const std::string why = obstacle_to_period(scene); !why.empty()) return {0, why};
  std::vector<double> all = frequencies_in_time(scene);
  const BodyTree& tree = system.tree();
  const Places cyclic = cyclic_at(system, system.begin(), y);
  for (int i = 0; i < static_cast<int>(tree.bodies().size()); ++i) {
    const int rate = tree.place(i).v;
    if (!runs_steadily(tree.body(i)) || cyclic[static_cast<std::size_t>(rate)]) continue;
    all.push_back(y[tree.coordinates() + rate]);
  }
  return common_period_of(all);
}

FoundPeriod find_period(const SceneFile& scene) {
  if (const std::string why = obstacle_to_period(scene); !why.empty()) return {0, why};
  std::vector<double> all = frequencies_in_time(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    if (runs_steadily(scene.bodies[i])) all.push_back(scene.start[i].rates.front());
  }
  return common_period_of(all);
}

double field_misses(const StudySystem& system, const VectorXd& start, double period) {
  const Directions directions(system);
  const Tangent tangent = tangent_of(system, start);
  double worst = 0;
  VectorXd y = start;
  for (const double share : {0.0, 0.3, 0.7}) {
    const auto turned = [&](double t) {
      VectorXd eta = VectorXd::Zero(tangent.dimension());
      for (const int i : list(directions.running)) {
        eta[i] = t * start[system.tree().coordinates() + i];
      }
      return tangent.moved(y, eta);
    };
    const double t = system.begin() + share * period;
    const VectorXd now = system.rates(t, turned(t));
    const VectorXd then = system.rates(t + period, turned(t + period));
    worst = std::max(worst, (then - now).norm() / (1 + now.norm()));
    y = off(system, y);
  }
  return worst;
}

FloquetMotion floquet_motion(const StudySystem& system, const VectorXd& start, double period) {
  constexpr double max_evaluations = 2e5;  // for one period: seconds, and at most 20 periods
  FloquetMotion floquet;
  floquet.period = period;
  const Directions directions(system);
  const Places cyclic = cyclic_at(system, system.begin() + period / 2, start);
  try {
    const auto motion = periodic_motion(system, system.begin(), period, start,
                                        {.held = list(joined(directions.held, cyclic)),
                                         .running = list(joined(directions.running, cyclic)),
                                         .most_iterations = 20},
                                        {.relative = 1e-12, .max_evaluations = max_evaluations});
    floquet.start = motion.start;
    floquet.residual = motion.residual;
    const auto there = linearized(system, system.begin(), motion.start);
    floquet.names = there.names;
    Places left_out = joined(directions.given, joined(directions.running, cyclic));
    for (const int i : there.free.dependent) left_out[static_cast<std::size_t>(i)] = true;
    floquet.kept = list(left_out, false);
    const MatrixXd X = motion.period.matrix(floquet.kept, floquet.kept);
    if (X.size() == 0) return floquet;
    floquet.multipliers = spectrum(X, motion.period.error.norm());
  } catch (const ComputationFailed& error) {
    floquet.reason = error.what();
    return floquet;
  }
  std::stable_sort(
      floquet.multipliers.begin(), floquet.multipliers.end(),
      [](const Mode& a, const Mode& b) { return std::abs(a.root) > std::abs(b.root); });
  floquet.verdict = verdict(floquet.multipliers, true,
                            [](const Mode& multiplier) { return std::abs(multiplier.root) - 1; });
  return floquet;
}

std::vector<VectorXd> states_of(const StudySystem& system, const FloquetMotion& motion, int parts) {
  std::vector<VectorXd> states;
  for (Moment& moment : moments_of(system, motion, parts))
    states.push_back(std::move(moment.state));
  return states;
}

std::vector<WhirlingMode> floquet_modes(const StudySystem& system, const FloquetMotion& motion) {
  const std::vector<Moment> moments = moments_of(system, motion, 16);
  // Deflections on a carrier that turns have other frequencies than those of the hub.
  auto spinning = spinning_bodies(system.tree(), motion.start);
  spinning.erase(std::remove_if(spinning.begin(), spinning.end(),
                                [](const SpinningBody& body) { return body.carrier != 0; }),
                 spinning.end());
  std::vector<WhirlingMode> modes;
  for (const Mode& multiplier : motion.multipliers) {
    const bool is_rounding = std::abs(multiplier.root) <= std::max(multiplier.error, 1e-12);
    const bool is_second = multiplier.root.imag() < 0 && multiplier.root.imag() < -multiplier.error;
    if (is_rounding || is_second) continue;
    modes.push_back(mode_of(multiplier, motion, moments, spinning, system.tree().rates()));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const WhirlingMode& a, const WhirlingMode& b) {
    return a.frequency() < b.frequency();
  });
  return modes;
}

}  // namespace kreisel
