#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/step/radau.hpp>

namespace kreisel::detail {

/// Factors of shift - J.
template <class Number>
void factorise_shifted(const Eigen::MatrixXd& J, const Number& shift, LuFactors<Number>& factors) {
  const Eigen::Index n = J.rows();
  factors.matrix.resize(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < n; ++i) factors.matrix(i, j) = -J(i, j);
    factors.matrix(j, j) += shift;
  }
  factors.compute();
}

/// result = sum_k weight_k columns_k
template <class Vector>
void combine(const Eigen::MatrixXd& columns, const Vector& weight, Vector& result) {
  for (Eigen::Index i = 0; i < columns.rows(); ++i) result[i] = columns(i, 0) * weight[0];
  for (Eigen::Index k = 1; k < columns.cols(); ++k) {
    for (Eigen::Index i = 0; i < columns.rows(); ++i) result[i] += columns(i, k) * weight[k];
  }
}

namespace {

/// Polynomials that are orthonormal on 0 and the nodes: column k has degree k.
[[nodiscard]] Eigen::MatrixXd orthonormal_polynomials(const Eigen::VectorXd& node) {
  const Eigen::Index count = node.size() + 1;
  Eigen::VectorXd x = Eigen::VectorXd::Constant(count, -1);
  x.tail(node.size()) += 2 * node;
  Eigen::MatrixXd P(count, count);
  for (Eigen::Index k = 0; k < count; ++k) {
    if (k == 0) {
      P.col(k).setOnes();
    } else {
      P.col(k) = x.cwiseProduct(P.col(k - 1));
    }
    for (int pass = 0; pass < 2; ++pass) {
      for (Eigen::Index j = 0; j < k; ++j) P.col(k) -= P.col(j).dot(P.col(k)) * P.col(j);
    }
    P.col(k).normalize();
  }
  return P;
}

/// The error of a step of order 2 s with stages Z that the decay of its polynomial promises.
///
/// For a smooth motion the parts of each degree decrease geometrically. Those of degrees s - 1 and s
/// bound the error estimate, and s + 1 further degrees reduce it to the error. At a corner or a jump
/// of the field they decrease over two degrees to a third or a half only. The error of the step is
/// then up to ten times as great as its last parts.
[[nodiscard]] Eigen::VectorXd error_by_decay(const Eigen::VectorXd& node,
                                             const Eigen::MatrixXd& Z) {
  constexpr double smooth = 0.25;
  const Eigen::Index s = node.size();
  const Eigen::MatrixXd part = (Z * orthonormal_polynomials(node).bottomRows(s)).cwiseAbs();
  Eigen::VectorXd error = part.col(s).cwiseMax(part.col(s - 1));
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    const double before = std::max(part(i, s - 2), part(i, s - 3));
    const bool falls = error[i] < smooth * before;
    error[i] *= falls ? std::pow(error[i] / before, static_cast<double>(s + 1) / 2) : 10;
  }
  return error;
}

/// The motions that a step does not resolve and that live until the next output, as columns of right
/// or left eigenvectors.
struct LivingModes {
  std::vector<double> remains;  ///< part at the next output
  Eigen::MatrixXcd vectors;
};

/// rate  : greatest one that the step resolves
/// left  : time to the next output
/// least : part at which a motion counts as dead
[[nodiscard]] LivingModes living_modes(const Eigen::MatrixXd& J, double rate, double left,
                                       double least) {
  const Eigenpairs all = eigenpairs(J);
  LivingModes found;
  found.vectors.resize(J.rows(), J.cols());
  for (Eigen::Index i = 0; i < all.values.size(); ++i) {
    const double remains = std::exp(all.values[i].real() * left);
    if (std::abs(all.values[i]) <= rate || remains < least) continue;
    found.vectors.col(static_cast<Eigen::Index>(found.remains.size())) = all.vectors.col(i);
    found.remains.push_back(std::min(remains, 1.0));
  }
  found.vectors.conservativeResize(J.rows(), static_cast<Eigen::Index>(found.remains.size()));
  return found;
}

