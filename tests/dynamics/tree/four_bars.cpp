// A row of four-bar linkages that passes its singular positions, against the pendulum that it is.

#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/solve/output_times.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/quadrature.hpp>
#include <support/told_error.hpp>

using namespace kreisel;
using namespace kreisel::test;
namespace data = boost::unit_test::data;

namespace {

constexpr double g = 9.81;
using std::numbers::pi;

/// A bar of 1 m and 1 kg in a hinge on its parent.
BodyDescription bar(const std::string& name, const std::string& parent,
                    const Vector3<double>& position, const Vector3<double>& along) {
  BodyDescription body;
  body.name = name;
  body.parent = parent;
  body.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}, .position = position};
  const Matrix3<double> tensor = Matrix3<double>::Identity() / 12;
  body.inertia = InertiaTensor<Body>::about_centre(1, along / 2, tensor);
  return body;
}

/// N windows: N + 1 bars that stand on the guide, and N bars that join their ends.
///
/// Source : the library of benchmarks of IFToMM, problem A02
BodySystem<RestingFrame<>> windows(int count) {
  const Vector3<double> up(0, 0, 1), right(1, 0, 0);
  std::vector<BodyDescription> bodies;
  std::vector<Constraint> loops;
  for (int i = 0; i <= count; ++i) {
    bodies.push_back(bar("post " + std::to_string(i), "guide", i * right, up));
  }
  for (int i = 0; i < count; ++i) {
    const std::string name = "beam " + std::to_string(i);
    bodies.push_back(bar(name, "post " + std::to_string(i), up, right));
    loops.push_back({"loop " + std::to_string(i), "post " + std::to_string(i + 1), name,
                     constraint::Point{up, right}});
  }
  return {RestingFrame<>{}, bodies, UniformGravity<Guide>{{0, 0, -g}}, {}, loops};
}

/// The common angle of all posts and its rate.
struct Turn {
  long double angle, rate;
};

/// All posts turn by the same angle, and the beams only move along. This is a pendulum with the
/// inertia I = (N + 1)/3 + N and the first moment S = (N + 1)/2 + N, which starts upright at 1 rad/s:
///
///   angle'^2 = 1 + 2 S g (1 - cos(angle))/I,   t = integral of d(angle)/angle'
class Pendulum {
 public:
  explicit Pendulum(int count)
      : pull_(((count + 1) / 2.0L + count) * static_cast<long double>(g) /
              ((count + 1) / 3.0L + count)) {}

  [[nodiscard]] Turn at(double time) const {
    const long double panel = 0.05L;
    long double angle = 0, passed = 0;
    for (long double next; (next = passed + duration(angle, angle + panel)) < time;
         angle += panel) {
      passed = next;
    }
    long double end = angle;
    for (int k = 0; k < 8; ++k) end -= (passed + duration(angle, end) - time) * rate(end);
    return {end, rate(end)};
  }

 private:
  [[nodiscard]] long double rate(long double angle) const {
    return std::sqrt(1 + 2 * pull_ * (1 - std::cos(angle)));
  }
  [[nodiscard]] long double duration(long double a, long double b) const {
    return integral<long double>(a, b, [this](long double x) { return 1 / rate(x); });
  }

