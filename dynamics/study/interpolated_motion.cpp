#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <sstream>
#include <utility>

#include <dynamics/study/exponential_panels.hpp>
#include <dynamics/study/interpolated_motion.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr int fewest_panels = 16;
constexpr int most_panels = 16384;

/// The last two coefficients, relative to the greatest value of each component.
constexpr double resolution = 1e-11;

/// A component smaller than this part of the greatest one counts as that large.
constexpr double smallest_part = 1e-6;

/// Replaces coefficients that may be rounding of values of these sizes by 0.
MatrixXd without_rounding(MatrixXd coefficients, const VectorXd& size) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  for (Eigen::Index i = 0; i < coefficients.rows(); ++i) {
    for (double& entry : coefficients.row(i)) {
      if (std::abs(entry) <= rounding * size[i]) entry = 0;
    }
  }
  return coefficients;
}

}  // namespace

InterpolatedMotion::InterpolatedMotion(const Tangent& tangent, const States& states, double begin,
                                       double end)
    : tangent_(tangent), begin_(begin), end_(end) {
  int panels = fewest_panels;
  while (!interpolate(states, panels)) {
    if (panels == most_panels) {
      std::ostringstream text;
      text << most_panels << " panels from t = " << begin << " s to " << end
           << " s do not resolve the approximate motion; compute a shorter time";
      throw ComputationFailed(text.str());
    }
    panels *= 2;
  }
}

bool InterpolatedMotion::interpolate(const States& states, int panels) {
  const double h = (end_ - begin_) / panels;
  std::vector<double> times;
  for (int i = 0; i < panels; ++i) {
    for (const double fraction : ExponentialPanels::fractions()) {
      times.push_back(begin_ + h * (i + fraction));
    }
  }
  const std::vector<VectorXd> all = states(times);
  auto next = all.begin();
  VectorXd size = VectorXd::Zero(all[0].size());
  VectorXd last = size;
  coefficients_.clear();
  for (int i = 0; i < panels; ++i) {
    MatrixXd values(size.size(), panel_nodes);
    for (int j = 0; j < panel_nodes; ++j) values.col(j) = *next++;
    size = size.cwiseMax(values.cwiseAbs().rowwise().maxCoeff());
    coefficients_.push_back(without_rounding(ExponentialPanels::coefficients(values), size));
    last = last.cwiseMax(coefficients_.back().rightCols(2).cwiseAbs().rowwise().maxCoeff());
  }
  // Components that are rounding beside the others need no resolution.
  const VectorXd counted = size.cwiseMax(smallest_part * size.maxCoeff());
  return (last.array() <= resolution * counted.array()).all();
}

std::vector<double> InterpolatedMotion::stops() const {
  const std::size_t panels = coefficients_.size();
  std::vector<double> result;
  for (std::size_t i = 1; i <= panels; ++i) {
    result.push_back(begin_ + (end_ - begin_) * double(i) / double(panels));
  }
  return result;
}

MotionSampler InterpolatedMotion::sampler() const {
  // Rates of a part are a part of the rates: their rounding does not grow with a shorter part.
  std::vector<MatrixXd> slopes;
  for (const MatrixXd& one : coefficients_) slopes.push_back(ExponentialPanels::derivative(one));
  return [tangent = tangent_, begin = begin_, end = end_, all = coefficients_,
          slopes = std::move(slopes)](double t, double h) {
    const auto panels = static_cast<double>(all.size());
    const double length = (end - begin) / panels;
    const double middle = std::floor((t + h / 2 - begin) / length);
    const auto i = static_cast<std::size_t>(std::clamp(middle, 0.0, panels - 1));
    const double from = (t - begin) / length - static_cast<double>(i);
    const auto on_part = [&](const MatrixXd& coefficients) {
      return ExponentialPanels::values(
          ExponentialPanels::on_part(coefficients, from, from + h / length));
    };
    const MatrixXd values = on_part(all[i]);
    const MatrixXd rates = on_part(slopes[i]) / length;
    MotionSamples result;
    for (int j = 0; j <= panel_nodes; ++j) {
      result.states.emplace_back(values.col(j));
      result.rates.push_back(tangent_rate(tangent, values.col(j), rates.col(j)));
    }
    return result;
  };
}

}  // namespace kreisel