/// The amplitude of each component of a deviation at the next output, in its living modes. A mode may
/// be in any phase now: a spring at its greatest deflection has no speed yet.
///
/// Left eigenvectors separate these modes from slow ones, which may lack independent eigenvectors.
/// If rounding prevents this, the amplitude is the deviation.
[[nodiscard]] Eigen::VectorXd living_amplitudes(const Eigen::MatrixXd& J, double rate, double left,
                                                double least,
                                                const Eigen::VectorXd& deviation) try {
  const LivingModes of_right = living_modes(J, rate, left, least);
  const LivingModes of_left = living_modes(J.transpose(), rate, left, least);
  if (of_right.remains.size() != of_left.remains.size()) return deviation;
  const Eigen::VectorXcd share = solution(of_left.vectors.transpose() * of_right.vectors,
                                          of_left.vectors.transpose() * deviation);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(deviation.size());
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    const double remains = of_right.remains[static_cast<std::size_t>(i)];
    result += remains * std::abs(share[i]) * of_right.vectors.col(i).cwiseAbs();
  }
  return result;
} catch (const ComputationFailed&) {  // no eigenvalues
  return deviation;
}

/// Part by which limits of a step's length are shorter at this accuracy than at 1e-8. Two runs with
/// the same limits would err alike, and their difference would not show it. At a thirtieth of the
/// accuracy the limit is 0.886 times as long, and the error of order 13 a fifth.
[[nodiscard]] double limit_at(const Accuracy& accuracy) {
  return std::pow(accuracy.relative / 1e-8, 1.0 / 28);
}

}  // namespace

RadauStages::RadauStages(const RadauCoefficients& coefficients, int components)
    : value(Eigen::MatrixXd::Zero(components, coefficients.node.size())),
      coefficients_(&coefficients),
      residual_(value),
      change_(value),
      mode_(components),
      pair_(components),
      complex_(coefficients.pairs.size()) {}

void RadauStages::factorise(const Eigen::MatrixXd& J, double h) {
  factorise_shifted(J, coefficients_->real.eigenvalue / h, real_);
  for (std::size_t k = 0; k < complex_.size(); ++k) {
    factorise_shifted(J, coefficients_->pairs[k].eigenvalue / h, complex_[k]);
  }
}

void RadauStages::guess(double begin, double length) {
  // Newton's divided differences through (0, 0) and the old stages.
  const Eigen::VectorXd& c = coefficients_->node;
  const Eigen::Index stages = c.size();
  Eigen::MatrixXd difference = value;
  const auto divide = [&](Eigen::Index i, double distance) {
    for (Eigen::Index r = 0; r < difference.rows(); ++r) {
      difference(r, i) = (difference(r, i) - difference(r, i - 1)) / distance;
    }
  };
  for (Eigen::Index i = stages - 1; i > 0; --i) divide(i, c[i] - c[i - 1]);
  for (Eigen::Index r = 0; r < difference.rows(); ++r) difference(r, 0) /= c[0];
  for (Eigen::Index degree = 2; degree <= stages; ++degree) {
    for (Eigen::Index i = stages - 1; i >= degree - 1; --i) {
      divide(i, c[i] - (i == degree - 1 ? 0 : c[i - degree]));
    }
  }
  const auto at = [&](Eigen::Index r, double x) {
    double sum = difference(r, stages - 1);
    for (Eigen::Index i = stages - 2; i >= 0; --i) sum = difference(r, i) + (x - c[i]) * sum;
    return x * sum;
  };
  for (Eigen::Index r = 0; r < difference.rows(); ++r) {
    const double start = at(r, 1 + begin);
    for (Eigen::Index i = 0; i < stages; ++i) {
      value(r, i) = at(r, 1 + begin + length * c[i]) - start;
    }
  }
}

