#include <boost/test/unit_test.hpp>

#include <cmath>
#include <limits>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/step/splitting.hpp>

#include <support/near.hpp>
#include <support/wide.hpp>

using namespace kreisel;
using test::near;

namespace {

using Quaternion = Eigen::Quaterniond;
using Vector = Vector3<double>;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Weight on the body's z axis; EulerTop's weight_moment.
struct Gravity {
  double weight_moment;

  Vector operator()(double /*t*/, const Quaternion& q) const {
    const double k = 2 * weight_moment / q.squaredNorm();
    return {k * (q.y() * q.z() + q.w() * q.x()), -k * (q.x() * q.z() - q.w() * q.y()), 0};
  }
};

/// The angle between two attitudes.
double angle(const Quaternion& a, const Quaternion& b) {
  return 2 * (a.conjugate() * b).vec().norm() / (a.norm() * b.norm());
}

/// A heavy symmetric top, tilted by 0.5 rad and spinning, released at rest.
struct Top {
  double A = 3e-4;
  double C = 1e-4;
  double weight_moment = 0.049;
  double spin;
  double end = 10;

  Quaternion attitude{Eigen::AngleAxisd(0.5, Vector::UnitX())};

  [[nodiscard]] exact::TopMotion exact() const {
    return exact::LagrangeTop(A, C, weight_moment, {0, 0, spin}, attitude).at(end);
  }

  template <class Scheme>
  [[nodiscard]] auto steps(double step) const {
    return SplittingSteps<SymmetricFreeFlow, Gravity, Scheme>(
        SymmetricFreeFlow(A, C), Gravity{weight_moment}, 0, attitude, {0, 0, spin}, step);
  }
};

struct Work {
  double error;  ///< rad
  double evaluations;
};

template <class Scheme>
Work work(const char* name, const Top& top, double step) {
  auto steps = top.steps<Scheme>(step);
  steps.advance_to(top.end);
  const Work work{angle(steps.attitude(), top.exact().attitude), steps.effort().evaluations};
  BOOST_TEST_MESSAGE(name << ", " << top.spin << " rad/s, step " << step << " s: " << work.error
                          << " rad for " << work.evaluations << " torques");
  return work;
}

Work work_of_verner(const Top& top, double tolerance) {
  const EulerTop scene({top.A, top.A, top.C}, {0, 0, top.weight_moment});
  Integrator run(scene, 0, {top.attitude, {0, 0, top.spin}}, {.relative = tolerance});
  const Work work{angle(run.to(top.end).attitude, top.exact().attitude), run.effort().evaluations};
  BOOST_TEST_MESSAGE("Verner98, " << top.spin << " rad/s, tolerance " << tolerance << ": "
                                  << work.error << " rad for " << work.evaluations);
  return work;
}

template <class Scheme>
double order(const char* name, const Top& top, double step) {
  return std::log2(work<Scheme>(name, top, step).error / work<Scheme>(name, top, step / 2).error);
}

/// Three different moments, by the closed solution.
class AsymmetricFlow {
 public:
  struct State {
    Quaternion attitude;
    Vector angular_velocity;
  };

  explicit AsymmetricFlow(const Vector& moments) : moments_(moments) {}

  [[nodiscard]] State start(const Quaternion& q, const Vector& w) const { return {q, w}; }
  [[nodiscard]] Quaternion attitude(const State& s) const { return s.attitude; }
  [[nodiscard]] Vector angular_velocity(const State& s) const { return s.angular_velocity; }

  void drift(State& s, DoubleDouble time) const {
    const auto after =
        exact::FreeTop(moments_, s.angular_velocity, s.attitude).at(static_cast<double>(time));
    s = {after.attitude, after.angular_velocity};
  }

  void kick(State& s, const Vector& impulse) const {
    s.angular_velocity += impulse.cwiseQuotient(moments_);
  }

 private:
  Vector moments_;
};

}  // namespace

BOOST_AUTO_TEST_SUITE(splitting_coefficients)

/// sum of kicks times the `power` of the time of each.
template <class Scheme>
long double moment(int power) {
  long double sum = 0;
  long double time = 0;
  for (std::size_t i = 0; i < Scheme::kick.size(); ++i) {
    time += test::wide(Scheme::drift[i]);
    sum += test::wide(Scheme::kick[i]) * std::pow(time, power);
  }
  return sum;
}

// The first-order effect of a torque is its integral along the free motion. The kicks are a
// quadrature of it, of order 8 for the last two.
BOOST_AUTO_TEST_CASE(integrate_powers_of_time) {
  for (int power = 0; power < 8; ++power) {
    const long double exact = 1.0L / (power + 1);
    if (power < 2) BOOST_TEST(near(moment<Strang>(power), exact, 1.0L, 1));
    BOOST_TEST(near(moment<Blanes864>(power), exact, 1.0L, 8));
    BOOST_TEST(near(moment<KahanLi8>(power), exact, 1.0L, 16));
  }
}

