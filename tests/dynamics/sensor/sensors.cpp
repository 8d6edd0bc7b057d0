// Readings of sensors against closed forms and against poses differentiated in 50 digits.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/sensor/sensors.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/attitude.hpp>

#include <support/cast.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;

namespace {

using Digits = boost::multiprecision::cpp_bin_float_50;
using Vector = Vector3<double>;

const Vector x_axis = Vector::UnitX();
const Vector y_axis = Vector::UnitY();
const Vector z_axis = Vector::UnitZ();

InertiaTensor<Body> inertia(double mass = 2, const Vector& centre = {0.1, -0.2, 0.3}) {
  return InertiaTensor<Body>::about_centre(mass, centre, Vector(0.3, 0.4, 0.5).asDiagonal());
}

BodyDescription described(const std::string& name, const std::string& parent, const Joint& joint,
                          const InertiaTensor<Body>& tensor = inertia()) {
  return {.name = name, .parent = parent, .joint = joint, .inertia = tensor};
}

/// A bob of 2 kg in a spherical joint.
BodyDescription hanging(const Vector& centre = {0, 0, -0.5},
                        const Vector& moments = {0.3, 0.3, 0.1}) {
  return described("bob", "guide", {.kind = JointKind::spherical},
                   InertiaTensor<Body>::about_centre(2, centre, moments.asDiagonal()));
}

double off(const Vector& found, const Vector& expected) { return (found - expected).norm(); }

}  // namespace

BOOST_AUTO_TEST_SUITE(sensors_in_closed_form)

// A body that rotates about a fixed axis: w, and w^2 r towards the axis.
BOOST_AUTO_TEST_CASE(on_a_body_at_constant_rate) {
  auto wheel = described("wheel", "guide", {.kind = JointKind::revolute, .axis = z_axis});
  wheel.rule = JointRule::driven;
  const BodySystem<RestingFrame<>> system{RestingFrame<>{}, {wheel}};
  BodyWorkspace w = system.workspace();
  const double rate = 12.5, r = 0.75;
  const auto now = kinematics(system, 0, Eigen::Vector2d(0.9, rate), w);
  BOOST_TEST(off(Gyro{0}(now), rate * z_axis) <= 1e-15 * rate);
  const Vector f = Accelerometer{0, r * x_axis}(now);
  BOOST_TEST(off(f, -rate * rate * r * x_axis) <= 1e-15 * rate * rate * r);
  // A rotation by a right angle about z takes the sensor's x to the body's y.
  const Eigen::Quaterniond turned(std::sqrt(0.5), 0, 0, std::sqrt(0.5));
  BOOST_TEST(off(Accelerometer{0, r * x_axis, turned}(now), rate * rate * r * y_axis) <=
             1e-15 * rate * rate * r);
}

// P = -d e_z at the angle q about y:  f = (-d q'' - g sin q, 0, d q'^2 + g cos q).  It has no
// transverse component if d is the distance of the centre of oscillation.
BOOST_AUTO_TEST_CASE(on_a_pendulum) {
  const double m = 2, s = 0.5, g = 9.8125, q = 0.7, rate = 1.25, d = 0.3;
  const auto rod = described("rod", "guide", {.kind = JointKind::revolute, .axis = y_axis},
                             inertia(m, {0, 0, -s}));
  const double moment = 0.4 + m * s * s;
  const double acceleration = -m * g * s / moment * std::sin(q);
  const Vector expected{-d * acceleration - g * std::sin(q), 0, d * rate * rate + g * std::cos(q)};
  for (const Gravity& gravity : {Gravity(UniformGravity<Guide>{{0, 0, -g}}),
                                 Gravity(UniformGravity<Inertial>{{0, 0, -g}})}) {
    const BodySystem<RestingFrame<>> system{RestingFrame<>{}, {rod}, gravity};
    BodyWorkspace w = system.workspace();
    const auto now = kinematics(system, 0, Eigen::Vector2d(q, rate), w);
    BOOST_TEST(off(Accelerometer{0, {0, 0, -d}}(now), expected) <= 4e-15 * g);
    const Vector middle = Accelerometer{0, {0, 0, -moment / (m * s)}}(now);
    BOOST_TEST(std::abs(middle.x()) <= 4e-15 * g);
  }
}

