// Closed loops against matrix exponentials, recursions and closed forms of their own.

#include <Eigen/LU>
#include <boost/test/unit_test.hpp>
#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <dynamics/control/controlled_system.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/sampled_transition.hpp>
#include <motor/error.hpp>

#include <support/told_error.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using namespace kreisel::test;

namespace {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

constexpr double moment = 0.5;
constexpr double angle_0 = 0.3;

BodyDescription arm() {
  BodyDescription body;
  body.name = "arm";
  body.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  const Matrix3<double> tensor = Vector3<double>(1, 1, moment).asDiagonal();
  body.inertia = InertiaTensor<Body>::about_centre(2, {0, 0, 0}, tensor);
  return body;
}

Controller servo(const ControlLaw& law, double period = 0) {
  Controller controller;
  controller.name = "servo";
  controller.reads = {{JointSensor{0, 0, false}}};
  controller.drives = {"arm"};
  controller.law = law;
  controller.period = period;
  return controller;
}

ControlledSystem<RestingFrame<>> arm_with(const Controller& controller) {
  return {BodySystem<RestingFrame<>>({}, {arm()}), {controller}};
}

template <class System>
auto released(const System& system, double tolerance, double end = 5) {
  const auto start =
      system.start({Eigen::VectorXd::Constant(1, angle_0), Eigen::VectorXd::Zero(1)});
  return solve(system, start, {.t_end = end, .output_step = end / 10, .tolerance = tolerance});
}

/// The greatest error of the arm's angle.
template <class Run, class Angle>
double worst_angle(const Run& run, const Angle& angle) {
  double worst = 0;
  for (std::size_t i = 0; i < run.times.size(); ++i) {
    worst = worst_of(worst, std::abs(run.states[i].coordinates[0] - double(angle(run.times[i]))));
  }
  return worst;
}

constexpr PidLaw pid{3, 0.7, 0.4, 0.05};

/// The state matrix of arm and pid: angle, rate, integral, filter.
RealMatrix loop_matrix() {
  const Real J = moment, P = pid.proportional, I = pid.integral, D = pid.derivative;
  const Real tau = pid.filter;
  RealMatrix A(4, 4);
  A << 0, 1, 0, 0,                                 //
      -(P + D / tau) / J, 0, I / J, -D / tau / J,  //
      -1, 0, 0, 0,                                 //
      -1 / tau, 0, 0, -1 / tau;
  return A;
}

/// The angles of an arm whose torque is held, from one sample to the next.
///
/// output : the torque for the k-th sample of the angle
template <class Output>
std::vector<Real> angles_between(Real period, int count, const Output& output) {
  std::vector<Real> angles;
  Real q = Real(angle_0), v = 0;
  for (int k = 0; k < count; ++k) {
    angles.push_back(q);
    const Real a = output(k, q) / Real(moment);
    q += v * period + a * period * period / 2;
    v += a * period;
  }
  angles.push_back(q);
  return angles;
}

}  // namespace

BOOST_AUTO_TEST_CASE(continuous_pid_is_its_matrix_exponential) {
  const RealMatrix A = loop_matrix();
  const auto angle = [&A](double t) {
    return (RealMatrix(A * Real(t)).exp() * RealVector(RealVector::Unit(4, 0)))(0) * Real(angle_0);
  };
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const auto run = released(arm_with(servo(pid)), tolerance);
    BOOST_TEST(run.report.tolerance_kept);
    const double error = worst_angle(run, angle);
    BOOST_TEST(error <= std::max(run.report.error_estimate * angle_0, 2e-15));
  }
}

BOOST_AUTO_TEST_CASE(sampled_pid_is_its_recursion) {
  const double T = 0.1;
  const Real a = std::exp(-Real(T) / Real(pid.filter));
  Real s = 0, d = 0, before = 0;
  const auto expected = angles_between(Real(T), 50, [&](int, Real q) {
    const Real e = -q;
    s += Real(T) * e;
    d = a * d + (1 - a) * (e - before) / Real(T);
    before = e;
    return Real(pid.proportional) * e + Real(pid.integral) * s + Real(pid.derivative) * d;
  });
  for (const double tolerance : {1e-6, 1e-12}) {
    const auto run = released(arm_with(servo(pid, T)), tolerance);
    BOOST_TEST(run.report.tolerance_kept);
    // Each sample lies within a rounding of its multiple of the period.
    BOOST_TEST(worst_angle(run, [&](double t) { return expected[size_t(std::lround(t / T))]; }) <=
               std::max(run.report.error_estimate * angle_0, 4e-15));
  }
}

