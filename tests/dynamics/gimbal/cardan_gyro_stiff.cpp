// Cardan gyros with an almost rigid inner bearing.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gsl/steps.hpp>
#include <dynamics/solve/solve.hpp>

#include <support/json.hpp>
#include <support/worst.hpp>

using namespace kreisel;

BOOST_AUTO_TEST_SUITE(a_cardan_gyro_in_a_stiff_bearing)

namespace {

using test::Json;
using Vector6 = Eigen::Matrix<double, 6, 1>;

const CardanMoments moments{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4e-4}};
constexpr double reference_angle = 0.3;

struct Outcome {
  double angles = 0;   ///< greatest error of alpha and beta, rad
  double bearing = 0;  ///< of the inner bearing's moment, relative
  IntegrationStatistics effort = {};
};

Json scene(const char* name) {
  return test::reference_file("ode-scenes.json").at("scenes").at(name);
}

double number(const Json& truth, std::size_t i, std::size_t k) {
  return std::stod(truth.at("states").at(i).at(k).get<std::string>());
}

/// 2 s (or the first 0.5 s) with the rotor at 500 rad/s against the reference, whose beta counts
/// from 0 except in case f.
Outcome run(const char* name, double stiffness, double damping, bool deviations,
            const Accuracy& accuracy) {
  const Json truth = scene(name);
  const CardanGyro gyro(moments, {{0.5, 1e-3}, {stiffness, damping, reference_angle}},
                        RestingFrame<>{});
  const auto field = [&gyro](const auto& t, const auto& y) { return gyro.rates(t, y); };
  const Vector6 start = (Vector6() << 0, 0, 0, 0.5, 0, 500).finished();
  GslSteps steps(GslMethod::bsimp, field, forward_jacobian<6>(field), 0.0, start, accuracy,
                 gyro.blocks);
  Outcome outcome;
  for (std::size_t i = 0; i < (deviations ? 1U : 4U); ++i) {
    const double t = truth.at("times").at(i).get<double>();
    const auto s = gyro.from_vector(steps.advance_to(t));
    const double beta = number(truth, i, 1) - (deviations ? 0 : reference_angle);
    outcome.angles = test::worst_of(outcome.angles, std::abs(s.alpha - number(truth, i, 0)),
                                    std::abs(s.beta - beta));
    if (deviations) {
      const double moment = stiffness * beta + damping * number(truth, i, 4);
      const double off = gyro.reactions(t, s).inner_ring_on_outer_ring.y() - moment;
      outcome.bearing = test::worst_of(outcome.bearing, std::abs(off / moment));
    }
  }
  outcome.effort = steps.effort();
  return outcome;
}

}  // namespace

// 1e12 N m/rad costs no more than 1e3.
BOOST_AUTO_TEST_CASE(costs_the_same_at_any_stiffness) {
  struct Case {
    const char* name;
    double stiffness, damping;
  };
  double evaluations = 0;
  for (const Case& c :
       {Case{"S4a_cardan_k1e3_d2", 1e3, 2}, Case{"S4b_cardan_k1e6_d2e3", 1e6, 2e3},
        Case{"S4c_cardan_k1e9_d2e6", 1e9, 2e6}, Case{"S4e_cardan_k1e12_d2e9", 1e12, 2e9}}) {
    const Outcome outcome = run(c.name, c.stiffness, c.damping, false, {.relative = 1e-10});
    BOOST_TEST_MESSAGE(c.name << ": error " << outcome.angles << " rad, "
                              << outcome.effort.evaluations << " evaluations");
    BOOST_TEST(outcome.angles < 1e-9);
    if (evaluations == 0) evaluations = outcome.effort.evaluations;
    BOOST_TEST(outcome.effort.evaluations < 1.5 * evaluations);
  }
}

// An angle of 0.3 cannot represent a moment of 1e-2 N m at 1e12 N m/rad, the deviation can.
BOOST_AUTO_TEST_CASE(has_its_moment_to_ten_digits) {
  const Outcome outcome = run("S4f_cardan_k1e12_d2e9_dev", 1e12, 2e9, true,
                              {.relative = 5e-11, .absolute_scale = 1e-13});
  BOOST_TEST_MESSAGE("at 1e12 N m/rad: moment off by "
                     << outcome.bearing << ", angles by " << outcome.angles << " rad, "
                     << outcome.effort.evaluations << " evaluations");
  BOOST_TEST(outcome.bearing < 1e-10);
  BOOST_TEST(outcome.angles < 1e-10);
}

// Any bearing may be damped, or the rotor alone may have friction.
BOOST_AUTO_TEST_CASE(is_stiff_wherever_it_is_damped) {
  const auto taken = [](const CardanBearings& bearings, double friction) {
    const CardanGyro gyro(moments, bearings, RestingFrame<>{}, FreeRotor{friction});
    BOOST_TEST(gyro.may_be_stiff() ==
               (friction != 0 || bearings.outer.damping != 0 || bearings.inner.damping != 0));
    return solve(gyro, {.alpha_rate = 0.5, .phi_rate = 500},
                 {.output_times = {1}, .tolerance = 1e-8})
        .report.method;
  };
  BOOST_TEST(taken({{}, {1e9, 2e6, reference_angle}}, 0) == "radau13");
  BOOST_TEST(taken({{1e9, 2e6}, {0, 0, reference_angle}}, 0) == "radau13");
  BOOST_TEST(taken({{}, {0, 0, reference_angle}}, 1e3) == "radau13");
  BOOST_TEST(taken({{}, {0, 0, reference_angle}}, 0) == "taylor");
}

// Half a last digit of a sum of moments is 2.4e-12 rad after 7e4 rad of a spring's oscillation, in
// every run alike.
BOOST_AUTO_TEST_CASE(reports_phase_rounding_without_damping) {
  const Json truth = scene("S4d_cardan_k1e6_d0");
  const CardanGyro gyro(moments, {{0.5, 1e-3}, {1e6, 0, reference_angle}}, RestingFrame<>{});
  for (const double tolerance : {1e-10, 1e-12}) {
    const auto run = solve(gyro, {.alpha_rate = 0.5, .phi_rate = 500},
                           {.output_times = {0.5, 1, 1.5, 2}, .tolerance = tolerance});
    double off = 0, size = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      size = test::worst_of(size, std::abs(number(truth, i, 4)));
      off = test::worst_of(off, std::abs(run.states[i].beta_rate - number(truth, i, 4)));
    }
    const double told = run.report.error_estimate;
    BOOST_TEST_MESSAGE("to " << tolerance << ": off by " << off / size << ", told " << told);
    BOOST_TEST(off / size <= told);
    BOOST_TEST(told <= std::max(tolerance, 2e-11));
  }
}

BOOST_AUTO_TEST_SUITE_END()
