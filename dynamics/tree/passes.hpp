#pragma once

#include <type_traits>

#include <dynamics/tree/rotors.hpp>
#include <motor/attitude.hpp>

/// The passes over a whole tree: outwards for motions, inwards for forces. Each link has a higher
/// number than its parent, so the passes are plain loops.

namespace kreisel::detail {

template <class S>
void set_pose(const Link& link, std::size_t i, const S* q, MotionSpace<S>& w) {
  set_pose(link, w.pose[static_cast<std::size_t>(link.parent)], q, w.pose[i]);
  turn(w.pose[i].R, link.inertia, w.inertia[i]);
}

template <class S>
void set_motion(const Link& link, std::size_t i, const S* v, const std::type_identity_t<S>* dv,
                MotionSpace<S>& w) {
  const auto parent = static_cast<std::size_t>(link.parent);
  set_motion(link, w.pose[i], w.pose[parent], w.motion[parent], v, dv, w.motion[i]);
  w.force[i] = inertia_force(w.inertia[i], w.motion[i]);
}

/// Sets the poses, and the inertias on guide axes, for the coordinates q.
template <class S>
void set_poses(const BodyTree& tree, const S* q, MotionSpace<S>& w) {
  for (std::size_t i = 1; i < tree.links().size(); ++i) set_pose(tree.links()[i], i, q, w);
}

/// Sets the motions, and the inertia force of each link alone: the left side of the equation of
/// motion. The guide's motion is `root`; a null dv means 0.
template <class S>
void set_motions(const BodyTree& tree, const LinkMotion<S>& root, const S* v,
                 const std::type_identity_t<S>* dv, MotionSpace<S>& w) {
  w.motion[0] = root;
  w.force[0] = {};
  for (std::size_t i = 1; i < tree.links().size(); ++i) set_motion(tree.links()[i], i, v, dv, w);
  begin_rotors(tree, w);
}

/// set_poses() and set_motions() in one pass.
template <class S>
void set_poses_and_motions(const BodyTree& tree, const LinkMotion<S>& root, const S* q, const S* v,
                           const std::type_identity_t<S>* dv, MotionSpace<S>& w) {
  w.motion[0] = root;
  w.force[0] = {};
  for (std::size_t i = 1; i < tree.links().size(); ++i) {
    set_pose(tree.links()[i], i, q, w);
    set_motion(tree.links()[i], i, v, dv, w);
  }
  begin_rotors(tree, w);
}

/// Sums the forces inwards: w.force[i] becomes the force of the parent on link i through the joint,
/// w.force[0] the force of the guide.
template <class S>
void sum_inwards(const BodyTree& tree, MotionSpace<S>& w) {
  for (std::size_t i = tree.links().size() - 1; i > 0; --i) {
    const Motor<S>& P = w.force[i];
    Motor<S>& above = w.force[static_cast<std::size_t>(tree.links()[i].parent)];
    above.resultant += P.resultant;
    above.moment += P.moment + cross(w.pose[i].r, P.resultant);
  }
}

/// The components of the forces in w along the joints' directions, one for each rate of a link.
template <class S>
void project(const BodyTree& tree, const MotionSpace<S>& w, S* result) {
  for (std::size_t i = 1; i < tree.links().size(); ++i) {
    const Link& link = tree.links()[i];
    if (link.kind == LinkKind::revolute) {
      result[link.v] = dot(w.pose[i].axis, w.force[i].moment);
      continue;
    }
    const LinkPose<S>& parent = w.pose[static_cast<std::size_t>(link.parent)];
    for (int k = 0; k < rate_count(link.kind); ++k) {
      result[link.v + k] = reciprocal(w.force[i], direction(link, w.pose[i], parent, k));
    }
  }
}

/// Sets the rates of the coordinates, q' = N(q) v.
template <class S>
void set_coordinate_rates(const BodyTree& tree, const S* q, const S* v, S* result) {
  for (const Link& link : tree.links()) {
    S* dq = result + link.q;
    const S* u = v + link.v;
    int set = 0;
    if (link.moves() && rate_count(link.kind) == 1) {
      dq[set++] = u[0];
    } else if (link.moves() && rate_count(link.kind) >= 3) {
      const S* p = q + link.q;
      const Eigen::Matrix<S, 4, 1> rate =
          attitude_rate(Eigen::Quaternion<S>(p[3], p[0], p[1], p[2]), three(u));
      for (; set < 4; ++set) dq[set] = rate[set];
      for (; set < coordinate_count(link.kind); ++set) dq[set] = u[set - 1];
    }
    for (; set < coordinate_count(link.kind); ++set) dq[set] = S(0);
  }
  for (const RotorLink& rotor : tree.rotors()) result[rotor.link.q] = v[rotor.link.v];
}

/// Sets the joint forces: springs, dampers and constants, without those that change with time.
template <class S>
void set_joint_forces(const BodyTree& tree, const S* q, const S* v, MotionSpace<S>& w) {
  for (std::size_t k = 0; k < tree.forces().size(); ++k) {
    const JointForce& f = tree.forces()[k];
    w.joint_force[static_cast<Eigen::Index>(k)] =
        f.constant - f.stiffness * (q[tree.coordinate_of()[k]] - f.rest) - f.damping * v[k];
  }
}

/// Adds the joint forces that change with time.
template <class S>
void add_timed_forces(const BodyTree& tree, const S& t, MotionSpace<S>& w) {
  for (const BodyTree::TimedForce& force : tree.timed_forces()) {
    w.joint_force[force.rate] += force.signal(t);
  }
}

}  // namespace kreisel::detail
