#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>

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
    coefficients_.push_back(ExponentialPanels::coefficients(values));
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
  return [tangent = tangent_, begin = begin_, end = end_, all = coefficients_](double t, double h) {
    const auto panels = static_cast<double>(all.size());
    const double length = (end - begin) / panels;
    const double middle = std::floor((t + h / 2 - begin) / length);
    const auto i = static_cast<std::size_t>(std::clamp(middle, 0.0, panels - 1));
    const double from = (t - begin) / length - static_cast<double>(i);
    const MatrixXd part = ExponentialPanels::on_part(all[i], from, from + h / length);
    const MatrixXd values = ExponentialPanels::values(part);
    const MatrixXd rates = ExponentialPanels::derivatives(part) / h;
    MotionSamples result;
    for (int j = 0; j <= panel_nodes; ++j) {
      result.states.emplace_back(values.col(j));
      result.rates.push_back(tangent_rate(tangent, values.col(j), rates.col(j)));
    }
    return result;
  };
}

}  // namespace kreisel