// Swings about a horizontal axis whose plane has the angle -b from x, clockwise from above.
BOOST_AUTO_TEST_CASE(azimuth_of_a_plane_swing) {
  const BodySystem<RestingFrame<>> system{
      RestingFrame<>{}, {hanging()}, UniformGravity<Guide>{{0, 0, -9.8125}}};
  BodyWorkspace w = system.workspace();
  for (const double b : {0.3, -1.2, 0.0}) {
    const Vector axis(std::sin(b), -std::cos(b), 0);
    for (const auto& [angle, rate] : {std::pair(0.7, 0.0), {1e-6, 0.0}, {-0.4, 1.5}, {0.0, 2.0}}) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(angle, axis));
      Eigen::VectorXd y(7);
      y << q.coeffs(), rate * axis;
      const auto now = kinematics(system, 0, y, w);
      BOOST_TEST(std::abs(AzimuthSensor{0, {0, 0, -1}}(now) + b) <= 1e-14);
    }
  }
}

// A guide turns unevenly about the vertical through the pivot. The plane keeps its direction in the
// inertial frame, and turns back in the guide.
BOOST_AUTO_TEST_CASE(azimuth_on_an_uneven_turntable) {
  const auto table = posed<Guide, Inertial>([](const auto& t) {
    using std::cos;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const T half = T(0.1) * t + T(0.4) * t * t;
    return Pose<T>::from(Eigen::Quaternion<T>(T(cos(half)), T(0), T(0), T(sin(half))),
                         Vector3<T>(T(0), T(0), T(0)));
  });
  const BodySystem<std::decay_t<decltype(table)>> system{
      table, {hanging()}, UniformGravity<Guide>{{0, 0, -9.8125}}};
  BodyWorkspace w = system.workspace();
  for (const double t : {0.0, 0.5, 1.0}) {
    const double turned = 0.2 * t + 0.8 * t * t, rate = 0.2 + 1.6 * t;
    for (const auto& [angle, speed] : {std::pair(0.7, 0.0), {1e-3, 0.0}, {-0.4, 1.5}, {0.0, 2.0}}) {
      const Eigen::Quaterniond back(Eigen::AngleAxisd(-turned, z_axis));
      const Eigen::Quaterniond swung(Eigen::AngleAxisd(angle, -y_axis));
      Eigen::VectorXd y(7);
      y << (back * swung).coeffs(), -speed * y_axis - swung.conjugate() * Vector(0, 0, rate);
      const auto now = kinematics(system, t, y, w);
      BOOST_TEST(std::abs(AzimuthSensor{0, {0, 0, -1}}(now)-turned) <= 1e-14);
    }
  }
}

// A turntable tilts the plumb line outwards by a with  tan a = u^2 (r + d sin a)/g,  for a pivot at
// the distance r from its axis. A small bob that is at rest in the guide, beside the plumb line, is
// at a turning point. The force to the plumb line has the stiffness g/d in all directions but for
// u^2 sin^2 a, which turns it by at most u^2 sin^2 a d/g.
BOOST_AUTO_TEST_CASE(azimuth_about_the_plumb_line) {
  const double u = 0.5, r = 2, d = 1, g = 9.8125, side = 0.01;
  double tilt = 0;
  for (int i = 0; i < 20; ++i) tilt = std::atan(u * u * (r + d * std::sin(tilt)) / g);
  auto bob = hanging({0, 0, -d}, Vector::Constant(1e-9));
  bob.joint.position = {r, 0, 0};
  const RotatingFrame<> table{.angular_velocity = {0, 0, u}};
  const BodySystem<RotatingFrame<>> system{table, {bob}, UniformGravity<Guide>{{0, 0, -g}}};
  BodyWorkspace w = system.workspace();
  const Eigen::Quaterniond plumb(Eigen::AngleAxisd(-tilt, y_axis));
  for (const double b : {0.3, -1.2}) {
    const Vector axis(std::sin(b), -std::cos(b), 0);
    const Eigen::Quaterniond q = plumb * Eigen::AngleAxisd(side, axis);
    Eigen::VectorXd y(7);
    y << q.coeffs(), Vector::Zero();
    const auto now = kinematics(system, 0, y, w);
    const double found = AzimuthSensor{0, {0, 0, -d}, {r, 0, 0}}(now);
    BOOST_TEST(std::abs(found + b) <= u * u * std::pow(std::sin(tilt), 2) * d / g);
  }
}