const Eigen::MatrixXd& RadauStages::correct(const Eigen::MatrixXd& f, double h) {
  set_residual(f, h);
  const auto& real = coefficients_->real;
  combine(residual_, real.covector, mode_);
  real_.solve(mode_);
  for (Eigen::Index j = 0; j < change_.cols(); ++j) {
    for (Eigen::Index i = 0; i < change_.rows(); ++i) change_(i, j) = mode_[i] * real.vector[j];
  }
  for (std::size_t k = 0; k < complex_.size(); ++k) {
    const auto& pair = coefficients_->pairs[k];
    combine(residual_, pair.covector, pair_);
    complex_[k].solve(pair_);
    for (Eigen::Index j = 0; j < change_.cols(); ++j) {
      const std::complex<double> v = pair.vector[j];
      for (Eigen::Index i = 0; i < change_.rows(); ++i) {
        change_(i, j) += 2 * (pair_[i].real() * v.real() - pair_[i].imag() * v.imag());
      }
    }
  }
  value += change_;
  return change_;
}

Eigen::VectorXd RadauStages::sum(const Eigen::VectorXd& weight) const {
  Eigen::VectorXd result(value.rows());
  combine(value, weight, result);
  return result;
}

void RadauStages::solve(Eigen::VectorXd& rate) const { real_.solve(rate); }

void RadauStages::set_residual(const Eigen::MatrixXd& f, double h) {
  const Eigen::MatrixXd& inverse = coefficients_->inverse;
  const Eigen::Index n = value.rows();
  for (Eigen::Index j = 0; j < value.cols(); ++j) {
    double* const column = residual_.col(j).data();
    for (Eigen::Index i = 0; i < n; ++i) column[i] = inverse(j, 0) * value(i, 0);
    for (Eigen::Index k = 1; k < value.cols(); ++k) {
      for (Eigen::Index i = 0; i < n; ++i) column[i] += inverse(j, k) * value(i, k);
    }
    for (Eigen::Index i = 0; i < n; ++i) column[i] = f(i, j) - column[i] / h;
  }
}

RadauIntegrator::RadauIntegrator(const RadauCoefficients& coefficients, double t,
                                 const Eigen::VectorXd& y, const Accuracy& accuracy,
                                 std::span<const int> blocks)
    : coefficients_(&coefficients),
      accuracy_(accuracy),
      sizes_(blocks, accuracy.absolute_scale, y),
      time_{t, 0},
      state_{y, Eigen::VectorXd::Zero(y.size())},
      before_{time_, state_},
      rate_(Eigen::VectorXd::Zero(y.size())),
      stages_(coefficients, static_cast<int>(y.size())),
      rounding_level_(Eigen::VectorXd::Zero(y.size())),
      rates_(stages_.value),
      point_(y) {
  check(accuracy);
  if (!std::isfinite(t)) refuse_steps("the start time is not finite");
  if (!finite(y)) refuse_steps("the state at the start is not finite");
  // The estimate has order s + 1, the step order 2 s. The limit of the estimate is raised
  // accordingly.
  const double order_of_estimate = stages() + 1.0;
  allowed_ = std::max(0.3 * std::pow(accuracy.relative, order_of_estimate / (2 * stages())),
                      accuracy.relative);
}

void RadauIntegrator::begin_step(StiffField& field, double goal) {
  start_time_ = on_this_side(t(), goal, jumps_);
  evaluate(field, start_time_, y(), rate_.data());
  if (!finite(rate_)) stop_integration(t(), "the field is not finite");
  if (step_ == 0) {
    // Where rates are great relative to the sizes of the start, a step must still move time.
    const double least = 64 * std::numeric_limits<double>::epsilon() * std::abs(t());
    step_ = std::max(sizes_.first_step(rate_), least);
  }
  note_jacobian(field);
  const bool at_jump = start_time_ != t();
  if (at_jump) quiet_ = 0;
  if (steps_to_spectrum_ == 0 || at_jump || step_ > 2 * looked_at_) note_spectrum();
  steps_to_spectrum_ = std::max(steps_to_spectrum_ - 1, 0);
  before_ = {time_, state_};
  if (goal > t() ? t() >= rejected_.end : t() <= rejected_.end) rejected_ = {};
}

