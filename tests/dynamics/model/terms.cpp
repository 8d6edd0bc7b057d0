#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/gimbal/foeppl.hpp>
#include <dynamics/gimbal/gyro_platform.hpp>
#include <dynamics/gimbal/gyro_small_oscillations.hpp>
#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/guide/steady.hpp>
#include <dynamics/guide/translating.hpp>
#include <dynamics/law/relative.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <dynamics/rigid/free_body.hpp>

#include <support/sample.hpp>

// The list of terms() against the field, at random states. Each term is compared with its formula,
// or with the change of the field if the term's cause is removed.

using namespace kreisel;
namespace data = boost::unit_test::data;

namespace {

template <class M>
auto any_guide(const M& guide) {
  return [guide](double t) { return guide(t); };
}

[[nodiscard]] Term term(const Terms& all, std::string_view name) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Term& candidate) { return candidate.name == name; });
  BOOST_REQUIRE_MESSAGE(found != all.end(), name);
  return *found;
}

/// Kept if it has an effect; every dropped term has a reason.
void holds(const Terms& all, std::string_view name, double size) {
  const Term found = term(all, name);
  BOOST_TEST(found.kept == (size != 0), name << " = " << size);
  BOOST_TEST((found.kept || !found.why.empty()), name);
}

InertiaTensor<Body> body(const Vector3<double>& centre, double product) {
  Matrix3<double> T = Vector3<double>(0.25, 0.27, 0.2).asDiagonal();
  T(0, 1) = T(1, 0) = -product;
  return InertiaTensor<Body>::about_centre(2, centre, T);
}

/// The sizes of the terms of a body's equation. `g` is the apparent field of uniform gravity and of
/// the guide, at the position r.
template <class Scene>
void check_body(const Scene& scene, const typename Scene::State& state, bool held,
                const Vector3<double>& field) {
  const Terms all = terms(scene);
  const LoadContext<> s = scene.situation(0.3, state);
  const Inertia<>& T = s.inertia.value;
  const Matrix3<double> R_t = s.X.value.rotation.transpose();
  const FrameMotion<Guide, Inertial>& guide = s.guide;
  const Vector3<double> u = R_t * guide.V.value.resultant;
  const Vector3<double> du = R_t * guide.dV.value.resultant;
  const Vector3<double>& r = s.X.value.translation;
  const Vector3<double> from_place =
      guide.dV.value.resultant.cross(r) +
      guide.V.value.resultant.cross(guide.V.value.resultant.cross(r));
  const Vector3<double> c = s.centre();
  const Matrix3<double> theta =
      held ? T.tensor.matrix()
           : Matrix3<double>(
                 (T.tensor - offset_product(c, Vector3<double>(T.first_moment / 2))).matrix());
  const std::string tensor = held ? "Theta" : "Theta_c";
  const auto product = [&](const char* a, const char* b) {
    std::string name = a;
    name += tensor;
    return name += b;
  };
  const Matrix3<double> off = theta - Matrix3<double>(theta.diagonal().asDiagonal());
  holds(all, product("products of inertia in ", ""), off.norm());
  holds(all, product("u x (", " u)"), u.norm());
  holds(all, product("", " ou"), du.norm());
  holds(all, product("u' x (", " u) + u x (") + product("", " u') + ") + product("", " (u x u')"),
        u.norm());
  const Vector3<double> g = field - guide.origin_acceleration();
  if (held) {
    holds(all, "s x g'", T.first_moment.norm() * (g - from_place).norm());
  } else {
    holds(all, "m g'", g.norm());
    holds(all, "c apart from O'", c.norm());
    holds(all, "m u x (u x r)", u.norm());
    holds(all, "m ou x r", du.norm());
    holds(all, "2 m u x v'", u.norm());
  }
}

