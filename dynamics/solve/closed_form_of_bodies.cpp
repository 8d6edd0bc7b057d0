#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <dynamics/exact/elliptic.hpp>
#include <dynamics/pendulum/physical_pendulum.hpp>
#include <dynamics/solve/closed_form.hpp>
#include <dynamics/solve/closed_form_parts.hpp>
#include <dynamics/tree/tree.hpp>

/// The closed form of systems that are only a pendulum or a top.

namespace kreisel::detail {

namespace {

/// The only body of a tree, if no joint force and no load acts on it.
[[nodiscard]] const BodyDescription* lone_body(const BodyTree& tree) {
  const bool alone = tree.bodies().size() == 1 && tree.rotors().empty() && is_free_of_forces(tree);
  return alone && tree.links().back().moved_by_forces() ? &tree.body(0) : nullptr;
}

/// The orientation of a joint in exact::Real, so that the conversion adds no error.
[[nodiscard]] Eigen::Quaternion<exact::Real> orientation(const kreisel::Joint& joint) {
  return joint.orientation.cast<exact::Real>().normalized();
}

/// The motion of a body in a revolute joint:
///
///   Theta q'' + E sin q + F cos q = 0,   E = p.g,   F = -a.(p x g)
///
/// a is the axis and Theta the moment of inertia about it; p is the part of the first moment across
/// a, at q = 0.
[[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> pendulum_motion(
    const BodyDescription& body, const Vector3<double>& gravity, double begin,
    const Eigen::VectorXd& y) {
  using exact::Real;
  using Vector = Vector3<Real>;
  const Inertia<>& inertia = body.inertia.value;
  const Vector a = body.joint.axis.cast<Real>().normalized();
  const auto q = orientation(body.joint);
  const Vector on_body = q.conjugate() * a;
  const Vector first_moment = q * Vector(inertia.first_moment.cast<Real>());
  const Vector p = first_moment - a.dot(first_moment) * a;
  const Vector g = gravity.cast<Real>();
  PendulumBody<Real> reduced;
  reduced.theta_c = on_body.dot(inertia.tensor.matrix().cast<Real>() * on_body);
  PendulumCoefficients<Real> c;
  c.weight = p.dot(g);
  c.f = -a.dot(p.cross(g));
  if (!(reduced.theta_c > 0) || (c.weight == 0 && c.f == 0)) return std::nullopt;
  if (!y.allFinite()) return std::nullopt;
  try {
    const SteadyPendulumMotion<Real> motion(reduced, c, y[0], y[1]);
    return ClosedForm<Eigen::VectorXd>{"energy integral, Fourier series",
                                       [motion, begin](double t) -> Eigen::VectorXd {
                                         const auto point = motion.at(Real(t) - begin);
                                         return Eigen::Vector2d(double(point.angle),
                                                                double(point.rate));
                                       },
                                       SteadyPendulumMotionError(motion, begin, of_inputs)};
  } catch (const ComputationFailed&) {  // too near a barrier
    return std::nullopt;
  }
}

/// A body that rotates about a point, as an EulerTop.
struct TurningBody {
  EulerTop top;
  Eigen::Quaternion<exact::Real> from_guide;  ///< to axes with the vertical along z
  Matrix3<double> axes;                       ///< of the top, on body axes: centre of mass on +z
};

/// The body as a top. Nothing if its axes are not principal axes, or its centre of mass lies on
/// none of them.
[[nodiscard]] std::optional<TurningBody> turning_body(const BodyDescription& body,
                                                      const Vector3<double>& gravity) {
  using exact::Real;
  const Inertia<>& inertia = body.inertia.value;
  const Symmetric3<>& T = inertia.tensor;
  const Vector3<double> moments(T.xx, T.yy, T.zz);
  const Vector3<double>& s = inertia.first_moment;
  const bool principal = T.xy == 0 && T.xz == 0 && T.yz == 0 && moments.minCoeff() > 0;
  if (!principal || (body.joint.kind == JointKind::free && !s.isZero(0))) return std::nullopt;
  const double k = gravity.norm() * s.norm();
  if (k == 0) {
    return TurningBody{EulerTop(moments), Eigen::Quaternion<Real>::Identity(),
                       Matrix3<double>::Identity()};
  }
  if ((s.array() != 0).count() != 1) return std::nullopt;
  const int z = s.x() != 0 ? 0 : s.y() != 0 ? 1 : 2;
  const int x = (z + 1) % 3, y = (z + 2) % 3;
  const double sign = s[z] > 0 ? 1 : -1;
  Matrix3<double> axes = Matrix3<double>::Zero();
  axes(x, 0) = 1;
  axes(y, 1) = sign;
  axes(z, 2) = sign;
  const Vector3<Real> up = -gravity.cast<Real>().normalized();
  return TurningBody{EulerTop({moments[x], moments[y], moments[z]}, {0, 0, k}),
                     Eigen::Quaternion<Real>::FromTwoVectors(up, Vector3<Real>::UnitZ()), axes};
}

/// The flight of a free body's centre of mass; all 0 for a held body.
template <class Real>
struct Flight {
  Vector3<Real> start, velocity, gravity;

  [[nodiscard]] Vector3<Real> place(Real time) const {
    return start + time * velocity_after(time / 2);
  }
  [[nodiscard]] Vector3<Real> velocity_after(Real time) const { return velocity + time * gravity; }
};

/// The error of a Flight, in the measure of RunReport::error_estimate. In exact::Real cancellation
/// costs little.
template <class Real>
class FlightError {
 public:
  explicit FlightError(const Flight<Real>& flight) : flight_(flight) {}

  [[nodiscard]] double operator()(Real time, double smallest) {
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    place_ = std::max(place_, smallest);
    velocity_ = std::max(velocity_, smallest);
    note_way(time);
    const Real fall = abs(time) * flight_.gravity.norm();
    const Real speed = flight_.velocity.norm() + fall;
    const Real way = flight_.start.norm() + abs(time) * speed;
    constexpr Real lost = 4 * std::numeric_limits<Real>::epsilon();
    const auto relative = [](Real off, double size) { return size > 0 ? double(off / size) : 0; };
    return 2 * u + std::max(relative(lost * way, place_), relative(lost * speed, velocity_));
  }

 private:
  void note(Real time) {
    place_ = std::max(place_, double(flight_.place(time).cwiseAbs().maxCoeff()));
    velocity_ = std::max(velocity_, double(flight_.velocity_after(time).cwiseAbs().maxCoeff()));
  }

  /// Each component is greatest at the start, at `time` or where its velocity reverses in between.
  void note_way(Real time) {
    note(0);
    note(time);
    for (int i = 0; i < 3; ++i) {
      const Real top = -flight_.velocity[i] / flight_.gravity[i];
      if (top / time > 0 && top / time < 1) note(top);
    }
  }

  Flight<Real> flight_;
  double place_ = 0;  ///< the greatest so far
  double velocity_ = 0;
};

[[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> top_motion(const BodyDescription& body,
                                                                    const Vector3<double>& gravity,
                                                                    double begin,
                                                                    const Eigen::VectorXd& y) {
  using exact::Real;
  using Quaternion = Eigen::Quaternion<Real>;
  const auto turning = turning_body(body, gravity);
  if (!turning || !y.allFinite()) return std::nullopt;
  const Matrix3<double> axes = turning->axes;
  const Quaternion before = turning->from_guide * orientation(body.joint);
  const Quaternion to_body(Matrix3<Real>(axes.cast<Real>()));
  const Quaternion start =
      before * Quaternion(Eigen::Matrix<Real, 4, 1>(y.head<4>().cast<Real>())) * to_body;
  const Eigen::Quaterniond rounded = start.cast<double>();
  // Without weight the rounding of the start stays as it is. With weight the motion amplifies it,
  // without bound near the motion that ends upright.
  const bool is_exact = rounded.coeffs().cast<Real>() == start.coeffs();
  const double k = turning->top.weight_moment().z();
  if (k > 0 && !is_exact) return std::nullopt;
  const bool free = body.joint.kind == JointKind::free;
  const Eigen::Index rates = free ? 7 : 4;
  const Vector3<double> w = axes.transpose() * y.segment<3>(rates);
  const auto motion = kreisel::closed_form(turning->top, begin, {rounded, w});
  if (!motion) return std::nullopt;
  // The rate of rotation. With weight the spin about the axis of symmetry is omitted, because it is
  // given. A pendulum's rate at the lowest point is added.
  const double fall = 2 * std::sqrt(k / turning->top.moments().minCoeff());
  const double rate = k > 0 ? std::hypot(w.x(), w.y()) + fall : w.norm();

  const Vector3<Real> zero = Vector3<Real>::Zero();
  Flight<Real> flight{zero, zero, zero};
  if (free) {
    flight = {y.segment<3>(4).cast<Real>(), y.tail<3>().cast<Real>(), gravity.cast<Real>()};
  }
  const auto at = [=, size = y.size(), top = motion->at](double t) {
    const EulerTop::State state = top(t);
    const Quaternion q = before.conjugate() * state.attitude.cast<Real>() * to_body.conjugate();
    Eigen::VectorXd result(size);
    result.head(4) = q.coeffs().cast<double>();
    result.segment(rates, 3) = axes * state.angular_velocity;
    if (free) {
      result.segment(4, 3) = flight.place(Real(t) - begin).cast<double>();
      result.tail(3) = flight.velocity_after(Real(t) - begin).cast<double>();
    }
    return result;
  };
  const auto error = [=, of_top = motion->error, of_flight = FlightError(flight)](
                         double t, double smallest) mutable {
    // Attitudes are rotated there and back.
    constexpr double of_turns = 2 * std::numeric_limits<double>::epsilon();
    const double turned = of_top(t, smallest) + of_turns + of_inputs * rate * std::abs(t - begin);
    return free ? std::max(turned, of_flight(Real(t) - begin, smallest)) : turned;
  };
  return ClosedForm<Eigen::VectorXd>{motion->name, at, error};
}

/// The motion of a free top, written on the axes of a guide that turns.
class TopOnGuide {
 public:
  /// start : the top's attitude and angular velocity in the inertial frame
  TopOnGuide(std::function<GuideAttitude(double)> guide, const Eigen::Quaterniond& joint,
             const ClosedForm<EulerTop::State>& top, const Eigen::Quaterniond& near)
      : guide_(std::move(guide)), joint_(joint), top_(top.at), near_(near) {}

  [[nodiscard]] Eigen::VectorXd at(double t) const {
    const EulerTop::State top = top_(t);
    const auto [rotation, u] = guide_(t);
    const Eigen::Quaterniond before = Eigen::Quaterniond(rotation) * joint_;
    Eigen::Quaterniond q = before.conjugate() * top.attitude;
    if (q.dot(near_) < 0) q.coeffs() = -q.coeffs();
    Eigen::VectorXd y(7);
    y << q.coeffs(), top.angular_velocity - (joint_ * q).conjugate() * u;
    return y;
  }

  [[nodiscard]] GuideAttitude guide(double t) const { return guide_(t); }

 private:
  std::function<GuideAttitude(double)> guide_;
  Eigen::Quaterniond joint_;
  std::function<EulerTop::State(double)> top_;
  Eigen::Quaterniond near_;
};

/// The error of a TopOnGuide, in the measure of RunReport::error_estimate.
class TopOnGuideError {
 public:
  /// beside : the same motion with the angular velocity at the start perturbed by its rounding
  TopOnGuideError(TopOnGuide motion, std::vector<TopOnGuide> beside,
                  std::function<double(double, double)> of_top, double rate, double begin)
      : motion_(std::move(motion)),
        beside_(std::move(beside)),
        of_top_(std::move(of_top)),
        rate_(rate),
        begin_(begin) {
    note(begin);
  }

  [[nodiscard]] double operator()(double t, double smallest) {
    constexpr double u = std::numeric_limits<double>::epsilon() / 2;
    const Eigen::VectorXd y = note(t);
    double turned = of_top_(t, smallest) + of_inputs * rate_ * std::abs(t - begin_) + 80 * u +
                    of_inputs * turning_ * std::max(std::abs(t), std::abs(begin_));
    double rate = 0;
    for (const TopOnGuide& other : beside_) {
      const Eigen::VectorXd off = other.at(t) - y;
      turned += 2 * off.head(4).norm();
      rate += off.tail(3).norm();
    }
    rate += turned * turning_ + 8 * u * (rate_ + turning_);
    return std::max(turned, rate / std::max(size_, smallest));
  }

 private:
  Eigen::VectorXd note(double t) {
    Eigen::VectorXd y = motion_.at(t);
    size_ = std::max(size_, y.tail(3).cwiseAbs().maxCoeff());
    turning_ = std::max(turning_, motion_.guide(t).u.norm());
    return y;
  }

  TopOnGuide motion_;
  std::vector<TopOnGuide> beside_;
  std::function<double(double, double)> of_top_;
  double rate_;  ///< of the absolute rotation
  double begin_;
  double size_ = 0;     ///< the greatest rate against the guide so far
  double turning_ = 0;  ///< the greatest angular velocity of the guide so far
};

/// The same motion, with the given start to the last bit, as that of steps has it.
[[nodiscard]] ClosedForm<Eigen::VectorXd> from_start(ClosedForm<Eigen::VectorXd> motion,
                                                     double begin, const Eigen::VectorXd& y) {
  motion.at = [begin, y, later = std::move(motion.at)](double t) {
    return t == begin ? y : later(t);
  };
  return motion;
}

[[nodiscard]] std::optional<ClosedForm<Eigen::VectorXd>> motion_of(const BodyDescription& body,
                                                                   const Vector3<double>& gravity,
                                                                   double begin,
                                                                   const Eigen::VectorXd& y) {
  switch (body.joint.kind) {
    case JointKind::revolute: return pendulum_motion(body, gravity, begin, y);
    case JointKind::spherical:
    case JointKind::free: return top_motion(body, gravity, begin, y);
    default: return std::nullopt;
  }
}

}  // namespace

std::optional<ClosedForm<Eigen::VectorXd>> closed_form_on_guide(
    const BodyTree& tree, const std::function<GuideAttitude(double)>& guide, double begin,
    const Eigen::VectorXd& y) {
  const BodyDescription* body = lone_body(tree);
  if (!body || body->joint.kind != JointKind::spherical || !y.allFinite()) return std::nullopt;
  if (!body->inertia.value.first_moment.isZero(0)) return std::nullopt;
  const auto turning = turning_body(*body, Vector3<double>::Zero());
  if (!turning) return std::nullopt;
  const Eigen::Quaterniond joint = body->joint.orientation.normalized();
  const Eigen::Quaterniond start = Eigen::Quaterniond(Eigen::Vector4d(y.head<4>())).normalized();
  const auto [rotation, u] = guide(begin);
  const Eigen::Quaterniond attitude = Eigen::Quaterniond(rotation) * joint * start;
  const Vector3<double> w = y.tail<3>() + (joint * start).conjugate() * u;
  const auto top = kreisel::closed_form(turning->top, begin, {attitude, w});
  if (!top) return std::nullopt;
  const TopOnGuide motion(guide, joint, *top, start);
  std::vector<TopOnGuide> beside;
  const double rounding =
      4 * std::numeric_limits<double>::epsilon() * (y.tail<3>().norm() + u.norm());
  for (int i = 0; i < 3; ++i) {
    const auto other = kreisel::closed_form(
        turning->top, begin, {attitude, Vector3<double>(w + rounding * Vector3<double>::Unit(i))});
    beside.emplace_back(guide, joint, *other, start);
  }
  return from_start(
      ClosedForm<Eigen::VectorXd>{top->name + ", on a moving guide",
                                  [motion](double t) { return motion.at(t); },
                                  TopOnGuideError(motion, beside, top->error, w.norm(), begin)},
      begin, y);
}

std::optional<ClosedForm<Eigen::VectorXd>> closed_form(const BodyTree& tree,
                                                       const Vector3<double>& gravity, double begin,
                                                       const Eigen::VectorXd& y) {
  const BodyDescription* body = lone_body(tree);
  auto motion = body ? motion_of(*body, gravity, begin, y) : gyro_motion(tree, begin, y);
  if (!motion) return std::nullopt;
  return from_start(std::move(*motion), begin, y);
}

}  // namespace kreisel::detail
