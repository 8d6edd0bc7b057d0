#include <boost/numeric/odeint.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/earth.hpp>
#include <dynamics/pendulum/pendulum_cases.hpp>
#include <dynamics/pendulum/pendulum_deviation.hpp>

#include <support/worst.hpp>

using namespace kreisel;
using namespace kreisel::test::pendulum;
using test::Sample;
namespace data = boost::unit_test::data;

namespace {

/// The worst digits of each column, printed at the end.
struct Column {
  double worst_relative = 0;
  double worst_ratio = 0;
  double ratio_sum = 0;
  int count = 0;
};

struct Report {
  std::map<std::string, Column> columns;

  void note(const std::string& name, const Exact& value, const Exact& truth,
            const Exact& estimate) {
    Column& column = columns[name];
    const double error = abs(Exact(value - truth)).convert_to<double>();
    if (truth != 0) {
      column.worst_relative =
          test::worst_of(column.worst_relative, error / std::abs(truth.convert_to<double>()));
    }
    const double ratio = error == 0 ? 0 : error / estimate.convert_to<double>();
    column.worst_ratio = test::worst_of(column.worst_ratio, ratio);
    column.ratio_sum += ratio;
    ++column.count;
  }

  ~Report() {
    std::cout << "column                  cases   digits   error/estimate: mean   worst\n";
    for (const auto& [name, c] : columns) {
      std::cout << std::left << std::setw(24) << name << std::right << std::setw(5) << c.count
                << std::fixed << std::setprecision(2) << std::setw(9)
                << (c.worst_relative == 0 ? 99 : -std::log10(c.worst_relative)) << std::setw(23)
                << c.ratio_sum / c.count << std::setw(8) << c.worst_ratio << '\n';
    }
  }
};

struct WithReport {
  static Report& report() {
    static Report all;
    return all;
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(reference)

BOOST_DATA_TEST_CASE(coefficients_have_fifteen_digits, data::xrange(cases().size()), index) {
  const Json& c = cases()[index];
  const Given<double> in = given<double>(c);
  const double size_u = in.site.rotation_rate;
  for (int i = 0; i < 3; ++i) {
    const Exact truth = number(c.at("u_xyz").at(static_cast<std::size_t>(i)));
    // 2 of each sine, 2 products, and half a degree's rounding each of two angles: 90 pi/180 u.
    BOOST_TEST(near(in.guide.angular_velocity[i], truth, size_u, 8));
    WithReport::report().note("u_xyz", in.guide.angular_velocity[i], truth, 5 * u * size_u);
  }
  // Each term: 2 components of u (5u), two products, an input (1u); the sums.
  const PendulumCoefficients<double> k = coefficients(in.body, in.guide);
  const PendulumBody<double>& b = in.body;
  const double in_plane =
      size_u * size_u * (std::abs(b.theta_a) + std::abs(b.theta_b) + 2 * std::abs(b.phi_c));
  const double across = size_u * size_u * (std::abs(b.phi_a) + std::abs(b.phi_b));
  const auto column = [&](const char* name, double value, double scale) {
    BOOST_TEST(near(value, number(c.at(name)), scale, 8), name);
    WithReport::report().note(name, value, number(c.at(name)), 8 * u * scale);
  };
  column("E", k.e(), k.weight + across);
  column("F", k.f, across);
  column("H", k.h, in_plane);
  column("K", k.k, in_plane);
}

BOOST_DATA_TEST_CASE(every_column_has_twelve_digits, data::xrange(cases().size()), index) {
  const Json& c = cases()[index];
  BOOST_TEST_CONTEXT(c.at("name").get<std::string>()) {
    const Given<double> in = given<double>(c);
    const auto answer = deviation(in.body, in.guide, 0.1);
    const auto digits = [&](const char* name, double value, const Exact& truth) {
      BOOST_TEST(near(value, truth, truth, 1e-12 / u), name);
      WithReport::report().note(name, value, truth, 1);
    };
    digits("phi0 (24)", answer.equilibrium.formula_24.value, number(c.at("phi0_eq24_rad")));
    digits("phi0 linear", answer.equilibrium.linear->value, number(c.at("phi0_linear_rad")));
    digits("phi0 exact", answer.equilibrium.exact.value, number(c.at("phi0_exact_rad")));
    digits("phi0 exact, arcsec", answer.equilibrium.exact.value * (180 * 3600 / std::acos(-1.0)),
           number(c.at("phi0_exact_arcsec")));
    digits("T00", answer.period.simple.value, number(c.at("T00_s")));
    digits("z (25)", answer.period.relative_change_formula_25.value,
           number(c.at("eq25_corrected_relative_term")));
    digits("T (25)",
           answer.period.simple.value * (1 + answer.period.relative_change_formula_25.value),
           number(c.at("T_eq25_corrected_s")));
    BOOST_TEST(answer.period.linear.has_value() == !c.at("T_linear_s").is_null());
    if (answer.period.linear) {
      digits("T linear", answer.period.linear->value, number(c.at("T_linear_s")));
    }
    digits("T small", answer.period.exact_small->value, number(c.at("T_small_exact_s")));
    digits("T small/T00 - 1", answer.period.relative_change_exact->value,
           number(c.at("T_small_exact_rel_to_T00_minus_1")));
    const Json& finite = c.at("finite_amplitude");
    digits("T at amplitude", answer.period.at_amplitude->value, number(finite.at("period_s")));
    digits("other turning point", answer.other_turning_point->value,
           number(finite.at("other_turning_point_rad")));
    if (c.contains("large_amplitude")) {
      const Json& large = c.at("large_amplitude");
      const auto swing = deviation(in.body, in.guide, 1.2);
      digits("T at 1.2", swing.period.at_amplitude->value, number(large.at("period_s")));
      digits("other turning at 1.2", swing.other_turning_point->value,
             number(large.at("other_turning_point_rad")));
    }
  }
}

BOOST_DATA_TEST_CASE(every_equilibrium_is_found, data::xrange(cases().size()), index) {
  const Json& c = cases()[index];
  const Given<double> in = given<double>(c);
  const auto found = equilibria(coefficients(in.body, in.guide));
  std::vector<std::pair<Exact, bool>> expected;
  for (const Json& e : c.at("equilibria_rad")) {
    Exact angle = number(e.at("phi"));
    if (angle < -3.14159265358979323846) angle = -angle;  // the file counts [-pi, pi)
    expected.emplace_back(angle, e.at("stable").get<bool>());
  }
  std::sort(expected.begin(), expected.end());
  BOOST_TEST_REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    BOOST_TEST(near(found[i].angle, expected[i].first, expected[i].first, 1e-13 / u));
    BOOST_TEST(found[i].stable == expected[i].second);
    BOOST_TEST(!found[i].degenerate);
    WithReport::report().note("equilibria", found[i].angle, expected[i].first, 1);
  }
}

// The scene does not depend on an integrator: any stepper accepts its field.
BOOST_DATA_TEST_CASE(trajectory_agrees_with_the_reference, data::xrange(cases().size()), index) {
  namespace odeint = boost::numeric::odeint;
  using Real = long double;
  using State = std::vector<Real>;
  const Json& c = cases()[index];
  const Given<Real> in = given<Real>(c);
  const PendulumField<Real> field(in.body, in.guide);
  const auto system = [&](const State& x, State& dx, Real t) {
    const PendulumState<Real> rate = field(t, PendulumState<Real>(x[0], x[1]));
    dx = {rate[0], rate[1]};
  };
  const Json& t = c.at("trajectory");
  State state{decimal<Real>(t.at("phi0")), decimal<Real>(t.at("phidot0"))};
  odeint::integrate_adaptive(
      odeint::make_controlled<odeint::runge_kutta_fehlberg78<State, Real>>(1e-18L, 1e-18L), system,
      state, Real(0), decimal<Real>(t.at("t")), Real(0.01));
  BOOST_TEST(near(state[0], number(t.at("phi")), 1, 4));
  BOOST_TEST(near(state[1], number(t.at("phidot")), 10, 4));
  WithReport::report().note("trajectory phi (80 bit)", state[0], number(t.at("phi")), 4 * u);
  WithReport::report().note("trajectory phi. (80 bit)", state[1], number(t.at("phidot")), 40 * u);
}

BOOST_AUTO_TEST_CASE(the_papers_pendulum) {
  EarthSite<double> site{.latitude = 45, .azimuth = 90};
  const auto body = PendulumBody<double>::from_reduced_length(0.5);
  const auto answer = deviation(body, pendulum_guide(earth_guide(site, 9.81)));
  BOOST_TEST(near(answer.equilibrium.exact.value, Exact("1.355120825005733944908506e-10"),
                  Exact("1.355e-10"), 6));
  // Changes of period that the first order of (25) does not contain: -3.2e-20.
  BOOST_TEST(near(answer.period.relative_change_exact->value,
                  Exact("-3.213616788137386752216753e-20"), Exact("3.2e-20"), 12));
  BOOST_TEST(answer.period.relative_change_formula_25.value == 0);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(closed_forms)

// Anchor: east-west axis in the north: u_x < 0, u_y > 0, the lower end swings to y, which is north.
BOOST_AUTO_TEST_CASE(lower_end_swings_north_in_the_north) {
  const auto body = PendulumBody<double>::thin_rod(0.75);
  const auto at = [&](double latitude) {
    const EarthSite<double> site{.latitude = latitude, .azimuth = 90};
    return formula_24(body, pendulum_guide(earth_guide(site, 9.81)));
  };
  BOOST_TEST(at(45) > 0);
  BOOST_TEST(at(-45) < 0);
  BOOST_TEST(at(0) == 0);
  BOOST_TEST(at(90) == 0);
}

BOOST_DATA_TEST_CASE(guide_form_equals_the_latitude_form, data::xrange(50u), seed) {
  Sample sample(seed);
  const EarthSite<double> site{.latitude = sample.uniform(-90, 90),
                               .azimuth = sample.uniform(-360, 360)};
  const auto body = PendulumBody<double>::thin_rod(sample.uniform(0.1, 3), sample.uniform(0.1, 9));
  const PendulumGuide<double> guide = pendulum_guide(earth_guide(site, 9.81));
  const auto [sin_t, cos_t] = sine_cosine_degrees(site.latitude);
  const auto [sin_2t, cos_2t] = sine_cosine_degrees(2 * site.latitude);
  const auto [sin_a, cos_a] = sine_cosine_degrees(site.azimuth);
  const double factor = (body.theta_b - body.theta_a) * site.rotation_rate * site.rotation_rate /
                        (2 * body.mass * body.arm * 9.81);
  BOOST_TEST(near(formula_24(body, guide), factor * sin_2t * sin_a, factor, 16));
  BOOST_TEST(near(formula_25(body, guide), factor * (sin_t * sin_t - cos_t * cos_t * sin_a * sin_a),
                  factor, 16));
}

BOOST_AUTO_TEST_CASE(rod_of_reduced_length) {
  const auto body = PendulumBody<double>::from_reduced_length(0.5, 2.0);
  BOOST_TEST(body.theta_c / (body.mass * body.arm) == 0.5);
  BOOST_TEST(body.arm == 0.375);
  BOOST_TEST(body.theta_b == 0.375);
  BOOST_TEST(body.theta_a == 0);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(estimate)

// Inputs are decimals; the estimate of the double answer includes their rounding.
BOOST_DATA_TEST_CASE(is_never_exceeded, data::xrange(cases().size()), index) {
  const Json& c = cases()[index];
  BOOST_TEST_CONTEXT(c.at("name").get<std::string>()) {
    const Given<long double> in = given<long double>(c);
    const auto answer = deviation(in.body, in.guide, 0.1L);
    const auto honest = [&](const char* name, const Estimated<double>& number_,
                            const Exact& truth) {
      BOOST_TEST(abs(Exact(number_.value) - truth) <= Exact(number_.error), name);
      WithReport::report().note(std::string("estimate: ") + name, number_.value, truth,
                                number_.error);
    };
    const Exact phi_0 = number(c.at("phi0_exact_rad"));
    const Exact small = number(c.at("T_small_exact_s"));
    const Exact change = number(c.at("T_small_exact_rel_to_T00_minus_1"));
    honest("equilibrium", answer.equilibrium.exact, phi_0);
    honest("formula 24", answer.equilibrium.formula_24, phi_0);
    honest("linear", *answer.equilibrium.linear, phi_0);
    honest("simple", answer.period.simple, small);
    honest("formula 25", answer.period.relative_change_formula_25, change);
    if (answer.period.linear) honest("linear period", *answer.period.linear, small);
    honest("small", *answer.period.exact_small, small);
    honest("change", *answer.period.relative_change_exact, change);
    honest("amplitude", *answer.period.at_amplitude,
           number(c.at("finite_amplitude").at("period_s")));
    honest("turning", *answer.other_turning_point,
           number(c.at("finite_amplitude").at("other_turning_point_rad")));
    // but not arbitrarily large
    BOOST_TEST(answer.equilibrium.exact.error <= 32 * u * abs(phi_0).convert_to<double>());
    BOOST_TEST(answer.period.exact_small->error <= 16 * u * small.convert_to<double>());
    BOOST_TEST(answer.period.at_amplitude->error <= 32 * u * small.convert_to<double>());
    BOOST_TEST(answer.other_turning_point->error <=
               32 * u * (0.1 + abs(phi_0).convert_to<double>()));
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(against_fifty_digits)

// An independent version of (23): plain sums, Newton, and differences of the potential in 50
// digits.
struct Plain {
  Exact e, f, h, k;

  explicit Plain(const PendulumBody<Exact>& b, const PendulumGuide<Exact>& guide) {
    const Vector3<Exact>& w = guide.angular_velocity;
    const Vector3<Exact>& g = guide.effective_gravity;
    e = b.mass * b.arm * g.x() - b.phi_a * w.z() * w.y() - b.phi_b * w.z() * w.x();
    f = -b.mass * b.arm * g.y() - b.phi_a * w.z() * w.x() + b.phi_b * w.z() * w.y();
    h = b.phi_c * (w.y() * w.y() - w.x() * w.x()) + (b.theta_b - b.theta_a) * w.x() * w.y();
    k = -2 * b.phi_c * w.x() * w.y() +
        (b.theta_a - b.theta_b) * (w.x() * w.x() - w.y() * w.y()) / 2;
  }
  Exact moment(const Exact& p) const {
    return e * sin(p) + f * cos(p) + h * cos(2 * p) + k * sin(2 * p);
  }
  Exact stiffness(const Exact& p) const {
    return e * cos(p) - f * sin(p) - 2 * h * sin(2 * p) + 2 * k * cos(2 * p);
  }
  Exact potential(const Exact& p) const {
    return -e * cos(p) + f * sin(p) + h * sin(2 * p) / 2 - k * cos(2 * p) / 2;
  }
  Exact root(Exact p) const {
    for (int i = 0; i < 8; ++i) p -= moment(p) / stiffness(p);
    return p;
  }
  Exact other_turning_point(const Exact& release, Exact p) const {
    for (int i = 0; i < 8; ++i) p -= (potential(p) - potential(release)) / moment(p);
    return p;
  }
  Exact period(const Exact& theta_c, const Exact& release, const Exact& other) const {
    const Exact c = (release + other) / 2;
    const Exact r = abs(Exact(release - other)) / 2;
    const Exact pi = acos(Exact(-1));
    constexpr int n = 192;
    Exact sum = 0;
    for (int i = 0; i < n; ++i) {
      const Exact s = pi * (2 * i + 1 - n) / (2 * n);
      sum +=
          r * cos(s) / sqrt(Exact(2 * (potential(release) - potential(c + r * sin(s))) / theta_c));
    }
    return 2 * pi * sum / n;
  }
};

// Bodies with all products of inertia, g' off the x axis, u from the earth's to 5 rad/s.
BOOST_DATA_TEST_CASE(twelve_digits_for_random_pendulums, data::xrange(200u), seed) {
  Sample sample(seed);
  const PendulumBody<double> body = body_of(random_points(sample)).cast<double>();
  const double size = std::pow(10.0, sample.uniform(-4, 0)) * 5;
  PendulumGuide<double> guide;
  for (int i = 0; i < 3; ++i) guide.angular_velocity[i] = sample.uniform(-size, size);
  const double tilt = (sample.once_in(2) ? size * size / 25 : 0);
  guide.effective_gravity = {9.81, tilt * sample.uniform(-1, 1), tilt * sample.uniform(-1, 1)};
  const double amplitude = sample.once_in(2) ? 1e-9 : 0.3;

  const auto answer = deviation(body, guide, amplitude);
  const PendulumBody<Exact> b = body.cast<Exact>();
  const PendulumGuide<Exact> g = guide.cast<Exact>();
  const Plain plain(b, g);
  const Exact phi_0 = plain.root(answer.equilibrium.exact.value);
  const Exact stiffness = plain.stiffness(phi_0);
  // Conditions: phi_0 ~ the constant terms over the stiffness; T ~ the coefficients over the
  // stiffness.
  const double constant =
      std::abs(answer.parts.tilt.f) + size * size *
                                          (std::abs(body.phi_a) + std::abs(body.phi_b) +
                                           2 * std::abs(body.phi_c) + body.theta_b + body.theta_a);
  const Exact total_ = abs(plain.e) + abs(plain.f) + 2 * abs(plain.h) + 2 * abs(plain.k);
  const Exact condition = total_ / stiffness;
  BOOST_TEST_REQUIRE(condition < 1000);
  BOOST_TEST(near(answer.equilibrium.exact.value, phi_0, constant / stiffness, 16));
  const Exact pi = acos(Exact(-1));
  const Exact small = 2 * pi * sqrt(Exact(b.theta_c / stiffness));
  BOOST_TEST(near(answer.period.exact_small->value, small, small * condition, 16));
  const Exact weight = b.mass * b.arm * g.effective_gravity.norm();
  const Exact change = sqrt(Exact(weight / stiffness)) - 1;
  // The change is a sum of terms of the size of u^2 and of the square of the tilt.
  const Exact terms = constant / weight * sqrt(Exact(weight / stiffness)) * condition;
  BOOST_TEST(near(answer.period.relative_change_exact->value, change, terms, 16));
  const Exact release = phi_0 + amplitude;
  const Exact other = plain.other_turning_point(release, answer.other_turning_point->value);
  BOOST_TEST(near(answer.other_turning_point->value, other,
                  (abs(phi_0) + amplitude + constant / stiffness) * condition, 16));
  if (amplitude > 1e-3) {  // the plain difference of potentials needs twice the digits below
    const Exact period = plain.period(b.theta_c, release, other);
    BOOST_TEST(near(answer.period.at_amplitude->value, period, period * condition, 16));
    WithReport::report().note("random: T at amplitude", answer.period.at_amplitude->value, period,
                              answer.period.at_amplitude->error);
  } else {
    BOOST_TEST(near(answer.period.at_amplitude->value, small, small * condition, 16));
  }
  // The estimates, all inputs being doubles.
  const auto honest = [](const char* name, const Estimated<double>& x, const Exact& truth) {
    BOOST_TEST(abs(Exact(x.value) - truth) <= Exact(x.error), name);
    WithReport::report().note(std::string("random: ") + name, x.value, truth, x.error);
  };
  honest("equilibrium", answer.equilibrium.exact, phi_0);
  honest("small period", *answer.period.exact_small, small);
  honest("change", *answer.period.relative_change_exact, change);
  honest("turning point", *answer.other_turning_point, other);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gravity_gradient)

const PendulumBody<double> rod_of_paper = PendulumBody<double>::from_reduced_length(0.5);

// 1.5 GM/R^3 (Theta_B - Theta_A) in K: 870 times the rotation's 1.36e-10.
BOOST_AUTO_TEST_CASE(round_earth_shortens_the_period_by_1e_7) {
  const EarthSite<double> site{.latitude = 0, .azimuth = 0};
  const auto earth = earth_guide(site, 9.81);
  const auto with = deviation(rod_of_paper, pendulum_guide(earth, GravityGradient::taken_in));
  const double rate2 = 3.986004418e14 / std::pow(6371008.8, 3);
  BOOST_TEST(near(with.parts.gravity_gradient.k, 1.5 * rate2 * rod_of_paper.theta_b,
                  rate2 * rod_of_paper.theta_b, 16));
  const double expected = -1.5 * rate2 * rod_of_paper.theta_b / with.coefficients.weight;
  BOOST_TEST(near(with.period.relative_change_exact->value, expected, expected,
                  std::abs(1.6 * expected) / u));  // second order: 3x^2/8 with x = -2 expected
  BOOST_TEST(std::abs(with.period.relative_change_exact->value + 1.18e-7) < 0.01e-7);
  const auto without = deviation(rod_of_paper, pendulum_guide(earth));
  BOOST_TEST(without.parts.gravity_gradient.k == 0);
  BOOST_TEST(without.period.relative_change_exact->value == 0);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(refused)

const PendulumGuide<double> hanging{{0, 0, 0}, {0, 0, 0}, {9.81, 0, 0}, {}};

std::string refusal(const PendulumBody<double>& body,
                    const PendulumGuide<double>& guide = hanging) {
  return message_of([&] { (void)deviation(body, guide, 0.1); });
}

BOOST_AUTO_TEST_CASE(impossible_bodies) {
  const PendulumBody<double> good = PendulumBody<double>::thin_rod(0.75);
  BOOST_TEST(refusal(good) == "nothing was thrown");
  PendulumBody<double> body = good;
  body.mass = -1;
  BOOST_TEST(refusal(body) == "mass = -1 kg must be a finite number above 0");
  body = good;
  body.arm = 0;
  BOOST_TEST(refusal(body) == "arm = 0 m must be a finite number above 0");
  body = good;
  body.theta_c = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(refusal(body) == "theta_c = nan kg m^2 must be a finite number above 0");
  body = good;
  body.theta_b = std::numeric_limits<double>::infinity();
  BOOST_TEST(refusal(body) != "nothing was thrown");
  body = good;
  body.theta_a = 0.3;
  BOOST_TEST(refusal(body).find("triangle inequality") != std::string::npos);
  body = good;
  body.theta_b = 0.1;  // below m a^2 = 0.140625
  BOOST_TEST(refusal(body).find("principal moments about the centre of mass >= 0") !=
             std::string::npos);
  body = good;
  body.phi_c = 0.01;  // a needle has none
  BOOST_TEST(refusal(body) != "nothing was thrown");
  body = good;
  body.theta_b *= 1 + 1e-14;  // rounding is forgiven
  BOOST_TEST(refusal(body) == "nothing was thrown");
}

BOOST_AUTO_TEST_CASE(guides_without_a_rest) {
  const auto good = PendulumBody<double>::thin_rod(0.75);
  PendulumGuide<double> guide = hanging;
  guide.angular_acceleration = {0, 0, 1e-9};
  BOOST_TEST(refusal(good, guide).starts_with("guide: angular_acceleration must be 0"));
  guide = hanging;
  guide.effective_gravity.setZero();
  BOOST_TEST(refusal(good, guide) == "guide: effective_gravity must not be 0");
  guide = hanging;
  guide.angular_velocity.x() = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST(refusal(good, guide).find("must be finite") != std::string::npos);
  guide = hanging;
  guide.effective_gravity.y() = std::numeric_limits<double>::infinity();
  BOOST_TEST(refusal(good, guide).find("must be finite") != std::string::npos);
  guide = hanging;
  guide.gravity_gradient = Matrix3<double>::Constant(std::numeric_limits<double>::quiet_NaN());
  BOOST_TEST(refusal(good, guide).find("must be finite") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(amplitudes_beyond_the_top) {
  const auto rod = PendulumBody<double>::thin_rod(0.75);
  for (const double amplitude : {4.0, -4.0, std::nan("")}) {
    BOOST_TEST(
        message_of([&] { (void)deviation(rod, hanging, amplitude); }).starts_with("amplitude = "));
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(terms)

std::string listed(const std::vector<PendulumTerm<double>>& terms) {
  std::string all;
  for (const auto& term : terms) all += term.name + ": " + term.reason + "\n";
  return all;
}

BOOST_AUTO_TEST_CASE(papers_pendulum) {
  const Given<double> in = given<double>(cases().front());
  const auto answer = deviation(in.body, in.guide);
  BOOST_TEST_REQUIRE(answer.terms_kept.size() == 2u);
  BOOST_TEST(answer.terms_kept[0].name == "E: weight");
  BOOST_TEST(answer.terms_kept[0].size == 1);
  BOOST_TEST(answer.terms_kept[1].name == "H: centrifugal");
  BOOST_TEST(
      near(answer.terms_kept[1].size, number(cases().front().at("phi0_eq24_rad")), 1.355e-10, 8));
  const std::string dropped = listed(answer.terms_dropped);
  for (const char* line :
       {"E, F: tilt: the x axis lies along the effective gravity\n",
        "E: centrifugal: Phi_A = Phi_B = 0\n", "K: centrifugal: u_x^2 = u_y^2 and Phi_C = 0\n",
        "E, F, H, K: gravity gradient: not requested: gravity taken as uniform over the body\n"}) {
    BOOST_TEST(dropped.find(line) != std::string::npos, line);
  }
}

BOOST_AUTO_TEST_CASE(kept_terms_have_their_size) {
  const Given<double> in = given<double>(cases()[12]);
  PendulumGuide<double> guide = in.guide;
  guide.gravity_gradient = spherical_gravity_gradient(0.0);
  guide.effective_gravity = {9.8, 0.2, -0.1};
  const auto answer = deviation(in.body, guide);
  const auto size = [&](const char* name) {
    for (const auto& term : answer.terms_kept) {
      if (term.name == name) return term.size * answer.parts.weight;
    }
    return -1.0;
  };
  BOOST_TEST(near(size("E: tilt"), std::abs(answer.parts.tilt.e), answer.parts.tilt.e, 4));
  BOOST_TEST(near(size("F: tilt"), std::abs(answer.parts.tilt.f), answer.parts.tilt.f, 4));
  const auto& centrifugal = answer.parts.centrifugal;
  BOOST_TEST(near(size("E: centrifugal"), std::abs(centrifugal.e), centrifugal.e, 4));
  BOOST_TEST(near(size("H: centrifugal"), std::abs(centrifugal.h), centrifugal.h, 4));
  BOOST_TEST(near(size("K: centrifugal"), std::abs(centrifugal.k), centrifugal.k, 4));
  BOOST_TEST(listed(answer.terms_kept).find("F: tilt") != std::string::npos);
  BOOST_TEST(listed(answer.terms_kept).find("K: gravity gradient") != std::string::npos);
}

// About an upright axis gravity changes equally to both sides.
BOOST_AUTO_TEST_CASE(name_terms_that_a_gradient_lacks) {
  PendulumGuide<double> guide = refused::hanging;
  guide.gravity_gradient = Eigen::Vector3d(-1e-6, -1e-6, 2e-6).asDiagonal();
  const std::string dropped =
      listed(deviation(PendulumBody<double>::thin_rod(0.75), guide).terms_dropped);
  for (const char* line :
       {"E: gravity gradient: Phi_A = Phi_B = 0\n", "H: gravity gradient: G_xy = 0 and Phi_C = 0\n",
        "K: gravity gradient: G_xx = G_yy and Phi_C = 0\n"}) {
    BOOST_TEST(dropped.find(line) != std::string::npos, line);
  }
}

// Turned about the line between its axes A and B.
BOOST_AUTO_TEST_CASE(name_terms_that_a_rotation_lacks) {
  PendulumGuide<double> guide = refused::hanging;
  guide.angular_velocity = {1e-3, 1e-3, 0};
  const std::string dropped =
      listed(deviation(PendulumBody<double>::thin_rod(0.75), guide).terms_dropped);
  BOOST_TEST(dropped.find("K: centrifugal: u_x^2 = u_y^2 and Phi_C = 0\n") != std::string::npos);
}

// Two products that cancel are recognised as different from absent ones.
BOOST_AUTO_TEST_CASE(name_terms_that_cancel) {
  // H = -G_xy (Theta_B - Theta_A) - (G_yy - G_xx) Phi_C = -1/4 + 2/8
  PendulumBody<double> body{1, 0.25, 0.5, 0.75, 0.75, 0, 0, 0.125};
  PendulumGuide<double> guide = refused::hanging;
  guide.gravity_gradient = Matrix3<double>::Zero();
  (*guide.gravity_gradient) << 1, 1, 0, 1, -1, 0, 0, 0, 0;
  const std::string dropped = listed(deviation(body, guide).terms_dropped);
  BOOST_TEST(dropped.find("H: gravity gradient: Theta_B - Theta_A and Phi_C cancel\n") !=
             std::string::npos);
  body.theta_a = body.theta_b;
  body.phi_c = 0;
  const std::string round = listed(deviation(body, guide).terms_dropped);
  BOOST_TEST(round.find("H: gravity gradient: Theta_A = Theta_B and Phi_C = 0\n") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(guide_at_rest) {
  const auto answer = deviation(PendulumBody<double>::thin_rod(0.75), refused::hanging);
  BOOST_TEST(answer.terms_kept.size() == 1u);
  BOOST_TEST(answer.equilibrium.exact.value == 0);
  BOOST_TEST(answer.equilibrium.exact.error == 0);
  BOOST_TEST(answer.period.relative_change_exact->value == 0);
  BOOST_TEST(!std::signbit(answer.equilibrium.formula_24.value));
}

// Rounding is added; the same period in DoubleDouble shows it.
BOOST_AUTO_TEST_CASE(great_swings_report_the_quadrature_error) {
  const auto rod = PendulumBody<double>::thin_rod(0.75);
  const auto swing = [](const auto& body, const auto& guide, double amplitude) {
    const auto c = coefficients(parts(body, guide));
    const auto all = equilibria(c);
    return period_at_amplitude(body, c, all, nearest_stable(all), amplitude);
  };
  for (const double amplitude : {0.5, 1.894, 3.0, 3.14157112, 3.14158814, 3.14159171}) {
    const auto found = swing(rod, refused::hanging, amplitude);
    const auto wide =
        swing(rod.cast<DoubleDouble>(), refused::hanging.cast<DoubleDouble>(), amplitude);
    const auto rounding = abs(found.period - wide.period);
    const auto told = deviation(rod, refused::hanging, amplitude).period.at_amplitude;
    BOOST_TEST_REQUIRE(told.has_value());
    BOOST_TEST(told->error >= double(rounding + found.quadrature_error));
  }
}

// (24) gives 0 if E + 2K = 0 and nothing is linear any more.
BOOST_AUTO_TEST_CASE(at_the_bifurcation_there_is_no_small_period) {
  const auto rod = PendulumBody<double>::thin_rod(1.5);                // theta 0.75, a 0.75
  PendulumGuide<double> guide{{-4, 0, 0}, {0, 0, 0}, {16, 0, 0}, {}};  // E = 12 = theta u^2
  const auto answer = deviation(rod, guide, 0.1);
  BOOST_TEST(!answer.equilibrium.linear.has_value());
  BOOST_TEST(!answer.period.linear.has_value());
  BOOST_TEST(!answer.period.exact_small.has_value());
  BOOST_TEST(answer.equilibria.front().degenerate);
  BOOST_TEST(answer.period.at_amplitude.has_value());
  BOOST_TEST(std::isinf(answer.period.simple.error));
}

BOOST_AUTO_TEST_SUITE_END()
