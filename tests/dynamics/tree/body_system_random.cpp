#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <dynamics/tree/body_system.hpp>
#include <dynamics/tree/joint/list.hpp>

#include <support/cast.hpp>
#include <support/jet.hpp>
#include <support/random_tree.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

/// Random trees against a second formulation that shares only the descriptions with the library.
/// The unknowns of one dense linear system are every body's absolute acceleration, every component
/// of every reaction and every joint acceleration. The equations are Newton's and Euler's about the
/// centres of mass on inertial axes. The kinematics come from poses differentiated twice as
/// functions of time. In 64 bits of mantissa.

using namespace kreisel;

namespace {

using L = long double;
using V3 = Vector3<L>;
using M3 = Matrix3<L>;
using J = test::Jet<L>;
using JV = Vector3<J>;
using JM = Matrix3<J>;
using LongVector = Eigen::Matrix<L, Eigen::Dynamic, 1>;
using LongMatrix = Eigen::Matrix<L, Eigen::Dynamic, Eigen::Dynamic>;

V3 wide(const Vector3<double>& v) { return test::cast<L>(v); }

JV still(const V3& v) {
  return v.unaryExpr([](const L& x) { return J(x); });
}
JM still(const M3& m) {
  return m.unaryExpr([](const L& x) { return J(x); });
}

M3 hat(const V3& a) {
  M3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}
V3 unhat(const M3& m) { return V3(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)) / 2; }

/// The rotation of a quaternion with constant norm.
JM turn(const J& x, const J& y, const J& z, const J& w) {
  const L norm2 = x.value * x.value + y.value * y.value + z.value * z.value + w.value * w.value;
  const J k(2 / norm2);
  const J one(1);
  JM R;
  R << one - k * (y * y + z * z), k * (x * y - z * w), k * (x * z + y * w), k * (x * y + z * w),
      one - k * (x * x + z * z), k * (y * z - x * w), k * (x * z - y * w), k * (y * z + x * w),
      one - k * (x * x + y * y);
  return R;
}

JM turn(const Eigen::Quaterniond& q) {
  return turn(J(L(q.x())), J(L(q.y())), J(L(q.z())), J(L(q.w())));
}

/// Cosines and sines of the angle about a direction.
JM turn(const Vector3<double>& direction, const J& angle) {
  const V3 a = wide(direction).normalized();
  const M3 along = a * a.transpose();
  const M3 across = M3::Identity() - along;
  const M3 around = hat(a);
  JM R;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      R(i, k) = J(along(i, k)) + cos(angle) * J(across(i, k)) + sin(angle) * J(around(i, k));
    }
  }
  return R;
}

struct JetPose {
  JM R = still(M3(M3::Identity()));
  JV x = still(V3(V3::Zero()));
};

/// The guide near this time, to second order in time.
JetPose guide_pose(const FrameMotion<Guide, Inertial>& g) {
  const M3 R = test::cast<L>(g.X.value.rotation);
  const M3 u = hat(wide(g.V.value.resultant));
  const M3 dR = R * u;
  const M3 ddR = R * (u * u + hat(wide(g.dV.value.resultant)));
  const V3 v = wide(g.V.value.moment);
  const V3 x = wide(g.X.value.translation);
  const V3 dx = R * v;
  const V3 ddx = R * (wide(g.dV.value.moment) + u * v);
  JetPose pose;
  for (int i = 0; i < 3; ++i) {
    pose.x[i] = {x[i], dx[i], ddx[i]};
    for (int k = 0; k < 3; ++k) pose.R(i, k) = {R(i, k), dR(i, k), ddR(i, k)};
  }
  return pose;
}

struct Joints {
  std::vector<int> parent, q, v, dof;
  int coordinates = 0;
  int rates = 0;

