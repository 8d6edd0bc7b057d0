#pragma once

#include <Eigen/Core>

#include <vector>

#include <dynamics/body/loads.hpp>
#include <dynamics/law/relative.hpp>

namespace kreisel {

/// A reaction motor by what causes it: the accelerations of all joints answer each cause by itself,
/// and what that takes from this joint is its part. The parts sum to the whole.
///
/// Source : paper 002 (26), its terms moved to the right side one group at a time
/// Frame  : body axes, about the body's origin
/// Units  : N, N m
struct ReactionParts {
  Force<Body> spin;     ///< V' alone: what would be there on a guide at rest, without any force
  Force<Body> guide;    ///< F, oF and their Coriolis terms with V'
  Force<Body> gravity;  ///< weight in a uniform field
  Force<Body> forces;   ///< springs, dampers and constant forces of joints, loads on bodies

  [[nodiscard]] Force<Body> total() const { return spin + guide + gravity + forces; }
};

/// What the joints carry.
///
/// Units  : N, N m
struct JointReactions {
  /// One for each body: what the PARENT exerts on it through the joint, springs, dampers and drives
  /// included; on body axes, about the body's origin. That lies in the joint; in a prismatic or
  /// free one it has moved along.
  std::vector<Force<Body>> on_body;

  /// One for each rate: what a drive or a lock adds to spring, damper and constant force of its
  /// joint; 0 where forces rule.
  Eigen::VectorXd drive;
};

namespace detail {

/// The force of its joint on a body, once w.force has been summed inwards.
[[nodiscard]] inline Force<Body> joint_reaction(const BodyTree& tree, int body,
                                                const BodyWorkspace& w) {
  const std::size_t link = tree.link(body);
  const Matrix3<double>& R = w.pose[link].R;
  const auto& [force, moment] = w.force[link];
  return {{transposed_product(R, force), transposed_product(R, moment)}};
}

/// The terms of (26) of one body, from the absolute accelerations in w, from which g was taken off.
[[nodiscard]] inline ForceParts<Body> terms(const BodyTree& tree, const Situation<>& s, int body,
                                            const Vector3<double>& g, const BodyWorkspace& w) {
  const std::size_t link = tree.link(body);
  const LinkMotion<>& absolute = w.motion[link];
  const auto& [x, V] = w.place[link];
  const Vector3<double>& u = s.guide.V.value.resultant;
  const Vector3<double>& du = s.guide.dV.value.resultant;
  const Vector3<double> carried =
      s.guide.origin_acceleration() + cross(du, x) + cross(u, cross(u, x));
  const Vector3<double> turn = absolute.dw - du - cross(u, V.resultant);
  const Vector3<double> slide = absolute.a + g - carried - 2.0 * cross(u, V.moment);
  const Matrix3<double>& R = w.pose[link].R;
  const Rate<Body, Velocity<Body, Guide, Body>> dV_rel{
      {transposed_product(R, turn), transposed_product(R, slide - cross(V.resultant, V.moment))}};
  const Displacement<Body, Guide> X = s.X.inverse();
  return equation_of_motion(s.inertia, s.V_rel, X * s.guide.V, dV_rel, X * s.guide.dV);
}

}  // namespace detail

}  // namespace kreisel
