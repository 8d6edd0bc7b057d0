#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>

#include "../hand_written_fields.hpp"
#include "cases.hpp"

using namespace kreisel;
using by_hand::Angle;
using by_hand::Top;
using by_hand::V3;

namespace pruning {

namespace {

const Angle plane_start(0.1, 0.3);
const Top ball_start = (Top() << 0.1, -0.5, 0.7, 0.5, 0.3, -2, 5).finished();

constexpr double gravity = 9.81;
constexpr double arm = 0.45;
const V3 earth(-5.15630e-5, 0, 5.15630e-5);  // rad/s, x south, z up
const V3 ball_moments(0.25, 0.25, 0.01);

const PendulumBody<> rod = PendulumBody<>::from_reduced_length(0.5);
const PendulumGuide<> meridian{{3e-5, 6e-5, 0}, V3::Zero(), {9.81, 0.01, 0}, {}};

/// A deck that rolls.
PendulumGuide<> deck(double t) {
  const double s = std::sin(0.9 * t), c = std::cos(0.9 * t);
  return {{0.1 * s, 0.05, 0.2 * c}, {0.09 * c, 0, -0.18 * s}, {9.81, 0.3 * s, 0.2 * c}, {}};
}

/// The same pendulum without the terms that vanish on principal axes.
struct Deck {
  V3 u, du, g;
};
Deck bare_deck(double t) {
  const double s = std::sin(0.9 * t), c = std::cos(0.9 * t);
  return {{0.1 * s, 0.05, 0.2 * c}, {0.09 * c, 0, -0.18 * s}, {9.81, 0.3 * s, 0.2 * c}};
}

by_hand::PlanePendulum plane_by_hand() {
  const PendulumCoefficients<> c = coefficients(rod, meridian);
  return {c.e() / rod.theta_c, c.f / rod.theta_c, c.h / rod.theta_c, 2 * c.k / rod.theta_c};
}

template <class Field>
auto plane(const Field& pendulum) {
  return [pendulum](double t, const Angle& y) -> Angle { return pendulum(t, y); };
}

}  // namespace

std::vector<Case> pendulums() {
  const PendulumGuide<> upright{V3::Zero(), V3::Zero(), {gravity, 0, 0}, {}};
  const auto any = [](const PendulumGuide<>& guide) { return [guide](double) { return guide; }; };
  const by_hand::PlanePendulumAtRest rest_hand{rod.mass * rod.arm * gravity / rod.theta_c};
  const by_hand::PlanePendulum earth_hand = plane_by_hand();
  const auto rolling = [](double t) { return deck(t); };
  const auto bare = [](double t) { return bare_deck(t); };
  const by_hand::PlanePendulumOnGuide<std::remove_const_t<decltype(bare)>> deck_hand{
      bare, rod.mass * rod.arm / rod.theta_c, (rod.theta_b - rod.theta_a) / rod.theta_c};

  const auto body = InertiaTensor<Body>::about_origin(1, {0, 0, -arm},
                                                      Matrix3<double>(ball_moments.asDiagonal()));
  const RotatingFrame<> ground{earth};
  const UniformGravity<Guide> down{{0, 0, -gravity}};
  const by_hand::BallPendulum ball_hand{ball_moments, earth, arm * gravity};
  const Without<ProductsOfInertia> principal;
  const Without<FirstMoment, Axis::x, Axis::y> hanging;
  const Without<ApparentGravity, Axis::x, Axis::y> plumb;
  const auto general_ball =
      field(FixedPointBody(body, V3::Zero(), any_guide(ground), any_load(down)));
  const auto by_hand_ball = [=](double, const Top& y) { return ball_hand.rates(y); };
  const auto unit_ball = [=](double, const Top& y) {
    return ball_hand.rates<by_hand::Norm::one>(y);
  };
  return {
      {"plane pendulum in the inertial frame",
       {form("general", plane_start, plane(PendulumField(rod, any(upright)))),
        form("pruned", plane_start, plane(PendulumField(rod, RestingPendulumGuide<>{gravity}))),
        form("by hand", plane_start, [=](double, const Angle& y) { return rest_hand(y); })}},
      {"plane pendulum on the earth",
       {form("general", plane_start, plane(PendulumField(rod, any(meridian)))),
        form("pruned", plane_start, plane(PendulumField(rod, meridian, NoDamping{}, principal))),
        form("by hand", plane_start, [=](double, const Angle& y) { return earth_hand(y); })}},
      {"plane pendulum on a rolling deck",
       {form("general", plane_start, plane(PendulumField(rod, rolling))),
        form("pruned", plane_start, plane(PendulumField(rod, rolling, NoDamping{}, principal))),
        form("by hand", plane_start, [=](double t, const Angle& y) { return deck_hand(t, y); })}},
      {"ball pendulum on the earth",
       {form("general", ball_start, general_ball),
        form("pruned", ball_start,
             field(FixedPointBody(body, V3::Zero(), ground, down, principal, hanging, plumb,
                                  Without<GuideRate, Axis::y>{}))),
        form("by hand", ball_start, by_hand_ball),
        form("by hand for norm 1", ball_start, unit_ball),
        form("pruned but nothing stated", ball_start,
             field(FixedPointBody(body, V3::Zero(), ground, down)))}},
  };
}

}  // namespace pruning