BOOST_AUTO_TEST_CASE(delayed_outputs_follow_their_samples) {
  const Real T = 0.1L;
  for (const double delay : {0.1, 0.2, 0.04, 0.25}) {
    Controller controller = servo(PidLaw{1.5}, 0.1);
    controller.delay = delay;
    // Outputs change at k T + rest, `whole` periods after their sample.
    const int whole = int(std::floor(delay / 0.1 + 1e-9));
    const Real rest = Real(delay) - whole * T;
    std::vector<Real> outputs;
    std::vector<Real> angles;
    Real q = Real(angle_0), v = 0, held = 0;
    const auto move = [&](Real h) {
      const Real acceleration = held / Real(moment);
      q += v * h + acceleration * h * h / 2;
      v += acceleration * h;
    };
    const auto due = [&](int k) { return k - whole < 0 ? Real(0) : outputs[size_t(k - whole)]; };
    for (int k = 0; k <= 50; ++k) {
      angles.push_back(q);
      outputs.push_back(-Real(1.5) * q);
      if (rest < 1e-9L) held = due(k);
      move(rest < 1e-9L ? T : rest);
      if (rest < 1e-9L) continue;
      held = due(k);
      move(T - rest);
    }
    const auto run = released(arm_with(controller), 1e-12);
    BOOST_TEST_CONTEXT("delay " << delay) {
      BOOST_TEST(worst_angle(run, [&](double t) { return angles[size_t(std::lround(t / 0.1))]; }) <=
                 std::max(run.report.error_estimate * angle_0, 1e-13));
    }
  }
}

// 3 * 0.3 is an ulp less than 0.9, and 9 * 0.1 is 0.9: no step fits between these times.
BOOST_AUTO_TEST_CASE(samples_may_differ_from_the_end_by_rounding) {
  Controller slow = servo(PidLaw{1.5}, 0.3);
  Controller fast = servo(PidLaw{0.5}, 0.1);
  fast.name = "fast";
  const ControlledSystem<RestingFrame<>> system(BodySystem<RestingFrame<>>({}, {arm()}),
                                                {slow, fast});
  Real of_slow = 0;
  const auto expected = angles_between(0.1L, 9, [&](int k, Real q) {
    if (k % 3 == 0) of_slow = -1.5L * q;
    return of_slow - 0.5L * q;
  });
  const auto start =
      system.start({Eigen::VectorXd::Constant(1, angle_0), Eigen::VectorXd::Zero(1)});
  const auto run = solve(system, start, {.t_end = 0.9, .tolerance = 1e-11});
  BOOST_TEST(run.report.tolerance_kept);
  BOOST_TEST(std::abs(run.states.back().coordinates[0] - double(expected.back())) < 1e-14);
  BOOST_TEST(sampled_transition(system, 0, Eigen::VectorXd::Zero(4)).period == 0.3);
}

// A run from the last state of another takes the samples of that time once.
BOOST_AUTO_TEST_CASE(runs_continue_from_the_state_of_a_sample) {
  Controller controller = servo(pid, 0.1);
  controller.delay = 0.13;
  const auto system = arm_with(controller);
  const auto start =
      system.start({Eigen::VectorXd::Constant(1, angle_0), Eigen::VectorXd::Zero(1)});
  const auto whole = solve(system, start, {.output_times = {0.8, 2}, .tolerance = 1e-12});
  const auto rest =
      solve(system, whole.states[0], {.begin = 0.8, .output_times = {2}, .tolerance = 1e-12});
  BOOST_TEST_REQUIRE(rest.states.size() == 1U, rest.report.message);
  BOOST_TEST(std::abs(whole.states[1].coordinates[0] - rest.states[0].coordinates[0]) < 1e-13);
  BOOST_TEST((whole.states[1].memory - rest.states[0].memory).cwiseAbs().maxCoeff() < 1e-12);
}

