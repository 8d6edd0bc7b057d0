#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>

#include <dynamics/solve/error_measure.hpp>
#include <dynamics/study/model_bound.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// The factor of |e| in the bound: e is known to 3 %.
constexpr double caution = 1.05;

/// Repeated solutions of a panel before it is halved.
constexpr int most_sweeps = 6;

/// The share of the error that a panel may add however short it is: at a jump it falls no faster
/// than the length.
constexpr double at_a_jump = 1e-3;

/// Rotation by which an attitude may be off.
constexpr double greatest_rotation = 1;

enum class Outcome { too_long, fits, fits_twice };

/// The deviation e along the panels.
class DeviationRun {
 public:
  DeviationRun(const Tangent& tangent, const TangentField& field, const ExponentialPanels& steps,
               detail::BlockDistance measure, double begin, const ModelBoundOptions& options)
      : tangent_(tangent),
        field_(field),
        steps_(steps),
        measure_(std::move(measure)),
        begin_(begin),
        options_(options) {}

  /// Sets the start: x of the model and the exact state.
  void start(const VectorXd& model, const VectorXd& exact) {
    e_ = tangent_.between(model, exact);
    greatest_ = distance(model, e_);
  }

  /// attempt(), or a shorter panel if the field fails on it.
  Outcome attempt_or_halve(double t, double h, const MotionSamples& model) {
    try {
      return attempt(t, h, model);
    } catch (const ComputationFailed&) {
      return Outcome::too_long;
    }
  }

  /// Why the deviation cannot be followed further than t; or empty.
  [[nodiscard]] std::string obstacle(double t) const {
    std::ostringstream text;
    if (evaluations_ > options_.max_evaluations) {
      text << "the error of the model is not known after t = " << t
           << " s: it would take more than " << options_.max_evaluations
           << " evaluations; take model 'exact'";
    }
    for (std::size_t i = 0; i < tangent_.quaternions().size(); ++i) {
      const Eigen::Index at = tangent_.quaternions()[i] - static_cast<int>(i);
      if (e_.segment<3>(at).norm() <= greatest_rotation) continue;
      text << "the model does not hold after t = " << t << " s: an attitude is off by more than "
           << greatest_rotation << " rad; take model 'exact'";
      break;
    }
    return text.str();
  }

  /// Solves a panel on which the model has these samples.
  Outcome attempt(double t, double h, const MotionSamples& model) {
    VectorXd force_size = VectorXd::Zero(e_.size());
    MatrixXd g = MatrixXd::Zero(e_.size(), panel_nodes);
    x_ = steps_.solution(h, e_, g);
    double before = std::numeric_limits<double>::infinity();
    for (int sweep = 1; sweep <= most_sweeps; ++sweep) {
      g = ExponentialPanels::coefficients(remainders(t, h, model, force_size));
      const MatrixXd next = steps_.solution(h, e_, g);
      if (!next.allFinite()) return Outcome::too_long;
      const double change = difference(model, x_, next);
      x_ = next;
      const double allowed = allowance(t, h, model);
      const double left = std::min(change, sweep > 1 ? change * change / before : change);
      before = change;
      if (left > allowed) continue;
      clear_rounding(g, force_size);
      off_ = off_by(steps_.truncation(h, g), model.states[panel_nodes]);
      if (off_ > allowed) return Outcome::too_long;
      return off_ <= std::ldexp(allowed, -panel_nodes) && sweep <= 3 ? Outcome::fits_twice
                                                                     : Outcome::fits;
    }
    return Outcome::too_long;
  }

  /// Takes over the panel.
  void proceed(const MotionSamples& model) {
    e_ = x_.col(panel_nodes);
    for (int j = 0; j <= panel_nodes; ++j) {
      greatest_ = std::max(greatest_, distance(model.states[std::size_t(j)], x_.col(j)));
    }
    doubt_ += off_;
  }

  [[nodiscard]] const VectorXd& e() const { return e_; }
  [[nodiscard]] double doubt() const { return doubt_; }
  [[nodiscard]] double evaluations() const { return evaluations_; }
  [[nodiscard]] const std::vector<double>& sizes() const { return measure_.sizes(); }

  double distance(const VectorXd& model, const VectorXd& e) {
    return between(model, tangent_.moved(model, e));
  }

  double between(const VectorXd& a, const VectorXd& b) {
    return measure_({a.data(), std::size_t(a.size())}, {b.data(), std::size_t(b.size())});
  }

