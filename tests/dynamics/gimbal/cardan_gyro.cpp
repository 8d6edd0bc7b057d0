#include <Eigen/LU>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/step/jacobian.hpp>

#include <support/json.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>
#include <support/worst.hpp>

using namespace kreisel;
using test::Json;
using test::near;
using test::number;
using test::Sample;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector3<double> vector(const Json& list) {
  return {number(list.at(0)), number(list.at(1)), number(list.at(2))};
}

const Json& reference() {
  static const Json json = test::reference_file("cardan-gyro.json");
  return json;
}

const Json& trajectory(const std::string& name) {
  for (const Json& t : reference().at("trajectories")) {
    if (t.at("name") == name) return t;
  }
  throw std::out_of_range(name);
}

/// A parameter; 0 if it is absent.
double parameter(const Json& p, const char* name) {
  return p.contains(name) ? number(p.at(name)) : 0.0;
}

CardanMoments moments(const Json& p) {
  return {{parameter(p, "A1"), parameter(p, "B1"), parameter(p, "C1")},
          {parameter(p, "A2"), parameter(p, "B2"), parameter(p, "C2")},
          {parameter(p, "A3"), parameter(p, "B3"), parameter(p, "C3")}};
}

CardanBearings bearings(const Json& p) {
  return {{parameter(p, "ca"), parameter(p, "da")}, {parameter(p, "cb"), parameter(p, "db")}};
}

Vector6 state(const Json& q, const Json& dq) {
  return (Vector6() << vector(q), vector(dq)).finished();
}

