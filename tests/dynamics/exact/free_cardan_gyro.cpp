// The free Cardan gyro in closed form, against references of 25 digits.

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <dynamics/exact/free_cardan_gyro.hpp>
#include <motor/decimal.hpp>

#include <support/json.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using exact::FreeCardanGyro;
using exact::Real;
using test::Json;

namespace {

const Json& reference() {
  static const Json json = test::reference_file("cardan-gyro.json");
  return json;
}

/// All digits that a Real takes, of a number stored as text.
Real real(const Json& text) { return decimal(text.get<std::string>()); }

const Vector3<double> rotor(.005, .005, .008);
const Vector3<double> inner_ring(.002, .0015, .0028);
const Vector3<double> outer_ring(.006, .0045, .005);

}  // namespace

BOOST_AUTO_TEST_SUITE(free_cardan_gyro)

// Drift and period at all amplitudes. The drift is a mean: the rounding of alpha', whose size is
// beta' at the start, remains in it. The moments are decimals, which double rounds by 2^-54.
BOOST_AUTO_TEST_CASE(has_the_drift_of_the_reference) {
  for (const Json& c : reference().at("drift").at("data")) {
    if (c.contains("case")) continue;
    const Real begin = real(c.at("betadot0"));
    const FreeCardanGyro gyro(rotor, inner_ring, outer_ring, false, {0, 0.5, 0, 0, begin, 50});
    const Real mean = real(c.at("mean"));
    const Real rounding = 32 * 0x1p-64 * begin + 4e-16 * abs(mean);
    BOOST_TEST(abs(gyro.drift() - mean) < rounding);
    BOOST_TEST(abs(gyro.period() / real(c.at("T")) - 1) < 4e-16);
  }
}

BOOST_AUTO_TEST_CASE(follows_the_trajectories) {
  double worst = 0;
  int judged = 0;
  for (const Json& c : reference().at("trajectories")) {
    const auto name = c.at("name").get<std::string>();
    const bool massive = name == "T1_free_symmetric";
    if (!massive && name != "T3s_massless_symmetric") continue;
    const Json& q = c.at("q0");
    const Json& dq = c.at("qd0");
    const Vector3<double> none = Vector3<double>::Zero();
    const FreeCardanGyro gyro(
        rotor, massive ? inner_ring : none, massive ? outer_ring : none, false,
        {real(q[0]), real(q[1]), real(q[2]), real(dq[0]), real(dq[1]), real(dq[2])});
    for (const Json& point : c.at("points")) {
      const auto s = gyro.at(real(point.at("t")));
      const Real found[] = {s.alpha, s.beta, s.phi, s.alpha_rate, s.beta_rate, s.phi_rate};
      for (std::size_t i = 0; i < 6; ++i) {
        const Real truth = real(point.at(i < 3 ? "q" : "qd")[i % 3]);
        const Real size = std::max(abs(truth), Real(1));
        worst = test::worst_of(worst, double(abs(found[i] - truth) / size));
        ++judged;
      }
    }
  }
  BOOST_TEST_MESSAGE("states: " << worst);
  BOOST_TEST(judged >= 48);
  // 2^-54 of each moment times some 50 rad of phase.
  BOOST_TEST(worst < 1e-14);
}

BOOST_AUTO_TEST_CASE(refuses_rings_that_turn_over) {
  const auto begin = [](Real beta_rate, Real spin) {
    return FreeCardanGyro(rotor, inner_ring, outer_ring, false, {0, 0.5, 0, 0, beta_rate, spin});
  };
  BOOST_CHECK_NO_THROW(begin(1, 50));
  BOOST_CHECK_THROW(begin(30, 5), ComputationFailed);  // over the top
  BOOST_CHECK_THROW(begin(0, 0), ComputationFailed);   // at rest
  BOOST_CHECK_THROW((void)begin(1, 50).at(INFINITY), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()