  explicit Joints(const std::vector<BodyDescription>& bodies) {
    for (const BodyDescription& b : bodies) {
      int p = -1;
      for (std::size_t k = 0; k < parent.size(); ++k) {
        if (bodies[k].name == b.parent) p = static_cast<int>(k);
      }
      const JointType& type = joint_type(b.joint.kind);
      parent.push_back(p);
      q.push_back(coordinates);
      v.push_back(rates);
      dof.push_back(type.rate_count());
      coordinates += type.coordinate_count();
      rates += type.rate_count();
    }
  }
};

struct Kinematics {
  M3 R;
  V3 x, w, v, dw, a;
};

/// The motion of all bodies at constant joint rates.
std::vector<Kinematics> kinematics(const std::vector<BodyDescription>& bodies, const Joints& joints,
                                   const JetPose& guide, const LongVector& q, const LongVector& v) {
  std::vector<JetPose> poses;
  std::vector<Kinematics> result;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Joint& joint = bodies[i].joint;
    const JetPose& P = joints.parent[i] < 0 ? guide : poses[std::size_t(joints.parent[i])];
    const bool held = bodies[i].rule == JointRule::held;
    const auto moving = [&](int k) {
      return J{q[joints.q[i] + k], held ? 0 : v[joints.v[i] + k], 0};
    };
    const auto ball = [&] {
      const auto b = joints.q[i];
      const V3 u = held ? V3::Zero() : V3(v.segment<3>(joints.v[i]));
      const V3 n(q[b], q[b + 1], q[b + 2]);
      const L s = q[b + 3];
      const V3 dn = (s * u + hat(n) * u) / 2;
      const L ds = -n.dot(u) / 2;
      const L bend = -u.squaredNorm() / 4;
      return turn(J(n.x(), dn.x(), bend * n.x()), J(n.y(), dn.y(), bend * n.y()),
                  J(n.z(), dn.z(), bend * n.z()), J(s, ds, bend * s));
    };
    const JM zero = turn(joint.orientation);
    JetPose X;
    JV offset = still(wide(joint.position));
    const V3 axis = wide(joint.axis).normalized();
    switch (joint.kind) {
      case JointKind::fixed: X.R = P.R * zero; break;
      case JointKind::revolute: X.R = P.R * turn(joint.axis, moving(0)) * zero; break;
      case JointKind::universal:
        X.R = P.R * turn(joint.axis, moving(0)) * turn(joint.second_axis, moving(1)) * zero;
        break;
      case JointKind::prismatic:
        X.R = P.R * zero;
        offset += still(axis) * moving(0);
        break;
      case JointKind::free:
        for (int k = 0; k < 3; ++k) {
          offset[k] += J{q[joints.q[i] + 4 + k], held ? 0 : v[joints.v[i] + 3 + k], 0};
        }
        [[fallthrough]];
      case JointKind::spherical: X.R = P.R * zero * ball(); break;
      case JointKind::cylindrical:
        X.R = P.R * turn(joint.axis, moving(0)) * zero;
        offset += still(axis) * moving(1);
        break;
      case JointKind::planar: {
        const V3 across = axis.cross(wide(joint.second_axis)).normalized();
        X.R = P.R * turn(joint.axis, moving(2)) * zero;
        offset += still(V3(across.cross(axis))) * moving(0) + still(across) * moving(1);
        break;
      }
      case JointKind::screw:
        X.R = P.R * turn(joint.axis, moving(0)) * zero;
        offset += still(V3(L(joint.pitch) * axis)) * moving(0);
        break;
    }
    X.x = P.x + P.R * offset;
    const M3 R = test::value(X.R);
    const M3 spin = test::first(X.R) * R.transpose();
    const M3 bent = test::second(X.R) * R.transpose();
    result.push_back(
        {R, test::value(X.x), unhat(spin), test::first(X.x), unhat(bent), test::second(X.x)});
    poses.push_back(X);
  }
  return result;
}

/// Force and torque about the body's origin, on inertial axes.
struct Wrench {
  V3 f = V3::Zero();
  V3 n = V3::Zero();
};

struct Truth {
  LongVector dv;
  std::vector<Wrench> reaction;  ///< by the parent, about the body's origin, on inertial axes
  std::vector<Kinematics> now;
  L force_size = 0;  ///< the largest force or torque of all
};

