// Discs and balls that roll: steady circles, the limits of stability, a tilted turntable.

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/told_error.hpp>

using namespace kreisel;
using namespace kreisel::test;

namespace {

constexpr double g = 9.81, m = 1.7, r = 0.4;
const UniformGravity<Guide> weight{{0, 0, -g}};

/// The moments of a wheel about its diameters and its axis.
struct Wheel {
  double A, C;
};
constexpr Wheel heavy_hub{0.07, 0.12};
constexpr Wheel disc{m * r * r / 4, m* r* r / 2};

constraint::Rolling contact_of(const Vector3<double>& axis) {
  constraint::Rolling contact;
  contact.radius = r;
  contact.axis = axis;
  return contact;
}

/// A wheel that rolls with the tilt of its axis from the vertical, whose axis circles at a rate.
///
///   (C + m r^2) n W sin(tilt) = A W^2 sin(tilt) cos(tilt) - m g r cos(tilt)
///
/// n is the angular velocity along the axis. This is the balance of moments about the contact, for the
/// motion of the axis with W about the vertical.
struct Circle {
  Wheel wheel;
  double tilt, rate;

  [[nodiscard]] double spin() const {
    const double of_axis = wheel.A * rate * rate * std::sin(tilt) * std::cos(tilt);
    return (of_axis - m * g * r * std::cos(tilt)) / ((wheel.C + m * r * r) * rate * std::sin(tilt));
  }

  /// The state of the free body, whose axis is its z.
  [[nodiscard]] Eigen::VectorXd at(double t) const {
    const double n = spin(), radius = -r * n / rate;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(rate * t, Vector3<double>::UnitZ()));
    const Eigen::Quaterniond q =
        turn * Eigen::AngleAxisd(tilt, Vector3<double>::UnitY()) *
        Eigen::AngleAxisd((n - rate * std::cos(tilt)) * t, Vector3<double>::UnitZ());
    const Vector3<double> vertical(0, 0, 1);
    const Vector3<double> to_axis = q.conjugate() * vertical;
    Vector3<double> w = rate * to_axis;
    w.z() = n;
    const Vector3<double> centre = turn * Vector3<double>(radius, 0, r * std::sin(tilt));
    Eigen::VectorXd y(13);
    y << q.coeffs(), centre, w, rate * vertical.cross(centre);
    return y;
  }
};