 private:
  /// e' - A e at the nodes, as columns, for the deviations x_.
  MatrixXd remainders(double t, double h, const MotionSamples& model, VectorXd& size) {
    MatrixXd result(e_.size(), panel_nodes);
    for (int j = 0; j < panel_nodes; ++j) {
      const VectorXd& y = model.states[std::size_t(j)];
      const VectorXd e = x_.col(j);
      const VectorXd rate = field_(t + h * ExponentialPanels::fractions()[j], tangent_.moved(y, e));
      size = size.cwiseMax(rate.cwiseAbs());
      result.col(j) =
          rate_of_move(tangent_, model.rates[std::size_t(j)], rate, e) - steps_.matrix() * e;
    }
    evaluations_ += panel_nodes;
    return result;
  }

  /// The error that a panel may add, in the measure.
  double allowance(double t, double h, const MotionSamples& model) {
    const double now =
        std::max(greatest_, distance(model.states[panel_nodes], x_.col(panel_nodes)));
    const double share = std::max(h / (t + h - begin_), at_a_jump);
    return share * std::max(options_.accuracy * now, options_.tolerance);
  }

  double difference(const MotionSamples& model, const MatrixXd& a, const MatrixXd& b) {
    double result = 0;
    for (const int j : {panel_nodes / 2, panel_nodes}) {
      const VectorXd& y = model.states[std::size_t(j)];
      result = std::max(
          result, between(tangent_.moved(y, VectorXd(a.col(j))), tangent_.moved(y, b.col(j))));
    }
    return result;
  }

  double off_by(const VectorXd& error, const VectorXd& y) {
    const VectorXd end = x_.col(panel_nodes);
    return between(tangent_.moved(y, end), tangent_.moved(y, VectorXd(end + error)));
  }

  /// Replaces coefficients that may be rounding of the field by 0.
  static void clear_rounding(MatrixXd& g, const VectorXd& size) {
    for (Eigen::Index i = 0; i < g.rows(); ++i) {
      for (double& entry : g.row(i)) {
        if (std::abs(entry) <= 64 * epsilon * size[i]) entry = 0;
      }
    }
  }

  const Tangent& tangent_;
  const TangentField& field_;
  const ExponentialPanels& steps_;
  detail::BlockDistance measure_;
  double begin_;
  ModelBoundOptions options_;
  VectorXd e_;
  MatrixXd x_;  ///< e at the nodes and the end
  double off_ = 0;
  double greatest_ = 0;
  double doubt_ = 0;
  double evaluations_ = 0;
};

/// The output times, and the stops before their end, in order.
std::vector<double> joined(std::vector<double> a, const std::vector<double>& stops) {
  const double end = a.back();
  std::copy_if(stops.begin(), stops.end(), std::back_inserter(a),
               [end](double t) { return t < end; });
  std::sort(a.begin(), a.end());
  a.erase(std::unique(a.begin(), a.end()), a.end());
  return a;
}

}  // namespace

ModelDistance ModelBound::run(const VectorXd& start, const MotionSampler& motion,
                              const std::vector<double>& times,
                              const std::vector<VectorXd>& outputs,
                              const std::vector<double>& stops,
                              const ModelBoundOptions& options) const {
  DeviationRun run(tangent_, field_, steps_, detail::BlockDistance(blocks_, options.absolute_scale),
                   begin_, options);
  ModelDistance result;
  std::vector<VectorXd> exact;
  std::vector<double> doubts;
  const auto note = [&](double t, const VectorXd& model) {
    while (exact.size() < times.size() && times[exact.size()] <= t) {
      exact.push_back(tangent_.moved(model, run.e()));
      doubts.push_back(run.doubt());
    }
  };
  run.start(state_, start);
  note(begin_, state_);
  for (PanelSequence panels(begin_, joined(times, stops)); !panels.done();) {
    const double t = panels.begin();
    const MotionSamples model = motion(t, panels.length());
    const Outcome outcome = run.attempt_or_halve(t, panels.length(), model);
    result.message = run.obstacle(t);
    if (!result.message.empty()) break;
    if (outcome == Outcome::too_long) {
      panels.halve();
      continue;
    }
    run.proceed(model);
    const bool at_stop = panels.advance(outcome == Outcome::fits_twice);
    if (at_stop) note(panels.done() ? times.back() : panels.begin(), model.states[panel_nodes]);
  }
  for (std::size_t i = 0; i < exact.size(); ++i) {
    result.bounds.push_back(caution * run.between(outputs[i], exact[i]) + doubts[i]);
  }
  result.sizes = run.sizes();
  result.evaluations = run.evaluations();
  return result;
}

}  // namespace kreisel