/// Newton's and Euler's equations of all bodies at once.
Truth newton_euler(const std::vector<BodyDescription>& bodies, const JetPose& guide,
                   const LongVector& q, const LongVector& v, const V3& gravity,
                   const std::vector<Wrench>& loads, const LongVector& joint_force) {
  const Joints joints(bodies);
  const auto n = static_cast<int>(bodies.size());
  Truth truth;
  truth.now = kinematics(bodies, joints, guide, q, v);
  // Partial velocities: the velocities of each body if one rate alone is 1.
  JetPose resting = guide;
  for (J& x : resting.R.reshaped()) x = J(x.value);
  for (J& x : resting.x) x = J(x.value);
  std::vector<std::vector<Kinematics>> by_rate;
  for (int k = 0; k < joints.rates; ++k) {
    by_rate.push_back(kinematics(bodies, joints, resting, q, LongVector::Unit(joints.rates, k)));
  }
  // Unknown: 6 i.. accelerations (a, dw), 6 (n + i).. reactions (f, n), 12 n.. joint rates' rates.
  const int size = 12 * n + joints.rates;
  LongMatrix A = LongMatrix::Zero(size, size);
  LongVector b = LongVector::Zero(size);
  for (int i = 0; i < n; ++i) {
    const BodyDescription& body = bodies[std::size_t(i)];
    const Kinematics& m = truth.now[std::size_t(i)];
    const Inertia<>& T = body.inertia.value;
    const L mass = T.mass;
    const V3 centre = mass > 0 ? V3(wide(T.first_moment) / mass) : V3::Zero();
    const V3 c = m.R * centre;
    const M3 about_origin = test::cast<L>(T.tensor.matrix());
    const M3 about_centre =
        m.R * (about_origin + mass * hat(centre) * hat(centre)) * m.R.transpose();
    const int a = 6 * i;
    const int f = 6 * (n + i);
    A.block<6, 6>(a, a).setIdentity();
    b.segment<3>(a) = m.a;
    b.segment<3>(a + 3) = m.dw;
    for (int k = 0; k < joints.rates; ++k) {
      const Kinematics& unit = by_rate[std::size_t(k)][std::size_t(i)];
      A.block<3, 1>(a, 12 * n + k) = -unit.v;
      A.block<3, 1>(a + 3, 12 * n + k) = -unit.w;
    }
    const Wrench& load = loads[std::size_t(i)];
    A.block<3, 3>(f, a) = mass * M3::Identity();
    A.block<3, 3>(f, a + 3) = -mass * hat(c);
    A.block<3, 3>(f, f) = -M3::Identity();
    b.segment<3>(f) = mass * gravity + load.f - mass * m.w.cross(m.w.cross(c));
    A.block<3, 3>(f + 3, a + 3) = about_centre;
    A.block<3, 3>(f + 3, f) = hat(c);
    A.block<3, 3>(f + 3, f + 3) = -M3::Identity();
    b.segment<3>(f + 3) = load.n - c.cross(load.f) - m.w.cross(about_centre * m.w);
    const int parent = joints.parent[std::size_t(i)];
    if (parent >= 0) {
      // A reaction acts on the body and, reversed, on its parent at the same point.
      const Kinematics& p = truth.now[std::size_t(parent)];
      const Inertia<>& Tp = bodies[std::size_t(parent)].inertia.value;
      const V3 parent_centre =
          p.x + (Tp.mass > 0 ? V3(p.R * wide(Tp.first_moment) / L(Tp.mass)) : V3::Zero());
      const int fp = 6 * (n + parent);
      A.block<3, 3>(fp, f) += M3::Identity();
      A.block<3, 3>(fp + 3, f + 3) += M3::Identity();
      A.block<3, 3>(fp + 3, f) += hat(V3(m.x - parent_centre));
    }
    for (int k = 0; k < joints.dof[std::size_t(i)]; ++k) {
      const int rate = joints.v[std::size_t(i)] + k;
      const int row = 12 * n + rate;
      const Kinematics& unit = by_rate[std::size_t(rate)][std::size_t(i)];
      if (body.rule == JointRule::forces) {
        A.block<1, 3>(row, f) = unit.v.transpose();
        A.block<1, 3>(row, f + 3) = unit.w.transpose();
        b[row] = joint_force[rate];
      } else {
        A(row, row) = 1;
      }
    }
  }
  const Eigen::PartialPivLU<LongMatrix> lu(A);
  LongVector solution = lu.solve(b);
  solution += lu.solve(LongVector(b - A * solution));
  const L residual = (b - A * solution).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  BOOST_TEST(residual <= 1e-15L * (1 + b.cwiseAbs().maxCoeff() + solution.cwiseAbs().maxCoeff()));
  truth.dv = solution.tail(joints.rates);
  truth.force_size = solution.segment(6 * n, 6 * n).cwiseAbs().maxCoeff();
  for (int i = 0; i < n; ++i) {
    const int f = 6 * (n + i);
    truth.reaction.push_back({solution.segment<3>(f), solution.segment<3>(f + 3)});
    truth.force_size = std::max(truth.force_size, L(bodies[std::size_t(i)].inertia.value.mass) *
                                                      truth.now[std::size_t(i)].a.norm());
  }
  return truth;
}

