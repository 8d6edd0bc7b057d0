#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/rotor_forces.hpp>

namespace kreisel {

/// The matrices of a system with rotors at one moment:
///
///   A_eff u' + c + G_R u = Q,   A_eff = A + sum over regulated rotors of C_i B_i^t B_i.
///
/// The velocities u are the rates of the system without those of the rotors. They may be angular
/// velocities, which are not derivatives of coordinates. The paper's (11), (13), (14) and (26) hold
/// for derivatives of coordinates only: they lack  u x dT/du,  which is in c and G_R here.
///
/// Source : paper 000 (1), (3), (10)-(14), with G_R from the axes' motion, without a derivative,
///          (G_R)_kj = sum l_i e_i.(J_k x J_j), J the angular velocity of the carrier per unit rate
/// Units  : those of the rates, joint by joint
/// Error  : <= 1e-13 relative against 22 digits           (tests/dynamics/tree/rotor_matrices.cpp)
/// Cost   : memory and time grow with the square of the number of rates
struct RotorMatrices {
  std::vector<int> rates;   ///< the rates of the system that are u
  std::vector<int> rotors;  ///< the bodies of the rows of B, l and C

  Eigen::MatrixXd A;  ///< of all bodies, without C
  Eigen::MatrixXd B;  ///< the carriers' rates about the rotors' axes:  e.w = B u on a guide at rest
  Eigen::VectorXd C;  ///< the diagonal of A_R
  Eigen::VectorXd l;  ///< L = C phi' of regulated rotors, p = C (phi' + e.w) of others
  Eigen::MatrixXd A_eff;  ///< A* of the paper, if all are regulated
  Eigen::MatrixXd G_R;    ///< gyroscopic: exactly skew
  Eigen::VectorXd h;      ///< B^t l

  /// Inertia forces at u' = 0 without G_R u: from the bodies' own motion (G_A u and similar terms)
  /// and from the guide.
  Eigen::VectorXd c;