/// A body that rolls freely on the plane of the guide.
template <class Frame>
BodySystem<Frame> free_on(const Frame& frame, const Gravity& gravity,
                          const Vector3<double>& moments, const constraint::Rolling& contact) {
  BodyDescription body;
  body.name = "body";
  body.joint = {.kind = JointKind::free};
  body.inertia = InertiaTensor<Body>::about_centre(m, {0, 0, 0}, moments.asDiagonal());
  return {frame, {body}, gravity, {}, {{"contact", "guide", "body", contact}}};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(rolling)

// The centre of the last disc is at rest: W^2 = 4 g/(r sin(tilt)), so that n = 0. The errors after 5 s
// are 3e-12 to 5e-11, 0.33 to 0.73 of the told ones.
BOOST_AUTO_TEST_CASE(steady_circles) {
  for (const Circle& circle :
       {Circle{heavy_hub, 1.2, 1.5}, Circle{heavy_hub, 1.2, -2.5}, Circle{disc, 0.4, 9.0},
        Circle{disc, 0.3, std::sqrt(4 * g / (r * std::sin(0.3)))}}) {
    const auto [A, C] = circle.wheel;
    const auto system = free_on(RestingFrame<>{}, weight, {A, A, C}, contact_of({0, 0, 1}));
    for (const Method method : {Method::automatic, Method::radau13}) {
      const auto run =
          solve(system, system.from_vector(circle.at(0)),
                {.output_times = linspace(0, 5, 11), .tolerance = 1e-10, .method = method});
      std::vector<Eigen::VectorXd> wanted;
      for (const double t : run.times) wanted.push_back(circle.at(t));
      const double told = run.report.error_estimate;
      const double off = true_error(system, run, wanted);
      BOOST_TEST(run.report.tolerance_kept);
      BOOST_TEST(off <= told, "rate " << circle.rate << ": " << off << " of " << told);
      BOOST_TEST(off >= 0.1 * told, "rate " << circle.rate << ": " << off << " of " << told);
      BOOST_TEST(greatest_gap(system, run) <= 1e-14);
      // No energy is above 11 J. Errors of rates count twice.
      BOOST_TEST(run.report.invariants.at(0).largest <= 2 * told * 11);
    }
  }
}

// A push makes 57 circles with nutations. A run of 0.3 s on one core.
BOOST_AUTO_TEST_CASE(disc_keeps_its_contact_for_40_s) {
  const auto system =
      free_on(RestingFrame<>{}, weight, {disc.A, disc.A, disc.C}, contact_of({0, 0, 1}));
  Eigen::VectorXd y = Circle{disc, 0.4, 9}.at(0);
  y[7] += 0.5;  // a push across the axis
  const auto start = system.assembled(system.from_vector(y));
  const auto run = solve(system, start, {.output_times = linspace(0, 40, 401)});
  BOOST_TEST(run.states.size() == 401U);
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(greatest_gap(system, run) <= 1e-13);
  BOOST_TEST(greatest_gap_rate(system, run) <= 1e-13);
}

namespace {

/// The square of the greatest root of an upright wheel with the rates of its heading and its spin.
double squared_lean(const Wheel& wheel, double heading, double spin) {
  std::vector<BodyDescription> bodies;
  const auto add = [&bodies](const std::string& name, JointKind kind, const Vector3<double>& axis) {
    BodyDescription body;
    body.name = name;
    if (!bodies.empty()) body.parent = bodies.back().name;
    body.joint = {.kind = kind, .axis = axis};
    bodies.push_back(body);
  };
  add("x", JointKind::prismatic, {1, 0, 0});
  add("y", JointKind::prismatic, {0, 1, 0});
  add("z", JointKind::prismatic, {0, 0, 1});
  add("heading", JointKind::revolute, {0, 0, 1});
  add("lean", JointKind::revolute, {1, 0, 0});
  add("wheel", JointKind::revolute, {0, 1, 0});
  bodies.back().inertia = InertiaTensor<Body>::about_centre(
      m, {0, 0, 0}, Vector3<double>(wheel.A, wheel.C, wheel.A).asDiagonal());
  const BodySystem system(RestingFrame<>{}, bodies, weight, {},
                          {{"contact", "guide", "wheel", contact_of({0, 1, 0})}});
  auto state = system.rest();
  state.coordinates[2] = r;
  state.rates << r * spin, 0, 0, heading, 0, spin;
  const auto linear = linearize<Guide, Body>(system, 0, system.to_vector(state));
  std::complex<double> lean = 0;
  for (const auto& root : eigenvalues(linear.A)) {
    if (std::abs(root) > std::abs(lean)) lean = root;
  }
  return (lean * lean).real();
}

}  // namespace

// A wheel that spins about its vertical diameter at the rate W, without rolling on:
//
//   lambda^2 = m g r/(A + m r^2) - W^2
//
// With the angular velocity n about the axis, (C + m r^2) n' = m r^2 W lean', and so
// (A + m r^2) lean'' + (C + m r^2) n W + (A W^2 - m g r) lean = 0. For a disc the limit is 4g/(5r).
BOOST_AUTO_TEST_CASE(spinning_coin_falls_below_its_limit) {
  for (const Wheel& wheel : {heavy_hub, disc}) {
    const double limit = m * g * r / (wheel.A + m * r * r);
    for (const double part : {0.25, 0.999, 1.001, 4.0}) {
      const double found = squared_lean(wheel, std::sqrt(part * limit), 0);
      // Linear equations err by 1e-13 of their terms.
      BOOST_TEST(std::abs(found - (1 - part) * limit) <= 1e-12 * (1 + part) * limit, part);
    }
  }
  BOOST_TEST(std::abs(m * g * r / (disc.A + m * r * r) - 4 * g / (5 * r)) <= 1e-14 * g / r);
}

// A wheel that rolls straight on:  n^2 = m g r A/((C + m r^2) C)  is its limit.
BOOST_AUTO_TEST_CASE(rolling_wheel_falls_below_its_limit) {
  for (const auto& [A, C] : {heavy_hub, disc}) {
    const double limit = m * g * r * A / ((C + m * r * r) * C);
    for (const double part : {0.25, 0.999, 1.001, 4.0}) {
      const double found = squared_lean({A, C}, 0, std::sqrt(part * limit));
      const double free = m * g * r / (A + m * r * r);
      BOOST_TEST(std::abs(found - (1 - part) * free) <= 1e-12 * (1 + part) * free, part);
    }
  }
}

// A ball on a turntable that is tilted by 0.2 drifts along the slope's level line at 5 g_t/(2 W), g_t
// along the plane. It starts at rest, and so describes a cycloid of the rate 2 W/7:
//
//   x' = (1 - rotation by 2 W t/7) drift
BOOST_AUTO_TEST_CASE(ball_on_a_tilted_turntable) {
  const double rate = 1.4, tilt = 0.2, turn = 2 * rate / 7;
  const UniformGravity<Inertial> tilted{{g * std::sin(tilt), 0, -g * std::cos(tilt)}};
  constraint::Rolling contact;
  contact.radius = r;
  const auto system = free_on(RotatingFrame<>{{0, 0, rate}}, tilted,
                              Vector3<double>::Constant(0.4 * m * r * r), contact);
  auto start = system.rest();
  start.coordinates[6] = r;
  start.rates[2] = -rate;
  const auto run = solve(system, start, {.output_times = linspace(0, 20, 11), .tolerance = 1e-10});
  BOOST_TEST(run.report.tolerance_kept);
  const double drift = 5 * g * std::sin(tilt) / (2 * rate);
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    const double t = run.times[i];
    const Eigen::Vector2d wanted(drift * (1 - std::cos(turn * t)) / turn,
                                 drift * (t - std::sin(turn * t) / turn));
    const Eigen::Vector2d found =
        Eigen::Rotation2Dd(rate * t) * run.states[i].coordinates.segment<2>(4);
    // The told error is relative to the greatest distance, 79 m. It is mostly that of the attitude.
    BOOST_TEST((found - wanted).norm() <= run.report.error_estimate * run.report.sizes[1]);
  }
}

BOOST_AUTO_TEST_SUITE_END()