BOOST_AUTO_TEST_CASE(saturated_samples_do_not_wind_up) {
  Controller controller = servo(PidLaw{3, 0.7}, 0.1);
  controller.limit = {0.25};
  Real s = 0;
  const auto expected = angles_between(0.1L, 50, [&](int, Real q) {
    const Real e = -q;
    const Real grown = s + 0.1L * e;
    const Real u = 3 * e + 0.7L * grown;
    const bool winds = (u > 0.25L && e > 0) || (u < -0.25L && e < 0);
    const Real to_limit = (std::copysign(0.25L, e) - 3 * e) / 0.7L;
    const bool is_beyond = e > 0 ? to_limit < s : to_limit > s;
    s = !winds ? grown : is_beyond ? s : to_limit;
    return std::clamp(3 * e + 0.7L * s, -0.25L, 0.25L);
  });
  const auto run = released(arm_with(controller), 1e-11);
  BOOST_TEST(worst_angle(run, [&](double t) { return expected[size_t(std::lround(t / 0.1))]; }) <=
             std::max(run.report.error_estimate * angle_0, 1e-13));
}

// From rest beyond the limit: constant acceleration until the torque falls below the limit, then an
// oscillation, and the same with the other sign.
BOOST_AUTO_TEST_CASE(saturated_spring_is_in_pieces_closed) {
  Controller controller = servo(PidLaw{2});
  controller.limit = {0.2};
  const Real k = 2, limit = 0.2L, J = moment, edge = limit / k, w = std::sqrt(k / J);
  const Real b = limit / J;
  const Real t_1 = std::sqrt(2 * (Real(angle_0) - edge) / b);
  const Real v_1 = -b * t_1;
  const Real phase = std::atan2(-v_1 / w, edge);  // q = r cos(w t + phase)
  const Real r = std::hypot(edge, v_1 / w);
  const Real t_2 = (Real(M_PIl) - 2 * phase) / w;
  const auto quarter = [&](Real t) -> Real {  // up to the next rest, at -angle_0
    if (t <= t_1) return Real(angle_0) - b * t * t / 2;
    if (t <= t_1 + t_2) return r * std::cos(w * (t - t_1) + phase);
    const Real left = 2 * t_1 + t_2 - t;
    return -(Real(angle_0) - b * left * left / 2);
  };
  const Real half = 2 * t_1 + t_2;
  const auto angle = [&](double t) -> Real {
    const auto turns = std::floor(Real(t) / half);
    const Real part = quarter(Real(t) - turns * half);
    return std::fmod(turns, 2) == 0 ? part : -part;
  };
  for (const double tolerance : {1e-6, 1e-10}) {
    const auto run = released(arm_with(controller), tolerance);
    BOOST_TEST(run.report.tolerance_kept);
    BOOST_TEST(worst_angle(run, angle) <= run.report.error_estimate * angle_0);
  }
}

// A wheel J v' = u - d v from rest, by u = P (1 - v) + I s. Beyond its limit L u is cut, and s rests.
// From P (1 - v) = L on it grows only as u stays at L. Where s' = 1 - v no longer holds it there,
// u leaves the limit, and the motion is a matrix exponential.
BOOST_AUTO_TEST_CASE(outputs_may_stay_at_their_limit) {
  const Real P = 2, I = 8, L = 1.5L, d = 0.1L, J = moment;
  BodyDescription wheel = arm();
  wheel.forces = {{.damping = double(d)}};
  Controller controller = servo(PidLaw{double(P), double(I)});
  controller.reads = {{JointSensor{0, 0, true}}};
  controller.reference = {Signal<double>(1.0)};
  controller.limit = {double(L)};
  const ControlledSystem<RestingFrame<>> system(BodySystem<RestingFrame<>>({}, {wheel}),
                                                {controller});
  const auto start = system.start({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)});
  const Real leaves_at = (I - P * L / J) / (I - P * d / J);  // I (1 - v) = P v'
  const Real leaves = -J / d * std::log1p(-leaves_at * d / L);
  BOOST_TEST(leaves_at > 1 - L / P);
  RealMatrix A(3, 3);  // of v, s, 1
  A << -(d + P) / J, I / J, P / J, -1, 0, 1, 0, 0, 0;
  RealVector there(3);
  there << leaves_at, (L - P * (1 - leaves_at)) / I, 1;
  const auto rate = [&](double t) -> Real {
    if (t <= leaves) return -L / d * std::expm1(-d * Real(t) / J);
    return (RealMatrix(A * (Real(t) - leaves)).exp() * there)[0];
  };
  for (const double tolerance : {1e-6, 1e-10}) {
    const auto run = solve(system, start, {.t_end = 3, .output_step = 0.1, .tolerance = tolerance});
    BOOST_TEST(run.report.tolerance_kept);
    BOOST_TEST(run.report.all_evaluations <= 60000);
    double worst = 0;
    for (std::size_t i = 0; i < run.times.size(); ++i) {
      worst = worst_of(worst, std::abs(run.states[i].rates[0] - double(rate(run.times[i]))));
    }
    // The fading of s changes the time at which u leaves by less than 1e-11.
    BOOST_TEST(worst <= run.report.error_estimate + 1e-11);
  }
}