struct PointLoad {
  int body;
  int axes;  ///< 0 body, 1 guide, 2 inertial
  Vector3<double> force, torque, point;
};

/// A load that depends on position and velocity: drag -k v' - d u', with a spring to the guide's
/// origin.
struct Drag {
  double k, d, c;

  Force<Body> operator()(const LoadContext<>& s) const {
    return {
        {-k * s.V_rel.value.moment - c * (s.X.value.rotation.transpose() * s.X.value.translation),
         -d * s.V_rel.value.resultant}};
  }
};

/// A guide frozen at one time of its motion.
struct FrozenGuide {
  FrameMotion<Guide, Inertial> motion;
  FrameMotion<Guide, Inertial> operator()(double) const { return motion; }
};

/// A system at one time, made from a seed.
struct RandomSystem {
  std::vector<BodyDescription> bodies;
  std::vector<PointLoad> loads;
  std::vector<int> dragged;
  Drag drag = {0.3, 0.2, 1.5};
  FrozenGuide guide;
  Gravity gravity;
  Eigen::VectorXd y;
  Eigen::VectorXd extra;

  explicit RandomSystem(std::uint64_t seed) {
    test::Sample sample(seed);
    const auto vec = [&](double size) { return Vector3<double>(size * sample.direction()); };
    const auto quaternion = [&] {
      return Eigen::Quaterniond(sample.uniform(-1, 1), sample.uniform(-1, 1), sample.uniform(-1, 1),
                                sample.uniform(0.2, 1));
    };
    const int n = 1 + static_cast<int>(sample.uniform(0, 5));
    for (int i = 0; i < n; ++i) {
      BodyDescription b;
      b.name = "body " + std::to_string(i);
      const int parent = static_cast<int>(sample.uniform(-1, i));
      if (i > 0 && !sample.once_in(6)) b.parent = "body " + std::to_string(parent < 0 ? 0 : parent);
      b.joint.kind = test::random_kind(sample);
      b.joint.axis = vec(sample.uniform(0.5, 2));
      b.joint.second_axis = b.joint.axis.cross(vec(1)) + 0.3 * b.joint.axis;
      if (b.joint.second_axis.cross(b.joint.axis).norm() < 0.1) {
        b.joint.second_axis = b.joint.axis.unitOrthogonal();
      }
      b.joint.position = vec(sample.uniform(0, 1));
      b.joint.pitch = sample.uniform(-0.5, 0.5);
      if (!sample.once_in(3)) b.joint.orientation = quaternion();
      const Matrix3<double> axes = sample.rotation();
      const Vector3<double> thirds(sample.uniform(0.02, 0.2), sample.uniform(0.02, 0.2),
                                   sample.uniform(0.02, 0.2));
      const Vector3<double> moments(thirds.y() + thirds.z(), thirds.x() + thirds.z(),
                                    thirds.x() + thirds.y());
      const double mass = sample.uniform(0.3, 3);
      Matrix3<double> tensor = mass * axes * moments.asDiagonal() * axes.transpose();
      tensor = (tensor + tensor.transpose()).eval() / 2;
      b.inertia = InertiaTensor<Body>::about_centre(mass, vec(sample.uniform(0, 0.5)), tensor);
      if (sample.once_in(8)) b.rule = JointRule::held;
      if (b.joint.kind == JointKind::revolute && sample.once_in(4)) {
        b.rule = JointRule::driven;
      }
      if (sample.once_in(2)) {
        const JointType& type = joint_type(b.joint.kind);
        b.forces.resize(static_cast<std::size_t>(type.rate_count()));
        for (JointForce& f : b.forces) {
          if (!type.has_attitude()) f.stiffness = sample.uniform(0, 5);
          f.rest = sample.uniform(-1, 1);
          f.damping = sample.uniform(0, 2);
          f.constant = sample.uniform(-2, 2);
        }
      }
      if (sample.once_in(3)) {
        const PointLoad load{i, static_cast<int>(sample.uniform(0, 3)), vec(4), vec(2), vec(0.5)};
        if (load.axes == 0)
          b.loads.emplace_back(ConstantLoad<Body>{load.force, load.torque, load.point});
        if (load.axes == 1)
          b.loads.emplace_back(ConstantLoad<Guide>{load.force, load.torque, load.point});
        if (load.axes == 2)
          b.loads.emplace_back(ConstantLoad<Inertial>{load.force, load.torque, load.point});
        loads.push_back(load);
      }
      if (sample.once_in(4)) {
        b.loads.emplace_back(drag);
        dragged.push_back(i);
      }
      bodies.push_back(b);
    }
    if (!sample.once_in(6)) {
      guide.motion.X.value = {sample.rotation(), vec(3)};
      guide.motion.V.value = {vec(sample.uniform(0, 3)), vec(5)};
      guide.motion.dV.value = {vec(sample.uniform(0, 3)), vec(5)};
    }
    const Vector3<double> g = vec(9.8);
    if (sample.once_in(3)) {
      gravity = UniformGravity<Guide>{g};
    } else if (sample.once_in(2)) {
      gravity = UniformGravity<Inertial>{g};
    }
    const Joints joints(bodies);
    y.resize(joints.coordinates + joints.rates);
    extra.resize(joints.rates);
    for (double& x : y) x = sample.uniform(-2, 2);
    for (double& x : extra) x = sample.uniform(-3, 3);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (joint_type(bodies[i].joint.kind).has_attitude())
        y[joints.q[i] + 3] = sample.uniform(0.5, 2);
    }
  }

  [[nodiscard]] BodySystem<FrozenGuide> system() const { return {guide, bodies, gravity}; }

  /// The same with the extra joint forces included in the description.
  [[nodiscard]] BodySystem<FrozenGuide> pushed() const {
    const Joints joints(bodies);
    std::vector<BodyDescription> pushed = bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      pushed[i].forces.resize(static_cast<std::size_t>(joints.dof[i]));
      for (int k = 0; k < joints.dof[i]; ++k) {
        pushed[i].forces[static_cast<std::size_t>(k)].constant += extra[joints.v[i] + k];
      }
    }
    return {guide, pushed, gravity};
  }
  [[nodiscard]] LongVector q() const { return y.head(Joints(bodies).coordinates).cast<L>(); }
  [[nodiscard]] LongVector v() const { return y.tail(extra.size()).cast<L>(); }

  [[nodiscard]] V3 field() const {
    if (const auto* g = std::get_if<UniformGravity<Inertial>>(&gravity)) return wide(g->g);
    if (const auto* g = std::get_if<UniformGravity<Guide>>(&gravity)) {
      return test::cast<L>(guide.motion.X.value.rotation) * wide(g->g);
    }
    return V3::Zero();
  }

  [[nodiscard]] std::vector<Wrench> load_wrenches() const {
    const Joints joints(bodies);
    const JetPose G = guide_pose(guide.motion);
    const M3 R_G = test::value(G.R);
    const V3 w_G = unhat(test::first(G.R) * R_G.transpose());
    const std::vector<Kinematics> now = kinematics(bodies, joints, G, q(), v());
    std::vector<Wrench> result(bodies.size());
    for (const PointLoad& load : loads) {
      const M3 R = load.axes == 0   ? now[std::size_t(load.body)].R
                   : load.axes == 1 ? R_G
                                    : M3(M3::Identity());
      const V3 f = R * wide(load.force);
      const V3 arm = now[std::size_t(load.body)].R * wide(load.point);
      result[std::size_t(load.body)].f += f;
      result[std::size_t(load.body)].n += R * wide(load.torque) + arm.cross(f);
    }
    for (const int i : dragged) {
      const Kinematics& m = now[std::size_t(i)];
      const V3 x = m.x - test::value(G.x);
      const V3 v_rel = m.v - test::first(G.x) - w_G.cross(x);
      result[std::size_t(i)].f += -L(drag.k) * v_rel - L(drag.c) * x;
      result[std::size_t(i)].n += -L(drag.d) * (m.w - w_G);
    }
    return result;
  }

  /// Springs, dampers and constants, without the extra ones.
  [[nodiscard]] LongVector joint_forces() const {
    const Joints joints(bodies);
    LongVector result = LongVector::Zero(joints.rates);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t k = 0; k < bodies[i].forces.size(); ++k) {
        const JointForce& f = bodies[i].forces[k];
        const int rate = joints.v[i] + static_cast<int>(k);
        result[rate] = L(f.constant) - L(f.damping) * v()[rate];
        if (!joint_type(bodies[i].joint.kind).has_attitude()) {
          result[rate] -= L(f.stiffness) * (q()[joints.q[i] + static_cast<int>(k)] - L(f.rest));
        }
      }
    }
    return result;
  }
};

