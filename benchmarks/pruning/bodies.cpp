#include <cmath>

#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/translating.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>

#include "../hand_written_fields.hpp"
#include "cases.hpp"

using namespace kreisel;
using by_hand::Free;
using by_hand::Top;
using by_hand::V3;

namespace pruning {

std::vector<Case> bodies() {
  const Top held_start = (Top() << 0.1, -0.5, 0.7, 0.5, 0.3, -2, 5).finished();
  const Free free_start =
      (Free() << 0.1, -0.5, 0.7, 0.5, 0.3, -0.4, 2, 0.3, -2, 5, 1, 2, -0.5).finished();
  Matrix3<double> T;
  T << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  const auto lopsided = InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, T);
  const V3 moments(0.25, 0.27, 0.06);
  const auto centred =
      InertiaTensor<Body>::about_centre(2, V3::Zero(), Matrix3<double>(moments.asDiagonal()));
  const RotatingFrame<> table{{0.3, -0.2, 1.1}, {0.2, 0, -0.1}};
  const V3 point(0.4, -0.1, 0.2);
  const V3 g(0.5, -1, -9.75);
  const UniformGravity<Inertial> gravitation{g};
  const UniformGravity<Guide> weight{g};
  const V3& u = table.angular_velocity;
  const by_hand::HeldOnTurningGuide held_hand{
      T, lopsided.value.first_moment, u, g,
      table.origin_acceleration + u.cross(V3(u.cross(point)))};
  const by_hand::FreeOnTurningGuide free_hand{moments, u, g - table.origin_acceleration};
  const TranslatingFrame lift([](double t) {
    const double s = std::sin(2 * t), c = std::cos(2 * t);
    return Translation<>{{0, 0, -s}, {0, 0, -2 * c}, {0, 0, 4 * s}};
  });
  const by_hand::HeldInLift lift_hand{T, lopsided.value.first_moment, g};
  return {
      {"fixed-point body in a lift",
       {form("general", held_start,
             field(FixedPointBody(lopsided, point, any_guide(lift), any_load(weight)))),
        form("pruned", held_start, field(FixedPointBody(lopsided, point, lift, weight))),
        form("by hand", held_start, [=](double t, const Top& y) { return lift_hand(t, y); })}},
      {"fixed-point body on a turntable with gravity at rest",
       {form("general", held_start,
             field(FixedPointBody(lopsided, point, any_guide(table), any_load(gravitation)))),
        form("pruned", held_start, field(FixedPointBody(lopsided, point, table, gravitation))),
        form("by hand", held_start, [=](double t, const Top& y) { return held_hand(t, y); })}},
      {"free body on a turntable with gravity on it",
       {form("general", free_start, field(FreeBody(centred, any_guide(table), any_load(weight)))),
        form("pruned", free_start,
             field(FreeBody(centred, table, weight, Without<ProductsOfInertia>{},
                            Without<FirstMoment>{}))),
        form("by hand", free_start, [=](double, const Free& y) { return free_hand(y); })}},
  };
}

}  // namespace pruning