BOOST_AUTO_TEST_CASE(azimuth_in_free_fall_has_no_vertical) {
  const Vector g(0, 0, -9.8125);
  const RotatingFrame<> falling{.origin_acceleration = g};
  const BodySystem<RotatingFrame<>> system{falling, {hanging()}, UniformGravity<Inertial>{g}};
  BodyWorkspace w = system.workspace();
  Eigen::VectorXd y = Eigen::VectorXd::Zero(7);
  y[3] = 1;
  const auto now = kinematics(system, 0, y, w);
  BOOST_CHECK_THROW((void)AzimuthSensor({0, {0, 0, -1}})(now), ComputationFailed);
}

// Coning: the attitude (cos a/2; sin a/2 cos wt, sin a/2 sin wt, 0) has on its own axes the rate
// w (-sin a sin wt, sin a cos wt, -2 sin^2 a/2).
BOOST_AUTO_TEST_CASE(gyro_in_coning) {
  const double a = 0.3, rate = 4.5;
  const auto coning = posed<Guide, Inertial>([a, rate](const auto& t) {
    using std::cos;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const T half(a / 2);
    return Pose<T>::from(Eigen::Quaternion<T>(T(cos(half)), T(sin(half)) * cos(rate * t),
                                              T(sin(half)) * sin(rate * t), T(0)),
                         Vector3<T>(T(0), T(0), T(0)));
  });
  const BodySystem<std::decay_t<decltype(coning)>> system{
      coning, {described("imu", "guide", {.kind = JointKind::fixed})}};
  BodyWorkspace w = system.workspace();
  for (const double t : {0.0, 0.4, 2.9}) {
    const auto now = kinematics(system, t, Eigen::VectorXd(0), w);
    const double h = std::sin(a / 2);
    const Vector expected{-std::sin(a) * std::sin(rate * t), std::sin(a) * std::cos(rate * t),
                          -2 * h * h};
    BOOST_TEST(off(Gyro{0}(now), rate * expected) <= 2e-14);
  }
}

// In free fall about a planet the reading at the centre of mass is 0. At a point r above, the
// reading is the deficit of gravitation.
BOOST_AUTO_TEST_CASE(accelerometer_in_free_fall) {
  const double R = 7e6, r = 2;
  const OblateGravitation<> planet{.j2 = 0};
  auto satellite = described("s", "guide", {.kind = JointKind::free}, inertia(2, {0, 0, 0}));
  satellite.loads.emplace_back(planet);
  const BodySystem<RestingFrame<>> system{RestingFrame<>{}, {satellite}};
  const BodyLoad gravitation(planet);
  auto state = system.rest();
  state.coordinates[4] = R;
  BodyWorkspace w = system.workspace();
  const auto now = kinematics(system, 0, system.to_vector(state), w, &gravitation);
  BOOST_TEST(Accelerometer{0}(now).norm() <= 1e-15 * 9);
  const double gradient = planet.parameter / ((R + r) * (R + r)) - planet.parameter / (R * R);
  BOOST_TEST(off(Accelerometer{0, r * x_axis}(now), gradient * x_axis) <= 1e-14 * 9);
  // Without gravitation the reading would be kinematic.
  BOOST_TEST(Accelerometer{0}(kinematics(system, 0, system.to_vector(state), w)).norm() > 8);
}

