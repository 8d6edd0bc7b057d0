#include <Eigen/LU>
#include <unsupported/Eigen/MatrixFunctions>

#include <cmath>
#include <complex>
#include <vector>

#include <dynamics/study/linear_plant.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

/// The regime xi(t) = eta(t) e^(-s t) of a plant under u = e^(s t): it has the period of the
/// samples,  xi' = (A - s) xi + B,  and jumps by J and G.
class PeriodicRegime {
 public:
  PeriodicRegime(const LinearPlant& plant, const Complex& s, const MatrixXcd& B)
      : plant_(plant), n_(plant.A.rows()), inputs_(B.cols()) {
    // The exponential of ((A - s, B, 0), (0, 0, 0), (1, 0, 0)) moves xi, 1 and the integral of xi.
    generator_ = MatrixXcd::Zero(2 * n_ + inputs_, 2 * n_ + inputs_);
    generator_.topLeftCorner(n_, n_) = plant.A.cast<Complex>() - s * MatrixXcd::Identity(n_, n_);
    generator_.block(0, n_, n_, inputs_) = B;
    generator_.bottomLeftCorner(n_, n_).setIdentity();
  }

  /// The mean of xi over a period.
  ///
  /// jumps : G for each sample
  [[nodiscard]] MatrixXcd mean(const std::vector<MatrixXcd>& jumps) const {
    MatrixXcd xi =
        MatrixXcd::Identity(n_, n_ + inputs_);  // from xi at the begin and from the input
    MatrixXcd sum = MatrixXcd::Zero(n_, n_ + inputs_);
    double now = 0;
    for (std::size_t k = 0; k < plant_.samples.size(); ++k) {
      flow(plant_.samples[k].time - now, xi, sum);
      now = plant_.samples[k].time;
      xi = (plant_.samples[k].J.cast<Complex>() * xi).eval();
      xi.rightCols(inputs_) += jumps[k];
    }
    flow(plant_.period - now, xi, sum);
    const MatrixXcd open = MatrixXcd::Identity(n_, n_) - xi.leftCols(n_);
    const MatrixXcd begin = open.fullPivLu().solve(MatrixXcd(xi.rightCols(inputs_)));
    return (sum.leftCols(n_) * begin + sum.rightCols(inputs_)) / plant_.period;
  }

 private:
  void flow(double length, MatrixXcd& xi, MatrixXcd& sum) const {
    if (!(length > 0)) return;
    const MatrixXcd E = (generator_ * length).exp();
    MatrixXcd from_input = MatrixXcd::Zero(n_, n_ + inputs_);
    from_input.rightCols(inputs_) = E.block(0, n_, n_, inputs_);
    MatrixXcd sum_of_input = MatrixXcd::Zero(n_, n_ + inputs_);
    sum_of_input.rightCols(inputs_) = E.block(n_ + inputs_, n_, n_, inputs_);
    sum += E.bottomLeftCorner(n_, n_) * xi + sum_of_input;
    xi = (E.topLeftCorner(n_, n_) * xi + from_input).eval();
  }

  const LinearPlant& plant_;
  Index n_;
  Index inputs_;
  MatrixXcd generator_;
};

/// The columns of a plant that are no integrals of inputs.
std::vector<const LinearPlant::Column*> shown_columns(const LinearPlant& plant) {
  std::vector<const LinearPlant::Column*> columns;
  for (const LinearPlant::Column& column : plant.columns) {
    if (column.power >= 0) columns.push_back(&column);
  }
  return columns;
}

/// Advances (A, B) of a transition by a flow of the given length with held inputs.
void advance(const MatrixXd& A, const MatrixXd& B, double length, StateSpace& result) {
  if (!(length > 0)) return;
  const Index n = A.rows();
  MatrixXd generator = MatrixXd::Zero(n + B.cols(), n + B.cols());
  generator.topLeftCorner(n, n) = A;
  generator.topRightCorner(n, B.cols()) = B;
  const MatrixXd E = detail::exponential(generator * length);
  result.A = (E.topLeftCorner(n, n) * result.A).eval();
  result.B = (E.topLeftCorner(n, n) * result.B + E.topRightCorner(n, B.cols())).eval();
}

}  // namespace

StateSpace state_space(const LinearPlant& plant) {
  StateSpace result;
  const auto columns = shown_columns(plant);
  const auto count = static_cast<Index>(columns.size());
  MatrixXd B(plant.A.rows(), count);
  result.D.resize(plant.C.rows(), count);
  for (Index k = 0; k < count; ++k) {
    const LinearPlant::Column& column = *columns[static_cast<std::size_t>(k)];
    const PlantInput& input = plant.inputs[static_cast<std::size_t>(column.input)];
    result.inputs.push_back({input.name, input.unit, column.power});
    B.col(k) = column.B;
    result.D.col(k) = column.D;
  }
  if (plant.period == 0) {
    result.A = plant.A;
    result.B = B;
    return result;
  }
  result.A = MatrixXd::Identity(plant.A.rows(), plant.A.cols());
  result.B = MatrixXd::Zero(B.rows(), B.cols());
  double now = 0;
  for (std::size_t i = 0; i < plant.samples.size(); ++i) {
    advance(plant.A, B, plant.samples[i].time - now, result);
    now = plant.samples[i].time;
    result.A = (plant.samples[i].J * result.A).eval();
    result.B = (plant.samples[i].J * result.B).eval();
    for (Index k = 0; k < count; ++k) {
      result.B.col(k) += columns[static_cast<std::size_t>(k)]->G[i];
    }
  }
  advance(plant.A, B, plant.period - now, result);
  return result;
}

namespace detail {

std::vector<LinearPlant::Column> columns_of(const std::vector<PlantInput>& inputs) {
  std::vector<LinearPlant::Column> columns;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto* const turn = std::get_if<PlantInput::GuideTurn>(&inputs[i].kind);
    const int first = turn != nullptr && turn->is_rate ? -1 : 0;
    const int count = turn != nullptr ? 3 : 1;
    for (int k = 0; k < count; ++k) columns.push_back({static_cast<int>(i), first + k});
  }
  return columns;
}

}  // namespace detail

MatrixXcd LinearPlant::response(double w) const {
  if (!(w > 0 && std::isfinite(w))) {
    throw InvalidInput("response: the frequency must be finite and above 0 rad/s");
  }
  const Complex s(0, w);
  const auto count = static_cast<Index>(inputs.size());
  MatrixXcd B = MatrixXcd::Zero(A.rows(), count);
  MatrixXcd D = MatrixXcd::Zero(C.rows(), count);
  std::vector<MatrixXcd> G(samples.size(), MatrixXcd::Zero(A.rows(), count));
  for (const Column& column : columns) {
    const Complex factor = std::pow(s, column.power);
    B.col(column.input) += factor * column.B;
    D.col(column.input) += factor * column.D;
    for (std::size_t k = 0; k < G.size(); ++k) G[k].col(column.input) += factor * column.G[k];
  }
  MatrixXcd eta;
  if (period > 0) {
    eta = PeriodicRegime(*this, s, B).mean(G);
  } else {
    const MatrixXcd open = s * MatrixXcd::Identity(A.rows(), A.cols()) - A;
    eta = open.fullPivLu().solve(B);
  }
  MatrixXcd result = C * eta + D;
  if (!result.allFinite()) {
    throw ComputationFailed("response: an undamped resonance lies at the frequency of " +
                            std::to_string(w) + " rad/s");
  }
  return result;
}

}  // namespace kreisel