void RadauIntegrator::note_spectrum() {
  if (tangent_.size() == 0) return;
  constexpr int steps_between = 4;
  const double fastest_before = fastest_;
  const Eigen::VectorXcd found = eigenvalues(tangent_);
  // A double eigenvalue 0 is computed as +- the square root of rounding.
  const double rounding =
      64 * std::numeric_limits<double>::epsilon() * tangent_.cwiseAbs().maxCoeff();
  rates_of_field_.resize(2, found.size());
  fastest_ = 0;
  growth_ = 0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const std::complex<double> rate = found[i];
    rates_of_field_.col(i) << rate.real(), std::abs(rate.imag());
    fastest_ = std::max(fastest_, std::abs(rate));
    if (rate.real() > rounding) growth_ = std::max(growth_, rate.real());
  }
  if (fastest_ > 2 * fastest_before) quiet_ = 0;
  steps_to_spectrum_ = steps_between;
  looked_at_ = step_;
}

double RadauIntegrator::limited(double step) const {
  // A motion too small for the estimate must still grow correctly: a step of 3 time constants errs
  // by 2e-9 of the motion.
  const double limit = growth_ > 0 ? 3 * limit_at(accuracy_) / growth_ : step;
  return std::min({step, limit, barrier_.steps > 0 ? barrier_.length : step});
}

double RadauIntegrator::resolved_angle() const { return 2 * limit_at(accuracy_); }

double RadauIntegrator::fastest_unresolved(double h, double left) const {
  double fastest = 0;
  for (Eigen::Index i = 0; i < rates_of_field_.cols(); ++i) {
    const double size = rates_of_field_.col(i).norm();
    const double remains = std::exp(rates_of_field_(0, i) * left);
    if (size * h <= resolved_angle() || remains < accuracy_.relative) continue;
    fastest = std::max(fastest, size);
  }
  return fastest;
}

void RadauIntegrator::step_towards(StiffField& field, double end, double output) {
  if (!std::isfinite(end)) refuse_steps("the end time is not finite");
  if (end == t()) return;
  const double goal = next_stop(t(), end, jumps_);
  begin_step(field, goal);
  bool again = false;
  while (true) {
    const double left = (goal - time_.value) - time_.rest;
    const double wanted = limited(step_);
    const bool last = is_last(wanted, left);
    last_stage_time_ = on_this_side(goal, t(), jumps_);
    if (!attempt(field, last ? left : std::copysign(wanted, left), output, again)) {
      again = true;
      continue;
    }
    if (last) {
      time_ = {goal, 0};
      step_ = std::max(step_, wanted);
    }
    return;
  }
}

bool RadauIntegrator::try_first_step(StiffField& field, double h, double end, double output) {
  const double goal = next_stop(t(), end, jumps_);
  step_ = h;
  begin_step(field, goal);
  const double left = (goal - time_.value) - time_.rest;
  if (std::abs(left) <= h || limited(h) < h) return false;
  last_stage_time_ = on_this_side(goal, t(), jumps_);
  return attempt(field, std::copysign(h, left), output, false);
}

bool RadauIntegrator::covers(double time) const {
  return time >= std::min(before_.time.value, t()) && time <= std::max(before_.time.value, t());
}

Eigen::VectorXd RadauIntegrator::at(StiffField& field, double time) {
  if (!covers(time)) {
    refuse_steps("t = ", time, " s lies outside the last step, [", before_.time.value, ", ", t(),
                 "] s");
  }
  if (time == t()) return y();
  if (time == before_.time.value) return before_.state.value;
  kept_ = stages_.value;
  const double h = (time - before_.time.value) - before_.time.rest;
  stages_.factorise(tangent_, h);
  stages_.guess(-1, h / h_before_);
  const bool done = solve_stages(field, before_.time, before_.state, h);
  Eigen::VectorXd there =
      before_.state.value + (stages_.value.col(stages() - 1) + before_.state.rest);
  stages_.value = kept_;
  if (done) {
    field.project(there);
    return there;
  }
  RadauIntegrator shorter = *this;
  shorter.time_ = before_.time;
  shorter.state_ = before_.state;
  shorter.h_before_ = 0;
  shorter.step_ = std::abs(h) / 4;
  while (shorter.t() != time) shorter.step_towards(field, time, time);
  effort_ = shorter.effort_;
  return shorter.y();
}