// A body held at its origin, with the weight m g at its centre c: the torque about p is (p - c) x m
// g.
BOOST_AUTO_TEST_CASE(reaction_about_a_point) {
  const Vector c{0.5, 0.25, 0}, p{0.1, 0, -0.4};
  const double weight = 2 * 9.8125;
  const BodySystem<RestingFrame<>> system{
      RestingFrame<>{},
      {described("arm", "guide", {.kind = JointKind::fixed}, inertia(2, c))},
      UniformGravity<Guide>{{0, 0, -9.8125}}};
  BodyWorkspace w = system.workspace();
  const auto now = kinematics(system, 0, Eigen::VectorXd(0), w);
  const Motor<> about_p = ReactionSensor{0, p}(now);
  BOOST_TEST(off(about_p.resultant, weight * z_axis) <= 1e-15 * weight);
  BOOST_TEST(off(about_p.moment, (c - p).cross(weight * z_axis)) <= 2e-15 * weight);
  const Eigen::Quaterniond turned(std::sqrt(0.5), std::sqrt(0.5), 0, 0);  // z to -y
  const Motor<> on_others = ReactionSensor{0, p, SensorFrame::guide(), turned}(now);
  BOOST_TEST(off(on_others.resultant, weight * y_axis) <= 1e-15 * weight);
}

BOOST_AUTO_TEST_SUITE_END()

namespace {

using Vec = Vector3<Digits>;
using Mat = Matrix3<Digits>;
using Quat = Eigen::Quaternion<Digits>;

Vec wide(const Vector& v) { return test::cast<Digits>(v); }

Mat rotation(const Quat& q) { return q.normalized().toRotationMatrix(); }

/// The rotation by a vector.
Mat turn(const Vec& v) {
  const Digits angle = v.norm();
  if (angle == 0) return Mat::Identity();
  return Eigen::AngleAxis<Digits>(angle, v / angle).toRotationMatrix();
}

struct Placed {
  Mat R = Mat::Identity();
  Vec x = Vec::Zero();

  [[nodiscard]] Placed then(const Placed& inner) const {
    return {R * inner.R, Vec(x + R * inner.x)};
  }
};

/// A guide whose quaternion and position are quadratic in t.
struct Quadratic {
  PoseDerivatives<double> p;