// Conditions of order 8 for a symmetric composition, as far as they concern single steps.
BOOST_AUTO_TEST_CASE(cancel_odd_powers_of_the_steps) {
  for (const int power : {3, 5, 7}) {
    long double sum = 0;
    for (const DoubleDouble& c : KahanLi8::kick) sum += std::pow(test::wide(c), power);
    BOOST_TEST(near(sum, 0.0L, 1.0L, 8));
  }
}

BOOST_AUTO_TEST_CASE(are_symmetric) {
  for (std::size_t i = 0; i < 8; ++i) BOOST_TEST(Blanes864::drift[i] == Blanes864::drift[7 - i]);
  for (std::size_t i = 0; i < 7; ++i) BOOST_TEST(Blanes864::kick[i] == Blanes864::kick[6 - i]);
  for (std::size_t i = 0; i < 17; ++i) BOOST_TEST(KahanLi8::kick[i] == KahanLi8::kick[16 - i]);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(splitting_steps)

BOOST_AUTO_TEST_CASE(converge_with_their_order) {
  const Top slow{.spin = 3};
  BOOST_TEST(std::abs(order<Strang>("Strang", slow, 1e-3) - 2) < 0.05);
  BOOST_TEST(std::abs(order<Blanes864>("Blanes864", slow, 8e-3) - 4) < 0.1);
  BOOST_TEST(std::abs(order<KahanLi8>("KahanLi8", slow, 0.016) - 8) < 0.3);
  // For a fast top e is so small that only e^2 h^6 is visible.
  BOOST_TEST(std::abs(order<Blanes864>("Blanes864", {.spin = 3000}, 2e-3) - 6) < 0.2);
}

// To the last digits after 30000 rad of spin.
BOOST_AUTO_TEST_CASE(are_better_than_explicit_on_fast_tops) {
  const Top fast{.spin = 3000};
  const Work coarse = work<Strang>("Strang", fast, 2e-3);
  const Work blanes = work<Blanes864>("Blanes864", fast, 1e-3);
  const Work kahan_li = work<KahanLi8>("KahanLi8", fast, 5e-4);
  const Work loose = work_of_verner(fast, 1e-4);
  const Work tight = work_of_verner(fast, 1e-10);
  BOOST_TEST(coarse.error < 1e-4);
  BOOST_TEST(blanes.error < 3e-10);
  BOOST_TEST(kahan_li.error < 5e-14);
  BOOST_TEST((coarse.error < loose.error && 20 * coarse.evaluations < loose.evaluations));
  BOOST_TEST((blanes.error < tight.error && 8 * blanes.evaluations < tight.evaluations));
}

BOOST_AUTO_TEST_CASE(turn_a_free_body_exactly_in_one_step) {
  const Quaternion start(0.3, -0.2, 0.9, 0.1);
  for (const auto& [A, C] : {std::pair{3e-4, 1e-4}, {1e-4, 1.9e-4}, {1e-4, 1e-4}}) {
    for (const Vector& w :
         {Vector(3, -2, 500), Vector(3, 2, 0), Vector(0, 0, -7), Vector(0, 0, 0)}) {
      SplittingSteps steps(SymmetricFreeFlow(A, C), Gravity{0}, 0, start, w, 10);
      steps.advance_to(10);
      const exact::TopMotion exact = exact::FreeTop({A, A, C}, w, start).at(10);
      BOOST_TEST(angle(steps.attitude(), exact.attitude) < 5e-15);
      BOOST_TEST((steps.angular_velocity() - exact.angular_velocity).norm() <= 1e-15 * w.norm());
      BOOST_TEST(near(steps.attitude().norm(), start.norm(), 1.0, 4));
    }
  }
}

BOOST_AUTO_TEST_CASE(accept_a_flow_of_the_user) {
  const Vector moments(3e-4, 2.5e-4, 1e-4);
  const Top top{.spin = 300, .end = 1};
  SplittingSteps<AsymmetricFlow, Gravity, KahanLi8> steps(AsymmetricFlow(moments), Gravity{0.049},
                                                          0, top.attitude, {1, 2, 300}, 2.5e-3);
  steps.advance_to(1);
  const EulerTop scene(moments, {0, 0, 0.049});
  Integrator run(scene, 0, {top.attitude, {1, 2, 300}}, {.relative = 1e-15});
  const double error = angle(steps.attitude(), run.to(1).attitude);
  BOOST_TEST_MESSAGE("asymmetric: " << error << " rad for " << steps.effort().evaluations
                                    << " torques, Verner98 " << run.effort().evaluations);
  BOOST_TEST(error < 1e-11);
}

// About the axis alone:  C w' = cos t.
BOOST_AUTO_TEST_CASE(take_time_into_account) {
  const auto torque = [](double t, const Quaternion&) { return Vector(0, 0, std::cos(t)); };
  SplittingSteps<SymmetricFreeFlow, decltype(torque), KahanLi8> steps(
      SymmetricFreeFlow(1, 0.5), torque, 0, Quaternion::Identity(), {0, 0, 1}, 0.1);
  for (int i = 1; i <= 30; ++i) steps.advance_to(0.1 * i);
  const double end = steps.t();
  BOOST_TEST(near(steps.angular_velocity().z(), 1 + 2 * std::sin(end), 1.0, 100));
  const double turned = end + 2 * (1 - std::cos(end));
  BOOST_TEST(angle(steps.attitude(), Quaternion(Eigen::AngleAxisd(turned, Vector::UnitZ()))) <
             1e-14);
  BOOST_TEST(steps.effort().steps == 30);
}

BOOST_AUTO_TEST_CASE(go_there_and_back) {
  const Top top{.spin = 300};
  auto steps = top.steps<Blanes864>(4e-3);
  steps.advance_to(10);
  steps.advance_to(0);
  BOOST_TEST(angle(steps.attitude(), top.attitude) < 1e-13);
  BOOST_TEST((steps.angular_velocity() - Vector(0, 0, 300)).norm() < 1e-13);
  BOOST_TEST(steps.angular_velocity().z() == 300);
}

BOOST_AUTO_TEST_CASE(keep_the_last_state_if_the_torque_fails) {
  const Top top{.spin = 300, .end = 1};
  const auto ends = [](double t, const Quaternion& q) {
    return t > 1 ? Vector(not_a_number, 0, 0) : Gravity{0.049}(t, q);
  };
  SplittingSteps<SymmetricFreeFlow, decltype(ends), KahanLi8> steps(
      SymmetricFreeFlow(top.A, top.C), ends, 0, top.attitude, {0, 0, 300}, 0x1p-9);
  BOOST_CHECK_EXCEPTION(steps.advance_to(2), ComputationFailed, [](const ComputationFailed& e) {
    return std::string(e.what()).find("integration stopped at t = ") == 0;
  });
  // One of the kicks of a step comes after its end.
  BOOST_TEST(std::abs(steps.t() - 1) <= 0x1p-9);
  const auto exact =
      exact::LagrangeTop(top.A, top.C, 0.049, {0, 0, 300}, top.attitude).at(steps.t());
  BOOST_TEST(angle(steps.attitude(), exact.attitude) < 1e-11);
}

BOOST_AUTO_TEST_CASE(give_up_at_the_limit) {
  const Top top{.spin = 300};
  for (const double evaluations : {0.0, 700.0}) {
    auto steps = top.steps<Blanes864>(1e-3);
    steps.give_up_after(evaluations);
    steps.advance_to(0);
    BOOST_TEST(steps.effort().evaluations == 0);
    BOOST_CHECK_THROW(steps.advance_to(10), ComputationFailed);
    BOOST_TEST(steps.effort().evaluations <= evaluations + 7);
    const Top stopped{.spin = 300, .end = steps.t()};
    BOOST_TEST((steps.t() > 0));
    BOOST_TEST(angle(steps.attitude(), stopped.exact().attitude) < 1e-8);
  }
}

BOOST_AUTO_TEST_CASE(become_shorter_on_request) {
  const Top top{.spin = 300};
  auto steps = top.steps<Blanes864>(4e-3);
  steps.advance_to(0.4);
  BOOST_TEST(steps.effort().steps == 100);
  steps.take_steps_of(2e-3);
  steps.advance_to(0.8);
  BOOST_TEST(steps.effort().steps == 300);
  BOOST_CHECK_THROW(steps.take_steps_of(0), InvalidInput);
}

BOOST_AUTO_TEST_CASE(refuse_invalid_steps) {
  const auto with = [](double t, double q, double w, double step) {
    return SplittingSteps(SymmetricFreeFlow(2, 1), Gravity{1}, t, Quaternion(q, 0, 0, 0), {0, 0, w},
                          step);
  };
  BOOST_CHECK_THROW(with(not_a_number, 1, 1, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, 0, 1, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, not_a_number, 1, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, not_a_number, 0.1), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 1, 0), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 1, 0.1).advance_to(not_a_number), InvalidInput);
  BOOST_CHECK_THROW(with(0, 1, 1, 1e-300).advance_to(1), ComputationFailed);
  BOOST_CHECK_THROW(SymmetricFreeFlow(0, 0), InvalidInput);
  BOOST_CHECK_THROW(SymmetricFreeFlow(1, 2.1), InvalidInput);
  BOOST_CHECK_THROW(SymmetricFreeFlow(not_a_number, 1), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()