void RadauIntegrator::jump_to(const Eigen::VectorXd& y) {
  state_ = {y, Eigen::VectorXd::Zero(y.size())};
  h_before_ = 0;  // the stages are not a guess for the next step
  sizes_.note(y);
}

void RadauIntegrator::undo_step(const Notes& notes) {
  time_ = before_.time;
  state_ = before_.state;
  sizes_ = notes.sizes;
  rounding_level_ = notes.rounding_level;
  h_before_ = 0;
}

void RadauIntegrator::back_to(StiffField& field, double time) {
  const Eigen::VectorXd there = at(field, time);
  time_ = {time, 0};
  state_ = {there, Eigen::VectorXd::Zero(there.size())};
  before_ = {time_, state_};
  h_before_ = 0;
}

double RadauIntegrator::rounding_level() const {
  return sizes_.relative(rounding_level_.cwiseSqrt(),
                         Eigen::VectorXd::Zero(rounding_level_.size()));
}

void RadauIntegrator::evaluate(StiffField& field, double t, const Eigen::VectorXd& y,
                               double* result) {
  effort_.evaluations += 1;
  field.rate(t, y, result);
}

bool RadauIntegrator::try_rate(StiffField& field, double at, double* result) {
  return failure_.succeeds(t(), [&] { evaluate(field, at, point_, result); });
}

void RadauIntegrator::note_jacobian(StiffField& field) {
  effort_.jacobians += 1;
  tangent_.resize(y().size(), y().size());
  field.jacobian(start_time_, y(), tangent_);
  if (!finite(tangent_)) stop_integration(t(), "the Jacobian of the field is not finite");
}

bool RadauIntegrator::solve_stages(StiffField& field, const Compensated<double>& time,
                                   const Compensated<Eigen::VectorXd>& state, double h) {
  constexpr int most_iterations = 12;
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  // The remaining error of the iteration has the same sign in every step. It must stay below
  // rounding.
  const double enough = std::max(accuracy_.relative / 20, rounding / 64);
  // Rounding in a stiff field ends the descent before rounding of the state does.
  const double stalled = 1e3 * std::max(accuracy_.relative / 20, rounding);
  // The first change belongs to the guess, often to motions that one iteration solves. Others then
  // shrink more slowly than the second change suggests: it proves no faster descent than this.
  double shrank = 0.1;
  double change_before = std::numeric_limits<double>::infinity();
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    for (int i = 0; i < stages(); ++i) {
      const double at = time.value + (coefficients_->node[i] * h + time.rest);
      const bool late = h > 0 ? at > last_stage_time_ : at < last_stage_time_;
      point_ = state.value + (stages_.value.col(i) + state.rest);
      if (!try_rate(field, late ? last_stage_time_ : at, rates_.col(i).data())) return false;
    }
    if (!finite(rates_)) return false;
    const Eigen::MatrixXd& correction = stages_.correct(rates_, h);
    double change = 0;
    for (int i = 0; i < stages(); ++i) {
      change = std::max(change, sizes_.relative(correction.col(i), stages_.value.col(i)));
    }
    if (!std::isfinite(change)) return false;
    if (change <= std::min(enough, rounding) || change_before <= rounding) return true;
    if (iteration > 1) {
      const double shrinks = change / change_before;
      if (shrinks >= 1) return change <= stalled;
      const double slowest = std::max(shrinks, std::exchange(shrank, shrinks));
      if (slowest / (1 - slowest) * change <= enough) return true;
      const double at_the_end = std::pow(shrinks, most_iterations - iteration) * change;
      if (at_the_end > enough && change > stalled) return false;
    }
    change_before = change;
  }
  return change_before <= stalled;
}

