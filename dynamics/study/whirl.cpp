#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <optional>

#include <dynamics/control/readings.hpp>
#include <dynamics/study/body_states.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/whirl.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel {

namespace {

using Eigen::Index;
using Eigen::VectorXd;
using Poses = std::vector<BodyKinematicsOn<double>>;

/// Rates below this value count as no rotation.
constexpr double least_rate = 1e-9;

/// The poses and velocities of all bodies but rotors, against the guide.
template <class S>
std::vector<BodyKinematicsOn<S>> poses(const BodyTree& tree, const detail::VectorOn<S>& y) {
  detail::MotionSpace<S> space(tree);
  MotionOfBodies<S> motion;
  detail::set_motion_of_bodies<S>(tree, y, nullptr, space, motion);
  return std::move(motion.bodies);
}

/// A body whose points move as those of `on`, the carrier of a rotor or the body itself.
struct Place {
  int on = 0;
  Vector3<double> centre = Vector3<double>::Zero();  ///< on the axes of `on`
  double mass = 0;
  double across = 0;  ///< moment of inertia about the centre, across the axis
};

int parent_of(const BodyTree& tree, int body) {
  const std::string& parent = tree.body(body).parent;
  return parent == "guide" ? -1 : tree.index(parent);
}

/// The mass, the point of the axis next to the centre of mass, and the moment across the axis.
///
/// axis : of length 1, on the body's axes
Place place_of(const BodyTree& tree, int body, const Vector3<double>& axis) {
  const Inertia<double>& T = tree.body(body).inertia.value;
  Place place{body, Vector3<double>::Zero(), T.mass, 0};
  if (!(T.mass > 0)) return place;
  const Vector3<double> c = T.first_moment / T.mass;
  const Matrix3<double> about =
      T.tensor.matrix() -
      T.mass * (c.squaredNorm() * Matrix3<double>::Identity() - c * c.transpose());
  place.centre = c;
  place.across = (about.trace() - axis.dot(about * axis)) / 2;
  return place;
}

/// The rate of a revolute joint, if it is one that turns or is made to turn.
std::optional<double> spin_of(const BodyTree& tree, int body, const VectorXd& y) {
  const BodyDescription& of = tree.body(body);
  if (of.joint.kind != JointKind::revolute || of.rule == JointRule::held) return std::nullopt;
  const double rate = y[tree.coordinates() + tree.place(body).v];
  const bool spins = of.rotor || of.rule == JointRule::driven || std::abs(rate) > least_rate;
  return spins ? std::optional(rate) : std::nullopt;
}

/// The six rows of SpinningBody::displacement.
Eigen::MatrixXd displacement(const BodyTree& tree, const VectorXd& y, const Place& place,
                             const Vector3<double>& arm) {
  constexpr int at_once = 4;
  using N = detail::Duals<at_once>;
  const Tangent tangent(static_cast<int>(y.size()), quaternions(tree));
  const Eigen::MatrixXd E = tangent.basis(y);
  Eigen::MatrixXd result(6, E.cols());
  for (Index begin = 0; begin < E.cols(); begin += at_once) {
    const Index count = std::min<Index>(at_once, E.cols() - begin);
    detail::VectorOn<N> state(y.size());
    for (Index i = 0; i < y.size(); ++i) {
      state[i] = N(y[i]);
      for (Index k = 0; k < count; ++k) state[i].derivatives()[k] = E(i, begin + k);
    }
    const BodyKinematicsOn<N> pose = poses<N>(tree, state)[static_cast<std::size_t>(place.on)];
    for (int end = 0; end < 2; ++end) {
      const Vector3<double> at = place.centre + (end == 0 ? 1 : -1) * arm;
      const Vector3<N> x = pose.x + pose.R * at.cast<N>();
      for (int i = 0; i < 3; ++i) {
        for (Index k = 0; k < count; ++k) result(3 * end + i, begin + k) = x[i].derivatives()[k];
      }
    }
  }
  return result;
}

/// The spinning body of a place. `spin` is the rate about `axis`, on the axes of `place.on`, against
/// the frame in which the deflection varies.
SpinningBody spinning(const BodyTree& tree, const VectorXd& y, const Poses& now, int body,
                      const Place& place, const Vector3<double>& axis, double spin) {
  const BodyKinematicsOn<double>& pose = now[static_cast<std::size_t>(place.on)];
  SpinningBody result;
  result.body = body;
  result.axis = pose.R * axis;
  result.carrier = pose.w.dot(result.axis);
  result.spin = result.carrier + spin;
  if (result.spin < 0) {
    result.axis = -result.axis;
    result.carrier = -result.carrier;
    result.spin = -result.spin;
  }
  result.half_mass = place.mass / 2;
  const double rho = std::sqrt(std::max(place.across / place.mass, 0.0));
  result.displacement = displacement(tree, y, place, rho * axis);
  return result;
}

/// The direction of a joint's axis on the axes of its body.
Vector3<double> axis_on_body(const Joint& joint) {
  return joint.orientation.normalized().conjugate() * joint.axis.normalized();
}

/// The body in a revolute joint, seen from its carrier, on which the points of the axis do not turn.
Place place_on_carrier(const BodyTree& tree, int body, int carrier) {
  const Joint& joint = tree.body(body).joint;
  Place place = place_of(tree, body, axis_on_body(joint));
  place.on = carrier;
  const Vector3<double> axis = joint.axis.normalized();
  place.centre = joint.position + axis * axis.dot(joint.orientation.normalized() * place.centre);
  return place;
}

/// The deflections of a point as semi-axes across e: Re((a + i b) exp(i w t)).
struct Ellipse {
  Vector3<double> a;
  Vector3<double> b;