namespace {

/// An arm with the pid above, limited: pieces of matrix exponentials. s rests while the torque is
/// beyond its limit and the error drives it further.
class LimitedArm {
 public:
  explicit LimitedArm(Real limit) : limit_(limit) { state_ << Real(angle_0), 0, 0, 0, 1; }

  /// The angle at a time after the last one asked for.
  Real operator()(Real t) {
    constexpr Real piece = 1e-3L;
    while (t_ < t) {
      const Real h = std::min(piece, t - t_);
      const RealMatrix A = matrix();
      const RealVector next = RealMatrix(A * h).exp() * state_;
      if (mode(next) == mode(state_)) {
        state_ = next;
        t_ += h;
        continue;
      }
      Real before = 0;
      Real after = h;
      while (after - before > 1e-19L) {
        const Real middle = (before + after) / 2;
        if (middle <= before || middle >= after) break;
        const RealVector there = RealMatrix(A * middle).exp() * state_;
        (mode(there) == mode(state_) ? before : after) = middle;
      }
      state_ = RealMatrix(A * after).exp() * state_;
      t_ += after;
    }
    return state_[0];
  }

 private:
  using State = Eigen::Matrix<Real, 5, 1>;  // angle, rate, integral, filter, 1

  [[nodiscard]] static Real torque(const RealVector& y) {
    const Real P = pid.proportional, I = pid.integral, D = pid.derivative, tau = pid.filter;
    return -(P + D / tau) * y[0] + I * y[2] - D / tau * y[3];
  }
  /// -1, 0, 1: the torque is beyond no limit or one of them; 10 more where s rests.
  [[nodiscard]] int mode(const RealVector& y) const {
    const Real u = torque(y);
    const int side = u > limit_ ? 1 : u < -limit_ ? -1 : 0;
    return side * -y[0] > 0 ? 10 + side : side;
  }
  [[nodiscard]] RealMatrix matrix() const {
    RealMatrix A = RealMatrix::Zero(5, 5);
    A.topLeftCorner(4, 4) = loop_matrix();
    const int now = mode(state_);
    const int side = now > 5 ? now - 10 : now;
    if (side != 0) {
      A.row(1).setZero();
      A(1, 4) = side * limit_ / Real(moment);
    }
    if (now > 5) A.row(2).setZero();
    return A;
  }

  Real limit_;
  Real t_ = 0;
  State state_;
};

}  // namespace

// The limits are met as events: an order of 9 or 13 is kept across them.
BOOST_AUTO_TEST_CASE(a_limited_pid_is_in_pieces_closed) {
  Controller controller = servo(pid);
  controller.limit = {0.4};
  const auto system = arm_with(controller);
  const auto start =
      system.start({Eigen::VectorXd::Constant(1, angle_0), Eigen::VectorXd::Zero(1)});
  LimitedArm arm(0.4L);
  std::vector<Real> angles;
  for (int i = 0; i <= 10; ++i) angles.push_back(arm(Real(i) / 2));
  for (const Method method : {Method::verner98, Method::radau13}) {
    for (const double tolerance : {1e-8, 1e-12}) {
      const auto run =
          solve(system, start,
                {.t_end = 5, .output_step = 0.5, .tolerance = tolerance, .method = method});
      BOOST_TEST_CONTEXT(name(method) << ", " << tolerance) {
        BOOST_TEST(run.report.tolerance_kept);
        const double worst =
            worst_angle(run, [&](double t) { return angles[std::size_t(std::lround(2 * t))]; });
        // s fades out over a millionth of the limit, for some 1e-6 s of an error of 0.1.
        BOOST_TEST(worst <= run.report.error_estimate * angle_0 + 1e-7);
      }
    }
  }
}