bool RadauIntegrator::jumps_within(double h, double worst) const {
  if (rejected_.step == 0) return false;
  const double shortened = std::abs(h) / rejected_.step;
  return worst > rejected_.worst * shortened * shortened;
}

double RadauIntegrator::least_allowed() const {
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  return std::min(1.0, std::max(accuracy_.relative, rounding) / allowed_);
}

double RadauIntegrator::estimate(double h) {
  change_ = stages_.value.col(stages() - 1);
  from_stages_ = stages_.sum(coefficients_->error) / h;
  error_ = rate_ + from_stages_;
  stages_.solve(error_);
  return sizes_.relative(error_, change_) / allowed_;
}

double RadauIntegrator::filtered_estimate(StiffField& field) {
  point_ = y() + error_;
  if (!try_rate(field, start_time_, error_.data())) return std::numeric_limits<double>::infinity();
  error_ += from_stages_;
  stages_.solve(error_);
  return sizes_.relative(error_, change_) / allowed_;
}

double RadauIntegrator::living_amplitude(double h, double left) {
  const Eigen::VectorXd rounding = rounding_of_step().cwiseSqrt();
  for (Eigen::Index i = 0; i < point_.size(); ++i) {
    const double beyond = std::max(std::abs(error_[i]) - 8 * rounding[i], 0.0);
    point_[i] = std::copysign(beyond, error_[i]);
  }
  const Eigen::VectorXd amplitude =
      living_amplitudes(tangent_, resolved_angle() / h, left, accuracy_.relative, point_);
  return sizes_.relative(amplitude, change_) / allowed_;
}

RadauIntegrator::Verdict RadauIntegrator::judge(StiffField& field, double h, double output,
                                                bool again) {
  const double left = std::abs(output - t());
  Verdict verdict{.worst = estimate(h)};
  const double fastest = fastest_unresolved(std::abs(h), left);
  verdict.looks_new = fastest > 0 && quiet_ == 0;
  if (verdict.looks_new) {
    const double amplitude = living_amplitude(std::abs(h), left);
    if (!(amplitude < least_allowed())) return {amplitude, least_allowed(), true, fastest};
  }
  if (verdict.worst >= 1 && (again || effort_.steps == 0 || verdict.looks_new)) {
    verdict.worst = filtered_estimate(field);
  }
  if (only_rounds(h, verdict.worst)) return verdict;
  if (jumps_within(h, verdict.worst)) {
    verdict.most = least_allowed();
  } else if (verdict.worst > least_allowed() && is_rough(std::abs(h))) {
    const double filtered = filtered_estimate(field);
    if (!(filtered < least_allowed())) {
      verdict.worst = filtered;
      verdict.most = least_allowed();
    }
  }
  return verdict;
}

bool RadauIntegrator::only_rounds(double h, double worst) const {
  if (std::abs(h) <= 64 * std::numeric_limits<double>::epsilon() * std::abs(t())) return true;
  constexpr double greatest_rounding = 1e-11;
  if (rejected_.step == 0 || worst * allowed_ > greatest_rounding) return false;
  return worst > rejected_.worst * std::sqrt(std::abs(h) / rejected_.step);
}

bool RadauIntegrator::is_rough(double h) const {
  constexpr int enough =
      7;  // with fewer stages smooth motions seem rough: steps are up to four times as many
  if (stages() < enough) return false;
  // An unresolved oscillation is no corner. One that outlasts the step dies before the output.
  constexpr double gone = 1e-2;
  for (Eigen::Index i = 0; i < rates_of_field_.cols(); ++i) {
    const double angle = rates_of_field_.col(i).norm() * h;
    if (angle > resolved_angle() && std::exp(rates_of_field_(0, i) * h) > gone) return false;
  }
  const Eigen::VectorXd error = error_by_decay(coefficients_->node, stages_.value);
  constexpr double rounding_of_forces = 1e-12;
  return sizes_.relative(error, change_) > std::max(least_allowed() * allowed_, rounding_of_forces);
}