  FrameMotion<Guide, Inertial> operator()(double /*t = 0*/) const {
    return frame_motion<Guide, Inertial>(p);
  }
  [[nodiscard]] Placed at(const Digits& t) const {
    const auto quadratic = [&t](double a, double b, double c) {
      return Digits(a) + t * Digits(b) + t * t / 2 * Digits(c);
    };
    Quat q;
    for (int i = 0; i < 4; ++i) {
      q.coeffs()[i] = quadratic(p.q.coeffs()[i], p.dq.coeffs()[i], p.ddq.coeffs()[i]);
    }
    Vec x;
    for (int i = 0; i < 3; ++i) x[i] = quadratic(p.x[i], p.dx[i], p.ddx[i]);
    return {rotation(q), x};
  }
};

/// The pose of a body relative to its parent near t = 0, by coordinates, rates and accelerations.
Placed joint_at(const Joint& joint, const double* q, const double* v, const double* dv,
                const Digits& t) {
  const auto moved = [&](int k) {
    return Digits(q[k]) + t * Digits(v[k]) + t * t / 2 * Digits(dv[k]);
  };
  const auto vector = [&](const double* first, const double* second) {
    Vec result;
    for (int i = 0; i < 3; ++i) result[i] = t * Digits(first[i]) + t * t / 2 * Digits(second[i]);
    return result;
  };
  const Eigen::Quaterniond& o = joint.orientation;
  const Mat zero = rotation(Quat(o.w(), o.x(), o.y(), o.z()));
  Placed result{zero, wide(joint.position)};
  const Vec axis = wide(joint.axis).normalized();
  switch (joint.kind) {
    case JointKind::fixed: break;
    case JointKind::revolute: result.R = turn(Vec(axis * moved(0))) * zero; break;
    case JointKind::prismatic: result.x += axis * moved(0); break;
    case JointKind::universal:
      result.R = turn(Vec(axis * moved(0))) *
                 turn(Vec(wide(joint.second_axis).normalized() * moved(1))) * zero;
      break;
    case JointKind::cylindrical:
      result.R = turn(Vec(axis * moved(0))) * zero;
      result.x += axis * moved(1);
      break;
    case JointKind::planar: {
      const Vec first = axis.cross(wide(joint.second_axis)).cross(axis).normalized();
      result.x += first * moved(0) + axis.cross(first) * moved(1);
      result.R = turn(Vec(axis * moved(2))) * zero;
      break;
    }
    case JointKind::screw:
      result.R = turn(Vec(axis * moved(0))) * zero;
      result.x += axis * (Digits(joint.pitch) * moved(0));
      break;
    case JointKind::free:
      for (int i = 0; i < 3; ++i) {
        result.x[i] += Digits(q[4 + i]) + t * Digits(v[3 + i]) + t * t / 2 * Digits(dv[3 + i]);
      }
      [[fallthrough]];
    case JointKind::spherical:
      result.R = zero * rotation(Quat(q[3], q[0], q[1], q[2])) * turn(vector(v, dv));
  }
  return result;
}

/// A function of time and its first two derivatives at 0, by differences: of 50 digits 25 remain.
template <class Value, class Function>
std::array<Value, 3> derivatives(const Function& f) {
  const Digits h("1e-12");
  const Value before = f(Digits(-h));
  const Value now = f(Digits(0));
  const Value after = f(h);
  return {now, Value((after - before) / (2 * h)), Value((after - 2 * now + before) / (h * h))};
}

/// A tree with all kinds of joints and a rotor, on a guide in general motion.
struct Case {
  Quadratic guide;
  std::vector<BodyDescription> bodies;
  Eigen::VectorXd y;
};

Eigen::Quaterniond some_quaternion(test::Sample& s) {
  return Eigen::Quaterniond(s.uniform(-1, 1), s.uniform(-1, 1), s.uniform(-1, 1), s.uniform(-1, 1))
      .normalized();
}

Vector some(test::Sample& s, double size = 1) {
  return {s.uniform(-size, size), s.uniform(-size, size), s.uniform(-size, size)};
}

Case some_case(unsigned seed) {
  test::Sample s(seed);
  Case c;
  const auto four = [&s] {
    return Eigen::Quaterniond(s.uniform(-1, 1), s.uniform(-1, 1), s.uniform(-1, 1),
                              s.uniform(-1, 1));
  };
  c.guide.p = {some_quaternion(s), four(), four(), some(s, 10), some(s, 10), some(s, 10)};
  const auto add = [&](const std::string& name, const std::string& parent, JointKind kind) {
    c.bodies.push_back(
        described(name, parent,
                  {kind, some(s).normalized(), some(s).normalized(), some(s), some_quaternion(s)},
                  inertia(2, some(s, 0.3))));
    c.bodies.back().joint.pitch = kind == JointKind::screw ? 0.3 : 0;
  };
  add("a", "guide", JointKind::revolute);
  add("b", "a", JointKind::spherical);
  add("c", "b", JointKind::prismatic);
  add("d", "guide", JointKind::free);
  add("e", "d", JointKind::universal);
  add("f", "e", JointKind::fixed);
  add("g", "b", JointKind::cylindrical);
  add("h", "g", JointKind::planar);
  add("i", "h", JointKind::screw);
  c.bodies.push_back(described(
      "rotor", "c", {JointKind::revolute, z_axis, {}, some(s)},
      InertiaTensor<Body>::about_centre(1, {0, 0, 0.2}, Vector(0.1, 0.1, 0.15).asDiagonal())));
  c.bodies.back().rotor = Rotor{};
  const BodyTree tree(c.bodies);
  c.y = Eigen::VectorXd(tree.coordinates() + tree.rates());
  for (double& y : c.y) y = s.uniform(-2, 2);
  for (const detail::Link& link : tree.links()) {
    if (detail::coordinate_count(link.kind) < 4) continue;
    c.y.segment<4>(link.q).normalize();
  }
  c.y[tree.coordinates() + tree.place(6).v] = 40;
  return c;
}

/// Poses of all bodies relative to the guide as functions of time.
class Poses {
 public:
  Poses(const Case& c, const BodyTree& tree, const Eigen::VectorXd& dv)
      : case_(c), tree_(tree), dv_(dv) {}

  [[nodiscard]] Placed guide(const Digits& t) const { return case_.guide.at(t); }

  [[nodiscard]] Placed body(int i, const Digits& t) const {
    const auto [q, q_count, v, v_count] = tree_.place(i);
    const double* const rates = case_.y.data() + tree_.coordinates();
    const Placed own =
        joint_at(tree_.body(i).joint, case_.y.data() + q, rates + v, dv_.data() + v, t);
    const std::string& parent = tree_.body(i).parent;
    return parent == "guide" ? own : body(tree_.index(parent), t).then(own);
  }