  Ellipse(const Eigen::Vector3cd& d, const Vector3<double>& e)
      : a(d.real() - e * e.dot(d.real())), b(d.imag() - e * e.dot(d.imag())) {}

  [[nodiscard]] double circulation(const Vector3<double>& e) const { return b.cross(a).dot(e); }
  [[nodiscard]] double size() const { return (a.squaredNorm() + b.squaredNorm()) / 2; }
};

/// Sums over bodies, weighted by mass.
struct Sums {
  double circulation = 0;
  double forward = 0;  ///< of bodies that turn forward
  double backward = 0;
  double size = 0;
  double carrier = 0;
  double mass = 0;

  void add(const SpinningBody& body, const Eigen::VectorXcd& shape) {
    const Eigen::VectorXcd d = body.displacement * shape.head(body.displacement.cols());
    double own = 0;
    double own_size = 0;
    for (const Eigen::Index end : {0, 3}) {
      const Ellipse ellipse(d.segment<3>(end), body.axis);
      own += body.half_mass * ellipse.circulation(body.axis);
      own_size += body.half_mass * ellipse.size();
    }
    circulation += own;
    if (body.spin > least_rate) (own > 0 ? forward : backward) += std::abs(own);
    size += own_size;
    carrier += own_size * body.carrier;
    mass += body.half_mass;
  }
};

}  // namespace

std::vector<SpinningBody> spinning_bodies(const BodyTree& tree, const VectorXd& y) {
  const VectorXd joints = y.head(tree.coordinates() + tree.rates());
  const Poses now = poses<double>(tree, joints);
  std::vector<SpinningBody> result;
  std::vector<int> turners(tree.bodies().size(), -1);  // the body whose joint turns a body
  const auto add = [&](int body, const Place& place, const Vector3<double>& axis, double spin) {
    if (place.mass > 0) result.push_back(spinning(tree, joints, now, body, place, axis, spin));
  };
  for (int body = 0; body < static_cast<int>(tree.bodies().size()); ++body) {
    const int carrier = parent_of(tree, body);
    int& turner = turners[static_cast<std::size_t>(body)];
    if (carrier >= 0) turner = turners[static_cast<std::size_t>(carrier)];
    if (const std::optional<double> spin = spin_of(tree, body, joints)) {
      turner = body;
      if (carrier < 0) continue;
      add(body, place_on_carrier(tree, body, carrier), tree.body(body).joint.axis.normalized(),
          *spin);
    } else if (turner >= 0) {
      const auto R = [&now](int i) -> const Matrix3<double>& {
        return now[static_cast<std::size_t>(i)].R;
      };
      const Vector3<double> axis =
          R(body).transpose() * (R(turner) * axis_on_body(tree.body(turner).joint));
      add(body, place_of(tree, body, axis), axis, 0);
    }
  }
  return result;
}

WhirlOfMode whirl(const std::vector<SpinningBody>& bodies, double frequency,
                  const Eigen::VectorXcd& shape) {
  WhirlOfMode result;
  result.frequency = frequency;
  Sums sums;
  for (const SpinningBody& body : bodies) sums.add(body, shape);
  // Amplitudes below 1e-12 of the shape are rounding.
  if (!(sums.size > 1e-24 * sums.mass * shape.squaredNorm())) return result;
  result.circulation = sums.circulation / sums.size;
  const bool any_forward = sums.forward > 1e-6 * sums.size;
  const bool any_backward = sums.backward > 1e-6 * sums.size;
  if (any_forward == any_backward) {
    result.sense = any_forward ? Whirl::mixed : Whirl::plane;
    return result;
  }
  const double carrier = sums.carrier / sums.size;
  result.frequency = any_forward ? carrier + frequency : carrier - frequency;
  result.sense = result.frequency >= 0 ? Whirl::forward : Whirl::backward;
  return result;
}

}  // namespace kreisel
