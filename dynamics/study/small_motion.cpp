#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/small_motion.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double last_digit = std::numeric_limits<double>::epsilon();

/// The parts of the run at which A is tested: without a common divisor, so that no period hides.
constexpr double tested_parts[] = {0.03, 0.11, 0.23, 0.49, 0.71, 0.83, 0.97};

/// A change of A below this part of its norm is rounding.
constexpr double same_matrix = 1e-12;

/// The distance from the constraints, relative to the state, that counts as rounding.
constexpr double off_constraints = 1e-8;

/// The error of A and f as polynomials, relative to the greatest values.
constexpr double resolved = 1e-13;

/// Marches along the panels of a small motion.
class SmallRun {
 public:
  /// is_steady : the equations contain f alone
  SmallRun(const ExponentialPanels& steps, const PanelSeries& equations, bool is_steady,
           VectorXd start, double relative)
      : steps_(steps),
        equations_(equations),
        is_steady_(is_steady),
        eta_(std::move(start)),
        size_(eta_.cwiseAbs()),
        error_(VectorXd::Zero(eta_.size())),
        relative_(relative) {}

  enum class Outcome { too_long, fits, fits_twice };

  /// Solves a panel. proceed() takes it over.
  Outcome attempt(double t, double h) {
    const MatrixXd all = equations_.at_nodes(t, h);
    if (!solve(h, all)) return Outcome::too_long;
    panel_ = {t, h, eta_, g_};
    off_ = VectorXd::Zero(eta_.size());
    if (is_steady_) return Outcome::fits_twice;
    off_ = steps_.truncation(h, without_rounding());
    const VectorXd size = size_.cwiseMax(x_.cwiseAbs().rowwise().maxCoeff());
    const auto fits = [&](double part) {
      return (off_.array() <= part * relative_ * size.array()).all();
    };
    if (!fits(1)) return Outcome::too_long;
    return fits(std::ldexp(1.0, -panel_nodes)) ? Outcome::fits_twice : Outcome::fits;
  }

  SmallSolution::Panel proceed() {
    eta_ = x_.col(panel_nodes);
    size_ = size_.cwiseMax(x_.cwiseAbs().rowwise().maxCoeff());
    error_ += off_;
    return panel_;
  }

  [[nodiscard]] const VectorXd& eta() const { return eta_; }
  [[nodiscard]] VectorXd relative_error() const {
    VectorXd result = error_;
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      if (size_[i] > 0) result[i] /= size_[i];
    }
    return result;
  }

 private:
  /// Solves for x at the nodes. False if the repeated solutions do not converge.
  bool solve(double h, const MatrixXd& all) {
    const Eigen::Index n = eta_.size();
    const auto f = all.bottomRows(n);
    g_ = ExponentialPanels::coefficients(f);
    x_ = steps_.solution(h, eta_, g_);
    if (is_steady_) return true;
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 0; sweep < 40; ++sweep) {
      MatrixXd force = f;
      for (int j = 0; j < panel_nodes; ++j) {
        const Eigen::Map<const MatrixXd> change(all.col(j).data(), n, n);
        force.col(j) += change * x_.col(j);
      }
      g_ = ExponentialPanels::coefficients(force);
      const MatrixXd next = steps_.solution(h, eta_, g_);
      const double off = greatest_change(next);
      x_ = next;
      if (off <= 4 * last_digit) return true;
      // Rounding ends the convergence.
      if (sweep > 1 && !(off < before)) return off <= 1e3 * last_digit;
      before = off;
    }
    return false;
  }

  /// The coefficients of g, with 0 for those within the error of the equations.
  [[nodiscard]] MatrixXd without_rounding() const {
    const Eigen::Index n = eta_.size();
    const VectorXd& error = equations_.error();
    const Eigen::Map<const MatrixXd> of_matrix(error.data(), n, n);
    const VectorXd level = error.tail(n) + of_matrix * x_.cwiseAbs().rowwise().maxCoeff();
    MatrixXd result = g_;
    for (Eigen::Index i = 0; i < n; ++i) {
      for (double& coefficient : result.row(i)) {
        if (std::abs(coefficient) <= level[i]) coefficient = 0;
      }
    }
    return result;
  }

  /// Relative to the size of each component.
  [[nodiscard]] double greatest_change(const MatrixXd& next) const {
    double result = 0;
    for (Eigen::Index i = 0; i < next.rows(); ++i) {
      const double size = std::max(size_[i], next.row(i).cwiseAbs().maxCoeff());
      const double change = (next.row(i) - x_.row(i)).cwiseAbs().maxCoeff();
      if (change > 0) result = std::max(result, change / size);
    }
    return result;
  }

  const ExponentialPanels& steps_;
  const PanelSeries& equations_;
  bool is_steady_;
  VectorXd eta_;
  VectorXd size_;
  VectorXd error_;
  double relative_;
  MatrixXd g_, x_;
  SmallSolution::Panel panel_{};
  VectorXd off_;
};