const CardanMoments symmetric{{.005, .005, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};
const CardanMoments unsymmetric{{.0055, .0045, .008}, {.002, .0015, .0028}, {.006, .0045, .005}};

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>,
                                            boost::multiprecision::et_off>;

/// The gyro by the recursion of Newton and Euler: each body on its own axes, with sines only in the
/// three rotations. Independent of the scene's formulas.
template <class S>
struct Recursion {
  using V = Eigen::Matrix<S, 3, 1>;
  using M = Eigen::Matrix<S, 3, 3>;

  std::array<V, 3> theta;  ///< outer ring, inner ring, rotor
  V q, dq, u, du;

  Recursion(const CardanMoments& m, const Vector6& y, const Vector3<double>& u_base,
            const Vector3<double>& du_base)
      : theta{cast(m.outer_ring), cast(m.inner_ring), cast(m.rotor)},
        q(cast(y.head<3>())),
        dq(cast(y.tail<3>())),
        u(cast(u_base)),
        du(cast(du_base)) {}

  static V cast(const Vector3<double>& v) {
    return v.unaryExpr([](double x) { return S(x); });
  }

  /// Turned about axis k = x, y, z.
  static M turn(int k, const S& angle) {
    using std::cos, std::sin;
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    M R = M::Identity();
    R(i, i) = R(j, j) = cos(angle);
    R(j, i) = sin(angle);
    R(i, j) = -R(j, i);
    return R;
  }

  /// The moments on each body from its outer neighbour; [0] from the guide. The inner neighbour
  /// gets the negative.
  std::array<V, 3> moments(const V& dqd, const V& rates, const V& base, const V& dbase) const {
    std::array<V, 3> torque;
    std::array<M, 3> R;
    V w = base;
    V dw = dbase;
    const int axes[] = {0, 1, 2};
    for (std::size_t i = 0; i < 3; ++i) {
      const int k = axes[i];
      R[i] = turn(k, q[k]);
      const V e = V::Unit(k);
      const V w_in = R[i].transpose() * w;
      dw = V(R[i].transpose() * dw) - rates[k] * e.cross(w_in) + dqd[k] * e;
      w = w_in + rates[k] * e;
      torque[i] = theta[i].cwiseProduct(dw) + w.cross(V(theta[i].cwiseProduct(w)));
    }
    torque[1] += R[2] * torque[2];
    torque[0] += R[1] * torque[1];
    return torque;  // on each body and all within it, on the body's axes
  }

  V left_side(const V& dqd, const V& rates, const V& base, const V& dbase) const {
    const auto t = moments(dqd, rates, base, dbase);
    return {t[0][0], t[1][1], t[2][2]};
  }

  /// The angular accelerations under torques about the axes, by the full mass matrix.
  V solve(const V& applied, bool regulated = false) const {
    const V zero = V::Zero();
    M mass;
    for (int k = 0; k < 3; ++k) mass.col(k) = left_side(V::Unit(k), zero, zero, zero);
    const V right = applied - left_side(zero, dq, u, du);
    V dqd = zero;
    if (regulated) {
      dqd.template head<2>() = Eigen::Matrix<S, 2, 2>(mass.template topLeftCorner<2, 2>())
                                   .fullPivLu()
                                   .solve(Eigen::Matrix<S, 2, 1>(right.template head<2>()));
    } else {
      dqd = mass.fullPivLu().solve(right);
    }
    return dqd;
  }
};

Vector3<double> rounded(const Recursion<Exact>::V& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// The greatest error of angular accelerations, relative to each one's own size or to phi''.
double error_of(const Vector3<double>& x, const Vector3<double>& truth) {
  return (x - truth).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() / truth.cwiseAbs().maxCoeff();
}

CardanMoments moments_at_random(Sample& sample) {
  const auto body = [&sample] {  // a box, so that the triangle inequality holds
    const Vector3<double> s(sample.magnitude(-3, -1), sample.magnitude(-3, -1),
                            sample.magnitude(-3, -1));
    return Vector3<double>(s.y() + s.z(), s.z() + s.x(), s.x() + s.y());
  };
  CardanMoments m{body(), body(), body()};
  if (sample.once_in(4)) m.rotor = m.rotor.x() * Vector3<double>(1, 1, 1.5);
  if (sample.once_in(6)) m.inner_ring.setZero();
  if (sample.once_in(6)) m.outer_ring.setZero();
  return m;
}

Vector6 state_at_random(Sample& sample) {
  return (Vector6() << sample.uniform(-4, 4), sample.uniform(-4, 4), sample.uniform(-100, 100),
          sample.uniform(-5, 5), sample.uniform(-5, 5), sample.uniform(-100, 100))
      .finished();
}

/// Constant u and ou at one time; the motion before and after does not matter.
struct Momentary {
  Vector3<double> u;
  Vector3<double> du;

  FrameMotion<Guide, Inertial> operator()(double /*t*/) const {
    FrameMotion<Guide, Inertial> motion;
    motion.V.value.resultant = u;
    motion.dV.value.resultant = du;
    return motion;
  }
};

/// The nine moments, in the order of the reference.
std::array<double, 9> list(const CardanReactions& r) {
  std::array<double, 9> all{};
  int i = 0;
  for (const auto* v :
       {&r.rotor_on_inner_ring, &r.inner_ring_on_outer_ring, &r.guide_on_outer_ring}) {
    for (int k = 0; k < 3; ++k) all[static_cast<std::size_t>(i++)] = (*v)[k];
  }
  return all;
}

constexpr std::array names{"M_A21", "M_B21", "M_C21", "M_A32", "M_B32",
                           "M_C32", "M_A3",  "M_BL",  "M_CL"};

/// The greatest errors found, each relative to the largest of its kind.
struct Worst {
  double angles = 0, rates = 0, accelerations = 0, reactions = 0;

  void note(const char* what) const {
    BOOST_TEST_MESSAGE(what << ": angles " << angles << ", rates " << rates << ", accelerations "
                            << accelerations << ", reactions " << reactions);
  }
};

double relative(const Eigen::VectorXd& x, const Eigen::VectorXd& truth) {
  return (x - truth).cwiseAbs().maxCoeff<Eigen::PropagateNaN>() /
         std::max(truth.cwiseAbs().maxCoeff(), 1e-300);
}

template <class Gyro>
double error_of_reactions(const Gyro& gyro, double t, const typename Gyro::State& s,
                          const Json& truth) {
  const auto mine = list(gyro.reactions(t, s));
  double worst = 0;
  double size = 0.1;  // reactions of massless rings are 0, a sum of terms of this size
  for (std::size_t i = 0; i < names.size(); ++i) {
    worst = test::worst_of(worst, std::abs(mine[i] - number(truth.at(names[i]))));
    size = std::max(size, std::abs(number(truth.at(names[i]))));
  }
  return worst / size;
}

/// Runs a trajectory of the reference and compares all its numbers.
template <class M, class Rotor>
Worst follow(const Json& c, M guide, Rotor rotor) {
  const CardanGyro gyro(moments(c.at("parameters")), bearings(c.at("parameters")), std::move(guide),
                        std::move(rotor));
  using Gyro = decltype(gyro);
  Integrator run(gyro, 0, std::decay_t<Gyro>::from_vector(state(c.at("q0"), c.at("qd0"))));
  Worst worst;
  double angle_size = 0;
  double rate_size = 0;
  for (const Json& point : c.at("points")) {
    const auto greatest = [&](const char* of) {
      return vector(point.at(of)).head<2>().cwiseAbs().maxCoeff();
    };
    angle_size = std::max(angle_size, greatest("q"));
    rate_size = std::max(rate_size, greatest("qd"));
  }
  for (const Json& point : c.at("points")) {
    const double t = number(point.at("t"));
    const auto s = run.to(t);
    const Vector6 y = gyro.to_vector(s);
    const Vector6 truth = state(point.at("q"), point.at("qd"));
    const Vector6 off = (y - truth).cwiseAbs();
    worst.angles = test::worst_of(worst.angles, off[0] / angle_size, off[1] / angle_size,
                                  off[2] / std::max(std::abs(truth[2]), 1e-300));
    worst.rates = test::worst_of(worst.rates, off[3] / rate_size, off[4] / rate_size,
                                 off[5] / std::max(std::abs(truth[5]), 1e-300));
    worst.accelerations =
        test::worst_of(worst.accelerations,
                       relative(gyro.rates(t, y).template tail<3>(), vector(point.at("qdd"))));
    worst.reactions =
        test::worst_of(worst.reactions, error_of_reactions(gyro, t, s, point.at("reactions")));
    const double drive = number(point.at("M_C12_drive_total"));
    BOOST_TEST(near(-gyro.reactions(t, s).rotor_on_inner_ring.z(), drive, 1.0, 1e-11 / test::u<>));
    if (point.contains("energy")) {
      const CardanBalance all = gyro.balance(t, s);
      const double energy = number(point.at("energy"));
      BOOST_TEST(
          near(all.kinetic_energy + all.potential_energy, energy, energy, 1e-13 / test::u<>));
    }
  }
  worst.note(c.at("name").get<std::string>().c_str());
  return worst;
}

/// Steps at 1e-14 over up to 20 nutations of up to 100 rad. Accelerations and moments amplify the
/// error of the state by the nutation frequency squared over the size of the rates.
void require_close(const Worst& worst) {
  BOOST_TEST(worst.angles < 1e-12);
  BOOST_TEST(worst.rates < 1e-12);
  BOOST_TEST(worst.accelerations < 1e-11);
  BOOST_TEST(worst.reactions < 1e-11);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cardan_gyro)

BOOST_AUTO_TEST_CASE(follows_the_reference_on_a_guide_at_rest) {
  for (const char* name : {"T1_free_symmetric", "T3_massless_asymmetric", "T3s_massless_symmetric",
                           "T4_springs_small", "T4b_springs_large", "T7b_through_lock"}) {
    BOOST_TEST_CONTEXT(name) {
      require_close(follow(trajectory(name), RestingFrame<>{}, FreeRotor{}));
    }
  }
  require_close(follow(trajectory("T8b_regulated_inertial"), RestingFrame<>{}, RegulatedRotor{}));
}

BOOST_AUTO_TEST_CASE(follows_the_reference_on_a_fast_base) {
  const double quarter = std::numbers::pi / 2;
  const HarmonicSeries<> u{{0.3, -0.2, 0.5},
                           {{{0.1, 0, 0}, 3, 0}, {{0, 0.15, 0}, 2, quarter}, {{0, 0, -0.2}, 5, 0}}};
  const HarmonicFrame<> base(u, {}, 0, 2);
  require_close(follow(trajectory("T6b_fast_base_free"), base, FreeRotor{}));
}

BOOST_AUTO_TEST_CASE(agrees_with_the_vectors_of_the_reference) {
  Worst worst;
  for (const Json& c : reference().at("algebraic_test_vectors")) {
    const Json& p = c.at("params");
    const Momentary base{vector(c.at("u")), vector(c.at("udot"))};
    const Vector6 y = state(c.at("q"), c.at("qd"));
    const auto compare = [&](const auto& gyro) {
      worst.accelerations = test::worst_of(
          worst.accelerations, relative(gyro.rates(0, y).template tail<3>(), vector(c.at("qdd"))));
      worst.reactions = test::worst_of(
          worst.reactions, error_of_reactions(gyro, 0, gyro.from_vector(y), c.at("reactions")));
    };
    const double friction = parameter(p, "df");
    const double torque = parameter(p, "Mdrive");
    if (c.at("regulated").get<bool>()) {
      compare(CardanGyro(moments(p), bearings(p), base, RegulatedRotor{friction}));
    } else {
      compare(CardanGyro(moments(p), bearings(p), base, DrivenRotor{torque, friction}));
      compare(CardanGyro(moments(p), bearings(p), base,
                         DrivenRotor{[torque](double, double) { return torque; }, friction}));
    }
  }
  worst.note("vectors");
  BOOST_TEST(worst.accelerations < 1e-13);
  BOOST_TEST(worst.reactions < 1e-13);
}

// 60 gyros at random, each with all three rotors, against the recursion in 50 digits.
BOOST_AUTO_TEST_CASE(agrees_with_newton_and_euler_in_50_digits) {
  double worst = 0;
  double worst_reaction = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Sample sample(seed);
    const CardanMoments m = moments_at_random(sample);
    const CardanBearings b{{sample.magnitude(-2, 1), 0.01}, {sample.magnitude(-2, 1), 0.02}};
    const Vector6 y = state_at_random(sample);
    const Momentary base{sample.vector(-1, 1), sample.vector(-1, 1)};
    const double friction = 0.001;
    const double drive = sample.number(-2, 0);
    const auto compare = [&](const auto& gyro, double on_rotor, bool regulated) {
      const Recursion<Exact> truth(m, y, base.u, base.du);
      using V = Recursion<Exact>::V;
      const V applied(-(Exact(b.outer.stiffness) * y[0] + Exact(b.outer.damping) * y[3]),
                      -(Exact(b.inner.stiffness) * y[1] + Exact(b.inner.damping) * y[4]),
                      Exact(on_rotor) - Exact(friction) * y[5]);
      const V dqd = truth.solve(applied, regulated);
      worst = test::worst_of(worst, error_of(gyro.rates(0, y).template tail<3>(), rounded(dqd)));
      const auto t = truth.moments(dqd, truth.dq, truth.u, truth.du);
      const V on_inner = Recursion<Exact>::turn(2, truth.q[2]) * -t[2];
      const V on_outer = Recursion<Exact>::turn(1, truth.q[1]) * -t[1];
      const CardanReactions r = gyro.reactions(0, gyro.from_vector(y));
      const double size = std::max({rounded(t[0]).norm(), rounded(t[1]).norm(),
                                    rounded(t[2]).norm(), m.rotor.z() * std::abs(y[5]) * 5});
      for (const double e : {(r.rotor_on_inner_ring - rounded(on_inner)).norm(),
                             (r.inner_ring_on_outer_ring - rounded(on_outer)).norm(),
                             (r.guide_on_outer_ring - rounded(t[0])).norm()}) {
        worst_reaction = test::worst_of(worst_reaction, e / size);
      }
      BOOST_TEST(near(r.motor_torque, static_cast<double>(t[2][2]) + friction * y[5], size,
                      1e-12 / test::u<>));
      BOOST_TEST(r.motor_power == r.motor_torque * y[5]);
    };
    BOOST_TEST_CONTEXT("seed " << seed) {
      compare(CardanGyro(m, b, base, FreeRotor{friction}), 0, false);
      compare(CardanGyro(m, b, base, DrivenRotor{drive, friction}), drive, false);
      compare(CardanGyro(m, b, base, RegulatedRotor{friction}), 0, true);
    }
  }
  BOOST_TEST_MESSAGE("180 gyros: accelerations " << worst << ", reactions " << worst_reaction);
  BOOST_TEST(worst < 1e-12);  // cos beta down to 1e-3, rings without mass
  BOOST_TEST(worst_reaction < 1e-12);
}

// Light rings, almost 90 degrees.
BOOST_AUTO_TEST_CASE(keeps_its_digits_at_gimbal_lock) {
  for (const CardanMoments& heavy : {symmetric, unsymmetric}) {
    for (const double factor : {1.0, 1e-4, 1e-8, 0.0}) {
      for (const double off : {0.0, 1e-8, -1e-4}) {
        if (factor == 0 && off == 0) continue;
        const CardanMoments m{heavy.rotor, factor * heavy.inner_ring, factor * heavy.outer_ring};
        const Vector6 y =
            (Vector6() << 0.3, std::numbers::pi / 2 + off, 0.7, 0.4, -0.6, 50).finished();
        const CardanGyro gyro(m, {}, RestingFrame<>{});
        const Recursion<Exact> exact(m, y, {0, 0, 0}, {0, 0, 0});
        const Recursion<double> full(m, y, {0, 0, 0}, {0, 0, 0});
        const Vector3<double> truth = rounded(exact.solve(Recursion<Exact>::V::Zero()));
        const double mine = error_of(gyro.rates(0, y).tail<3>(), truth);
        BOOST_TEST_MESSAGE("rings of " << factor << ", " << off << " from 90 degrees: " << mine
                                       << ", by the full mass matrix "
                                       << error_of(full.solve({0, 0, 0}), truth));
        BOOST_TEST(mine < 1e-14);
      }
    }
  }
}

// A state with a reference angle has full accuracy of its sines near 90 degrees too.
BOOST_AUTO_TEST_CASE(does_not_depend_on_reference_angles) {
  const double reference = 1.5;
  const double rest = std::numbers::pi / 2 - reference + 1e-8;  // exact but for its last digit
  const Vector6 y = (Vector6() << 0.25, rest, 0.7, 0.4, -0.6, 50).finished();
  const CardanMoments m{unsymmetric.rotor, {0, 0, 0}, {0, 0, 0}};
  const CardanGyro gyro(m, {{0, 0, 0.125}, {0, 0, reference}}, Momentary{{.1, .2, .3}, {1, 2, 3}});
  Recursion<Exact> exact(m, y, {.1, .2, .3}, {1, 2, 3});
  exact.q[0] += 0.125;
  exact.q[1] += reference;
  const Vector3<double> truth = rounded(exact.solve(Recursion<Exact>::V::Zero()));
  BOOST_TEST(error_of(gyro.rates(0, y).tail<3>(), truth) < 1e-14);
}

// Near 90 degrees the cosine is nearly 0, near 180 degrees the sine. Their values then depend on
// digits below the last digit of the angle.
BOOST_AUTO_TEST_CASE(has_accurate_sines_near_right_angles) {
  using L = long double;
  constexpr double pi = std::numbers::pi;
  for (const double hidden : {1e-20, -3e-18, 1e-17}) {
    const auto half_turn = detail::sin_cos(pi, hidden);
    const auto quarter = detail::sin_cos(pi / 2, hidden);
    const L sine = std::sin(L(pi)) - L(hidden);
    const L cosine = std::cos(L(pi / 2)) - L(hidden);
    BOOST_TEST(std::abs(half_turn.sin / sine - 1) <= 4e-16L);
    BOOST_TEST(std::abs(quarter.cos / cosine - 1) <= 4e-16L);
    BOOST_TEST(half_turn.cos == -1);
    BOOST_TEST(quarter.sin == 1);
  }
  for (const double reference : {0.1, 0.3, 0.7, 1.1}) {  // the lesser of both
    const double deviation = pi - reference;
    const L sine = std::sin(L(reference) + L(deviation));
    BOOST_TEST(std::abs(detail::sin_cos(reference, deviation).sin / sine - 1) <= 4e-16L);
  }
}

BOOST_AUTO_TEST_CASE(rounds_moments_to_their_mean) {
  const CardanGyro round =
      CardanGyro(unsymmetric, {}, RestingFrame<>{}).without(RotorAsymmetry{}, 0, 1);
  const Vector3<double>& rotor = unsymmetric.rotor;
  const double mean = (rotor.x() + rotor.y()) / 2;
  BOOST_TEST((round.moments().rotor == Vector3<double>(mean, mean, rotor.z())));
  BOOST_TEST((round.moments().inner_ring == unsymmetric.inner_ring));
}

BOOST_AUTO_TEST_CASE(stops_at_a_singular_mass_matrix) {
  const Vector6 y = (Vector6() << 0.3, std::numbers::pi / 2, 0.7, 0.4, -0.6, 50).finished();
  const auto says = [](const char* words) {
    return [words](const ComputationFailed& e) {
      return std::string(e.what()).find(words) != std::string::npos;
    };
  };
  for (const CardanMoments& m : {symmetric, unsymmetric}) {
    const CardanGyro massless({m.rotor, {0, 0, 0}, {0, 0, 0}}, {}, RestingFrame<>{});
    BOOST_CHECK_EXCEPTION((void)massless.rates(0, y), ComputationFailed, says("outer ring"));
    BOOST_CHECK_EXCEPTION((void)massless.reactions(0, massless.from_vector(y)), ComputationFailed,
                          says("gimbal lock"));
    Vector6 near_it = y;
    near_it[1] += 1e-6;
    BOOST_TEST(massless.rates(0, near_it).allFinite());
    // A regulated rotor includes its own inertia, so that no such angle exists.
    BOOST_TEST(CardanGyro({m.rotor, {0, 0, 0}, {0, 0, 0}}, {}, RestingFrame<>{}, RegulatedRotor{})
                   .rates(0, y)
                   .allFinite());
  }
  // A rotor without B, at phi = 0, in an inner ring without mass.
  const CardanGyro needle({{1, 0, 1}, {0, 0, 0}, {1, 1, 1}}, {}, RestingFrame<>{});
  BOOST_CHECK_EXCEPTION((void)needle.rates(0, Vector6::Zero()), ComputationFailed,
                        says("inner ring"));
  // Rings with 1e4 times the rotor's mass do not amplify the rounding of a quarter turn.
  for (const CardanMoments& m : {symmetric, unsymmetric}) {
    const CardanGyro rod({m.rotor, {1e4, 1e4, 0}, {0, 0, 0}}, {}, RestingFrame<>{});
    BOOST_CHECK_EXCEPTION((void)rod.rates(0, y), ComputationFailed, says("gimbal lock"));
  }
  for (const CardanMoments& m : {CardanMoments{{0, 1, 1}, {1e4, 0, 1e4}, {1, 1, 1}},
                                 CardanMoments{{0, 1, 1}, {0, 0, 0}, {1e4, 1e4, 1e4}}}) {
    const CardanGyro needles(m, {}, RestingFrame<>{});
    BOOST_CHECK_EXCEPTION((void)needles.rates(0, Vector6::Unit(2) * std::acos(0.0)),
                          ComputationFailed, says("inner ring"));
    BOOST_TEST(needles.rates(0, Vector6::Unit(2)).allFinite());
  }
  // A trial state that is not finite does not stop a run if a shorter step succeeds.
  const CardanGyro gyro(symmetric, {}, RestingFrame<>{});
  BOOST_TEST(
      !gyro.rates(0, Vector6::Constant(std::numeric_limits<double>::infinity())).allFinite());
}

BOOST_AUTO_TEST_CASE(is_refused_with_impossible_moments) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const RestingFrame<> rest;
  const auto refuses = [&](const CardanMoments& m, const CardanBearings& b, const char* words) {
    BOOST_CHECK_EXCEPTION(CardanGyro(m, b, rest), InvalidInput, [&](const InvalidInput& e) {
      return std::string(e.what()).find(words) != std::string::npos;
    });
  };
  const auto& [rotor, inner, outer] = symmetric;
  refuses({{-1, 1, 1}, inner, outer}, {}, "rotor");
  refuses({{1, 1, 3}, inner, outer}, {}, "rotor: triangle inequality");
  refuses({{1, 1, nan}, inner, outer}, {}, "rotor");
  refuses({{1, 1, 0}, inner, outer}, {}, "C of the rotor");
  refuses({rotor, {1, 1, 3}, outer}, {}, "inner ring");
  refuses({rotor, inner, {1, -1, 1}}, {}, "outer ring");
  refuses({{0, 1, 1}}, {}, "singular at every angle");
  refuses(symmetric, {{-1, 0}, {}}, "outer bearing: stiffness = -1");
  refuses(symmetric, {{}, {0, nan}}, "inner bearing: damping");
  refuses(symmetric, {{}, {0, 0, nan}}, "reference");
  BOOST_CHECK_THROW(CardanGyro(symmetric, {}, rest, FreeRotor{-1}), InvalidInput);
  BOOST_CHECK_THROW(CardanGyro(symmetric, {}, rest, RegulatedRotor{nan}), InvalidInput);
  BOOST_CHECK_THROW(CardanGyro(symmetric, {}, rest, DrivenRotor{nan}), InvalidInput);
  // Legal limits: rings without mass, a rotor that is a disc, a needle in a ring.
  BOOST_CHECK_NO_THROW(CardanGyro({{1, 1, 2}}, {}, rest));
  BOOST_CHECK_NO_THROW(CardanGyro({{0, 1, 1}, inner}, {}, rest));
  BOOST_CHECK_NO_THROW(CardanGyro({{0, 1, 1}}, {}, rest, RegulatedRotor{}));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(invariants_of_a_cardan_gyro)

namespace {

/// The names of the invariants, and the greatest drift of any relative to its size.
template <class Gyro>
std::vector<std::string> kept(const Gyro& gyro, double t_end = 5) {
  const typename Gyro::State start{0.1, -0.2, 0.3, 0.5, -0.4, 60};
  const auto before = gyro.conserved(0, start);
  Integrator run(gyro, 0, start);
  std::vector<std::string> found;
  for (const auto& [name, value] : before) found.emplace_back(name);
  for (int i = 1; i <= 20; ++i) {
    const double t = t_end * i / 20;
    const auto now = gyro.conserved(t, run.to(t));
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double drift = std::abs(now[k].second / before[k].second - 1);
      BOOST_TEST(drift < 2e-13, found[k] << " drifts by " << drift);
    }
  }
  return found;
}

using Names = std::vector<std::string>;
const CardanBearings springs{{2, 0}, {1.5, 0}};
const CardanBearings brakes{{2, 0.002}, {1.5, 0.003}};
const RotatingFrame<> turntable{{0.3, -0.2, 0.5}};

}  // namespace

