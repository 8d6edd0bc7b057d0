#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dynamics/study/free_directions.hpp>

namespace kreisel {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Conditions that are below this part of the greatest follow from the others.
constexpr double least = 1e-10;

/// The rows with length 1. Rows much shorter than the longest stay short. Their conditions move
/// next to nothing at this position, and their rounding would count as a direction.
MatrixXd normalized_rows(const MatrixXd& rows) {
  constexpr double shortest = 1e-4;
  const VectorXd norms = rows.rowwise().norm();
  if (rows.size() == 0 || norms.maxCoeff() == 0) return rows;
  return norms.cwiseMax(shortest * norms.maxCoeff()).cwiseInverse().asDiagonal() * rows;
}

/// The candidates among the columns of G that the other columns determine, by pivoting.
std::vector<int> pivots(const MatrixXd& G, const std::vector<int>& candidates) {
  const MatrixXd among = normalized_rows(G)(Eigen::all, candidates);
  if (among.size() == 0) return {};
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
  qr.setThreshold(least);
  qr.compute(among);
  std::vector<int> chosen;
  for (Index k = 0; k < qr.rank(); ++k) {
    const int column = qr.colsPermutation().indices()[k];
    chosen.push_back(candidates[static_cast<std::size_t>(column)]);
  }
  return chosen;
}

}  // namespace

bool FreeDirections::is_dependent(int component) const {
  return std::binary_search(dependent.begin(), dependent.end(), component);
}

VectorXd FreeDirections::complete(const VectorXd& eta) const {
  return bound() ? VectorXd(N * eta(independent)) : eta;
}

MatrixXd FreeDirections::unit_moves(int dimension) const {
  return bound() ? detail::with_columns(N, independent, dimension)
                 : MatrixXd::Identity(dimension, dimension);
}

namespace detail {

FreeDirections free_directions(const MatrixXd& slopes, const std::vector<int>& given, int rates) {
  const Index conditions = slopes.rows() / 2;
  const auto open = [&given](int begin, int end) {
    std::vector<int> components;
    for (int i = begin; i < end; ++i) {
      if (std::find(given.begin(), given.end(), i) == given.end()) components.push_back(i);
    }
    return components;
  };
  std::vector<int> dependent = pivots(slopes.topRows(conditions), open(0, rates));
  const std::vector<int> of_rates = pivots(slopes.bottomRows(conditions), open(rates, 2 * rates));
  dependent.insert(dependent.end(), of_rates.begin(), of_rates.end());
  std::sort(dependent.begin(), dependent.end());
  return free_directions(slopes, std::move(dependent));
}

FreeDirections free_directions(const MatrixXd& slopes, std::vector<int> dependent) {
  const auto dimension = static_cast<int>(slopes.cols());
  FreeDirections free;
  free.dependent = std::move(dependent);
  for (int i = 0; i < dimension; ++i) {
    if (!free.is_dependent(i)) free.independent.push_back(i);
  }
  const MatrixXd G = normalized_rows(slopes);
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> of_dependent;
  of_dependent.setThreshold(least);
  of_dependent.compute(G(Eigen::all, free.dependent));
  const auto count = static_cast<Index>(free.independent.size());
  free.N = MatrixXd::Zero(dimension, count);
  free.N(free.independent, Eigen::all) = MatrixXd::Identity(count, count);
  free.N(free.dependent, Eigen::all) =
      -of_dependent.solve(MatrixXd(G(Eigen::all, free.independent)));
  return free;
}

double determination(const MatrixXd& slopes, const std::vector<int>& dependent) {
  if (dependent.empty()) return 1;
  Eigen::ColPivHouseholderQR<MatrixXd> qr(normalized_rows(slopes)(Eigen::all, dependent));
  const auto last = static_cast<Index>(dependent.size()) - 1;
  return std::abs(qr.matrixR()(last, last) / qr.matrixR()(0, 0));
}

MatrixXd with_columns(const MatrixXd& given, const std::vector<int>& positions, int count) {
  MatrixXd result = MatrixXd::Zero(given.rows(), count);
  result(Eigen::all, positions) = given;
  return result;
}

}  // namespace detail

}  // namespace kreisel
