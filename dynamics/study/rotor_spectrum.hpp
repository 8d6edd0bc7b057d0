#pragma once

#include <Eigen/Cholesky>

#include <cstddef>
#include <optional>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/tree/rotor_matrices.hpp>

namespace kreisel {

/// Derivative of the state matrix of linearize() by the momenta of all rotors, d A / d ln(L), at
/// constant position and forces. It is -A_eff^-1 G_R in the rows of the accelerations, together
/// with the response of free rotors' speeds.
///
/// Joints that are locked or driven do not move.
/// Cost   : as rotor_matrices()
template <class M>
[[nodiscard]] Eigen::MatrixXd momenta_slope(const BodySystem<M>& system, double t,
                                            const Eigen::VectorXd& y, BodyWorkspace& w) {
  const BodyTree& tree = system.tree();
  const RotorMatrices m = rotor_matrices(system, t, y, w);
  std::vector<bool> gives_way(static_cast<std::size_t>(tree.rates()), false);
  for (const detail::Link& link : tree.links()) {
    const int end = link.v + detail::rate_count(link.kind);
    for (int v = link.v; v < end; ++v) {
      gives_way[static_cast<std::size_t>(v)] = link.moved_by_forces();
    }
  }
  std::vector<int> own;    // positions among u
  std::vector<int> rates;  // and among all rates
  for (int k = 0; k < static_cast<int>(m.rates.size()); ++k) {
    const int rate = m.rates[static_cast<std::size_t>(k)];
    if (!gives_way[static_cast<std::size_t>(rate)]) continue;
    own.push_back(k);
    rates.push_back(tree.rates() + rate);
  }
  const Eigen::MatrixXd answer = -Eigen::MatrixXd(m.A_eff(own, own)).ldlt().solve(m.G_R(own, own));
  const int size = 2 * tree.rates();
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(size, size);
  slope(rates, rates) = answer;
  for (std::size_t i = 0; i < tree.rotors().size(); ++i) {
    const detail::RotorLink& rotor = tree.rotors()[i];
    if (rotor.regulated()) continue;
    const Eigen::RowVectorXd about = m.B.row(static_cast<Eigen::Index>(i));
    slope(tree.rates() + rotor.link.v, rates) = -about(own) * answer;
  }
  return slope;
}

/// The modes of x' = A x, damped or not, with the dependence of their roots on the rotors' momenta:
///
///   d ln|s| / d ln(L) = Re(y.(dA / d ln(L)) x / s),   y.x = 1,   y and x left and right vectors.
///
/// energy_sign is 0: it is defined only without damping.
///
/// Error  : of the roots as spectrum(); of spin_growth that of the vectors. 0 for roots that do not
///          oscillate, or are multiple and have too few vectors
/// Throws : as spectrum()
[[nodiscard]] inline std::vector<GyroscopicMode> rotor_spectrum(const Eigen::MatrixXd& A,
                                                                const Eigen::MatrixXd& slope) {
  std::vector<GyroscopicMode> modes;
  Eigen::MatrixXcd shapes(A.rows(), A.rows());
  for (const Mode& mode : spectrum(A)) {
    shapes.col(static_cast<Eigen::Index>(modes.size())) = mode.shape;
    modes.push_back({mode, 0, 0});
  }
  const std::optional<Eigen::MatrixXcd> left = detail::inverse(shapes);
  if (!left) return modes;
  for (std::size_t i = 0; i < modes.size(); ++i) {
    GyroscopicMode& mode = modes[i];
    if (std::abs(mode.root.imag()) <= mode.error) continue;
    const auto row = left->row(static_cast<Eigen::Index>(i));
    mode.spin_growth = ((row * slope * mode.shape).value() / mode.root).real();
  }
  return modes;
}

}  // namespace kreisel