/// The largest distance between the reactions of library and truth.
template <class Reaction>
double distance(const Truth& truth, const Reaction& reaction_of) {
  double worst = 0;
  for (std::size_t i = 0; i < truth.reaction.size(); ++i) {
    const M3 to_body = truth.now[i].R.transpose();
    const Motor<> found = reaction_of(i);
    const V3 df = wide(found.resultant) - to_body * truth.reaction[i].f;
    const V3 dn = wide(found.moment) - to_body * truth.reaction[i].n;
    worst = test::worst_of(worst, static_cast<double>(test::worst_of(df.norm(), dn.norm())));
  }
  return worst;
}

/// Condition of the mass matrix scaled to a diagonal of 1: the amplification of rounding in forces
/// by any method.
double condition(const Eigen::MatrixXd& mass) {
  if (mass.rows() == 0) return 1;
  const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * mass * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().maxCoeff() / eigen.eigenvalues().minCoeff();
}

constexpr std::uint64_t seeds = 1200;

}  // namespace

BOOST_AUTO_TEST_SUITE(a_random_tree)

// Relative to the largest acceleration and to the largest force, times the condition of the mass
// matrix if that is above 1e3.
BOOST_AUTO_TEST_CASE(agrees_with_newton_and_euler) {
  double worst_dv = 0;
  double worst_reaction = 0;
  double worst_condition = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomSystem random(seed);
      const auto system = random.system();
      BodyWorkspace w = system.workspace();
      Eigen::VectorXd dv;
      Eigen::MatrixXd mass;
      system.mass_matrix(random.y, mass, w);
      const double k = condition(mass);
      const double allowed = 1e-11 * std::max(1.0, k / 1e3);
      const JetPose guide = guide_pose(random.guide.motion);
      const auto loads = random.load_wrenches();

      const Truth truth = newton_euler(random.bodies, guide, random.q(), random.v(), random.field(),
                                       loads, random.joint_forces() + random.extra.cast<L>());
      system.accelerations(0, random.y, random.extra, dv, w);
      double error = 0;
      double size = 1;
      for (Eigen::Index i = 0; i < dv.size(); ++i) {
        error = test::worst_of(error, static_cast<double>(std::abs(L(dv[i]) - truth.dv[i])));
        size = std::max(size, static_cast<double>(std::abs(truth.dv[i])));
      }
      BOOST_TEST(error <= allowed * size);

      JointReactions reactions;
      random.pushed().reactions(0, random.y, reactions, w);
      const double off = distance(truth, [&](std::size_t i) { return reactions.on_body[i].value; });
      const auto force = std::max(1.0, static_cast<double>(truth.force_size));
      BOOST_TEST(off <= allowed * force);
      worst_dv = test::worst_of(worst_dv, error / size / std::max(1.0, k / 1e3));
      worst_reaction = test::worst_of(worst_reaction, off / force / std::max(1.0, k / 1e3));
      worst_condition = std::max(worst_condition, k);
    }
  }
  BOOST_TEST_MESSAGE(seeds << " systems: accelerations " << worst_dv << ", reactions "
                           << worst_reaction << ", worst condition " << worst_condition);
}