/// The rounding of A, by the greatest entry of each row, and of f, by its greatest entry.
VectorXd rounding_of(const std::vector<MatrixXd>& equations) {
  MatrixXd size = MatrixXd::Zero(equations[0].rows(), equations[0].cols());
  for (const MatrixXd& one : equations) size = size.cwiseMax(one.cwiseAbs());
  const Eigen::Index n = size.rows();
  const VectorXd rows = size.leftCols(n).rowwise().maxCoeff();
  const double force = size.col(n).maxCoeff();
  size.leftCols(n) = rows.replicate(1, n);
  size.col(n).setConstant(force);
  return 2 * last_digit * Eigen::Map<const VectorXd>(size.data(), size.size());
}

}  // namespace

void SmallMotion::prepare(const Equations& equations, const PanelSeries::Function& force,
                          double end, const std::vector<double>& breaks) {
  const double begin = nominal_->begin();
  check_constraints(end);
  std::vector<double> times;
  for (const double part : tested_parts) times.push_back(begin + part * (end - begin));
  double before = begin;
  for (const double t : breaks) {
    times.push_back(before + 0.5 * (t - before));
    before = t;
  }
  std::vector<MatrixXd> all;
  all.reserve(times.size());
  for (const double t : times) all.push_back(equations(t));
  const Eigen::Index n = nominal_->rate().size();
  MatrixXd mean = MatrixXd::Zero(n, n);
  for (const MatrixXd& one : all) mean += one.leftCols(n) / static_cast<double>(all.size());
  is_steady_ = std::all_of(all.begin(), all.end(), [&](const MatrixXd& one) {
    return (one - all[0]).leftCols(n).norm() <= same_matrix * mean.norm();
  });
  if (is_steady_) mean = all[0].leftCols(n);
  steps_ = std::make_shared<const ExponentialPanels>(mean);
  const VectorXd rounding = rounding_of(all);
  if (is_steady_) {
    equations_.emplace(force, begin, end, breaks, rounding.tail(n), resolved);
    return;
  }
  const auto changes = [&](double t) {
    MatrixXd now = equations(t);
    now.leftCols(n) -= mean;
    return VectorXd(Eigen::Map<const VectorXd>(now.data(), now.size()));
  };
  equations_.emplace(changes, begin, end, breaks, rounding, resolved);
}

void SmallMotion::check_constraints(double end) const {
  const double begin = nominal_->begin();
  for (const double part : {0.0, 0.41, 1.0}) {
    const double t = begin + part * (end - begin);
    const VectorXd y = nominal_->at(t);
    const VectorXd move = nominal_->tangent().between(y, on_constraints_(y));
    if (move.norm() <= off_constraints * (1 + y.norm())) continue;
    std::ostringstream text;
    text << "small motion: at t = " << t << " s the nominal motion, in which coordinates rest and "
         << "spins run, is off the constraints by " << move.norm()
         << "; start in a state in which the constraints allow it, or take model 'exact'";
    throw InvalidInput(text.str());
  }
}