BOOST_AUTO_TEST_CASE(are_listed_for_each_kind) {
  const RestingFrame<> rest;
  const auto same = [](const Names& a, const Names& b) {
    BOOST_CHECK_EQUAL_COLLECTIONS(a.begin(), a.end(), b.begin(), b.end());
  };
  same(kept(CardanGyro(symmetric, {}, rest)), {"energy", "alpha momentum", "rotor momentum"});
  same(kept(CardanGyro(unsymmetric, {}, rest)), {"energy", "alpha momentum"});
  same(kept(CardanGyro(unsymmetric, springs, rest)), {"energy"});
  same(kept(CardanGyro(symmetric, springs, rest)), {"energy", "rotor momentum"});
  same(kept(CardanGyro(symmetric, brakes, rest)), {"rotor momentum"});
  same(kept(CardanGyro(symmetric, {}, rest, FreeRotor{0.001})), {"alpha momentum"});
  same(kept(CardanGyro(unsymmetric, {}, rest, DrivenRotor{0.01})), {"alpha momentum"});
  same(kept(CardanGyro(symmetric, springs, rest, RegulatedRotor{})), {"energy of rings"});
  same(kept(CardanGyro(unsymmetric, {}, rest, RegulatedRotor{})), {"alpha momentum"});
  same(kept(CardanGyro(symmetric, brakes, turntable)), {"rotor momentum"});
  same(kept(CardanGyro(unsymmetric, {}, turntable)), {"Jacobi integral"});
  same(kept(CardanGyro(symmetric, springs, turntable)), {"Jacobi integral", "rotor momentum"});
  same(kept(CardanGyro(unsymmetric, {}, turntable, RegulatedRotor{})), {});
}

