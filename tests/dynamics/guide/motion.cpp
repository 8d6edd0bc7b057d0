#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <vector>

#include <dynamics/guide/motion.hpp>

#include <support/cast.hpp>
#include <support/kinematics.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

/// A chain of moving frames is one moving frame, compared with positions composed in 50 digits.

using namespace kreisel;
using test::Digits50;
using test::near;
namespace data = boost::unit_test::data;

namespace {

struct Ship {};
struct Earth {};

/// Earth in space, ship on earth and ship in space, at one instant of random motions.
template <class S>
struct Chain {
  FrameMotion<Earth, Inertial, S> earth;
  FrameMotion<Ship, Earth, S> ship;
  FrameMotion<Ship, Inertial, S> both;  ///< from the truth, not by composition
};

template <class S>
Chain<S> chain(unsigned seed) {
  test::Sample sample(seed);
  // The truth's guide is the earth here, its body the ship.
  const test::Truth t = test::truth(sample, {});
  const auto real = [](const auto& x) { return test::cast<S>(x); };
  Chain<S> c;
  c.earth = {{real(t.X_IG)}, {real(t.F_G)}, {real(t.dF_G)}};
  c.ship = {{real(t.X_GB)}, {real(t.V_rel.value)}, {real(t.V_rel.T.body)}};
  c.both = {{real(t.X_IG * t.X_GB)},
            {real(t.V_rel.value + t.F.value)},
            {real(t.V_rel.T.body + t.F.T.body)}};
  return c;
}

template <class S>
S size(const Pose<S>& X) {
  return X.translation.norm() + S(1);
}

template <class S, class A, class B>
test::Verdict agree(const FrameMotion<A, B, S>& found, const FrameMotion<A, B, S>& truth,
                    const S& scale, double k) {
  const auto pose = near(found.X.value.rotation, truth.X.value.rotation, S(1), k, "rotation ");
  if (!pose) return pose;
  const auto place = near(found.X.value.translation, truth.X.value.translation, scale, k, "place ");
  if (!place) return place;
  const auto velocity = near(found.V.value, truth.V.value, scale, k);
  return velocity ? near(found.dV.value, truth.dV.value, scale, k) : velocity;
}

/// A bound of every term of the composition.
template <class S>
S terms(const Chain<S>& c) {
  const S shift = size(c.ship.X.value) * size(c.earth.X.value);
  const S V = test::size(c.earth.V.value) * shift + test::size(c.ship.V.value);
  return shift + V + V * V + test::size(c.earth.dV.value) * shift + test::size(c.ship.dV.value);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_chain_of_frames)

BOOST_DATA_TEST_CASE(is_one_frame_in_double, data::xrange(300u), seed) {
  const Chain<double> c = chain<double>(seed);
  BOOST_TEST(agree(c.earth * c.ship, c.both, terms(c), 8));
}

BOOST_DATA_TEST_CASE(is_one_frame_in_fifty_digits, data::xrange(50u), seed) {
  const Chain<Digits50> c = chain<Digits50>(seed);
  BOOST_TEST(agree(c.earth * c.ship, c.both, terms(c), 64));
}

// Anchor: on a disc of 3 rad/s, at 1 m along x, a ship moves with the rotation at 2 m/s. Its inward
//         acceleration is 9 (centripetal) and 2 x 3 x 2 (Coriolis), because its path in the disc is
//         straight.
BOOST_AUTO_TEST_CASE(adds_coriolis_and_centripetal_acceleration) {
  const FrameMotion<Earth, Inertial> disc{{}, {{{0, 0, 3}, {0, 0, 0}}}, {{{0, 0, 0}, {0, 0, 0}}}};
  FrameMotion<Ship, Earth> ship{{}, {{{0, 0, 0}, {0, 2, 0}}}, {{{0, 0, 0}, {0, 0, 0}}}};
  ship.X.value.translation = {1, 0, 0};
  const FrameMotion<Ship, Inertial> both = disc * ship;
  BOOST_TEST(both.V.value.moment == Vector3<double>(0, 5, 0));
  BOOST_TEST(both.origin_acceleration() == Vector3<double>(-9 - 12, 0, 0));
}

// The chain is associative: earth and ship may be joined first, or ship and device.
BOOST_DATA_TEST_CASE(is_associative, data::xrange(50u), seed) {
  struct Device {};
  const Chain<Digits50> first = chain<Digits50>(seed);
  const Chain<Digits50> second = chain<Digits50>(seed + 1000);
  const FrameMotion<Device, Ship, Digits50> device{
      {second.ship.X.value}, {second.ship.V.value}, {second.ship.dV.value}};
  const auto left = (first.earth * first.ship) * device;
  const auto right = first.earth * (first.ship * device);
  const Digits50 scale = terms(first) * terms(second);
  BOOST_TEST(agree(left, right, scale, 64));
}

BOOST_AUTO_TEST_SUITE_END()
