#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/analytic.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/guide/translating.hpp>
#include <motor/attitude.hpp>

#include <support/series.hpp>

using namespace kreisel;
using test::hold_samples;
using test::hold_series;

namespace {

template <class Scene>
concept KnowsSeries = requires(const Scene& scene) {
  scene.series();
};

/// Rotors with equal moments across their axis and with unequal ones.
CardanMoments moments(bool round) {
  return {.rotor = {round ? 0.005 : 0.0055, round ? 0.005 : 0.0045, 0.008},
          .inner_ring = {0.002, 0.0015, 0.0028},
          .outer_ring = {0.006, 0.0045, 0.005}};
}

const CardanBearings bearings{{0.02, 0.003, 0.4}, {0.015, 0.002, -0.7}};

/// All rotors that have a series, with bearings and without.
template <class M>
void hold_gyros(const std::string& what, const M& guide) {
  for (const bool round : {true, false}) {
    const std::string which = what + (round ? ", symmetric" : ", unsymmetric");
    const CardanMoments m = moments(round);
    hold_samples(which, CardanGyro(m, {}, guide, FrictionlessRotor{}));
    hold_samples(which + ", in bearings", CardanGyro(m, bearings, guide, FreeRotor{0.001}));
    hold_samples(which + ", regulated", CardanGyro(m, bearings, guide, RegulatedRotor{0.001}));
    hold_samples(which + ", driven", CardanGyro(m, bearings, guide, DrivenRotor{0.03, 0.002}));
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cardan_series)

BOOST_AUTO_TEST_CASE(agrees_on_guides_without_rotation) {
  hold_gyros("at rest", RestingFrame<>{});
  hold_gyros("in a lift", TranslatingFrame([](double t) {
               return Translation<>{{0, 0, t * t}, {0, 0, 2 * t}, {0, 0, 2}};
             }));
}

BOOST_AUTO_TEST_CASE(agrees_on_guides_in_steady_motion) {
  hold_gyros("on a turntable", RotatingFrame<>{{0.3, -0.8, 0.5}});
  SteadyFrame<> screw;
  screw.V.value = {{0.2, 0.1, -0.4}, {1, 2, 3}};
  hold_gyros("in a steady screw", screw);
}

BOOST_AUTO_TEST_CASE(agrees_on_analytic_guides) {
  const HarmonicSeries<> u{{0.1, -0.2, 0.3},
                           {{{0.3, 0.1, -0.2}, 1.3, 0.4}, {{0.1, 0.5, 0.2}, 2.9, 1}}};
  hold_gyros("on a harmonic guide", HarmonicFrame<>(u, {}, 0, 2));
  hold_gyros(
      "on a ship", analytic([](const auto& t) {
        using std::sin;
        using T = std::decay_t<decltype(t)>;
        const YawPitchRoll<T> turn{T(0.3 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.2 * sin(0.9 * t))};
        return Pose<T>{turn.rotation(), Vector3<T>(T(5.0 * t), T(0.5 * sin(0.7 * t)), T(t))};
      }));
}

// Without mass of the rings only the rotor resists.
BOOST_AUTO_TEST_CASE(agrees_for_massless_rings) {
  for (const bool round : {true, false}) {
    hold_samples("without rings", CardanGyro({moments(round).rotor}, {}, RestingFrame<>{}));
    hold_samples("without rings on a turntable",
                 CardanGyro({moments(round).rotor}, {}, RotatingFrame<>{{0.3, -0.8, 0.5}}));
  }
}

BOOST_DATA_TEST_CASE(passes_through_gimbal_lock,
                     boost::unit_test::data::make({0.0, 1e-8, -1e-8, 1e-2}), aside) {
  const CardanBearings upright{{}, {.reference = std::numbers::pi / 2}};
  CardanGyro<RestingFrame<>>::Vector y;
  y << 0.1, aside, 0.3, 0.5, -0.4, 1.2;
  for (const bool round : {true, false}) {
    hold_series("beside the lock", CardanGyro(moments(round), upright, RestingFrame<>{}), y);
  }
}

// Exactly: all coefficients of phi' are 0.
BOOST_AUTO_TEST_CASE(keeps_the_speed_of_regulated_rotors) {
  for (const bool round : {true, false}) {
    auto series = CardanGyro(moments(round), bearings, RestingFrame<>{}, RegulatedRotor{}).series();
    Eigen::Matrix<double, 6, 25> c;
    c.col(0) << 0.1, 0.5, 0.3, 1, 2, 30;
    series(0, 0.01, 24, c);
    BOOST_TEST(c.row(5).tail(24).isZero(0));
  }
}

BOOST_AUTO_TEST_CASE(stops_with_the_field) {
  const CardanBearings upright{{}, {.reference = std::numbers::pi / 2}};
  CardanGyro<RestingFrame<>>::Vector y;
  y << 0.1, 0, 0.3, 0.5, -0.4, 1.2;
  for (const bool round : {true, false}) {
    const CardanGyro gyro({moments(round).rotor}, upright, RestingFrame<>{});
    std::string words;
    try {
      (void)gyro.rates(0, y);
    } catch (const ComputationFailed& error) {
      words = error.what();
    }
    BOOST_TEST(words.find("gimbal lock") != std::string::npos);
    Eigen::Matrix<double, 6, 25> c;
    c.col(0) = y;
    BOOST_CHECK_EXCEPTION(gyro.series()(0, 0.01, 24, c), ComputationFailed,
                          [&](const auto& error) { return error.what() == words; });
  }
}

BOOST_AUTO_TEST_CASE(is_absent_if_the_drive_is_a_function) {
  const auto torque = [](double, auto rate) { return -0.1 * rate; };
  using Driven = CardanGyro<RestingFrame<>, DrivenRotor<decltype(torque)>>;
  static_assert(!KnowsSeries<Driven>);
  static_assert(KnowsSeries<CardanGyro<RestingFrame<>, DrivenRotor<double>>>);
}

BOOST_AUTO_TEST_SUITE_END()