  /// The pose relative to the inertial frame.
  [[nodiscard]] Placed frame(const SensorFrame& f, const Digits& t) const {
    if (f.kind == SensorFrame::Kind::inertial) return {};
    if (f.kind == SensorFrame::Kind::guide) return guide(t);
    return guide(t).then(body(f.body, t));
  }

 private:
  const Case& case_;
  const BodyTree& tree_;
  const Eigen::VectorXd& dv_;
};

double relative(const Vector& found, const Vec& truth, double size) {
  return static_cast<double>(Digits((wide(found) - truth).norm() / (truth.norm() + size)));
}

const std::vector<SensorFrame> frames{SensorFrame::guide(),    SensorFrame::inertial(),
                                      SensorFrame::of_body(0), SensorFrame::of_body(2),
                                      SensorFrame::of_body(4), SensorFrame::of_body(6)};

}  // namespace

BOOST_AUTO_TEST_SUITE(sensors_by_differentiated_poses)

// All kinds of sensors on all bodies of random systems, relative to all frames.
BOOST_AUTO_TEST_CASE(read_what_the_poses_do) {
  double worst = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Case c = some_case(seed);
    const Vector g(1, -2, 9);
    const BodySystem<Quadratic> system{c.guide, c.bodies, UniformGravity<Inertial>{g}};
    BodyWorkspace w = system.workspace();
    Eigen::VectorXd dv;
    system.accelerations(0, c.y, {}, dv, w);
    const SystemKinematics now = kinematics(system, 0, c.y, w);
    const Poses poses(c, system.tree(), dv);
    test::Sample s(1000 + seed);
    for (int i = 0; i < system.body_count(); ++i) {
      const Vector at = some(s);
      const Eigen::Quaterniond axes = some_quaternion(s);
      const Mat sensor = rotation(Quat(axes.w(), axes.x(), axes.y(), axes.z()));
      const SensorFrame own = SensorFrame::of_body(i);
      const auto [R, dR, ddR] =
          derivatives<Mat>([&](const Digits& t) { return poses.frame(own, t).R; });
      const Mat W = R.transpose() * dR;
      const Vec w_body(W(2, 1), W(0, 2), W(1, 0));
      worst = test::worst_of(worst, relative(Gyro{i, axes}(now), sensor.transpose() * w_body, 1));
      const auto place = [&](const Digits& t) {
        const Placed p = poses.frame(own, t);
        return Vec(p.x + p.R * wide(at));
      };
      const auto [x, v, a] = derivatives<Vec>(place);
      const Vec f = sensor.transpose() * R.transpose() * (a - wide(g));
      // The rotor spins at 40 rad/s: its acceleration has terms of 1600 m/s^2.
      worst = test::worst_of(worst, relative(Accelerometer{i, at, axes}(now), f, 100));
      for (const SensorFrame& against : frames) {
        const auto seen = [&](const Digits& t) {
          const Placed frame = poses.frame(against, t);
          return Vec(frame.R.transpose() * (place(t) - frame.x));
        };
        const auto [r, dr, ddr] = derivatives<Vec>(seen);
        const SensorFrame& on = frames[static_cast<std::size_t>(s.uniform(0, 6))];
        const Mat turned = poses.frame(on, 0).R.transpose() * poses.frame(against, 0).R;
        const PointReading<> found = PointSensor{i, at, against, on}(now);
        worst = test::worst_of(worst, relative(found.position, turned * r, 10));
        worst = test::worst_of(worst, relative(found.velocity, turned * dr, 100));
        worst = test::worst_of(worst, relative(found.acceleration, turned * ddr, 3000));
        const Matrix3<double> attitude = AttitudeSensor{i, against}(now);
        const Mat truth = poses.frame(against, 0).R.transpose() * R;
        for (int k = 0; k < 3; ++k) {
          worst = test::worst_of(worst, relative(attitude.col(k), truth.col(k), 0));
        }
      }
    }
  }
  BOOST_TEST_MESSAGE("sensors against differentiated poses: " << worst);
  BOOST_TEST(worst <= 1e-14);
}

BOOST_AUTO_TEST_SUITE_END()