// Each cause alone, by the same second formulation.
BOOST_AUTO_TEST_CASE(splits_its_reactions_by_cause) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomSystem random(seed);
      const auto system = random.system();
      BodyWorkspace w = system.workspace();
      std::vector<ReactionParts> parts;
      system.reaction_parts(0, random.y, parts, w);
      JointReactions whole;
      system.reactions(0, random.y, whole, w);

      const JetPose moving = guide_pose(random.guide.motion);
      const JetPose resting = guide_pose({random.guide.motion.X, {}, {}});
      const LongVector q = random.q();
      const LongVector v = random.v();
      const LongVector none = LongVector::Zero(v.size());
      const std::vector<Wrench> unloaded(random.bodies.size());
      const V3 zero = V3::Zero();
      const Truth spin = newton_euler(random.bodies, resting, q, v, zero, unloaded, none);
      Truth guide = newton_euler(random.bodies, moving, q, v, zero, unloaded, none);
      for (std::size_t i = 0; i < guide.reaction.size(); ++i) {
        guide.reaction[i].f -= spin.reaction[i].f;
        guide.reaction[i].n -= spin.reaction[i].n;
      }
      const Truth gravity =
          newton_euler(random.bodies, resting, q, none, random.field(), unloaded, none);
      const Truth forces = newton_euler(random.bodies, resting, q, none, zero,
                                        random.load_wrenches(), random.joint_forces());
      const auto size = static_cast<double>(
          std::max({spin.force_size, guide.force_size, gravity.force_size, forces.force_size}));
      const double off =
          test::worst_of(distance(spin, [&](std::size_t i) { return parts[i].spin.value; }),
                         distance(guide, [&](std::size_t i) { return parts[i].guide.value; }),
                         distance(gravity, [&](std::size_t i) { return parts[i].gravity.value; }),
                         distance(forces, [&](std::size_t i) { return parts[i].forces.value; }));
      BOOST_TEST(off <= 1e-11 * size);
      worst = test::worst_of(worst, off / size);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const Motor<> rest = parts[i].total().value - whole.on_body[i].value;
        BOOST_TEST(rest.resultant.norm() + rest.moment.norm() <= 1e-12 * size);
      }
    }
  }
  BOOST_TEST_MESSAGE("parts of reactions: " << worst);
}

