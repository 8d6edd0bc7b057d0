#include <Eigen/LU>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <string>

#include <dynamics/study/harmonic_response.hpp>
#include <motor/error.hpp>

namespace kreisel {

namespace {

using Complex = std::complex<double>;
using Eigen::Index, Eigen::MatrixXcd, Eigen::MatrixXd;

void check(double period, const std::vector<LinearPlant>& samples) {
  if (!(period > 0 && std::isfinite(period))) {
    throw InvalidInput("periodic plant: the period must be finite and above 0 s");
  }
  if (samples.size() < 8 || samples.size() % 4 != 0) {
    throw InvalidInput("periodic plant: the number of samples must be a multiple of 4 from 8 on");
  }
  for (const LinearPlant& sample : samples) {
    if (sample.period > 0) {
      throw InvalidInput("periodic plant: a controller is sampled; make it continuous");
    }
    if (sample.names != samples.front().names) {
      throw InvalidInput(
          "periodic plant: constraints leave other coordinates free along the motion; choose "
          "joints so that fewer constraints are needed");
    }
  }
}

/// The Fourier coefficients of a matrix for |k| <= 2 most; those beyond half of the samples are 0.
template <class MatrixOf>
std::vector<MatrixXcd> coefficients(const std::vector<LinearPlant>& samples, int most,
                                    const MatrixOf& matrix_of) {
  const auto count = static_cast<int>(samples.size());
  std::vector<MatrixXcd> result;
  for (int k = -2 * most; k <= 2 * most; ++k) {
    MatrixXcd sum = MatrixXcd::Zero(matrix_of(samples[0]).rows(), matrix_of(samples[0]).cols());
    for (int j = 0; j < count && 2 * std::abs(k) < count; ++j) {
      const double angle = -2 * std::numbers::pi * ((j * k) % count) / count;
      sum += std::polar(1.0 / count, angle) * matrix_of(samples[static_cast<std::size_t>(j)]);
    }
    result.push_back(std::move(sum));
  }
  return result;
}

}  // namespace

PeriodicPlant::PeriodicPlant(double period, const std::vector<LinearPlant>& samples)
    : period_(period), most_(static_cast<int>(samples.size()) / 4) {
  check(period, samples);
  inputs_ = static_cast<Index>(samples[0].inputs.size());
  states_ =
      coefficients(samples, most_, [](const LinearPlant& p) -> const MatrixXd& { return p.A; });
  outputs_ =
      coefficients(samples, most_, [](const LinearPlant& p) -> const MatrixXd& { return p.C; });
  for (std::size_t i = 0; i < samples[0].columns.size(); ++i) {
    columns_.push_back({samples[0].columns[i].input, samples[0].columns[i].power});
    forces_.push_back(coefficients(
        samples, most_, [i](const LinearPlant& p) -> MatrixXd { return p.columns[i].B; }));
    direct_.push_back(coefficients(
        samples, most_, [i](const LinearPlant& p) -> MatrixXd { return p.columns[i].D; }));
  }
}

MatrixXcd PeriodicPlant::stacked(const std::vector<Coefficients>& columns, double w) const {
  const Index rows = at(columns.front(), 0).rows();
  MatrixXcd result = MatrixXcd::Zero(rows * (2 * most_ + 1), inputs_);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const Complex factor = std::pow(Complex(0, w), columns_[i].power);
    for (int l = -most_; l <= most_; ++l) {
      result.col(columns_[i].input).segment(rows * (l + most_), rows) += factor * at(columns[i], l);
    }
  }
  return result;
}

std::vector<MatrixXcd> PeriodicPlant::response(double w, int harmonics) const {
  if (!(w > 0 && std::isfinite(w))) {
    throw InvalidInput("response: the frequency must be finite and above 0 rad/s");
  }
  if (harmonics < 0 || harmonics > most_) {
    throw InvalidInput("response: at most " + std::to_string(most_) +
                       " harmonics: take more samples of the period");
  }
  const Index n = at(states_, 0).rows();
  const int blocks = 2 * most_ + 1;
  MatrixXcd balance(n * blocks, n * blocks);
  for (int l = 0; l < blocks; ++l) {
    for (int m = 0; m < blocks; ++m) balance.block(n * l, n * m, n, n) = -at(states_, l - m);
    const double rate = w + (l - most_) * 2 * std::numbers::pi / period_;
    balance.block(n * l, n * l, n, n).diagonal().array() += Complex(0, rate);
  }
  const MatrixXcd X = balance.partialPivLu().solve(stacked(forces_, w));
  const MatrixXcd direct = stacked(direct_, w);
  std::vector<MatrixXcd> result;
  for (int l = most_ - harmonics; l <= most_ + harmonics; ++l) {
    const Index rows = at(outputs_, 0).rows();
    MatrixXcd H = direct.middleRows(rows * l, rows);
    for (int m = 0; m < blocks; ++m) H += at(outputs_, l - m) * X.middleRows(n * m, n);
    if (!H.allFinite()) {
      throw ComputationFailed("response: an undamped resonance lies at the frequency of " +
                              std::to_string(w) + " rad/s");
    }
    result.push_back(std::move(H));
  }
  return result;
}

}  // namespace kreisel