void RadauIntegrator::reject(double h, double worst, double most, double fastest) {
  const double root = 1.0 / (stages() + 1);
  stages_.value = kept_;
  effort_.rejected += 1;
  const double aim = std::isfinite(worst) ? 0.9 * std::pow(worst / most, -root) : 0.125;
  step_ = std::abs(h) * std::clamp(aim, 0.125, 0.9);
  if (fastest > 0) {
    barrier_.length = resolved_angle() / fastest;
    barrier_.take();
  }
  rejected_ = {t() + h, std::abs(h), worst};
}

bool RadauIntegrator::attempt(StiffField& field, double h, double output, bool again) {
  if (std::abs(h) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t()) || h == 0) {
    failure_.stop(t());
    stop_integration(t(), "the step has become too short to move time on");
  }
  if (effort_.evaluations > accuracy_.max_evaluations) {
    stop_without_evaluations(t(), accuracy_.max_evaluations);
  }
  kept_ = stages_.value;
  stages_.factorise(tangent_, h);
  if (h_before_ == 0) {
    stages_.value.setZero();
  } else {
    stages_.guess(0, h / h_before_);
  }
  if (!solve_stages(field, time_, state_, h)) {
    stages_.value = kept_;
    effort_.rejected += 1;
    step_ = std::abs(h) / 4;
    return false;
  }
  const Verdict verdict = judge(field, h, output, again);
  if (!(verdict.worst < verdict.most)) {
    reject(h, verdict.worst, verdict.most, verdict.lives);
    return false;
  }
  quiet_ = std::max(quiet_ - 1, 0);
  // The estimate of a step that nearly resolves a motion is smaller than its amplitude.
  constexpr double shows_amplitude = 10;
  if (verdict.looks_new && fastest_ * std::abs(h) > shows_amplitude) {
    constexpr int steps_between = 16;
    quiet_ = steps_between;
    barrier_.patience = 8;
  }
  barrier_.steps = std::max(barrier_.steps - 1, 0);
  set_next_step(h, std::max(verdict.worst, 1e-8), again);
  h_before_ = h;
  effort_.steps += 1;
  note_rounding();
  state_.add(change_);
  field.project(state_.value);
  time_.add(h);
  sizes_.note(y());
  return true;
}

void RadauIntegrator::set_next_step(double h, double worst, bool again) {
  const double root = 1.0 / (stages() + 1);
  double aim = 0.9 * std::pow(worst, -root);
  if (h_before_ != 0) {
    aim = std::min(aim, aim * std::abs(h / h_before_) * std::pow(worst_before_ / worst, root));
  }
  step_ = std::abs(h) * std::clamp(aim, 0.2, again ? 1.0 : 8.0);
  worst_before_ = std::max(worst, 1e-2);
}

Eigen::VectorXd RadauIntegrator::rounding_of_step() {
  constexpr double half_digit = std::numeric_limits<double>::epsilon() / 2;
  const double part = half_digit * coefficients_->real.eigenvalue / std::sqrt(double(stages()));
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(y().size());
  for (Eigen::Index j = 0; j < squares.size(); ++j) {
    point_ = part * std::abs(y()[j]) * tangent_.col(j);
    stages_.solve(point_);
    squares += point_.cwiseAbs2();
  }
  return squares;
}

void RadauIntegrator::note_rounding() {
  for (Eigen::Index j = 0; j < rounding_level_.size(); ++j) {
    point_.setZero();
    point_[j] = 1;
    stages_.solve(point_);
    const double stays = point_[j] * coefficients_->real.eigenvalue / h_before_;
    rounding_level_[j] *= std::min(1.0, stays * stays);
  }
  rounding_level_ += rounding_of_step();
}

}  // namespace kreisel::detail
