// Small motion about a nominal motion: closed solutions on resting, turning and moving guides.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/guide/any_guide.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/study/exponential_panels.hpp>
#include <dynamics/study/interpolated_motion.hpp>
#include <dynamics/study/small_motion.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

using System = BodySystem<AnyGuide>;

BodyDescription hinged(const std::string& name, const std::string& parent, const Vector3d& axis,
                       double mass, const Vector3d& centre, const Vector3d& moments) {
  BodyDescription body;
  body.name = name;
  body.parent = parent;
  body.joint = {.kind = JointKind::revolute, .axis = axis};
  if (mass > 0) {
    body.inertia = InertiaTensor<Body>::about_centre(mass, centre, moments.asDiagonal());
  }
  return body;
}

/// A rotor whose motor keeps its speed.
BodyDescription rotor_in(const std::string& parent, const Vector3d& axis, const Vector3d& moments) {
  BodyDescription body = hinged("rotor", parent, axis, 1, Vector3d::Zero(), moments);
  body.rotor = Rotor{.mode = RotorMode::regulated};
  return body;
}

SmallMotion small_motion(const System& system, const VectorXd& start, double end) {
  return {system, nominal_motion(system, 0, start), end};
}

/// Frequencies of a matrix without damping, falling; each once.
std::vector<double> frequencies(const MatrixXd& A) {
  std::vector<double> result;
  for (const auto& root : eigenvalues(A)) {
    if (root.imag() > 1e-12) result.push_back(root.imag());
  }
  std::sort(result.rbegin(), result.rend());
  return result;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(small_motions)

// x'' + w^2 x = sin(p t) on one panel, from slow to 3e4 rad long.
BOOST_AUTO_TEST_CASE(a_panel_may_be_long) {
  const double p = 0.8;
  const double h = 1.5;
  for (const double w : {0.1, 3.0, 50.0, 2e4}) {
    MatrixXd A(2, 2);
    A << 0, 1, -w * w, 0;
    const ExponentialPanels panels(A);
    MatrixXd force = MatrixXd::Zero(2, panel_nodes);
    for (int j = 0; j < panel_nodes; ++j) {
      force(1, j) = std::sin(p * h * ExponentialPanels::fractions()[j]);
    }
    const MatrixXd g = ExponentialPanels::coefficients(force);
    const MatrixXd x = panels.solution(h, Eigen::Vector2d(1e-3, 0), g);
    const double wanted =
        1e-3 * std::cos(w * h) + (std::sin(p * h) - p / w * std::sin(w * h)) / (w * w - p * p);
    // Rounding of the phase w h, and the polynomial's error, below 1e-16.
    BOOST_TEST(std::abs(x(0, panel_nodes) - wanted) < 1e-3 * (1e-15 * w * h + 1e-13),
               w << ": " << x(0, panel_nodes) - wanted);
    BOOST_TEST(panels.truncation(h, g).maxCoeff() < 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(tiny_deviations_keep_their_digits) {
  const auto rod = hinged("rod", "guide", {0, 1, 0}, 1, {0, 0, -1}, {0.1, 0.1, 0.1});
  const System system(RestingFrame<>{}, {rod}, UniformGravity<Guide>{{0, 0, -9.81}});
  const double w = std::sqrt(9.81 / 1.1);
  const SmallMotion small = small_motion(system, Eigen::Vector2d::Zero(), 100);
  BOOST_TEST(small.is_steady());
  const auto run = small.run(Eigen::Vector2d(1e-10, 0), {50, 100});
  for (const std::size_t i : {0U, 1U}) {
    const double t = i == 0 ? 50 : 100;
    // 12 digits: the phase of 300 rad has a rounding of 1e-13.
    BOOST_TEST(std::abs(run.deviations()[i][0] - 1e-10 * std::cos(w * t)) < 1e-22);
  }
}

// A ring against a spring on a guide that turns about the input axis:
//   theta (k + (I_y - I_z) W^2) = -H W,  I_y and I_z of ring and rotor together.
BOOST_AUTO_TEST_CASE(a_rate_gyro_shows_the_rate) {
  const double H = 5e-3 * 2000;
  const double k = 40;
  for (const double W : {0.3, -0.01}) {
    auto ring = hinged("ring", "guide", {1, 0, 0}, 1, {0, 0, 0}, {2e-3, 1e-3, 3e-3});
    ring.forces = {{.stiffness = k, .damping = 2}};
    const System system(RotatingFrame<>{.angular_velocity = {0, W, 0}},
                        {ring, rotor_in("ring", {0, 0, 1}, {3e-3, 3e-3, 5e-3})});
    VectorXd start(4);
    start << 0, 0, 0, 2000;
    const auto run = small_motion(system, start, 20).run(start, {20});
    const double theta = -H * W / (k + (4e-3 - 8e-3) * W * W);
    // The start has died out: k/d = 20/s.
    BOOST_TEST(std::abs(run.deviations()[0][0] - theta) < 1e-13 * std::abs(theta));
  }
}

// A level gyro axis in the plane of the horizon: A w^2 = H u cos(lat) + (I_z - I_y) (u cos(lat))^2.
BOOST_AUTO_TEST_CASE(a_level_gyrocompass_has_its_period) {
  const double u = 7.292115e-5 * std::cos(0.87);
  const double H = 5e-3 * 2400;
  const System system(RotatingFrame<>{.angular_velocity = {0, 0, u}},
                      {hinged("ring", "guide", {1, 0, 0}, 0.2, {0, 0, 0}, {2e-3, 1e-3, 1e-3}),
                       rotor_in("ring", {0, 0, 1}, {3e-3, 3e-3, 5e-3})});
  const SmallMotion small = small_motion(system, Eigen::Vector4d(0, 0, 0, 2400), 100);
  const double w = std::sqrt((H * u + (6e-3 - 4e-3) * u * u) / 5e-3);
  BOOST_TEST(std::abs(frequencies(small.matrix()).front() - w) < 1e-12 * w);
}

// x up, y east, z north; B = m g l. The roots of  (A s^2 + H u)(A s^2 + B + H u) + H^2 s^2 = 0,
// without terms A u^2. Without A: w^2 = u (B + H u)/H.
BOOST_AUTO_TEST_CASE(a_pendulous_gyrocompass_has_its_period) {
  const double u = 7.292115e-5 * std::cos(0.87);
  const double H = 5e-3 * 2400;
  const double B = 0.5 * 9.81 * 2e-3;
  const auto outer = hinged("outer", "guide", {1, 0, 0}, 0.1, {0, 0, 0}, {1e-3, 1e-3, 1e-3});
  const auto inner = hinged("inner", "outer", {0, 1, 0}, 0.5, {-2e-3, 0, 0}, {1e-3, 1e-3, 1e-3});
  const System system(RotatingFrame<>{.angular_velocity = {0, 0, u}},
                      {outer, inner, rotor_in("inner", {0, 0, 1}, {3e-3, 3e-3, 5e-3})},
                      UniformGravity<Guide>{{-9.81, 0, 0}});
  VectorXd start = VectorXd::Zero(6);
  start[5] = 2400;
  const double w = frequencies(small_motion(system, start, 100).matrix()).back();
  const double outer_moment = 1e-3 + 1e-3 + 3e-3;
  const double inner_moment = 1e-3 + 0.5 * 2e-3 * 2e-3 + 3e-3;
  const double c = H * u * (B + H * u);
  const double b = outer_moment * (B + H * u) + inner_moment * H * u + H * H;
  const double slow =
      std::sqrt(2 * c / (b + std::sqrt(b * b - 4 * outer_moment * inner_moment * c)));
  // They are A u/H of the others, 2.0e-8.
  BOOST_TEST(std::abs(w - slow) < 2e-8 * slow, w / slow - 1);
  // The law without A leaves out A B/H^2 of w^2, 3.4e-7.
  BOOST_TEST(std::abs(w - std::sqrt(u * (B + H * u) / H)) < 4e-7 * w);
}

// Two crossed knife edges on the earth: the modes are sqrt(dw^2 + ((2 Theta - Theta_A)/Theta W)^2)
// apart, to first order in dw/w and W/w.
BOOST_AUTO_TEST_CASE(crossed_knife_edges_split_the_modes) {
  const double moment = 2;
  const double axial = 0.5;
  const double W = 7.292115e-5 * std::sin(0.87);
  for (const double spring : {0.0, 1e-3, 4e-3}) {
    auto first = hinged("first", "guide", {1, 0, 0}, 0, {0, 0, 0}, {0, 0, 0});
    first.forces = {{.stiffness = spring}};
    const auto bob =
        hinged("bob", "first", {0, 1, 0}, 1, {0, 0, -1}, {moment - 1, moment - 1, axial});
    const System system(RotatingFrame<>{.angular_velocity = {0, 0, W}}, {first, bob},
                        UniformGravity<Guide>{{0, 0, -9.81}});
    const auto modes = frequencies(small_motion(system, VectorXd::Zero(4), 10).matrix());
    const double w = std::sqrt(9.81 / moment);
    const double dw = std::sqrt((9.81 + spring) / moment) - w;
    const double wanted = std::hypot(dw, (2 * moment - axial) / moment * W);
    BOOST_TEST(std::abs(modes[0] - modes[1] - wanted) < (dw + W) / w * wanted + 1e-14,
               spring << ": " << modes[0] - modes[1] << " and " << wanted);
  }
}

// Theta = m s R: no acceleration of the pivot along the sphere deviates the pendulum.
BOOST_AUTO_TEST_CASE(schulers_pendulum_stays_vertical) {
  const double R = 6.371e6;
  const double s = 1e-3;
  const double far = 1e-4;
  const double p = 1e-2;
  const auto sphere = posed<Guide, Inertial>([=](const auto& t) {
    using std::cos;
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const T phi = far * sin(p * t);
    return Pose<T>{YawPitchRoll<T>{T(0), phi, T(0)}.rotation(),
                   Vector3<T>(R * sin(phi), T(0), R * cos(phi))};
  });
  for (const double off : {0.0, 0.01}) {
    const double moment = (1 + off) * s * R;
    const auto bob =
        hinged("bob", "guide", {0, 1, 0}, 1, {0, 0, -s}, {1, moment - s * s, moment - s * s});
    const System system(sphere, {bob}, UniformGravity<Guide>{{0, 0, -9.81}});
    const SmallMotion small = small_motion(system, Eigen::Vector2d::Zero(), 3000);
    const double deviation = small.run(Eigen::Vector2d::Zero(), {3000}).deviations()[0][0];
    // theta'' + w^2 theta = far p^2 (1 - m s R/Theta) sin(p t)
    const double w = std::sqrt(s * 9.81 / moment);
    const double wanted = far * p * p * (off / (1 + off)) / (w * w - p * p) *
                          (std::sin(p * 3000) - p / w * std::sin(w * 3000));
    // The centripetal acceleration R phi'^2 changes w^2 by 6.6e-7.
    const double tolerance = off == 0 ? 1e-11 * far : 3e-6 * std::abs(wanted);
    BOOST_TEST(std::abs(deviation - wanted) < tolerance, off << ": " << deviation - wanted);
  }
}

// A rotor without the key spins on, and so does a symmetric top about its axis.
BOOST_AUTO_TEST_CASE(spins_are_part_of_the_nominal_motion) {
  const auto wheel = hinged("wheel", "guide", {0, 0, 1}, 1, {0, 0, 0.1}, {1, 1, 2});
  const auto arm = hinged("arm", "guide", {1, 0, 0}, 1, {0, 0, -1}, {1, 1, 2});
  BodyDescription top = wheel;
  top.name = "top";
  top.joint = {.kind = JointKind::spherical};
  const System system(RestingFrame<>{}, {wheel, arm, top}, UniformGravity<Guide>{{0, 0, -9.81}});
  VectorXd start = system.to_vector(system.rest());
  start.tail(5) << 30, 0.1, 0, 0, 50;
  const NominalMotion nominal = nominal_motion(system, 0, start);
  VectorXd wanted = VectorXd::Zero(10);
  wanted[0] = 30;
  wanted[4] = 50;
  BOOST_TEST((nominal.rate() - wanted).norm() < 1e-13, nominal.rate().transpose());
}

// Rates from states alone: x = exp(sin(t)) to the accuracy of the derivative.
BOOST_AUTO_TEST_CASE(an_interpolated_motion_has_its_rates) {
  const auto states = [](const std::vector<double>& times) {
    std::vector<VectorXd> result;
    for (const double t : times) result.push_back(VectorXd::Constant(1, std::exp(std::sin(t))));
    return result;
  };
  const InterpolatedMotion motion(Tangent(1, {}), states, 0, 20);
  const MotionSamples samples = motion.sampler()(3.75, 0.25);
  for (std::size_t j = 0; j <= panel_nodes; ++j) {
    const double part =
        j < panel_nodes ? ExponentialPanels::fractions()[static_cast<Eigen::Index>(j)] : 1;
    const double t = 3.75 + 0.25 * part;
    const double x = std::exp(std::sin(t));
    BOOST_TEST(std::abs(samples.states[j][0] - x) < 1e-11);
    BOOST_TEST(std::abs(samples.rates[j][0] - std::cos(t) * x) < 1e-8);
  }
}

// Rounding of terms that cancel changes from one microsecond to the next, and not within it, where
// the series would find it. It ends the halving of panels, and is part of the error.
BOOST_AUTO_TEST_CASE(a_series_leaves_rounding_unresolved) {
  int evaluations = 0;
  const auto force = [&evaluations](double t) {
    ++evaluations;
    const double digits = std::sin(1e4 * std::round(1e6 * t));
    return VectorXd(VectorXd::Constant(1, 1e-10 * std::cos(t) + 1e-14 * digits));
  };
  const PanelSeries series(force, 0, 1, {}, VectorXd::Zero(1), 1e-13);
  BOOST_TEST(evaluations < 2000);
  BOOST_TEST(series.error()[0] > 1e-14);
  BOOST_TEST(series.error()[0] < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
