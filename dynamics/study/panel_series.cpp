#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <dynamics/study/exponential_panels.hpp>
#include <dynamics/study/panel_series.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

/// The part of the time below which a panel is short by a kink or a jump of the function.
constexpr double shortest_smooth = 1e-6;

/// Coefficients up to so many times the rounding of the function may be rounding of its own parts,
/// as of an ill-conditioned mass matrix. They are, if a shorter panel does not make them smaller.
constexpr double amplified_rounding = 1e5;

/// The greatest change of a function over times that differ by rounding.
VectorXd rounding_of(const PanelSeries::Function& function, double begin, double end) {
  VectorXd result;
  for (const double part : {0.02, 0.13, 0.29, 0.37, 0.53, 0.61, 0.79, 0.94}) {
    const double t = begin + part * (end - begin);
    const VectorXd there = function(t);
    if (result.size() == 0) result = VectorXd::Zero(there.size());
    for (const double shift : {1e-14, 3e-14, 7e-14}) {
      result = result.cwiseMax((function(t + shift * (end - begin)) - there).cwiseAbs());
    }
  }
  return result;
}

/// After so many halvings in a row, coefficients that are no smaller count as rounding, which the
/// error contains. At a kink they would be smaller by 2^halvings; jumps are among the breaks.
constexpr int halvings_of_rounding = 6;

VectorXd last_two(const MatrixXd& coefficients) {
  return coefficients.rightCols(2).cwiseAbs().rowwise().sum();
}

/// The last two coefficients, times their ratio to the two before: an estimate of those left out.
VectorXd truncation(const MatrixXd& coefficients, const VectorXd& rounding) {
  const auto size = [&](int k) {
    return VectorXd(coefficients.col(k).cwiseAbs() + coefficients.col(k + 1).cwiseAbs());
  };
  VectorXd last = size(panel_nodes - 2);
  const VectorXd before = size(panel_nodes - 4);
  for (Eigen::Index i = 0; i < last.size(); ++i) {
    if (last[i] <= rounding[i]) {
      last[i] = 0;
    } else if (last[i] < before[i]) {
      last[i] *= last[i] / before[i];
    }
  }
  return last;
}

}  // namespace

PanelSeries::PanelSeries(const Function& function, double begin, double end,
                         const std::vector<double>& breaks, VectorXd rounding, double relative) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const VectorXd most_rounding = amplified_rounding * rounding;
  rounding += rounding_of(function, begin, end);
  VectorXd of_longer;   // the last two coefficients of the panel that was halved
  VectorXd of_longest;  // of the first panel that was halved in this row
  int halvings = 0;
  VectorXd size = VectorXd::Zero(rounding.size());
  std::vector<double> stops = breaks;
  std::erase_if(stops, [end](double t) { return t >= end; });
  stops.push_back(end);
  for (PanelSequence panels(begin, stops); !panels.done();) {
    const double t = panels.begin();
    const double h = panels.length();
    MatrixXd values(size.size(), panel_nodes);
    for (int j = 0; j < panel_nodes; ++j) {
      values.col(j) = function(t + h * ExponentialPanels::fractions()[j]);
    }
    size = size.cwiseMax(values.cwiseAbs().rowwise().maxCoeff());
    const MatrixXd coefficients = ExponentialPanels::coefficients(values);
    const VectorXd last = last_two(coefficients);
    for (Eigen::Index i = 0; i < of_longer.size(); ++i) {
      const bool falls = last[i] < of_longer[i] / 2;
      const bool stays = halvings >= halvings_of_rounding && last[i] > of_longest[i] / 2;
      const bool rounds = !falls && last[i] <= most_rounding[i];
      if (stays || rounds) rounding[i] = std::max(rounding[i], last[i]);
    }
    const VectorXd off = truncation(coefficients, 8 * (rounding + epsilon * size));
    // Panels too short to matter may contain a kink or a jump.
    const double shortness = std::max(1.0, shortest_smooth * (end - begin) / h);
    const VectorXd allowed = shortness * shortness * relative * size;
    if ((off.array() > allowed.array()).any()) {
      panels.halve();
      if (halvings++ == 0) of_longest = last;
      of_longer = last;
      continue;
    }
    of_longer.resize(0);
    halvings = 0;
    panels_.push_back({t, h, coefficients});
    panels.advance((off.array() <= std::ldexp(1.0, -panel_nodes) * allowed.array()).all());
  }
  error_ = relative * size + 8 * (rounding + epsilon * size);
}

MatrixXd PanelSeries::at_nodes(double t, double h) const {
  const auto after = std::upper_bound(panels_.begin(), panels_.end(), t + h / 2,
                                      [](double time, const Panel& p) { return time < p.begin; });
  const Panel& panel = after == panels_.begin() ? *after : *std::prev(after);
  const double from = (t - panel.begin) / panel.length;
  const MatrixXd part =
      ExponentialPanels::on_part(panel.coefficients, from, from + h / panel.length);
  return ExponentialPanels::values(part).leftCols(panel_nodes);
}

std::vector<double> PanelSeries::stops() const {
  std::vector<double> result;
  for (const Panel& panel : panels_) result.push_back(panel.begin + panel.length);
  return result;
}

}  // namespace kreisel