  /// Weight, loads, springs, dampers, constant joint forces and the reactions of the rotors'
  /// motors: -B^t M of driven rotors, -B^t C phi'' of regulated rotors with a prescribed
  /// acceleration.
  Eigen::VectorXd Q;
};

namespace detail {

/// The angular velocities of a link per unit of each rate, as columns, on guide axes.
[[nodiscard]] inline Eigen::Matrix3Xd turning(const BodyTree& tree, std::size_t link,
                                              const BodyWorkspace& w) {
  Eigen::Matrix3Xd J = Eigen::Matrix3Xd::Zero(3, tree.rates());
  for (std::size_t j = link; j > 0; j = static_cast<std::size_t>(tree.links()[j].parent)) {
    const Link& above = tree.links()[j];
    const LinkPose<>& parent = w.pose[static_cast<std::size_t>(above.parent)];
    for (int k = 0; k < rate_count(above.kind); ++k) {
      J.col(above.v + k) = direction(above, w.pose[j], parent, k).resultant;
    }
  }
  return J;
}

}  // namespace detail

/// The matrices of a system in the state y. Drives and locks of joints are treated as free, as in
/// BodySystem::mass_matrix.
template <class M>
[[nodiscard]] RotorMatrices rotor_matrices(const BodySystem<M>& system, double t,
                                           const Eigen::VectorXd& y, BodyWorkspace& w) {
  using Eigen::Index;
  const BodyTree& tree = system.tree();
  Eigen::MatrixXd whole;
  system.mass_matrix(y, whole, w);
  RotorMatrices m;
  std::vector<bool> spins(static_cast<std::size_t>(tree.rates()), false);
  for (const detail::RotorLink& rotor : tree.rotors()) {
    spins[static_cast<std::size_t>(rotor.link.v)] = true;
    m.rotors.push_back(rotor.link.body);
  }
  for (int k = 0; k < tree.rates(); ++k) {
    if (!spins[static_cast<std::size_t>(k)]) m.rates.push_back(k);
  }

  const double* v = y.data() + tree.coordinates();
  const FrameMotion<Guide, Inertial> guide = system.guide()(t);
  const detail::LinkMotion<> moving{guide.V.value.resultant, guide.dV.value.resultant,
                                    guide.origin_acceleration()};
  const Vector3<double> zero = Vector3<double>::Zero();
  const detail::LinkMotion<> weight{zero, zero, -detail::field(system.gravity(), guide)};
  const auto n = static_cast<Index>(m.rates.size());
  const auto count = static_cast<Index>(tree.rotors().size());
  Eigen::VectorXd projected(tree.rates());

  detail::set_poses(tree, y.data(), w);  // restores the inertias that mass_matrix() has summed
  detail::set_motions(tree, moving, v, detail::ask_drives(tree, t, w), w);
  m.B.resize(count, n);
  m.C.resize(count);
  m.l.resize(count);
  m.G_R.setZero(n, n);
  for (Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const detail::RotorLink& rotor = tree.rotors()[k];
    const std::size_t c = detail::carrier(rotor);
    const Vector3<double>& e = w.pose[tree.rotor_slot(k)].axis;
    const Eigen::Matrix3Xd J = detail::turning(tree, c, w)(Eigen::all, m.rates);
    m.C[i] = rotor.about;
    m.l[i] = detail::momentum_weight(rotor, v[rotor.link.v], e.dot(w.motion[c].w));
    m.B.row(i) = e.transpose() * J;
    for (Index a = 0; a < n; ++a) {
      const Vector3<double> across = m.l[i] * e.cross(Vector3<double>(J.col(a)));
      for (Index b = 0; b < a; ++b) {
        const double entry = across.dot(J.col(b));
        m.G_R(a, b) += entry;
        m.G_R(b, a) -= entry;
      }
    }
    w.force[c].moment += m.l[i] * moving.w.cross(e);
  }
  m.h = m.B.transpose() * m.l;
  m.A_eff = whole(m.rates, m.rates);
  m.A = m.A_eff - m.B.transpose() * m.C.asDiagonal() * m.B;
  for (Index i = 0; i < count; ++i) {
    if (tree.rotors()[static_cast<std::size_t>(i)].regulated()) continue;
    m.A_eff -= m.B.row(i).transpose() * m.C[i] * m.B.row(i);
  }
  detail::sum_inwards(tree, w);
  detail::project(tree, w, projected.data());
  m.c = projected(m.rates);

  detail::set_motions(tree, weight, w.still.data(), nullptr, w);
  detail::take_off_loads(tree, t, guide, v, w);
  detail::take_off_elements(tree, t, v, w);
  detail::set_joint_forces(tree, y.data(), v, w);
  detail::add_timed_forces(tree, t, w);
  detail::add_couplings(tree, y.data(), v, w.joint_force);
  detail::ask_spin_up(tree, t, w);
  detail::add_rotor_forces(tree, w.still.data(), w.joint_force.data(), w);
  detail::sum_inwards(tree, w);
  detail::project(tree, w, projected.data());
  m.Q = w.joint_force(m.rates) - projected(m.rates);
  return m;
}

/// The rank of G_R. At full rank the precession equations  G_R u = Q  determine the motion.
///
/// Source : paper 000, the condition  det G_R != 0.  The rank of m rotors is 2m at most, so the
///          number of velocities must be even and at most 2m
struct GyroscopicRank {
  Eigen::VectorXd singular_values;  ///< of G_R, in pairs, descending
  int rank = 0;
  int most = 0;            ///< 2m
  Eigen::MatrixXd kernel;  ///< orthonormal columns: directions whose accelerations matter
};

/// The rank of G_R by its singular values.
///
/// Error : singular values below `tolerance` times the greatest count as 0
[[nodiscard]] inline GyroscopicRank gyroscopic_rank(const RotorMatrices& m,
                                                    double tolerance = 1e-12) {
  const auto [s, U, V] = detail::singular_values(m.G_R);
  GyroscopicRank result;
  result.singular_values = s;
  result.rank = s.size() ? static_cast<int>((s.array() > tolerance * s[0]).count()) : 0;
  result.most = 2 * static_cast<int>(m.rotors.size());
  result.kernel = V.rightCols(s.size() - result.rank);
  return result;
}

}  // namespace kreisel
