#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

#include <dynamics/file/linear_motion.hpp>
#include <dynamics/file/steady_motions.hpp>
#include <dynamics/study/rotor_spectrum.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

using namespace steady_motion;
using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// The greatest angular rate of a joint.
double angular_rate(const JointType& type, const double* rates) {
  double greatest = 0;
  for (const JointQuantity& quantity : type.rates) {
    for (int k = 0; k < quantity.count(); ++k, ++rates) {
      if (quantity.unit == "rad/s") greatest = std::max(greatest, std::abs(*rates));
    }
  }
  return greatest;
}

/// The frame in which a mode about a steady motion is observed. Attitudes vary by angles on the
/// body's own axes, which may rotate in a steady motion. Single coordinates vary relative to the
/// parent.
std::string frame_of(const StudySystem& system, const VectorXd& state) {
  const BodyTree& tree = system.tree();
  std::string carriers;
  for (int body = 0; body < static_cast<int>(tree.bodies().size()); ++body) {
    const BodyDescription& description = tree.body(body);
    const JointType& type = joint_type(description.joint.kind);
    const double* const rates = state.data() + tree.coordinates() + tree.place(body).v;
    if (description.rotor || angular_rate(type, rates) < 1e-9) continue;
    const std::string& name = description.name;
    if (type.has_attitude()) return "on body axes, which turn with '" + name + "'";
    const bool carries = std::any_of(tree.bodies().begin(), tree.bodies().end(),
                                     [&name](const auto& other) { return other.parent == name; });
    if (carries && carriers.empty()) carriers = name;
  }
  if (carriers.empty()) return "against the guide";
  return "against the parent of each body; '" + carriers + "' turns against the guide";
}

/// The roots s of a loop with samples, from its multipliers z = exp(s period). Multipliers that are
/// rounding have no root: they are dead beats.
std::vector<GyroscopicMode> sampled_modes(const MatrixXd& transition, LinearMotion& linear) {
  std::vector<GyroscopicMode> modes;
  for (const Mode& multiplier : spectrum(transition)) {
    const double size = std::abs(multiplier.root);
    if (size <= std::max(multiplier.error, 1e-12)) {
      ++linear.dead_beats;
      continue;
    }
    GyroscopicMode mode;
    mode.root = std::log(multiplier.root) / linear.sample_period;
    mode.error = multiplier.error / size / linear.sample_period;
    mode.shape = multiplier.shape;
    modes.push_back(std::move(mode));
  }
  return modes;
}

/// The modes of the kept directions.
std::vector<GyroscopicMode> modes_of(const StudySystem& system, const VectorXd& state,
                                     const MatrixXd& A, const std::vector<int>& kept,
                                     LinearMotion& linear) {
  if (system.has_samples()) {
    const SampledTransition transition = system.sampled_transition(state);
    linear.sample_period = transition.period;
    return sampled_modes(transition.matrix(kept, kept), linear);
  }
  MatrixXd slope = MatrixXd::Zero(A.rows(), A.cols());
  if (linear.has_rotors) slope = system.momenta_slope(system.begin(), state)(kept, kept);
  return rotor_spectrum(A, slope);
}

}  // namespace

LinearMotion linear_motion(const StudySystem& system, const VectorXd& state) {
  const auto there = linearized(system, system.begin(), state);
  const Directions directions(system);
  const Places out = directions.without_roots(there);
  const std::vector<int> kept = list(out, false);
  LinearMotion linear;
  linear.names = there.names;
  linear.frame = frame_of(system, state);
  linear.rates = directions.rates;
  // Modes have kinds by their change with the rotors' momenta, which is for trees alone.
  linear.has_rotors =
      !system.tree().rotors().empty() && !there.free.bound() && !system.has_samples();
  std::vector<int> left_out;
  for (const int i : list(out)) {
    const bool follows = there.free.is_dependent(i);
    (follows ? linear.dependent : linear.left_out)
        .push_back(there.names[static_cast<std::size_t>(i)]);
    if (!follows) left_out.push_back(i);
  }
  if (kept.empty()) return linear;
  std::vector<GyroscopicMode> modes = modes_of(system, state, there.A(kept, kept), kept, linear);
  const std::vector<SpinningBody> spinning = spinning_bodies(system.tree(), state);
  for (GyroscopicMode& mode : modes) {
    if (mode.root.imag() < 0) continue;
    const Eigen::VectorXcd own = mode.shape;
    mode.shape.setZero(there.A.rows());
    mode.shape(kept) = own;
    if (there.free.bound()) mode.shape = (there.free.N * mode.shape(there.free.independent)).eval();
    const WhirlOfMode whirl = kreisel::whirl(spinning, mode.root.imag(), mode.shape);
    linear.modes.push_back({std::move(mode), whirl});
  }
  // A coordinate that is neither held nor restored drifts, however slowly.
  const bool drifts = std::any_of(left_out.begin(), left_out.end(), [&directions](int i) {
    return !directions.held[static_cast<std::size_t>(i)];
  });
  linear.verdict =
      verdict(linear.modes, !drifts, [](const GyroscopicMode& mode) { return mode.root.real(); });
  return linear;
}

}  // namespace kreisel
