#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <dynamics/study/nominal_motion.hpp>

namespace kreisel::detail {

using Eigen::VectorXd;

Spins::Spins(const Tangent& tangent, TangentField field, double t, VectorXd y,
             Eigen::Index first_rate, Eigen::Index rates)
    : tangent_(tangent),
      field_(std::move(field)),
      t_(t),
      y_(std::move(y)),
      first_rate_(first_rate),
      rates_(rates) {}

VectorXd Spins::with_rates(const VectorXd& rates) const {
  VectorXd y = y_;
  y.segment(first_rate_, rates_) = rates;
  return y;
}

/// True if turns about the axis change no acceleration: by angles without a common divisor. At
/// `attitude`, the first rate of a turning body, they may turn with its axes.
bool Spins::spins(const VectorXd& rates, const VectorXd& axis, int attitude) const {
  const VectorXd y = with_rates(rates);
  const Eigen::Index others = tangent_.dimension() - rates_;
  const VectorXd at_start = field_(t_, y).tail(others);
  VectorXd move = VectorXd::Zero(tangent_.dimension());
  for (const double angle : {0.7, 1.9, 3.1}) {
    move.head(rates_) = angle * axis;
    VectorXd there = field_(t_, tangent_.moved(y, move)).tail(others);
    if (attitude >= 0) {
      const Eigen::Vector3d e = axis.segment<3>(attitude);
      there.segment<3>(attitude) =
          (Eigen::AngleAxisd(angle, e) * there.segment<3>(attitude)).eval();
    }
    if ((there - at_start).norm() > 1e-9 * (1 + at_start.norm())) return false;
  }
  return true;
}

VectorXd Spins::kept(const RuledDirections& ruled) const {
  const VectorXd start = y_.segment(first_rate_, rates_);
  VectorXd kept = VectorXd::Zero(rates_);
  std::vector<bool> done(static_cast<std::size_t>(rates_), false);
  for (const int v : ruled.running) {
    kept[v] = start[v];
    done[static_cast<std::size_t>(v)] = true;
  }
  for (const int first : ruled.attitudes) {
    std::fill_n(done.begin() + first, 3, true);
    const Eigen::Vector3d w = start.segment<3>(first);
    if (w.isZero(0)) continue;
    // A spin about the whole angular velocity, else about the axis of the body with most of it.
    Eigen::Index most = 0;
    w.cwiseAbs().maxCoeff(&most);
    for (const Eigen::Vector3d& e :
         {Eigen::Vector3d(w.normalized()), Eigen::Vector3d(Eigen::Vector3d::Unit(most))}) {
      VectorXd axis = VectorXd::Zero(rates_);
      axis.segment<3>(first) = e;
      const VectorXd with = kept + e.dot(w) * axis;
      if (!spins(with, axis, first)) continue;
      kept = with;
      break;
    }
  }
  for (Eigen::Index v = 0; v < rates_; ++v) {
    if (done[static_cast<std::size_t>(v)] || start[v] == 0) continue;
    const VectorXd axis = VectorXd::Unit(rates_, v);
    if (spins(kept + start[v] * axis, axis, -1)) kept[v] = start[v];
  }
  return kept;
}

}  // namespace kreisel::detail