// No step can end before a corner that is nearer than the spacing of times. It is crossed, and the run
// goes on.
BOOST_AUTO_TEST_CASE(a_regulator_leaves_its_limit) {
  BodyDescription sprung = arm();
  sprung.forces = {{.stiffness = 2}};
  for (const double limit : {0.02, 0.03, 0.05, 0.1, 0.2}) {
    Controller regulator = servo(PidLaw{0.2, 0.3});
    regulator.reads = {{JointSensor{0, 0, true}}};
    regulator.limit = {limit};
    const ControlledSystem<RestingFrame<>> system(BodySystem<RestingFrame<>>({}, {sprung}),
                                                  {regulator});
    const auto start = system.start({Eigen::VectorXd::Constant(1, 1), Eigen::VectorXd::Zero(1)});
    const auto by = [&](Method method) {
      return solve(system, start,
                   {.t_end = 30, .output_step = 1, .tolerance = 1e-8, .method = method});
    };
    const auto run = by(Method::verner98);
    const auto other = by(Method::radau13);
    BOOST_TEST_CONTEXT("limit " << limit) {
      BOOST_TEST(run.report.tolerance_kept);
      BOOST_TEST_REQUIRE(run.states.size() == other.states.size());
      std::size_t i = 0;
      const double apart =
          worst_angle(other, [&](double) { return run.states[i++].coordinates[0]; });
      BOOST_TEST(apart <= run.report.error_estimate + other.report.error_estimate);
    }
  }
}

