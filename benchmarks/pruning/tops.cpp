#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>

#include "../hand_written_fields.hpp"
#include "cases.hpp"

using namespace kreisel;
using by_hand::Top;
using by_hand::V3;

namespace pruning {

namespace {

const Top start = (Top() << 0.1, -0.5, 0.7, 0.5, 0.3, -2, 5).finished();
const V3 moments(0.25, 0.27, 0.06);
const V3 weight_moment(0.3, -0.2, 4);
constexpr double mass = 2, gravity = 10;

Matrix3<double> lopsided() {
  Matrix3<double> T;
  T << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  return T;
}

/// EulerTop's weight moment, k = m g r_s, for a body.
InertiaTensor<Body> body(const Matrix3<double>& tensor, const V3& k) {
  const Vector3<double> first_moment = k / gravity;
  return {{mass, first_moment, Symmetric3<double>::from(tensor)}};
}

}  // namespace

std::vector<Case> tops() {
  const Matrix3<double> principal = moments.asDiagonal();
  const auto rest = any_guide(RestingFrame<>{});
  const UniformGravity<Guide> down{{0, 0, -gravity}};
  const auto heavy = body(lopsided() + Matrix3<double>::Identity(), weight_moment);
  const auto principal_heavy = body(principal, weight_moment / 10);
  const auto light = body(principal, V3::Zero());
  const by_hand::PrincipalTop free_hand{moments};
  const by_hand::PrincipalTop heavy_hand{moments, weight_moment / 10};
  const by_hand::GeneralTop general_hand{lopsided() + Matrix3<double>::Identity(), weight_moment};
  const auto free_top = [=](double, const Top& y) { return free_hand.rates<false>(y); };
  const auto heavy_top = [=](double, const Top& y) { return heavy_hand.rates<true>(y); };
  const auto unit_top = [=](double, const Top& y) {
    return heavy_hand.rates<true, by_hand::Norm::one>(y);
  };
  const auto general_top = [=](double, const Top& y) { return general_hand(y); };
  const auto general_free = field(FixedPointBody(light, V3::Zero(), rest));
  const auto general_heavy =
      field(FixedPointBody(principal_heavy, V3::Zero(), rest, any_load(down)));
  return {
      {"free top (EulerTop)",
       {form("general", start, general_free), form("pruned", start, field(EulerTop(moments))),
        form("by hand", start, free_top)}},
      {"free top (FixedPointBody)",
       {form("general", start, general_free),
        form("pruned", start,
             field(FixedPointBody(light, V3::Zero(), RestingFrame<>{}, Without<FirstMoment>{},
                                  Without<ProductsOfInertia>{}))),
        form("by hand", start, free_top)}},
      {"heavy top (EulerTop)",
       {form("general", start, general_heavy),
        form("pruned", start, field(EulerTop(moments, weight_moment / 10))),
        form("by hand", start, heavy_top), form("by hand for norm 1", start, unit_top)}},
      {"heavy top (FixedPointBody)",
       {form("general", start, general_heavy),
        form("pruned", start,
             field(FixedPointBody(principal_heavy, V3::Zero(), RestingFrame<>{}, down,
                                  Without<ProductsOfInertia>{},
                                  Without<ApparentGravity, Axis::x, Axis::y>{}))),
        form("by hand", start, heavy_top), form("by hand for norm 1", start, unit_top)}},
      {"heavy top with products of inertia",
       {form("general", start, field(FixedPointBody(heavy, V3::Zero(), rest, any_load(down)))),
        form("pruned", start,
             field(FixedPointBody(heavy, V3::Zero(), RestingFrame<>{}, down,
                                  Without<ApparentGravity, Axis::x, Axis::y>{}))),
        form("by hand", start, general_top)}},
  };
}

}  // namespace pruning
