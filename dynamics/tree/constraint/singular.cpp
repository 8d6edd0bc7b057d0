#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <dynamics/tree/accelerations.hpp>
#include <dynamics/tree/constraint/singular.hpp>
#include <dynamics/tree/constraint/state.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/passes.hpp>
#include <motor/error.hpp>

/// States near a singular position, where the rank of the conditions falls.

namespace kreisel::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Moves the coordinates along the columns of `across` by what closes the gaps to first order.
void close_gaps_along(const BodyTree& tree, const MatrixXd& across, VectorXd& y,
                      ConstraintSpace& c) {
  list_gaps(c);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> general;
  general.setThreshold(redundant_below);
  general.compute(c.directions.transpose() * across);
  c.change = -across * general.solve(c.right);
  move_coordinates(tree, y, c);
}

/// Values on the branch of states through y, near a singular position.
///
/// At a singular position the conditions have no direction, and near it only rounded ones. But y
/// moves on, and the motion through it is smooth. So values are taken at states before and after y, at
/// distances where the conditions have directions, and are interpolated at y.
class Branch {
 public:
  Branch(const BodyTree& tree, const VectorXd& y, BodyWorkspace& w) : tree_(tree), w_(w), y_(y) {
    rates_ = VectorXd::Zero(y.size());
    set_coordinate_rates(tree, y.data(), y.data() + tree.coordinates(), rates_.data());
    const double fastest = y.tail(tree.rates()).cwiseAbs().maxCoeff();
    if (fastest > 0) find_time(widest / fastest);
  }

  /// The value at y, of a vector function of states. Nothing if y rests, or if the states before and
  /// after it are near a singular position too.
  ///
  /// A wide range of states has an error of interpolation, a narrow one of rounding. The range is
  /// halved as long as the first is greater.
  template <class Value>
  [[nodiscard]] std::optional<VectorXd> at_middle(const Value& value) {
    for (double wide = widest; wide > widest / 100 && time_ > 0; wide /= 2) {
      if (!take(wide, value)) continue;
      VectorXd found = interpolated(0);
      const double error = (found - interpolated(1)).norm() / found.norm();
      const double nearest = wide / (2 * nodes);
      if (error < std::numeric_limits<double>::epsilon() / (nearest * nearest)) return found;
    }
    return std::nullopt;
  }

 private:
  static constexpr int nodes = 8;         ///< on each side
  static constexpr int most_missing = 2;  ///< too near to the singular position
  static constexpr double widest = 0.12;  ///< distance of the last, in radians or body lengths

  /// Takes the values on both sides of y, up to this distance; false if too few can be had.
  template <class Value>
  [[nodiscard]] bool take(double wide, const Value& value) {
    const double least = std::pow(wide / (1.5 * nodes), 2);
    places_.clear();
    values_.clear();
    int missing = 0;
    for (int k = -nodes; k < nodes && missing <= most_missing; ++k) {
      const double place = (k + 0.5) / nodes;
      if (!move_to(place * wide / widest) || independence(*w_.constraints) < least) {
        missing += 1;
        continue;
      }
      places_.push_back(place);
      values_.push_back(value(state_));
    }
    return missing <= most_missing;
  }

  /// The value at y of the polynomial through the values, without so many at each end.
  [[nodiscard]] VectorXd interpolated(std::size_t without) const {
    VectorXd sum = VectorXd::Zero(values_.front().size());
    const std::size_t end = places_.size() - without;
    for (std::size_t i = without; i < end; ++i) {
      double weight = 1;
      for (std::size_t j = without; j < end; ++j) {
        if (j != i) weight *= places_[j] / (places_[j] - places_[i]);
      }
      sum += weight * values_[i];
    }
    return sum;
  }

  /// Finds the time in which y moves about as far as the last node lies.
  void find_time(double guess) {
    constexpr int most = 8;
    for (int i = 0; i < most; ++i, guess *= 0.6) {
      time_ = guess;
      across_.resize(0, 0);
      if (!move_to(1)) continue;
      const double distance = std::sqrt(independence(*w_.constraints));
      if (distance > 0.4 * widest && distance < 1.5 * widest) return;
      if (distance < widest) guess *= std::min(widest / distance, 10.0) / 0.6;
    }
    time_ = 0;
  }

  /// Moves the state by a part of the time and onto the conditions, along fixed directions. Least
  /// changes are no smooth function of the part: they turn where conditions lose their direction. False
  /// if the conditions cannot be met.
  [[nodiscard]] bool move_to(double part) {
    constexpr int most = 16;
    ConstraintSpace& c = *w_.constraints;
    state_ = y_ + part * time_ * rates_;
    bool is_close = false;
    for (int i = 0; i < most; ++i) {
      set_state(tree_, state_, w_);
      eliminate_all(tree_, w_);
      set_directions(tree_, w_);
      const double worst = worst_gap(c).first;
      if (!(worst < 1)) return false;
      if (is_close) {
        close_rates(tree_, state_, c);
        set_state(tree_, state_, w_);
        close_rates(tree_, state_, c);
        return true;
      }
      is_close = worst <= 64 * std::numeric_limits<double>::epsilon();
      if (across_.size() == 0) across_ = c.responses;
      close_gaps_along(tree_, across_, state_, c);
    }
    return false;
  }

  const BodyTree& tree_;
  BodyWorkspace& w_;
  VectorXd y_;
  VectorXd rates_;  ///< of the coordinates; those of the rates are 0
  VectorXd state_;
  MatrixXd across_;  ///< directions of the motion in which the conditions are met
  double time_ = 0;
  std::vector<double> places_;  ///< -1 to 1
  std::vector<VectorXd> values_;
};

}  // namespace

std::optional<VectorXd> interpolated_near_singular(
    const BodyTree& tree, const VectorXd& y, BodyWorkspace& w,
    const std::function<const VectorXd&(const VectorXd&)>& value) {
  constexpr double near = 4e-4;  // squared
  if (independence(*w.constraints) > near) return std::nullopt;
  return Branch(tree, y, w).at_middle(value);
}

bool is_near_singular(BodyWorkspace& w) { return independence(*w.constraints) <= near_singular; }

std::optional<VectorXd> rates_near_singular(
    const BodyTree& tree, const VectorXd& y, BodyWorkspace& w,
    const std::function<const VectorXd&(const VectorXd&)>& rates) {
  auto found = interpolated_near_singular(tree, y, w, rates);
  VectorXd projected = y;
  try {
    project_on_directions(tree, projected, w);
  } catch (const ComputationFailed&) {
    return found;  // nothing at a trial point far from the conditions: its step is rejected
  }
  const VectorXd& beside = rates(projected);  // leaves w at this state
  return found ? found : beside;
}

}  // namespace kreisel::detail