// A hook on a rope that a winch pays out and takes in, by the displacement at each sample. In between
// it swings about the sag, or falls. Two controllers that drive the rope add up.
BOOST_AUTO_TEST_CASE(a_winch_may_slacken_a_rope_at_a_sample) {
  const Real g = 9.81L, m = 10, k = 2000, w = std::sqrt(k / m), T = 0.1L;
  const auto length = [](Real z) { return 2 - 0.3L * (-1.9L - z); };
  Real z = -2.05L, v = 0;
  std::vector<Real> places{z};
  for (int sample = 0; sample < 5; ++sample) {
    const Real l = length(z);
    const Real rests = -l - m * g / k;
    Real left = T;
    while (left > 0) {
      const Real from = z, rate = v;
      const bool taut = -z > l || (-z == l && v < 0);
      const auto at = [&](Real t) {
        return taut ? rests + (from - rests) * std::cos(w * t) + rate / w * std::sin(w * t)
                    : from + rate * t - g * t * t / 2;
      };
      const auto speed = [&](Real t) {
        return taut ? rate * std::cos(w * t) - (from - rests) * w * std::sin(w * t) : rate - g * t;
      };
      Real until = left;
      for (Real t = left / 64; t <= left * 1.0001L; t += left / 64) {
        if ((-at(t) > l) == taut) continue;
        Real before = t - left / 64;
        until = std::min(t, left);
        while (until - before > 1e-19L) {
          const Real middle = (before + until) / 2;
          if (middle <= before || middle >= until) break;
          ((-at(middle) > l) == taut ? before : until) = middle;
        }
        break;
      }
      z = until < left ? -l : at(until);
      v = speed(until);
      left -= until;
    }
    places.push_back(z);
  }
  BodyDescription hook = arm();
  hook.joint = {.kind = JointKind::prismatic, .axis = {0, 0, 1}};
  hook.inertia = InertiaTensor<Body>::about_centre(10, {0, 0, 0}, Matrix3<double>::Identity());
  const RopeElement rope{
      .name = "rope", .ends = {{{"guide"}, {"arm"}}}, .stiffness = 2000, .length = 2};
  const auto winch = [](const std::string& name, double gain) {
    Controller result = servo(PidLaw{gain}, 0.1);
    result.name = name;
    result.drives = {"rope"};
    result.reference = {Signal<double>(-1.9)};
    return result;
  };
  const std::vector<std::vector<Controller>> ways{{winch("one", -0.3)},
                                                  {winch("one", -0.5), winch("two", 0.2)}};
  for (const auto& winches : ways) {
    const ControlledSystem<RestingFrame<>> system(
        BodySystem<RestingFrame<>>({}, {hook}, UniformGravity<Guide>{{0, 0, -9.81}}, {rope}),
        winches);
    const auto start =
        system.start({Eigen::VectorXd::Constant(1, -2.05), Eigen::VectorXd::Zero(1)});
    for (const Method method : {Method::automatic, Method::radau13}) {
      const auto run = solve(
          system, start, {.t_end = 0.5, .output_step = 0.1, .tolerance = 1e-10, .method = method});
      BOOST_TEST_CONTEXT(winches.size() << " controllers, " << name(method)) {
        BOOST_TEST(run.report.tolerance_kept);
        BOOST_TEST(worst_angle(run, [&](double t) {
                     return places[std::size_t(std::lround(t / 0.1))];
                   }) <= run.report.error_estimate * 2.1);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(reference_steps_are_met) {
  Controller controller = servo(StateSpaceLaw{{}, {}, {}, Eigen::MatrixXd::Constant(1, 1, 2)});
  controller.law = StateSpaceLaw{Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 1),
                                 Eigen::MatrixXd(1, 0), Eigen::MatrixXd::Constant(1, 1, 2)};
  controller.reference = {Signal<double>::steps({{1.25, 0.5}})};
  const auto system = arm_with(controller);
  const auto start = system.start({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)});
  const auto run =
      solve(system, start,
            {.t_end = 5, .output_step = 0.5, .discontinuities = {1.25}, .tolerance = 1e-11});
  const Real w = std::sqrt(Real(2) / Real(moment));
  const double error = worst_angle(run, [&](double t) -> Real {
    return t < 1.25 ? 0 : Real(0.5) * (1 - std::cos(w * (Real(t) - 1.25L)));
  });
  BOOST_TEST(error <= std::max(run.report.error_estimate * 0.5, 4e-15));
}

// A torque that depends on the specific force of an accelerometer through a filter:
// x' = -2 x - l a, J a = 0.4 x. The algebra has no loop, because x does not change at once.
BOOST_AUTO_TEST_CASE(readings_of_accelerations_close_loops) {
  const double lever = 0.7;
  Controller controller =
      servo(StateSpaceLaw{Eigen::MatrixXd::Constant(1, 1, -2), Eigen::MatrixXd::Constant(1, 1, 1),
                          Eigen::MatrixXd::Constant(1, 1, 0.4), Eigen::MatrixXd::Zero(1, 1),
                          Eigen::VectorXd::Constant(1, 0.9)});
  controller.reads = {{Accelerometer{0, {lever, 0, 0}}, 1}};
  const auto run = released(arm_with(controller), 1e-12);
  const Real rate = -2 - Real(lever) * 0.4L / Real(moment);  // x = 0.9 exp(rate t)
  const Real c = 0.4L * 0.9L / Real(moment);
  const double error = worst_angle(run, [&](double t) -> Real {
    return Real(angle_0) + c * (std::expm1(rate * Real(t)) / rate - Real(t)) / rate;
  });
  BOOST_TEST(error <= std::max(run.report.error_estimate, 4e-15));
  controller.law = PidLaw{1};
  BOOST_CHECK_THROW((void)arm_with(controller), InvalidInput);
}

// The same loop by gyro and attitude angles, on a guide that turns: the readings are inertial and
// relative.
BOOST_AUTO_TEST_CASE(instruments_and_joints_close_one_loop) {
  const RotatingFrame<> guide{Vector3<double>(0, 0, 0.3)};
  const BodySystem<RotatingFrame<>> bodies(guide, {arm()});
  Controller by_joint = servo(PidLaw{});
  by_joint.reads = {{JointSensor{0, 0, false}}, {JointSensor{0, 0, true}}};
  by_joint.law = StateSpaceLaw{Eigen::MatrixXd(0, 0), Eigen::MatrixXd(0, 2), Eigen::MatrixXd(1, 0),
                               Eigen::RowVector2d(2, 0.3)};
  Controller by_instruments = by_joint;
  by_instruments.reads = {{AttitudeAngles{AttitudeSensor{0}}, 0}, {Gyro{0}, 2}};
  by_instruments.reference = {Signal<double>(0.0), Signal<double>(0.3)};
  const ControlledSystem<RotatingFrame<>> one(bodies, {by_joint});
  const ControlledSystem<RotatingFrame<>> other(bodies, {by_instruments});
  const auto a = released(one, 1e-11);
  const auto b = released(other, 1e-11);
  for (std::size_t i = 0; i < a.states.size(); ++i) {
    BOOST_TEST(std::abs(a.states[i].coordinates[0] - b.states[i].coordinates[0]) < 1e-11);
  }
}

BOOST_AUTO_TEST_CASE(closed_loop_matrix_is_exact) {
  const auto system = arm_with(servo(pid));
  const auto linear = linearize<Guide, Body>(system, 0, Eigen::VectorXd(Eigen::VectorXd::Zero(4)));
  BOOST_TEST((linear.A - loop_matrix().cast<double>()).cwiseAbs().maxCoeff() < 1e-14);
  BOOST_TEST(linear.names[2] == "servo state 1");
}

// Angle, rate and held torque after a period, and after two periods of a delay.
BOOST_AUTO_TEST_CASE(sampled_transition_is_exact) {
  const double T = 0.1;
  for (const bool delays : {false, true}) {
    Controller controller = servo(PidLaw{1.5}, T);
    if (delays) controller.delay = T;
    const auto system = arm_with(controller);
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(system.memory() + 2);
    const auto transition = sampled_transition(system, 0, rest);
    RealMatrix expected = RealMatrix::Zero(rest.size(), rest.size());
    const Real h = Real(T), J = moment;
    expected.topLeftCorner(2, 2) << 1, h, 0, 1;
    expected.block(0, rest.size() - 1, 2, 1) << h * h / 2 / J, h / J;
    expected.row(2) = -1.5L * expected.row(0);
    if (delays) expected(3, 2) = 1;
    BOOST_TEST(transition.period == T);
    BOOST_TEST((transition.matrix - expected.cast<double>()).cwiseAbs().maxCoeff() < 4e-16);
  }
}

// Linear equations of a loop with gyro, attitude and point readings, by differences of the field.
BOOST_AUTO_TEST_CASE(dual_numbers_follow_all_readings) {
  BodyDescription top;
  top.name = "top";
  top.joint = {.kind = JointKind::spherical};
  const Matrix3<double> tensor = Vector3<double>(0.5, 0.6, 0.8).asDiagonal();
  top.inertia = InertiaTensor<Body>::about_origin(1.3, {0.1, 0, 0.2}, tensor);
  BodyDescription wheel = arm();
  wheel.name = "wheel";
  wheel.parent = "top";
  const RotatingFrame<> guide{Vector3<double>(0.1, -0.2, 0.3), Vector3<double>(0.5, 0.2, 9.8)};
  const BodySystem<RotatingFrame<>> bodies(guide, {top, wheel});
  Controller controller;
  controller.name = "wheel speed";
  controller.reads = {{Gyro{0}, 1},
                      {PointSensor{0, {0.1, 0.2, 0.3}, SensorFrame::inertial()}, 4},
                      {AttitudeSensor{0}, 2},
                      {AttitudeAngles{AttitudeSensor{1}}, 1},
                      {Accelerometer{1, {0, 0.1, 0}}, 0}};
  controller.drives = {"wheel"};
  controller.law = StateSpaceLaw{Eigen::MatrixXd::Constant(1, 1, -0.3),
                                 Eigen::RowVectorXd::LinSpaced(5, 0.2, 1.1),
                                 Eigen::MatrixXd::Constant(1, 1, 0.7), Eigen::MatrixXd::Zero(1, 5)};
  const ControlledSystem<RotatingFrame<>> system(bodies, {controller});
  Eigen::VectorXd y(10);
  y << 0.5, -0.1, 0.3, std::sqrt(1 - 0.35), 0.4, 0.2, -0.3, 0.5, 0.8, 0.6;
  const auto d = detail::derivatives(system, 0.2, y, Eigen::MatrixXd::Identity(10, 10));
  constexpr double h = 1e-4;
  for (int k = 0; k < 10; ++k) {
    const auto at = [&](double step) {
      Eigen::VectorXd moved = y;
      moved[k] += step;
      return system.rates(0.2, moved);
    };
    // Differences of fourth order err by h^4 and by 1e-16/h.
    const Eigen::VectorXd slope = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
    BOOST_TEST((slope - d.along.col(k)).cwiseAbs().maxCoeff() < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(samples_continue_from_a_checkpoint) {
  Controller controller = servo(pid, 0.1);
  controller.delay = 0.13;
  const auto system = arm_with(controller);
  const auto start =
      system.start({Eigen::VectorXd::Constant(1, angle_0), Eigen::VectorXd::Zero(1)});
  for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
    SolveOptions options{.t_end = 3, .output_step = 0.25, .tolerance = 1e-9, .method = method};
    std::vector<std::vector<double>> checkpoints;
    options.offer_checkpoint = [&](const auto& here) { checkpoints.push_back(here()); };
    const auto whole = solve(system, start, options);
    BOOST_TEST_REQUIRE(checkpoints.size() > 4U);
    options.offer_checkpoint = nullptr;
    options.checkpoint = checkpoints[4];
    const auto rest = solve(system, start, options);
    BOOST_TEST(whole.states.back().coordinates[0] == rest.states.back().coordinates[0]);
    BOOST_TEST((whole.states.back().memory - rest.states.back().memory).isZero(0));
  }
}

BOOST_AUTO_TEST_CASE(callable_laws_control) {
  CallableLaw law{1, [](double, const Eigen::VectorXd& e, const Eigen::VectorXd& x,
                        Eigen::VectorXd& u, Eigen::VectorXd& dx) {
                    u[0] = 3 * e[0] + 0.7 * x[0];
                    dx[0] = e[0];
                  }};
  const auto by_callable = released(arm_with(servo(law)), 1e-11);
  const auto by_pid = released(arm_with(servo(PidLaw{3, 0.7})), 1e-11);
  BOOST_TEST(std::abs(by_callable.states.back().coordinates[0] -
                      by_pid.states.back().coordinates[0]) < 1e-11);
  const auto system = arm_with(servo(law));
  BOOST_CHECK_THROW(
      (void)(linearize<Guide, Body>(system, 0, Eigen::VectorXd(Eigen::VectorXd::Zero(3)))),
      InvalidInput);
}

BOOST_AUTO_TEST_CASE(wrong_controllers_are_refused) {
  const auto refused = [](const auto& change, const std::string& part) {
    Controller controller = servo(pid);
    change(controller);
    try {
      (void)arm_with(controller);
      BOOST_TEST(false, "accepted: " << part);
    } catch (const InvalidInput& error) {
      const std::string text = error.what();
      BOOST_TEST(text.find(part) != std::string::npos, text);
    }
  };
  refused([](Controller& c) { c.name = ""; }, "no name");
  refused([](Controller& c) { c.reads.clear(); }, "reads nothing");
  refused([](Controller& c) { c.drives = {"leg"}; }, "no such body");
  refused([](Controller& c) { c.drives = {"arm", "arm"}; }, "twice");
  refused([](Controller& c) { c.reads[0].sensor = JointSensor{0, 1, false}; }, "component 1 of 1");
  refused([](Controller& c) { c.reads[0].sensor = JointSensor{3, 0, false}; }, "body 3");
  refused([](Controller& c) { c.limit = {0}; }, "above 0");
  refused([](Controller& c) { c.limit = {1, 2}; }, "2 limits");
  refused([](Controller& c) { c.reference = {1.0, 2.0}; }, "2 references");
  refused([](Controller& c) { c.delay = 1; }, "needs a period");
  refused([](Controller& c) { c.period = NAN; }, "period");
  refused([](Controller& c) { c.law = PidLaw{1, 0, 1, 0}; }, "needs a filter");
  refused([](Controller& c) { c.law = PidLaw{INFINITY}; }, "not finite");
  refused([](Controller& c) { c.law = StateSpaceLaw{}; }, "C must have");
  refused([](Controller& c) { c.law = CallableLaw{}; }, "empty function");
  const auto system = arm_with(servo(pid, 0.1));
  const auto start = system.start({Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)});
  BOOST_CHECK_THROW((void)solve(system, start, {.t_end = -1}), InvalidInput);
}