SmallSolution SmallMotion::run(const VectorXd& start, const std::vector<double>& times,
                               double relative) const {
  SmallSolution result;
  result.steps_ = steps_;
  result.nominal_ = nominal_;
  const double begin = nominal_->begin();
  std::vector<double> stops = times;
  for (const double t : equations_->stops()) {
    if (t < times.back()) stops.push_back(t);
  }
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
  const VectorXd first = nominal_->tangent().between(nominal_->at(begin), start);
  SmallRun run(*steps_, *equations_, is_steady_, first, relative);
  auto next = times.begin();
  const auto note = [&](double t) {
    for (; next != times.end() && *next <= t; ++next) {
      if (!run.eta().allFinite()) {
        std::ostringstream text;
        text << "small motion: at t = " << *next << " s it has grown beyond all numbers";
        throw ComputationFailed(text.str());
      }
      result.deviations_.push_back(run.eta());
      result.states_.push_back(
          on_constraints_(nominal_->tangent().moved(nominal_->at(*next), run.eta())));
    }
  };
  note(begin);
  for (PanelSequence panels(begin, stops); !panels.done();) {
    const auto outcome = run.attempt(panels.begin(), panels.length());
    if (outcome == SmallRun::Outcome::too_long) {
      panels.halve();
      continue;
    }
    result.panels_.push_back(run.proceed());
    const bool at_stop = panels.advance(outcome == SmallRun::Outcome::fits_twice);
    if (at_stop) note(panels.done() ? times.back() : panels.begin());
  }
  result.error_ = run.relative_error();
  return result;
}

std::vector<double> SmallSolution::stops() const {
  std::vector<double> result;
  for (const Panel& panel : panels_) result.push_back(panel.begin + panel.length);
  return result;
}

namespace {

/// The motion on parts of the panels of a solution.
class PanelSampler {
 public:
  PanelSampler(std::shared_ptr<const ExponentialPanels> steps,
               std::shared_ptr<const NominalMotion> nominal,
               std::vector<SmallSolution::Panel> panels)
      : steps_(std::move(steps)), nominal_(std::move(nominal)), panels_(std::move(panels)) {}

  MotionSamples operator()(double t, double h) {
    go_to(t, h);
    const SmallSolution::Panel& panel = panels_[at_];
    const double from = (t - panel.begin) / panel.length;
    const MatrixXd g = ExponentialPanels::on_part(panel.g, from, from + h / panel.length);
    const MatrixXd eta = steps_->solution(h, eta_, g);
    const MatrixXd rates = steps_->matrix() * eta + ExponentialPanels::values(g);
    MotionSamples result;
    for (int j = 0; j <= panel_nodes; ++j) {
      const double time = t + h * (j < panel_nodes ? ExponentialPanels::fractions()[j] : 1);
      result.states.push_back(nominal_->tangent().moved(nominal_->at(time), VectorXd(eta.col(j))));
      result.rates.push_back(
          rate_of_moved(nominal_->tangent(), nominal_->rate(), eta.col(j), rates.col(j)));
    }
    end_ = t + h;
    eta_at_end_ = eta.col(panel_nodes);
    return result;
  }

 private:
  /// Sets the panel and eta at t.
  void go_to(double t, double h) {
    const double middle = t + h / 2;
    while (at_ + 1 < panels_.size() && panels_[at_ + 1].begin <= middle) ++at_;
    const SmallSolution::Panel& panel = panels_[at_];
    if (std::abs(t - panel.begin) <= 1e-9 * h) {
      eta_ = panel.eta;
    } else if (std::abs(t - end_) <= 1e-9 * h) {
      eta_ = eta_at_end_;
    } else if (t != begin_) {
      const double length = t - panel.begin;
      const MatrixXd g = ExponentialPanels::on_part(panel.g, 0, length / panel.length);
      eta_ = steps_->solution(length, panel.eta, g).col(panel_nodes);
    }
    begin_ = t;
  }

  std::shared_ptr<const ExponentialPanels> steps_;
  std::shared_ptr<const NominalMotion> nominal_;
  std::vector<SmallSolution::Panel> panels_;
  std::size_t at_ = 0;
  double begin_ = std::numeric_limits<double>::quiet_NaN();
  double end_ = std::numeric_limits<double>::quiet_NaN();
  VectorXd eta_;
  VectorXd eta_at_end_;
};

}  // namespace

MotionSampler SmallSolution::sampler() const { return PanelSampler(steps_, nominal_, panels_); }

}  // namespace kreisel