// Action equals reaction: the forces of joints and loads on a body equal those of its motion, (26).
// Drives give the torque of inverse dynamics, if there are any.
BOOST_AUTO_TEST_CASE(balances_every_body) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomSystem random(seed);
      const auto system = random.system();
      const Joints joints(random.bodies);
      BodyWorkspace w = system.workspace();
      JointReactions r;
      system.reactions(0, random.y, r, w);
      std::vector<Motor<>> given(random.bodies.size());
      double size = 1;
      for (int i = 0; i < system.body_count(); ++i) {
        const auto b = std::size_t(i);
        const LoadContext<> s = system.situation(0, random.y, i, w);
        given[b] += r.on_body[b].value;
        size =
            std::max(size, r.on_body[b].value.moment.norm() + r.on_body[b].value.resultant.norm());
        for (const BodyLoad& load : random.bodies[b].loads) given[b] += load(s).value;
        if (const auto* g = std::get_if<UniformGravity<Guide>>(&random.gravity)) {
          given[b] += (*g)(s).value;
        }
        if (const auto* g = std::get_if<UniformGravity<Inertial>>(&random.gravity)) {
          given[b] += (*g)(s).value;
        }
        if (joints.parent[b] >= 0) {
          const auto p = std::size_t(joints.parent[b]);
          const LoadContext<> above = system.situation(0, random.y, joints.parent[b], w);
          given[p] -= ((above.X.inverse() * s.X).value * r.on_body[b].value);
        }
      }
      for (int i = 0; i < system.body_count(); ++i) {
        const ForceParts<Body> terms = system.terms(0, random.y, i, w);
        const Motor<> rest = terms.total().value - given[std::size_t(i)];
        BOOST_TEST(rest.resultant.norm() + rest.moment.norm() <= 1e-12 * size);
      }

      Eigen::VectorXd dv;
      Eigen::VectorXd asked;
      system.accelerations(0, random.y, {}, dv, w);
      system.joint_forces(0, random.y, dv, asked, w);
      for (std::size_t i = 0; i < random.bodies.size(); ++i) {
        const bool driven = random.bodies[i].rule != JointRule::forces;
        for (int k = joints.v[i]; k < joints.v[i] + joints.dof[i]; ++k) {
          BOOST_TEST(r.drive[k] == (driven ? asked[k] : 0));
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(inverse_dynamics_returns_the_forces) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      const RandomSystem random(seed);
      const auto system = random.system();
      BodyWorkspace w = system.workspace();
      Eigen::VectorXd dv;
      Eigen::VectorXd found;
      system.accelerations(0, random.y, random.extra, dv, w);
      system.joint_forces(0, random.y, dv, found, w);
      Eigen::VectorXd none;
      system.joint_forces(0, random.y, Eigen::VectorXd::Zero(dv.size()), none, w);
      const Joints joints(random.bodies);
      for (std::size_t i = 0; i < random.bodies.size(); ++i) {
        if (random.bodies[i].rule != JointRule::forces) continue;
        for (int k = joints.v[i]; k < joints.v[i] + joints.dof[i]; ++k) {
          const double size = 10 + none.cwiseAbs().maxCoeff();
          BOOST_TEST(std::abs(found[k] - random.extra[k]) <= 1e-12 * size);
        }
      }
    }
  }
}

// Column by column from the inverse dynamics; symmetric and positive.
BOOST_AUTO_TEST_CASE(has_the_mass_matrix_of_its_inverse_dynamics) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    BOOST_TEST_CONTEXT("seed = " << seed) {
      RandomSystem random(seed);
      for (BodyDescription& body : random.bodies) body.rule = JointRule::forces;
      const auto system = random.system();
      BodyWorkspace w = system.workspace();
      Eigen::MatrixXd mass;
      system.mass_matrix(random.y, mass, w);
      Eigen::VectorXd column;
      Eigen::VectorXd bias;
      const auto n = random.extra.size();
      system.joint_forces(0, random.y, Eigen::VectorXd::Zero(n), bias, w);
      for (Eigen::Index k = 0; k < n; ++k) {
        system.joint_forces(0, random.y, Eigen::VectorXd::Unit(n, k), column, w);
        const double size = bias.cwiseAbs().maxCoeff() + mass.cwiseAbs().maxCoeff();
        BOOST_TEST((column - bias - mass.col(k)).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() <=
                   1e-13 * size);
      }
      BOOST_TEST((n == 0 || Eigen::LLT<Eigen::MatrixXd>(mass).info() == Eigen::Success));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