template <class M>
void check_on(const M& guide, test::Sample& sample, const Vector3<double>& gravity) {
  const Eigen::Quaterniond q(Eigen::Vector4d(Eigen::Vector4d(1, 2, 3, 4) +
                                             sample.uniform(0, 1) * Eigen::Vector4d::Ones()));
  const auto check = [&](const InertiaTensor<Body>& T, const auto&... parts) {
    const FixedPointBody held(T, sample.direction(), guide, parts...);
    check_body(held, {q, sample.direction()}, true, gravity);
    const FreeBody free(T, guide, parts...);
    check_body(free, {q, sample.direction(), {{sample.direction(), sample.direction()}}}, false,
               gravity);
  };
  const auto with = [&](const auto&... parts) {
    check(body(sample.direction(), 0.03), parts...);
    check(body({0, 0, 0}, 0.03), Without<FirstMoment>{}, parts...);
    check(body({0, 0, 0.2}, 0), Without<ProductsOfInertia>{},
          Without<FirstMoment, Axis::x, Axis::y>{}, parts...);
    check(body({0, 0, 0}, 0), Without<ProductsOfInertia>{}, Without<FirstMoment>{}, parts...);
  };
  const ViscousDrag<> drag{0.02, 0.1};
  if (gravity.isZero(0)) {
    with();
    with(drag);
  } else {
    with(UniformGravity<Guide>{gravity});
    with(drag, UniformGravity<Guide>{gravity});
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(the_terms_of_a_scene)

BOOST_DATA_TEST_CASE(agree_with_the_field, data::xrange(10u), seed) {
  test::Sample sample(seed);
  const RotatingFrame<> table{sample.direction(), sample.direction()};
  const SteadyFrame<> steady{{exp(Motor<>{sample.direction(), {}})},
                             {{sample.direction(), sample.direction()}}};
  // A guide of unknown type may turn unsteadily, and this one does.
  const auto shaken = [](double t) {
    PoseDerivatives<> p;
    p.q = Eigen::Quaterniond(1, t * t, t, 0);
    p.dq = Eigen::Quaterniond(0, 2 * t, 1, 0);
    p.ddq = Eigen::Quaterniond(0, 2, 0, 0);
    p.x = Vector3<double>(1, t * t, 0);
    p.dx = Vector3<double>(0, 2 * t, 0);
    p.ddx = Vector3<double>(0, 2, 0);
    return frame_motion<Guide, Inertial>(p);
  };
  const TranslatingFrame lift([](double t) {
    return Translation<>{{0, 0, t * t}, {0, 0, 2 * t}, {0, 0, 2}};
  });
  for (const Vector3<double>& gravity : {Vector3<double>(0, 0, 0), Vector3<double>(1, 2, -9)}) {
    check_on(RestingFrame<>{}, sample, gravity);
    check_on(lift, sample, gravity);
    check_on(table, sample, gravity);
    check_on(steady, sample, gravity);
    check_on(shaken, sample, gravity);
  }
}

// The terms of a Cardan gyro: the field on the guide against that on one at rest, and similarly.
BOOST_AUTO_TEST_CASE(cardan_gyro_terms_have_their_stated_effect) {
  const auto y = CardanGyro<RestingFrame<>>::to_vector({0.2, 0.3, 0.7, 1, 2, 200});
  const CardanMoments round{{5, 5, 8}, {2, 3, 2.5}, {4, 4, 4.5}};
  const CardanMoments oval{{5, 6, 8}, {2, 3, 2.5}, {4, 4, 4.5}};
  const CardanBearings bearings{{0.5, 0.1, 0}, {1, 2, 0}};
  const auto effect = [&](const auto& a, const auto& b) {
    return (a.rates(0.7, y) - b.rates(0.7, y)).norm();
  };
  const RotatingFrame<> table{{0.1, 0.2, 0.3}, {1, 2, 3}};
  const RotatingFrame<> still{};
  const RotatingFrame<> carried{{0, 0, 0}, {1, 2, 3}};
  const auto check = [&](const auto& guide, const CardanMoments& moments, const auto& rotor) {
    const CardanGyro gyro(moments, bearings, guide, rotor);
    const CardanGyro at_rest(moments, bearings, RestingFrame<>{}, rotor);
    const Terms all = terms(gyro);
    const double turning = effect(gyro, at_rest);
    holds(all, "u x (Theta_i u)", turning);
    holds(all, "u' x (Theta_i u) + u x (Theta_i u') + Theta_i (u x u')", turning);
    holds(all, "A_1 - B_1, which turns with phi", moments.rotor.x() - moments.rotor.y());
    // Another phi has no effect on a symmetric rotor.
    auto later = y;
    later[2] += 1;
    holds(all, "A_1 - B_1, which turns with phi",
          (gyro.rates(0.7, later) - gyro.rates(0.7, y)).norm());
  };
  check(RestingFrame<>{}, round, FreeRotor{});
  check(RestingFrame<>{}, oval, FrictionlessRotor{});
  check(table, round, RegulatedRotor{});
  check(table, oval, FreeRotor{});
  check(any_guide(table), oval, FreeRotor{});
  BOOST_TEST(effect(CardanGyro(oval, bearings, carried), CardanGyro(oval, bearings, still)) == 0);

  const auto spun = [&](const auto& rotor) {
    return term(terms(CardanGyro(round, bearings, table, rotor)),
                "drive and friction of the rotor");
  };
  BOOST_TEST(spun(FreeRotor{0.1}).kept);
  BOOST_TEST(spun(DrivenRotor{3.0}).kept);
  BOOST_TEST(spun(FrictionlessRotor{}).why == "FrictionlessRotor");
  BOOST_TEST(spun(RegulatedRotor{}).why == "the motor keeps phi'");
  // Springs and friction have an effect if there are any.
  for (const CardanBearings& some :
       {CardanBearings{}, CardanBearings{{0.5, 0}, {}}, CardanBearings{{}, {0, 0.1}}}) {
    const CardanGyro gyro(round, some, table);
    holds(terms(gyro), "springs and friction of the rings' bearings",
          effect(gyro, CardanGyro(round, {}, table)));
  }
  const CardanGyro bent(round, {{0.5, 0.1, 0.3}, {}}, table);
  BOOST_TEST(term(terms(bent), "references of the bearings").kept);
  const Term du = term(terms(CardanGyro(round, bearings, table)), "Theta_i ou");
  BOOST_TEST(du.why == "the guide moves steadily");
}

BOOST_AUTO_TEST_CASE(top_terms_are_weight_and_rotor) {
  for (const double k : {0.0, 1.0}) {
    for (const double h : {0.0, 2.0}) {
      const Terms all = terms(EulerTop({1, 2, 2.5}, {0, 0, k}, {h, 0, 0}));
      holds(all, "k x gamma", k);
      holds(all, "w x h", h);
      holds(all, "products of inertia in Theta", 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(pendulum_terms_have_their_stated_effect) {
  const PendulumState<> y(0.4, 1);
  PendulumBody<> crooked = PendulumBody<>::thin_rod(1);
  crooked.theta_a = 0.1;
  const PendulumGuide<> guide{{1, 2, 3}, {1, 0, 2}, {9, 3, 0}, {}};
  const Without<ProductsOfInertia> principal_axes;
  const PendulumField plain(crooked, guide, NoDamping{}, principal_axes);
  holds(terms(plain), "products of inertia: in E, F, H, K", 0);
  holds(terms(plain), "damping", 0);
  crooked.phi_c = 0.01;
  const PendulumField general(crooked, guide, [](double w) { return 0.1 * w; });
  holds(terms(general), "products of inertia: in E, F, H, K", crooked.phi_c);
  holds(terms(general), "damping", 0.1);
  const PendulumField upright(crooked, RestingPendulumGuide<>{9});
  for (const char* name : {"(Theta_B - Theta_A) of u x (u x r): in H, K", "Theta_C ou_z",
                           "m a g'_y: in F", "products of inertia: in E, F, H, K"}) {
    holds(terms(upright), name, 0);
  }
  // Each term by removing its cause.
  const double all = general(0, y)[1];
  const auto without = [&](const PendulumGuide<>& less) {
    return PendulumField(crooked, less, [](double w) { return 0.1 * w; })(0, y)[1] - all;
  };
  const auto rates = guide.angular_acceleration;
  holds(terms(general), "Theta_C ou_z", without({{1, 2, 3}, {1, 0, 0}, {9, 3, 0}, {}}));
  holds(terms(general), "(Theta_B - Theta_A) of u x (u x r): in H, K",
        without({{0, 0, 0}, rates, {9, 3, 0}, {}}));
  holds(terms(general), "m a g'_y: in F", without({{1, 2, 3}, rates, {9, 0, 0}, {}}));
}

// Its spin changes nothing but the angle.
BOOST_AUTO_TEST_CASE(axisymmetric_terms_do_not_depend_on_spin) {
  const AxisymmetricBody top(1, 0.1, 0.02, 0.01, {0, 0, 0}, RestingFrame<>{},
                             UniformGravity<Guide>{{0, 0, -9.81}});
  const auto y = top.to_vector({Eigen::Quaterniond(1, 0.1, 0.2, 0), {1, 2, 3}, 0});
  auto later = y;
  later[7] += 1;
  holds(terms(top), "angle of the spin", (top.rates(0, later) - top.rates(0, y)).norm());
  holds(terms(top), "s x g'", 0.1 * 9.81);
}

BOOST_AUTO_TEST_CASE(small_oscillations_at_rest_have_two_terms) {
  const CardanMoments oval{{5, 6, 8}, {2, 3, 2.5}, {4, 4, 4.5}};
  const CardanMoments round{{5, 5, 8}, {2, 3, 2.5}, {4, 4, 4.5}};
  const auto check = [](const auto& gyro, const auto& bare) {
    const auto y = gyro.to_vector({0.1, 0.2, 0.3, 0.4});
    const Terms all = terms(gyro);
    holds(all, "A_1 - B_1, which turns with phi", (gyro.rates(0.3, y) - gyro.rates(0.0, y)).norm());
    holds(all, "moments of inertia of both rings",
          (gyro.rates(0.0, y) - bare.rates(0.0, y)).norm());
    holds(all, "u of the guide", 0);
  };
  check(UnsymmetricRotor<>(oval, {}, 2), UnsymmetricRotor<>({oval.rotor}, {}, 2));
  check(FoepplGyro<>(round, {}, 2), FoepplGyro<>({round.rotor}, {}, 2));
}

BOOST_AUTO_TEST_CASE(small_oscillations_have_the_chosen_terms) {
  const auto shaken = [](double t) {
    PoseDerivatives<> p;
    p.q = Eigen::Quaterniond(1, t * t, t, 0.1 * t * t);
    p.dq = Eigen::Quaterniond(0, 2 * t, 1, 0.2 * t);
    p.ddq = Eigen::Quaterniond(0, 2, 0, 0.2);
    return frame_motion<Guide, Inertial>(p);
  };
  using Gyro = GyroSmallOscillations<decltype(shaken)>;
  const auto rates = [&shaken](GuideMomentum kept, const Gyro::State& s) {
    return Gyro({5, 6, 8}, {}, 2, shaken, kept).rates(0.3, Gyro::to_vector(s));
  };
  for (const auto kept :
       {GuideMomentum::none, GuideMomentum::constant, GuideMomentum::first_order}) {
    const Terms all = terms(Gyro({5, 6, 8}, {}, 2, shaken, kept));
    const auto effect = [&](GuideMomentum less, const Gyro::State& s) {
      return (rates(kept, s) - rates(less, s)).norm();
    };
    holds(all, "oJ_f + u x J_f of the rotor not inclined", effect(GuideMomentum::none, {}));
    if (kept == GuideMomentum::none) continue;
    const double inclined = effect(GuideMomentum::constant, {0.1, 0.2, 0, 0});
    holds(all, "g_a, g_b in J_f", inclined);
    holds(all, "torque of the drive, along the inclined axis", inclined);
  }
}

BOOST_AUTO_TEST_CASE(platform_terms_are_those_of_its_equations) {
  GyroPlatform p;
  p.frame_4.moments = {1, 2, 4};
  p.housing_5.moments = {3, 5, 6};
  p.housing_7.moments = {2, 7, 3};
  p.frame_9.moments = {1, 3, 8};
  p.housing_10.moments = {4, 2, 5};
  p.rotor_6 = p.rotor_8 = p.rotor_11 = {1, 2, 1};
  const Vector3<double> W(0.3, 0.2, -0.4);
  const GyroPlatform::Angles none = GyroPlatform::Angles::Zero();
  const GyroPlatform::Angles some = GyroPlatform::Angles::LinSpaced(0.1, 0.5);
  for (const auto equations :
       {PlatformEquations::printed, PlatformEquations::corrected, PlatformEquations::complete}) {
    // Without spin and W' only the products J W are left.
    const auto left = [&](const GyroPlatform::Angles& rates) -> GyroPlatform::Angles {
      return p.linear_accelerations(equations, W, {0, 0, 0}, some, rates, none);
    };
    const Terms all = p.terms(equations);
    holds(all, "J W W, J W W times angles", left(none).norm());
    holds(all, "J W alpha'", (left(some) - left(none)).norm());
    BOOST_TEST(term(all, "L W").why.empty() == (equations != PlatformEquations::printed));
  }
  BOOST_TEST(terms(p).size() == p.terms(PlatformEquations::complete).size());
}

// It does not vanish: the user has declared it absent.
BOOST_AUTO_TEST_CASE(omit_a_dropped_centrifugal_force) {
  const RotatingFrame<> table{{0, 0, 2}};
  const FreeBody whole(body({0, 0, 0}, 0), table);
  const FreeBody less(body({0, 0, 0}, 0), table, Without<CentrifugalForce>{});
  const auto y = whole.to_vector({Eigen::Quaterniond(1, 0, 0, 0), {3, 0, 1}, {}});
  const auto off = (whole.rates(0, y) - less.rates(0, y)).eval();
  BOOST_TEST(term(terms(whole), "m u x (u x r)").kept);
  BOOST_TEST(term(terms(less), "m u x (u x r)").why == "declared by Without<CentrifugalForce>");
  BOOST_TEST(off[10] == 12);  // |u|^2 outwards
  BOOST_TEST(off.norm() == 12);
}

BOOST_AUTO_TEST_CASE(print_as_a_table) {
  std::ostringstream text;
  text << terms(FixedPointBody(
      body({0, 0, 0.2}, 0), {0, 0, 0}, RestingFrame<>{}, UniformGravity<Guide>{{0, 0, -9.81}},
      ViscousDrag<>{0.02}, Without<ProductsOfInertia>{}, Without<FirstMoment, Axis::x, Axis::y>{}));
  const std::string expected = R"(
relative  u' x (Theta u')                                   kept
relative  products of inertia in Theta                      dropped: declared by Without<ProductsOfInertia>
guide     u x (Theta u)                                     dropped: the guide does not turn
guide     Theta ou                                          dropped: the guide does not turn
guide     s x g'                                            kept: without x y, declared by Without<FirstMoment>
Coriolis  u' x (Theta u) + u x (Theta u') + Theta (u x u')  dropped: the guide does not turn
load      gravity on guide axes                             kept: without x y, declared by Without<FirstMoment>
load      viscous drag                                      kept
)";
  BOOST_TEST("\n" + text.str() == expected);
}

BOOST_AUTO_TEST_SUITE_END()