// On any base. The momentum's rate in space has the values of the case. The kinetic energy's rate
// is the power of all torques, including the base's.
BOOST_AUTO_TEST_CASE(balance_momentum_and_energy_on_a_moving_base) {
  const HarmonicFrame<> base({{0.3, -0.2, 0.5}, {{{0.1, 0.2, -0.1}, 3, 0.4}}}, {}, 0, 2);
  const CardanGyro gyro(unsymmetric, brakes, base, RegulatedRotor{0.001});
  Integrator run(gyro, 0, {0.1, -0.2, 0.3, 0.5, -0.4, 60});
  const double h = 2.5e-4;
  for (int i = 1; i <= 5; ++i) {
    const double t = 0.3 * i;
    // Six points about t: the difference quotient errs by (120 h)^6/140 of the terms.
    std::array<CardanBalance, 7> at{};
    CardanReactions r{};
    Vector3<double> torque = Vector3<double>::Zero();
    double power = 0;
    for (int k = -3; k <= 3; ++k) {
      const auto s = run.to(t + k * h);
      at[static_cast<std::size_t>(k + 3)] = gyro.balance(t + k * h, s);
      if (k == 0) {
        r = gyro.reactions(t, s);
        torque = Eigen::AngleAxisd(s.alpha, Vector3<double>::UnitX()) * r.guide_on_outer_ring;
        const Vector3<double> u = base(t).V.value.resultant;
        power = torque.dot(u) + r.motor_power - 0.001 * s.phi_rate * s.phi_rate +
                r.guide_on_outer_ring.x() * s.alpha_rate -
                r.inner_ring_on_outer_ring.y() * s.beta_rate;
      }
    }
    const auto rate = [&](const auto& of) {
      using Value = decltype(of(at[0]));
      return Value(((of(at[6]) - of(at[0])) - 9.0 * (of(at[5]) - of(at[1])) +
                    45.0 * (of(at[4]) - of(at[2]))) /
                   (60 * h));
    };
    const Vector3<double> u = base(t).V.value.resultant;
    const Vector3<double> L = at[3].angular_momentum;
    const Vector3<double> dL =
        rate([](const CardanBalance& b) -> Vector3<double> { return b.angular_momentum; });
    BOOST_TEST((dL + u.cross(L) - torque).norm() < 1e-8 * torque.norm());
    const double dT = rate([](const CardanBalance& b) { return b.kinetic_energy; });
    BOOST_TEST(std::abs(dT - power) < 1e-8 * std::max(std::abs(power), 1.0));
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_cardan_gyro_in_other_numbers)

// Bodies, springs, friction, a drive and a base, each with all dependencies.
BOOST_AUTO_TEST_CASE(has_an_exact_jacobian) {
  const auto base = [](const auto& t) {
    using S = std::decay_t<decltype(t)>;
    FrameMotion<Guide, Inertial, S> motion;
    using std::cos, std::sin;
    motion.V.value.resultant = {S(0.3 + 0.1 * sin(S(3.0 * t))), S(0.2 * t), S(cos(t))};
    motion.dV.value.resultant = {S(0.3 * cos(S(3.0 * t))), S(0.2), S(-sin(t))};
    return motion;
  };
  const auto drive = [](const auto& t, const auto& rate) {
    using S = std::decay_t<decltype(t)>;
    return S(0.01 * t - 0.0001 * rate);
  };
  const CardanBearings b{{2, 0.002, 0.1}, {1.5, 0.003, -0.3}};
  const Vector6 y = (Vector6() << 0.1, -0.2, 0.3, 0.5, -0.4, 60).finished();
  const double t = 0.7;
  for (const CardanMoments& m : {symmetric, unsymmetric}) {
    const auto check = [&](const auto& gyro, bool regulated) {
      const auto exact = [&](const Exact& time, const Eigen::Matrix<Exact, 6, 1>& at) {
        Recursion<Exact> r(m, Vector6::Zero(), {0, 0, 0}, {0, 0, 0});
        r.q = at.head<3>();
        r.dq = at.tail<3>();
        r.u = base(time).V.value.resultant;
        r.du = base(time).dV.value.resultant;
        const Recursion<Exact>::V applied(-(b.outer.stiffness * at[0] + b.outer.damping * at[3]),
                                          -(b.inner.stiffness * at[1] + b.inner.damping * at[4]),
                                          Exact(drive(time, at[5])) - 0.0001 * at[5]);
        r.q[0] += b.outer.reference;
        r.q[1] += b.inner.reference;
        return r.solve(applied, regulated);
      };
      const auto jacobian = forward_jacobian<6>(
          [&](const auto& time, const auto& at) { return gyro.rates(time, at); });
      const Jacobian<6> mine = jacobian(t, y);
      const Exact h("1e-15");
      double worst = 0;
      for (int k = 0; k <= 6; ++k) {
        const auto at = [&](int sign) {
          Eigen::Matrix<Exact, 6, 1> shifted = y.cast<Exact>();
          Exact time(t);
          (k < 6 ? shifted[k] : time) += sign * h;
          return exact(time, shifted);
        };
        const Vector3<double> truth = rounded(Recursion<Exact>::V((at(1) - at(-1)) / Exact(2 * h)));
        const Vector3<double> column =
            k < 6 ? Vector3<double>(mine.of_state.col(k).tail<3>()) : mine.of_time.tail<3>();
        worst = test::worst_of(worst, (column - truth).norm() / std::max(truth.norm(), 1.0));
      }
      BOOST_TEST_MESSAGE("Jacobian: " << worst);
      BOOST_TEST(worst < 1e-13);
      BOOST_TEST(
          (mine.of_state.topRows<3>() ==
           (Eigen::Matrix<double, 3, 6>() << Matrix3<double>::Zero(), Matrix3<double>::Identity())
               .finished()));
    };
    check(CardanGyro(m, b, base, DrivenRotor{drive, 0.0001}), false);
    check(CardanGyro(m, b, base, RegulatedRotor{}), true);
  }
}

BOOST_AUTO_TEST_CASE(has_the_digits_of_long_double) {
  const CardanGyro gyro(unsymmetric, {}, RestingFrame<>{});
  const Vector6 y = (Vector6() << 0.1, -0.2, 0.3, 0.5, -0.4, 60).finished();
  const auto truth =
      Recursion<Exact>(unsymmetric, y, {0, 0, 0}, {0, 0, 0}).solve(Recursion<Exact>::V::Zero());
  const auto mine = gyro.rates(0, Eigen::Matrix<long double, 6, 1>(y.cast<long double>()));
  for (int k = 0; k < 3; ++k) {
    BOOST_TEST(static_cast<double>(abs(Exact(mine[k + 3]) - truth[k])) < 1e-15);
  }
}

// A guide of doubles gives ou, so that df/dt lacks only the rate of ou.
BOOST_AUTO_TEST_CASE(has_most_derivatives_on_a_guide_of_doubles) {
  const RotatingFrame<> turntable{{0.3, -0.2, 0.5}};
  const CardanGyro gyro(symmetric, {}, turntable);
  const auto jacobian =
      forward_jacobian<6>([&](const auto& t, const auto& y) { return gyro.rates(t, y); });
  const Vector6 y = (Vector6() << 0.1, -0.2, 0.3, 0.5, -0.4, 60).finished();
  BOOST_TEST(jacobian(0, y).of_time.isZero(0));
  const Momentary speeding{{0.3, -0.2, 0.5}, {1, 2, 3}};
  const CardanGyro other(symmetric, {}, speeding);
  const auto mine =
      forward_jacobian<6>([&](const auto& t, const auto& s) { return other.rates(t, s); })(0.7, y);
  const double h = 1e-6;
  const auto at = [&](double t) {
    return CardanGyro(symmetric, {}, Momentary{speeding.u + t * speeding.du, speeding.du})
        .rates(0, y);
  };
  const Vector6 difference = (at(h) - at(-h)) / (2 * h);
  BOOST_TEST((mine.of_time - difference).norm() < 1e-7 * difference.norm());
}

BOOST_AUTO_TEST_CASE(is_the_same_on_all_guides_at_rest) {
  const HarmonicFrame<> still({{0, 0, 0}, {{{0, 0, 0}, 3, 0}}}, {}, 0, 10);
  for (const CardanMoments& m : {symmetric, unsymmetric}) {
    const CardanGyro a(m, {}, RestingFrame<>{});
    const CardanGyro b(m, {}, still);
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      Sample sample(seed);
      const Vector6 y = state_at_random(sample);
      BOOST_TEST(test::same(a.rates(0, y), b.rates(0, y)));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
