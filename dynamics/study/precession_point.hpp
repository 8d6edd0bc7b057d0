#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/study/precession.hpp>

/// The precession equations at one position, shared by the motion and the admissibility test.

namespace kreisel::detail {

/// Products of two matrices at a time: the compiler would instantiate each longer expression.
[[nodiscard]] inline Eigen::MatrixXd product(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  return A * B;
}

/// The orthonormal directions N of kept accelerations and P of the others.
struct Directions {
  Eigen::MatrixXd N;
  Eigen::MatrixXd P;
  Eigen::MatrixXd N_t = N.transpose();
  Eigen::MatrixXd P_t = P.transpose();

  [[nodiscard]] static Directions of(const Eigen::MatrixXd& G, const PrecessionOptions& options) {
    const Eigen::Index n = G.rows();
    if (options.kept == KeptAccelerations::none) {
      return {Eigen::MatrixXd(n, 0), Eigen::MatrixXd::Identity(n, n)};
    }
    const auto [s, U, V] = singular_values(G);
    const Eigen::Index rank = (s.array() > options.rank_tolerance * s[0]).count();
    return {V.rightCols(n - rank), V.leftCols(rank)};
  }
};

/// Values at one position: u from the precession equations, and its response to more force.
struct PrecessionPoint {
  GyroForces f;
  Eigen::MatrixXd W;  ///< G + D
  Eigen::VectorXd u;
  Eigen::VectorXd dv;   ///< of v = N' u
  Eigen::MatrixXd way;  ///< P, and the response of the kept directions: way' A N = 0
  Eigen::FullPivLU<Eigen::MatrixXd> across;  ///< way' W P
  bool determined = true;                    ///< true if it is regular
  Eigen::LDLT<Eigen::MatrixXd> along;        ///< N' A N

  PrecessionPoint(const Directions& d, GyroForces forces, const Eigen::VectorXd& v)
      : f(std::move(forces)), W(f.G + f.D), way(d.P) {
    if (d.N.cols() > 0) {
      const Eigen::MatrixXd N_A = product(d.N_t, f.A);
      along.compute(product(N_A, d.N));
      way -= product(d.N, along.solve(product(N_A, d.P)));
    }
    if (d.P.cols() > 0) {
      across.compute(product(product(way.transpose(), W), d.P));
      across.setThreshold(1e-12);
      determined = across.isInvertible();
    }
    u = velocity(d, f.Q, v);
    dv = acceleration(d, f.Q - W * u);
  }

  [[nodiscard]] Eigen::VectorXd velocity(const Directions& d, const Eigen::VectorXd& Q,
                                         const Eigen::VectorXd& v) const {
    Eigen::VectorXd whole = d.N * v;
    if (d.P.cols() == 0) return whole;
    const Eigen::VectorXd left = Q - W * whole;
    const Eigen::VectorXd w = across.solve(Eigen::VectorXd(way.transpose() * left));
    return whole + d.P * w;
  }
  [[nodiscard]] Eigen::VectorXd acceleration(const Directions& d,
                                             const Eigen::VectorXd& force) const {
    if (d.N.cols() == 0) return Eigen::VectorXd(0);
    return along.solve(Eigen::VectorXd(d.N_t * force));
  }
};

}  // namespace kreisel::detail