  long double pull_;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(four_bars)

// All bars lie on a line twice in each turn. Each loop can change its kind of motion there, and the
// rank of its conditions falls. In the first 3 s the posts pass 4 such positions and turn 1.6 times.
BOOST_DATA_TEST_CASE(windows_turn_as_a_pendulum, data::make({1, 2, 5}), count) {
  const auto system = windows(count);
  const Eigen::VectorXd turn = (Eigen::VectorXd(2 * count + 1) << Eigen::VectorXd::Ones(count + 1),
                                -Eigen::VectorXd::Ones(count))
                                   .finished();
  auto start = system.rest();
  start.rates = turn;
  const auto run =
      solve(system, start,
            {.output_times = linspace(0, 3, 11), .tolerance = 1e-7, .max_evaluations = 1e5});
  BOOST_TEST_REQUIRE(run.states.size() == 11U);
  BOOST_TEST(run.report.tolerance_kept);

  const Pendulum pendulum(count);
  std::vector<Eigen::VectorXd> wanted;
  for (const double t : run.times) {
    const auto [angle, rate] = pendulum.at(t);
    wanted.emplace_back(2 * turn.size());
    wanted.back() << static_cast<double>(angle) * turn, static_cast<double>(rate) * turn;
  }
  // 0.60 to 0.64 of the told errors of 3e-9 to 1.4e-8.
  const double told = run.report.error_estimate;
  const double off = true_error(system, run, wanted);
  BOOST_TEST(off <= told);
  BOOST_TEST(off >= 0.1 * told);
  BOOST_TEST(greatest_gap(system, run) <= 1e-14);

  // The error e of the rates changes the kinetic energy I angle'^2/2 by 2 e of it, that of the angles
  // the potential energy by S g e of the greatest angle. The drift is 0.01 to 0.06 of both.
  const double inertia = (count + 1) / 3.0 + count, moment = (count + 1) / 2.0 + count;
  const double angle = run.report.sizes.front(), rate = run.report.sizes.back();
  const double energy = inertia * rate * rate + moment * g * angle;
  BOOST_TEST(run.report.invariants.at(0).largest <= told * energy);
}

// Steps end at other places near the singular positions for each speed.
BOOST_DATA_TEST_CASE(windows_pass_at_20_speeds, data::make({1, 2, 5}), count) {
  const auto system = windows(count);
  auto start = system.rest();
  for (int i = 0; i < 20; ++i) {
    start.rates << (1 + 0.15 * i) * Eigen::VectorXd::Ones(count + 1),
        -(1 + 0.15 * i) * Eigen::VectorXd::Ones(count);
    const auto run = solve(
        system, start,
        {.t_end = 2.5, .tolerance = 1e-8, .method = Method::verner98, .max_evaluations = 2e4});
    BOOST_TEST(run.report.tolerance_kept, start.rates[0] << " rad/s: " << run.report.message);
  }
}

// Peaucellier's linkage falls into the position in which its two arms and its rhombus lie on a line,
// and out of it. Its point P draws the line x = (0.8^2 - 0.35^2)/0.6. Two loops lose their direction at
// once, so the states beside that position must be found along fixed directions.
BOOST_AUTO_TEST_CASE(peaucelliers_arms_change_their_sides) {
  const auto link = [](const std::string& name, const std::string& parent,
                       const Vector3<double>& position, double length) {
    BodyDescription body = bar(name, parent, position, Vector3<double>(length, 0, 0));
    body.joint.axis = {0, 0, 1};
    const double moment = length * length / 12;
    const Matrix3<double> tensor = Eigen::Vector3d(1e-4, moment, moment).asDiagonal();
    body.inertia = InertiaTensor<Body>::about_centre(1, Vector3<double>(length / 2, 0, 0), tensor);
    return body;
  };
  const Vector3<double> origin(0, 0, 0), crank_end(0.3, 0, 0), arm_end(0.8, 0, 0),
      side_end(0.35, 0, 0);
  const auto meet = [](const std::string& name, const std::string& first, const std::string& second,
                       const Vector3<double>& on_first, const Vector3<double>& on_second) {
    return Constraint{name, first, second, constraint::Point{on_first, on_second}};
  };
  const BodySystem linkage(RestingFrame<>{},
                           {link("crank", "guide", crank_end, 0.3),
                            link("OA", "guide", origin, 0.8), link("OB", "guide", origin, 0.8),
                            link("AC", "OA", arm_end, 0.35), link("AP", "OA", arm_end, 0.35),
                            link("BC", "OB", arm_end, 0.35), link("BP", "OB", arm_end, 0.35)},
                           UniformGravity<Guide>{{0, -g, 0}}, {},
                           {meet("A to C", "crank", "AC", crank_end, side_end),
                            meet("B to C", "crank", "BC", crank_end, side_end),
                            meet("P", "AP", "BP", side_end, side_end)});
  auto start = linkage.rest();
  // C is at 0.6 cos 0.2 from O in the direction 0.2. The angles at O, and of the sides at A.
  const double to_C = 0.6 * std::cos(0.2), to_P = (0.8 * 0.8 - 0.35 * 0.35) / to_C;
  const double middle = (to_C + to_P) / 2, half = (to_P - to_C) / 2;
  const double opening = std::acos(middle / 0.8), side = std::acos(half / 0.35);
  start.coordinates << 0.4, 0.2 + opening, 0.2 - opening, -pi + side - opening, -side - opening,
      pi - side + opening, side + opening;
  const auto run =
      solve(linkage, linkage.assembled(start),
            {.output_times = {0.25, 0.5, 0.6, 0.75}, .tolerance = 1e-9, .max_evaluations = 2e4});
  BOOST_TEST(run.report.tolerance_kept, run.report.message);
  for (const auto& state : run.states) {
    const double arm = state.coordinates[1], along = arm + state.coordinates[4];
    const double x = 0.8 * std::cos(arm) + 0.35 * std::cos(along);
    BOOST_TEST(std::abs(x - (0.8 * 0.8 - 0.35 * 0.35) / 0.6) <= 1e-13);
  }
  // The arms have changed their sides.
  BOOST_TEST(run.states[2].coordinates[1] < run.states[2].coordinates[2]);
}

BOOST_AUTO_TEST_SUITE_END()
