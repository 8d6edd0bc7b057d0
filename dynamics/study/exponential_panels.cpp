#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <sstream>
#include <utility>

#include <dynamics/study/exponential_panels.hpp>
#include <motor/error.hpp>

namespace kreisel {

using Eigen::MatrixXd, Eigen::VectorXd;

namespace {

using AtNodes = Eigen::Matrix<double, panel_nodes, panel_nodes>;
using Fractions = ExponentialPanels::Fractions;

/// P_0 .. P_n at x in [-1, 1].
template <int n>
Eigen::Matrix<double, n + 1, 1> legendre(double x) {
  Eigen::Matrix<double, n + 1, 1> P;
  P[0] = 1;
  P[1] = x;
  for (int k = 1; k < n; ++k) P[k + 1] = ((2 * k + 1) * x * P[k] - k * P[k - 1]) / (k + 1);
  return P;
}

/// Gauss nodes and weights on [0, 1], by Newton's method.
struct Gauss {
  Fractions node;
  Fractions weight;

  Gauss() {
    for (int i = 0; i < panel_nodes; ++i) {
      double x = -std::cos(std::numbers::pi * (i + 0.75) / (panel_nodes + 0.5));
      double slope = 0;
      for (int step = 0; step < 8; ++step) {
        const auto P = legendre<panel_nodes>(x);
        slope = panel_nodes * (x * P[panel_nodes] - P[panel_nodes - 1]) / (x * x - 1);
        x -= P[panel_nodes] / slope;
      }
      node[i] = (1 + x) / 2;
      weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
  }
};

const Gauss& gauss() {
  static const Gauss rule;
  return rule;
}

/// Column j has P_0 .. P_m-1 at the place in [from, to] of node j.
AtNodes polynomials(double from, double to) {
  AtNodes P;
  for (int j = 0; j < panel_nodes; ++j) {
    const double place = from + (to - from) * gauss().node[j];
    P.col(j) = legendre<panel_nodes>(2 * place - 1).template head<panel_nodes>();
  }
  return P;
}

/// Values at the nodes, as rows, to coefficients: (2 k + 1) w_j P_k(x_j).
const AtNodes& to_coefficients() {
  static const AtNodes matrix = [] {
    AtNodes m = gauss().weight.asDiagonal() * polynomials(0, 1).transpose();
    for (int k = 0; k < panel_nodes; ++k) m.col(k) *= 2 * k + 1;
    return m;
  }();
  return matrix;
}

/// Row k has the coefficients of P_k on the part [from, to] of its panel.
AtNodes restriction(double from, double to) { return polynomials(from, to) * to_coefficients(); }

/// e^(B s), and W_k(s) for polynomials on [0, s].
struct Weights {
  MatrixXd exponential;
  std::array<MatrixXd, panel_nodes> W;
};

/// The Taylor series for |B| s < 1/2:  W_k = sum_p s^(p+1) B^p (-1)^k p!/((p-k)! (p+k+1)!).
Weights short_weights(const MatrixXd& B, double s) {
  const Eigen::Index n = B.rows();
  Weights result;
  result.exponential = MatrixXd::Identity(n, n);
  result.W.fill(MatrixXd::Zero(n, n));
  MatrixXd power = MatrixXd::Identity(n, n);  // (B s)^p
  double factorial = 1;
  for (int p = 0; p <= 22; ++p) {
    if (p > 0) {
      power *= s * B;
      factorial *= p;
      result.exponential += power / factorial;
    }
    // p!/((p-k)! (p+k+1)!) for k = 0, 1, ..
    double share = 1 / (factorial * (p + 1));
    for (int k = 0; k <= std::min(p, panel_nodes - 1); ++k) {
      result.W[std::size_t(k)] += (k % 2 == 0 ? s : -s) * share * power;
      share *= double(p - k) / (p + k + 2);
    }
  }
  return result;
}

std::array<MatrixXd, panel_nodes> combined(const AtNodes& shares,
                                           const std::array<MatrixXd, panel_nodes>& W) {
  std::array<MatrixXd, panel_nodes> result;
  for (int k = 0; k < panel_nodes; ++k) {
    result[std::size_t(k)] = MatrixXd::Zero(W[0].rows(), W[0].cols());
    for (int l = 0; l < panel_nodes; ++l)
      result[std::size_t(k)] += shares(k, l) * W[std::size_t(l)];
  }
  return result;
}

Weights weights(const MatrixXd& B, double s) {
  static const AtNodes left = restriction(0, 0.5);
  static const AtNodes right = restriction(0.5, 1);
  const double size = B.cwiseAbs().colwise().sum().maxCoeff() * s;
  const int doublings = size > 0.5 ? static_cast<int>(std::ceil(std::log2(2 * size))) : 0;
  Weights result = short_weights(B, std::ldexp(s, -doublings));
  for (int i = 0; i < doublings; ++i) {
    const auto of_left = combined(left, result.W);
    const auto of_right = combined(right, result.W);
    for (std::size_t k = 0; k < panel_nodes; ++k) {
      result.W[k].noalias() = result.exponential * of_left[k];
      result.W[k] += of_right[k];
    }
    result.exponential = (result.exponential * result.exponential).eval();
  }
  return result;
}

/// Powers of two D for which the rows and columns of D^-1 A D are about equally large.
VectorXd balance_of(const MatrixXd& A) {
  VectorXd D = VectorXd::Ones(A.rows());
  for (int sweep = 0; sweep < 20; ++sweep) {
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      const double own = std::abs(A(i, i));
      const double row = (A.row(i).cwiseAbs() * D.asDiagonal()).sum() / D[i] - own;
      const double column = A.col(i).cwiseAbs().cwiseQuotient(D).sum() * D[i] - own;
      if (!(row > 0 && column > 0)) continue;
      D[i] *= std::exp2(std::round(std::log2(row / column) / 2));
    }
  }
  return D;
}

}  // namespace

ExponentialPanels::ExponentialPanels(const MatrixXd& A)
    : matrix_(A),
      balance_(balance_of(A)),
      balanced_(balance_.cwiseInverse().asDiagonal() * A * balance_.asDiagonal()) {}

const ExponentialPanels::Fractions& ExponentialPanels::fractions() { return gauss().node; }

MatrixXd ExponentialPanels::coefficients(const MatrixXd& values) {
  return values * to_coefficients();
}

MatrixXd ExponentialPanels::on_part(const MatrixXd& coefficients, double from, double to) {
  return coefficients * restriction(from, to);
}

MatrixXd ExponentialPanels::values(const MatrixXd& coefficients) {
  static const AtNodes at_nodes = polynomials(0, 1);
  MatrixXd result(coefficients.rows(), panel_nodes + 1);
  result.leftCols(panel_nodes) = coefficients * at_nodes;
  result.col(panel_nodes) = coefficients.rowwise().sum();  // P_k(1) = 1
  return result;
}

MatrixXd ExponentialPanels::derivative(const MatrixXd& coefficients) {
  // P_k' = sum over j = k - 1, k - 3, .. of (2 j + 1) P_j, and the chain rule's 2.
  MatrixXd result = MatrixXd::Zero(coefficients.rows(), panel_nodes);
  for (int k = 1; k < panel_nodes; ++k) {
    for (int j = k - 1; j >= 0; j -= 2) {
      result.col(j) += 2 * (2 * j + 1) * coefficients.col(k);
    }
  }
  return result;
}

MatrixXd ExponentialPanels::solution(double h, const VectorXd& start,
                                     const MatrixXd& coefficients) const {
  const Propagator& of = propagator(h);
  MatrixXd x(start.size(), panel_nodes + 1);
  const Eigen::Map<const VectorXd> force(coefficients.data(), coefficients.size());
  Eigen::Map<VectorXd> all(x.data(), x.size());
  all.noalias() = of.of_start * start;
  all.noalias() += of.of_force * force;
  return x;
}

VectorXd ExponentialPanels::contribution(const Propagator& of, const MatrixXd& coefficients,
                                         int k) const {
  const Eigen::Index n = matrix_.rows();
  VectorXd result = VectorXd::Zero(n);
  for (int i = 0; i <= panel_nodes; ++i) {
    const VectorXd even = of.of_force.block(i * n, k * n, n, n) * coefficients.col(k);
    const VectorXd odd = of.of_force.block(i * n, (k + 1) * n, n, n) * coefficients.col(k + 1);
    result = result.cwiseMax(even.cwiseAbs() + odd.cwiseAbs());
  }
  return result;
}

VectorXd ExponentialPanels::truncation(double h, const MatrixXd& coefficients) const {
  const Propagator& of = propagator(h);
  const VectorXd last = contribution(of, coefficients, panel_nodes - 2);
  const VectorXd before = contribution(of, coefficients, panel_nodes - 4);
  VectorXd result = last;
  for (Eigen::Index i = 0; i < last.size(); ++i) {
    if (last[i] < before[i]) result[i] *= last[i] / before[i];
  }
  return result;
}

const ExponentialPanels::Propagator& ExponentialPanels::propagator(double h) const {
  // Lengths of panels that differ by the rounding of their times are the same.
  const auto near = known_.lower_bound(h * (1 - 1e-12));
  if (near != known_.end() && near->first <= h * (1 + 1e-12)) return near->second;
  if (known_.size() >= 256) known_.clear();
  const Eigen::Index n = matrix_.rows();
  Propagator result{MatrixXd((panel_nodes + 1) * n, n),
                    MatrixXd((panel_nodes + 1) * n, panel_nodes * n)};
  const auto unbalanced = [this](const MatrixXd& M) {
    return MatrixXd(balance_.asDiagonal() * M * balance_.cwiseInverse().asDiagonal());
  };
  for (int i = 0; i <= panel_nodes; ++i) {
    const double fraction = i < panel_nodes ? fractions()[i] : 1;
    const Weights own = weights(balanced_, fraction * h);
    const auto W = combined(restriction(0, fraction), own.W);
    result.of_start.middleRows(i * n, n) = unbalanced(own.exponential);
    for (int k = 0; k < panel_nodes; ++k) {
      result.of_force.block(i * n, k * n, n, n) = unbalanced(W[std::size_t(k)]);
    }
  }
  return known_.emplace(h, std::move(result)).first->second;
}

PanelSequence::PanelSequence(double begin, std::vector<double> stops)
    : begin_(begin), stops_(std::move(stops)) {
  std::erase_if(stops_, [begin](double t) { return !(t > begin); });
}

double PanelSequence::interval_length() const { return stops_[interval_] - begin_; }

double PanelSequence::begin() const {
  return begin_ + std::ldexp(interval_length() * double(part_), -level_);
}

double PanelSequence::length() const { return std::ldexp(interval_length(), -level_); }

void PanelSequence::halve() {
  if (level_ == 48) {
    std::ostringstream text;
    text << "no panel after t = " << begin() << " s is short enough for the equations";
    throw ComputationFailed(text.str());
  }
  ++level_;
  part_ *= 2;
}

bool PanelSequence::advance(bool longer) {
  ++part_;
  if (part_ < 1LL << level_) {
    if (longer && part_ % 2 == 0) {
      --level_;
      part_ /= 2;
    }
    return false;
  }
  const double length = this->length();
  begin_ = stops_[interval_];
  ++interval_;
  part_ = 0;
  if (done()) return true;
  const double ratio = interval_length() / (longer ? 2 * length : length);
  level_ = ratio > 1 ? std::min(48, static_cast<int>(std::ceil(std::log2(ratio * (1 - 1e-9))))) : 0;
  return true;
}

}  // namespace kreisel
