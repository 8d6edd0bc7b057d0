#include <Eigen/Eigenvalues>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <boost/numeric/odeint.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <unsupported/Eigen/AutoDiff>

#include <array>
#include <complex>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include <dynamics/guide/earth.hpp>
#include <dynamics/scene/pendulum.hpp>
#include <dynamics/scene/pendulum_deviation.hpp>
#include <dynamics/scene/pendulum_equilibria.hpp>
#include <dynamics/scene/pendulum_period.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using Exact = boost::multiprecision::cpp_bin_float_50;
using Json = nlohmann::json;

namespace {

using test::Sample;

constexpr double u = 0x1p-53;

/// |value - truth| <= k u scale with u = 2^-53, whatever precision value and truth have.
test::Verdict near(const Exact& value, const Exact& truth, const Exact& scale, double k) {
  return test::near(value, truth, Exact(abs(scale)), k * u / test::u<Exact>.convert_to<double>());
}

Exact number(const Json& text) { return Exact(text.get<std::string>()); }

/// The S nearest to what is written.
template <class S>
S decimal(const Json& text) {
  return static_cast<S>(number(text));
}

const std::vector<Json>& cases() {
  static const std::vector<Json> all = [] {
    std::vector<Json> list;
    for (const char* name : {"pendulum.json", "pendulum-extra.json"}) {
      std::ifstream stream(std::string(KREISEL_TEST_DATA) + "/" + name);
      const Json file = Json::parse(stream);
      for (const Json& one : file.at("cases")) list.push_back(one);
    }
    return list;
  }();
  return all;
}

template <class S>
struct Given {
  PendulumBody<S> body;
  PendulumGuide<S> guide;
  EarthSite<S> site;
  S gravity;
};

/// The inputs of a case read straight into S, the way a program would.
template <class S>
Given<S> given(const Json& c) {
  const Json& i = c.at("inputs");
  const auto get = [&](const char* key) { return decimal<S>(i.at(key)); };
  const PendulumBody<S> body{get("m"),   get("a"),   get("ThA"), get("ThB"),
                             get("ThC"), get("PhA"), get("PhB"), get("PhC")};
  EarthSite<S> site;
  site.latitude = get("latitude_deg");
  site.azimuth = get("alpha_deg");
  site.rotation_rate = get("u");
  const S gravity = get("g_eff");
  return {body, pendulum_guide(earth_guide(site, gravity)), site, gravity};
}

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
          std::max(column.worst_relative, error / std::abs(truth.convert_to<double>()));
    }
    const double ratio = error == 0 ? 0 : error / estimate.convert_to<double>();
    column.worst_ratio = std::max(column.worst_ratio, ratio);
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

Vector3<Exact> vector(Sample& sample, double size) {
  const double x = sample.uniform(-size, size);
  const double y = sample.uniform(-size, size);
  const double z = sample.uniform(-size, size);
  return {Exact(x), Exact(y), Exact(z)};
}

struct PointMass {
  Exact mass;
  Vector3<Exact> place;  // body axes, from the pivot
};

/// A body of point masses whose centre of mass lies on the axis A.
std::vector<PointMass> random_points(Sample& sample) {
  std::vector<PointMass> points;
  Exact mass = 0;
  Vector3<Exact> moment = Vector3<Exact>::Zero();
  for (int i = 0; i < 6; ++i) {
    PointMass p{Exact(sample.uniform(0.1, 1)), vector(sample, 0.4)};
    mass += p.mass;
    moment += p.mass * p.place;
    points.push_back(p);
  }
  const Exact arm = sample.uniform(0.1, 0.8);
  for (PointMass& p : points) p.place += Vector3<Exact>(arm, 0, 0) - moment / mass;
  return points;
}

PendulumBody<Exact> body_of(const std::vector<PointMass>& points) {
  PendulumBody<Exact> body{0, 0, 0, 0, 0, 0, 0, 0};
  Exact moment = 0;
  for (const auto& [m, p] : points) {
    const Exact x = p.x();
    const Exact y = p.y();
    const Exact z = p.z();
    body.mass += m;
    moment += m * x;
    body.theta_a += m * (y * y + z * z);
    body.theta_b += m * (x * x + z * z);
    body.theta_c += m * (x * x + y * y);
    body.phi_a += m * y * z;
    body.phi_b += m * z * x;
    body.phi_c += m * x * y;
  }
  body.arm = moment / body.mass;
  return body;
}

Exact total(const PendulumCoefficients<Exact>& c) {
  return abs(c.e()) + abs(c.f) + abs(c.h) + abs(c.k);
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing was thrown";
}

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

// The scene knows no integrator: any stepper takes its field.
BOOST_DATA_TEST_CASE(trajectory_is_that_of_the_reference, data::xrange(cases().size()), index) {
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
  // Changes of period that the first order of (25) does not see: -3.2e-20.
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

BOOST_DATA_TEST_CASE(guide_form_is_the_latitude_form, data::xrange(50u), seed) {
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

// Inputs come as decimals; the estimate of the double answer includes their rounding.
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
    // and is no blank cheque
    BOOST_TEST(answer.equilibrium.exact.error <= 32 * u * abs(phi_0).convert_to<double>());
    BOOST_TEST(answer.period.exact_small->error <= 16 * u * small.convert_to<double>());
    BOOST_TEST(answer.period.at_amplitude->error <= 32 * u * small.convert_to<double>());
    BOOST_TEST(answer.other_turning_point->error <=
               32 * u * (0.1 + abs(phi_0).convert_to<double>()));
  }
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(derivation)

// (23) against Newton's law for every point mass, in the inertial frame written on guide axes:
//   sum m [r, g + G r - (dv + [u v] + [du r] + [u [u r]] + 2 [u r'] + r'')]_z = 0.
BOOST_DATA_TEST_CASE(field_is_newtons_law_for_point_masses, data::xrange(100u), seed) {
  Sample sample(seed);
  const std::vector<PointMass> points = random_points(sample);
  const Vector3<Exact> rotation = vector(sample, 5);
  const Vector3<Exact> rotation_rate = vector(sample, 3);
  const Vector3<Exact> velocity = vector(sample, 10);
  const Vector3<Exact> velocity_rate = vector(sample, 5);
  const Vector3<Exact> gravity = vector(sample, 10);
  Matrix3<Exact> gradient = Matrix3<Exact>::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) gradient(i, j) = gradient(j, i) = sample.uniform(-20, 20);
  }
  const Exact phi = sample.uniform(-3, 3);
  const Exact rate = sample.uniform(-4, 4);
  const Exact friction = sample.uniform(-1, 1);

  Exact without = 0;  // the moment without r''; r'' = phi.. e_z x r - phi.^2 r
  Exact inertia = 0;
  for (const auto& [m, p] : points) {
    const Exact s = sin(phi);
    const Exact c = cos(phi);
    const Vector3<Exact> r(c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z());
    const Vector3<Exact> across(-r.y(), r.x(), 0);
    const Vector3<Exact> r_dot = rate * across;
    const Vector3<Exact> inward = -rate * rate * Vector3<Exact>(r.x(), r.y(), 0);
    const Vector3<Exact> acceleration = velocity_rate + rotation.cross(velocity) +
                                        rotation_rate.cross(r) +
                                        rotation.cross(Vector3<Exact>(rotation.cross(r))) +
                                        Exact(2) * rotation.cross(r_dot) + inward;
    const Vector3<Exact> pull = gravity + gradient * r;
    without += m * r.cross(Vector3<Exact>(pull - acceleration)).z();
    inertia += m * r.cross(across).z();
  }
  const Exact expected = (without - friction * rate) / inertia;

  const auto motion = [&](const Exact&) {
    return PendulumGuide<Exact>{
        rotation, rotation_rate,
        effective_gravity<Exact>(gravity, rotation, velocity, velocity_rate), gradient};
  };
  const auto damping = [&](const Exact& w) { return Exact(friction * w); };
  const PendulumField<Exact, decltype(motion), decltype(damping)> field(body_of(points), motion,
                                                                        damping);
  const PendulumState<Exact> result = field(Exact(0), PendulumState<Exact>(phi, rate));
  BOOST_TEST(result[0] == rate);
  BOOST_TEST(abs(Exact(result[1] - expected)) <= Exact("1e-46") * (abs(without) / inertia + 300));
}

// E, F, H, K as the paper prints them, without g', weight or gradients.
BOOST_DATA_TEST_CASE(coefficients_are_those_printed_below_23, data::xrange(50u), seed) {
  Sample sample(seed);
  const PendulumBody<Exact> b = body_of(random_points(sample));
  const Vector3<Exact> w = vector(sample, 5);
  const Vector3<Exact> dw = vector(sample, 3);
  const Vector3<Exact> v = vector(sample, 10);
  const Vector3<Exact> dv = vector(sample, 5);
  const Vector3<Exact> g = vector(sample, 10);
  const PendulumGuide<Exact> guide{w, dw, effective_gravity<Exact>(g, w, v, dv), {}};
  const PendulumCoefficients<Exact> c = coefficients(b, guide);
  const Exact ma = b.mass * b.arm;
  const Exact e = -ma * (dv.x() - w.z() * v.y() + w.y() * v.z()) -
                  b.phi_a * (w.z() * w.y() - dw.x()) - b.phi_b * (w.z() * w.x() + dw.y()) +
                  ma * g.x();
  const Exact f = ma * (dv.y() + w.z() * v.x() - w.x() * v.z()) -
                  b.phi_a * (w.z() * w.x() + dw.y()) + b.phi_b * (w.z() * w.y() - dw.x()) -
                  ma * g.y();
  const Exact h =
      b.phi_c * (w.y() * w.y() - w.x() * w.x()) + (b.theta_b - b.theta_a) * w.x() * w.y();
  const Exact k =
      -2 * b.phi_c * w.x() * w.y() + (b.theta_a - b.theta_b) * (w.x() * w.x() - w.y() * w.y()) / 2;
  const Exact tiny = Exact("1e-46") * (total(c) + ma * 100);
  BOOST_TEST(abs(Exact(c.e() - e)) <= tiny);
  BOOST_TEST(abs(Exact(c.f - f)) <= tiny);
  BOOST_TEST(abs(Exact(c.h - h)) <= tiny);
  BOOST_TEST(abs(Exact(c.k - k)) <= tiny);
  BOOST_TEST(c.weight == ma * guide.effective_gravity.norm());
}

// A guide that turns with u pulls like a guide at rest in the gradient u^2 - u u^t.
BOOST_DATA_TEST_CASE(centrifugal_terms_are_those_of_a_gradient, data::xrange(20u), seed) {
  Sample sample(seed);
  const PendulumBody<Exact> body = body_of(random_points(sample));
  const Vector3<Exact> w = vector(sample, 5);
  const Vector3<Exact> g = vector(sample, 10);
  const Matrix3<Exact> gradient = w.squaredNorm() * Matrix3<Exact>::Identity() - w * w.transpose();
  const auto turning = coefficients(body, PendulumGuide<Exact>{w, {0, 0, 0}, g, {}});
  const auto resting = coefficients(body, PendulumGuide<Exact>{{0, 0, 0}, {0, 0, 0}, g, gradient});
  const Exact tiny = Exact("1e-47") * total(turning);
  BOOST_TEST(abs(Exact(turning.e() - resting.e())) <= tiny);
  BOOST_TEST(abs(Exact(turning.f - resting.f)) <= tiny);
  BOOST_TEST(abs(Exact(turning.h - resting.h)) <= tiny);
  BOOST_TEST(abs(Exact(turning.k - resting.k)) <= tiny);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(against_fifty_digits)

// Written anew from (23): plain sums, Newton, and differences of the potential in 50 digits.
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

BOOST_AUTO_TEST_SUITE(all_equilibria)

// In z = exp(i phi) the moment is  [(H - iK) z^4 + (F - iE) z^3 + (F + iE) z + (H + iK)]/(2 z^2).
int roots_on_the_unit_circle(double e, double f, double h, double k, bool& clear) {
  using Complex = std::complex<double>;
  const Complex leading(h, -k);
  Eigen::Matrix4cd companion = Eigen::Matrix4cd::Zero();
  companion(1, 0) = companion(2, 1) = companion(3, 2) = 1;
  companion(0, 3) = -Complex(h, k) / leading;
  companion(1, 3) = -Complex(f, e) / leading;
  companion(3, 3) = -Complex(f, -e) / leading;
  const Eigen::Vector4cd roots = companion.eigenvalues();
  int count = 0;
  clear = true;
  for (int i = 0; i < 4; ++i) {
    const double off = std::abs(std::abs(roots[i]) - 1);
    if (off < 1e-9) ++count;
    if (off >= 1e-9 && off < 1e-5) clear = false;  // two roots about to meet
  }
  return count;
}

BOOST_AUTO_TEST_CASE(are_as_many_as_the_quartics_roots_on_the_unit_circle) {
  Sample sample(1);
  int unclear = 0;
  std::array<int, 5> seen{};
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&] {
      return sample.uniform(-1, 1) * std::pow(10.0, std::floor(sample.uniform(-2, 1)));
    };
    const double e = draw();
    const double f = draw();
    const double h = draw();
    const double k = draw();
    bool clear = false;
    const int count = roots_on_the_unit_circle(e, f, h, k, clear);
    if (!clear) {
      ++unclear;
      continue;
    }
    const PendulumCoefficients<double> c{1, e - 1, f, h, k};
    const auto found = equilibria(c);
    BOOST_TEST_REQUIRE(static_cast<int>(found.size()) == count);
    ++seen[found.size()];
    for (std::size_t j = 0; j < found.size(); ++j) {
      // Stable and unstable ones alternate around the circle.
      BOOST_TEST_REQUIRE(found[j].stable != found[(j + 1) % found.size()].stable);
      BOOST_TEST_REQUIRE(near(c.moment(found[j].angle), 0,
                              std::abs(e) + std::abs(f) + std::abs(h) + std::abs(k), 16));
    }
  }
  BOOST_TEST(unclear < 20);
  BOOST_TEST(seen[2] > 1000);
  BOOST_TEST(seen[4] > 1000);
}

// By the arithmetic-geometric mean, T = 2 pi/agm(1, cos(amplitude/2)): sums of many terms are not
// rounded as often as there are terms.
BOOST_AUTO_TEST_CASE(periods_of_great_swings_do_not_add_up_rounding) {
  using L = long double;
  const PendulumCoefficients<double> c{1, 0, 0, 0, 0};
  const auto all = equilibria(c);
  for (const double below : {1.0, 0.137, 0.1}) {
    const double amplitude = std::acos(-1.0) - below;
    const auto found = period_at_amplitude(PendulumBody<double>{.arm = 1, .theta_c = 1}, c, all,
                                           nearest_stable(all), amplitude);
    L a = 1;
    L g = std::cos(L(amplitude) / 2);
    for (int i = 0; i < 8; ++i) {
      const L mean = (a + g) / 2;
      g = std::sqrt(a * g);
      a = mean;
    }
    const L off = found.period / (2 * std::acos(L(-1)) / a) - 1;
    BOOST_TEST(std::abs(off) <= L(1.8) * u, below << " rad below: off by " << double(off) / u
                                                  << " u with " << found.nodes << " nodes");
  }
}

// Against Newton's method in 64 bits, wherever on the circle and however small the terms are there.
BOOST_AUTO_TEST_CASE(have_all_the_digits_that_their_terms_have) {
  using L = long double;
  Sample sample(2);
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto draw = [&] {
      return sample.uniform(-1, 1) * std::pow(10.0, std::floor(sample.uniform(-2, 1)));
    };
    const PendulumCoefficients<double> c{1, draw(), draw(), draw(), draw()};
    const L e = 1 + L(c.delta_e);
    for (const auto& found : equilibria(c)) {
      L x = found.angle;
      L slope = 0;
      for (int step = 0; step < 3; ++step) {
        slope = e * std::cos(x) - c.f * std::sin(x) - 2 * c.h * std::sin(2 * x) +
                2 * c.k * std::cos(2 * x);
        x -= (e * std::sin(x) + c.f * std::cos(x) + c.h * std::cos(2 * x) + c.k * std::sin(2 * x)) /
             slope;
      }
      const L terms = std::abs(e * std::sin(x)) + std::abs(c.f * std::cos(x)) +
                      std::abs(c.h * std::cos(2 * x)) + std::abs(c.k * std::sin(2 * x));
      if (std::abs(slope) < 1e-2L * terms) continue;  // almost merged
      const L off = std::abs(found.angle - x) / (std::abs(x) + terms / std::abs(slope));
      worst = std::max(worst, double(off) / u);
    }
  }
  BOOST_TEST_MESSAGE("at most " << worst << " u of what their terms are");
  BOOST_TEST(worst <= 2);
}

// The circle is cut where no equilibrium is: hit by one, the signs at the ends of the cut are chance.
BOOST_AUTO_TEST_CASE(are_not_lost_where_the_circle_is_cut) {
  for (int i = 0; i < 2000; ++i) {
    const double angle = 0.9 + (i - 1000) * 3e-17;
    const double size = 1 + 0.37 * (i % 7);
    const PendulumCoefficients<double> c{size, size * (std::cos(angle) - 1),
                                         -size * std::sin(angle), 0, 0};
    BOOST_TEST_REQUIRE(equilibria(c).size() == 2U);
  }
}

// (1 - cos(x - a)) (cos(a - b)/2 + cos(x - b)): a double root at a whatever b is.
BOOST_DATA_TEST_CASE(a_merged_pair_is_reported_once_and_unstable, data::xrange(200u), seed) {
  Sample sample(seed);
  const double a = sample.uniform(-3.1, 3.1);
  const double b = sample.uniform(-3.1, 3.1);
  const double q = std::cos(a - b) / 2;
  if (std::abs(q) < 0.05) return;  // three meet where cos(a - b) = 0
  // Products: cos(x-a) cos(x-b) = cos(a-b)/2 + cos(2x-a-b)/2; the constants cancel.
  const double e = std::sin(b) - q * std::sin(a);
  const double f = std::cos(b) - q * std::cos(a);
  const double h = -std::cos(a + b) / 2;
  const double k = -std::sin(a + b) / 2;
  const auto found = equilibria(PendulumCoefficients<double>{1, e - 1, f, h, k});
  int merged = 0;
  for (const auto& one : found) {
    if (!one.degenerate) continue;
    ++merged;
    BOOST_TEST(!one.stable);
    BOOST_TEST(near(one.angle, a, 1, std::sqrt(64 / u)));  // a double root is known to sqrt(u)
  }
  BOOST_TEST(merged == 1);
  BOOST_TEST(found.size() == 3u);
}

// E sin x + K sin 2x with E = -2K: the hanging position loses its stability (case P9's pitchfork).
BOOST_AUTO_TEST_CASE(the_pitchfork_point_itself) {
  const auto at = [](double k) { return equilibria(PendulumCoefficients<double>{1, 0, 0, 0, k}); };
  const auto merged = at(-0.5);
  BOOST_TEST_REQUIRE(merged.size() == 2u);
  BOOST_TEST(merged[0].angle == 0);
  BOOST_TEST(merged[0].degenerate);
  BOOST_TEST(merged[0].stable);
  BOOST_TEST_REQUIRE(at(-0.499999).size() == 2u);
  BOOST_TEST(at(-0.499999)[0].stable);
  const auto split = at(-0.500001);  // cos(phi) = 1/(2 |k|)
  BOOST_TEST_REQUIRE(split.size() == 4u);
  BOOST_TEST(split[0].stable);
  BOOST_TEST(!split[1].stable);
  BOOST_TEST(near(split[2].angle, std::acos(1 / 1.000002), 1, 1 / std::sqrt(u) / 100));
}

BOOST_AUTO_TEST_CASE(a_merged_pair_of_exact_numbers) {
  // a = 0, b = 0: (1 - cos x)(1/2 + cos x) = cos(x)/2 - cos(2x)/2, roots 0 (double), +-2 pi/3.
  const auto found = equilibria(PendulumCoefficients<double>{0, 0, 0.5, -0.5, 0});
  BOOST_TEST_REQUIRE(found.size() == 3u);
  BOOST_TEST(found[1].angle == 0);
  BOOST_TEST(found[1].degenerate);
  BOOST_TEST(!found[1].stable);
  BOOST_TEST(near(found[2].angle, 2 * std::acos(-1.0) / 3, 2, 2));
}

BOOST_AUTO_TEST_CASE(the_positive_one_of_two_equally_near_is_taken) {
  const auto found = equilibria(PendulumCoefficients<double>{1, 0, 0, 0, -0.9});
  BOOST_TEST_REQUIRE(found.size() == 4u);
  BOOST_TEST(nearest_stable(found).angle > 0);
  BOOST_TEST(found.back().angle == std::acos(-1.0));
}

BOOST_AUTO_TEST_CASE(tiny_angles_keep_their_digits) {
  for (const double f : {1e-3, 1e-10, 1e-100, 1e-300}) {
    const auto found = equilibria(PendulumCoefficients<double>{1, 0, -f, 0, 0});
    BOOST_TEST_REQUIRE(found.size() == 2u);
    BOOST_TEST(near(nearest_stable(found).angle, std::atan(f), f, 4));
  }
}

BOOST_AUTO_TEST_CASE(no_moment_at_all_is_refused) {
  BOOST_TEST(message_of([] { (void)equilibria(PendulumCoefficients<double>{}); }) ==
             "every angle is an equilibrium: E, F, H and K are all 0");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BOOST_CHECK_THROW((void)equilibria(PendulumCoefficients<double>{1, 0, nan, 0, 0}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(finite_amplitude)

const PendulumBody<double> rod = PendulumBody<double>::thin_rod(0.75);

FiniteOscillation<double> swing(const PendulumCoefficients<double>& c, double amplitude) {
  const auto all = equilibria(c);
  return period_at_amplitude(rod, c, all, nearest_stable(all), amplitude);
}

BOOST_DATA_TEST_CASE(both_turning_points_have_the_same_height, data::xrange(300u), seed) {
  Sample sample(seed);
  const PendulumCoefficients<double> c{1, sample.uniform(-0.5, 0.5), sample.uniform(-1, 1),
                                       sample.uniform(-1, 1), sample.uniform(-1, 1)};
  const auto all = equilibria(c);
  const auto rest = nearest_stable(all);
  const double amplitude = sample.uniform(-3, 3);
  const auto there = period_at_amplitude(rod, c, all, rest, amplitude);
  const double release = rest.angle + amplitude;
  const double other = rest.angle + there.other_turning_point;
  const double size = std::abs(c.e()) + std::abs(c.f) + std::abs(c.h) + std::abs(c.k);
  BOOST_TEST(near(c.potential(other), c.potential(release), size, 64));
  // It falls at the release, and nothing between is as high.
  BOOST_TEST((c.moment(release) > 0) == (other < release));
  for (int i = 1; i < 200; ++i) {
    BOOST_TEST_REQUIRE(c.potential(release + (other - release) * i / 200) < c.potential(release));
  }
  // Released at the other point it comes back, in the same time.
  if (std::abs(there.other_turning_point) < 3.14) {
    const auto back = period_at_amplitude(rod, c, all, rest, there.other_turning_point);
    const double steepest = std::min(std::abs(c.moment(release)), std::abs(c.moment(other)));
    BOOST_TEST(near(back.period, there.period, there.period * size / steepest, 64));
  }
}

BOOST_AUTO_TEST_CASE(a_small_amplitude_gives_the_small_period) {
  const PendulumCoefficients<double> c{3.7, 1e-3, -0.02, 0.01, 0.3};
  const double rest = nearest_stable(equilibria(c)).angle;
  const double small = small_period(rod, c, rest);
  for (const double amplitude : {1e-9, -1e-9, 1e-15, 1e-30, 1e-200}) {
    const auto there = swing(c, amplitude);
    BOOST_TEST(near(there.period, small, small, 16));
    BOOST_TEST(
        near(there.other_turning_point, -amplitude, amplitude, 16 + std::abs(amplitude) / u));
  }
  BOOST_TEST(swing(c, 0).period == small);
}

// Mirror: phi -> -phi takes F -> -F, H -> -H.
BOOST_AUTO_TEST_CASE(the_mirrored_pendulum_swings_alike) {
  const PendulumCoefficients<double> c{3.7, 0.1, -0.3, 0.2, -1.1};
  const PendulumCoefficients<double> mirrored{3.7, 0.1, 0.3, -0.2, -1.1};
  for (const double amplitude : {-2.5, -0.4, 0.7, 2.9}) {
    BOOST_TEST(near(swing(mirrored, -amplitude).period, swing(c, amplitude).period, 1, 16));
  }
}

// Two wells at +-arccos(1/1.8), the barrier between them at 0: released above it, it passes.
BOOST_AUTO_TEST_CASE(a_high_release_passes_the_barrier) {
  const PendulumCoefficients<double> c{1, 0, 0, 0, -0.9};
  const double rest = nearest_stable(equilibria(c)).angle;
  const auto low = swing(c, 0.1);
  BOOST_TEST(rest + low.other_turning_point > 0);
  const auto high = swing(c, 2.5 - rest);
  BOOST_TEST(near(rest + high.other_turning_point, -2.5, 2.5, 8));
}

BOOST_AUTO_TEST_CASE(infinite_periods_are_refused) {
  const PendulumCoefficients<double> plain{1, 0, 0, 0, 0};
  BOOST_TEST(message_of([&] { (void)swing(plain, std::acos(-1.0)); }) ==
             "amplitude = 3.141592654 rad releases the pendulum at the equilibrium phi = "
             "3.141592654 rad: it stays there");
  BOOST_TEST(message_of([&] { (void)swing(plain, 3.2); }) ==
             "amplitude = 3.2 rad lies outside [-3.141592654, 3.141592654] rad");
  // E = 1, K = -1: the height of the barrier at 0 is reached again where
  // 1 - cos p = sin^2 p, p = pi/2: E (1 - cos p) + K sin^2 p = 1 - 1 = 0.
  const PendulumCoefficients<double> wells{1, 0, 0, 0, -1};
  const double rest = nearest_stable(equilibria(wells)).angle;
  // From either side, to one barrier.
  for (const double release : {std::acos(0.0), -std::acos(0.0)}) {
    BOOST_CHECK_EXCEPTION((void)swing(wells, release - rest), ComputationFailed,
                          [](const auto& error) {
                            const std::string text = error.what();
                            BOOST_TEST_MESSAGE(text);
                            return text.starts_with("the period is infinite") &&
                                   std::abs(std::stod(text.substr(text.find("phi = ") + 6))) < 1e-9;
                          });
  }
}

// The slope is  m (E' + 2 K') + F' (3 m^2 + d^2)/2  next to the equilibrium: where m and d are off by
// a part delta, it is off by no more than  delta (|m| |E' + 2 K'| + |F'| (3 m^2 + d^2)).
BOOST_DATA_TEST_CASE(rounding_is_magnified_as_foretold, data::xrange(100u), seed) {
  Sample sample(seed);
  const bool third = seed % 2 == 0;  // E' + 2 K' = 0: the moment is of second order
  const detail::ShiftedMoment<double> moment{
      third ? 0 : sample.uniform(-1, 1), third ? 0 : sample.uniform(-1, 1), sample.uniform(-1, 1)};
  const double m = sample.uniform(-0.3, 0.3);
  const double d = sample.uniform(0, 0.3);
  const double slope = moment.slope(m, d);
  constexpr double delta = 1e-6;
  double worst = 0;
  for (const double off : {m * (1 + delta), m * (1 - delta)}) {
    worst = std::max({worst, std::abs(moment.slope(off, d * (1 + delta)) - slope),
                      std::abs(moment.slope(off, d * (1 - delta)) - slope)});
  }
  const double foretold = moment.condition(m, d, slope) * std::abs(slope) * delta;
  BOOST_TEST(worst <= 1.6 * foretold);
  if (third) BOOST_TEST(worst >= 0.4 * foretold);
}

BOOST_AUTO_TEST_CASE(near_a_barrier_the_error_reached_is_named) {
  const PendulumCoefficients<double> wells{1, 0, 0, 0, -1};
  const double rest = nearest_stable(equilibria(wells)).angle;
  BOOST_CHECK_EXCEPTION(
      (void)swing(wells, std::acos(0.0) + 1e-13 - rest), ComputationFailed, [](const auto& error) {
        BOOST_TEST_MESSAGE(error.what());
        return std::string(error.what()).find("leave an error of") != std::string::npos;
      });
  BOOST_CHECK_NO_THROW((void)swing(wells, std::acos(0.0) + 1e-6 - rest));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gravity_gradient)

const PendulumBody<double> rod_of_paper = PendulumBody<double>::from_reduced_length(0.5);

// 1.5 GM/R^3 (Theta_B - Theta_A) in K: 870 times the rotation's 1.36e-10.
BOOST_AUTO_TEST_CASE(of_a_round_earth_shortens_the_period_by_1_2e_7) {
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

BOOST_AUTO_TEST_SUITE(field)

BOOST_AUTO_TEST_CASE(steady_and_moving_guide_give_the_same) {
  const Given<double> in = given<double>(cases().back());
  const PendulumField<double> steady(in.body, in.guide);
  const auto motion = [&](double) { return in.guide; };
  const PendulumField<double, decltype(motion)> moving(in.body, motion);
  const PendulumState<double> state(0.3, -0.7);
  BOOST_TEST((steady(0.0, state) == moving(0.0, state)));
}

// dE/dt = Theta_C phi. phi.. + moment phi. = -f(phi.) phi.
BOOST_AUTO_TEST_CASE(damping_takes_its_power_from_the_energy) {
  const Given<double> in = given<double>(cases()[5]);
  const auto damping = [](double w) { return 0.03 * w + 0.02 * w * w * w; };
  const PendulumField<double, PendulumGuide<double>, decltype(damping)> damped(in.body, in.guide,
                                                                               damping);
  const auto c = coefficients(in.body, in.guide);
  const PendulumState<double> state(0.8, 1.7);
  const PendulumState<double> rate = damped(0.0, state);
  const double power = (in.body.theta_c * rate[1] + c.moment(state[0])) * state[1];
  BOOST_TEST(near(power, -damping(1.7) * 1.7, 10, 4));
}

BOOST_AUTO_TEST_CASE(automatic_derivatives_give_stiffness_and_energy_rate) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Vector2d>;
  const Given<double> in = given<double>(cases()[11]);
  const PendulumField<double> f(in.body, in.guide);
  const auto c = coefficients(in.body, in.guide);
  const PendulumState<Dual> state(Dual(0.4, 2, 0), Dual(-1.1, 2, 1));
  const PendulumState<Dual> rate = f(0.0, state);
  const double size = std::abs(c.e()) + std::abs(c.f) + 4 * (std::abs(c.h) + std::abs(c.k));
  BOOST_TEST(near(rate[1].derivatives()[0] * in.body.theta_c, -c.stiffness(0.4), size, 8));
  BOOST_TEST(rate[1].derivatives()[1] == 0);
  // The energy is an invariant: its gradient is normal to the field.
  const Dual e = energy(in.body, c, state);
  const double along = e.derivatives()[0] * rate[0].value() + e.derivatives()[1] * rate[1].value();
  BOOST_TEST(near(along, 0, size, 8));
}

// Sensitivities: a body in dual numbers, seeded in the arm.
BOOST_AUTO_TEST_CASE(bodies_may_be_dual_numbers) {
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  PendulumBody<Dual> body{Dual(2.0), Dual(0.3, 1, 0), Dual(0.1), Dual(0.4),
                          Dual(0.5), Dual(0.01),      Dual(0.0), Dual(0.02)};
  PendulumGuide<Dual> guide;
  guide.angular_velocity = {Dual(1.0), Dual(2.0), Dual(0.5)};
  guide.effective_gravity = {Dual(9.0), Dual(0.5), Dual(0.0)};
  const PendulumCoefficients<Dual> c = coefficients(body, guide);
  BOOST_TEST(near(c.e().derivatives()[0], 2 * 9.0, 18, 4));
  BOOST_TEST(near(c.f.derivatives()[0], -2 * 0.5, 1, 4));
}

template <class S>
void agrees(double k) {
  const Json& c = cases()[4];
  const Given<S> in = given<S>(c);
  const auto all = equilibria(coefficients(in.body, in.guide));
  const auto rest = nearest_stable(all);
  const auto swing_ =
      period_at_amplitude(in.body, coefficients(in.body, in.guide), all, rest, S(1) / S(10));
  BOOST_TEST(near(Exact(rest.angle), number(c.at("phi0_exact_rad")), 1, k));
  BOOST_TEST(near(Exact(swing_.period), number(c.at("finite_amplitude").at("period_s")), 1, k));
  const PendulumField<S> f(in.body, in.guide);
  const PendulumState<S> rate = f(S(0), PendulumState<S>(rest.angle, S(0)));
  BOOST_TEST(near(Exact(rate[1]), 0, 20, k));
}

BOOST_AUTO_TEST_CASE(every_scalar_agrees) {
  agrees<float>(8 * 0x1p29);
  agrees<double>(8);
  agrees<long double>(8 * 0x1p-11);
  agrees<Exact>(1e-24 / u);  // the reference's digits
}

BOOST_AUTO_TEST_CASE(linearised_field_is_the_tangent_at_0) {
  const Given<double> in = given<double>(cases().back());
  const auto c = coefficients(in.body, in.guide);
  const LinearPendulum<double> linear = linearised(in.body, c);
  BOOST_TEST(near(linear.acceleration(0.0) * in.body.theta_c, -c.moment(0.0), c.weight, 4));
  BOOST_TEST(linear.stiffness == c.stiffness(0.0));
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(refused)

const PendulumGuide<double> hanging{{0, 0, 0}, {0, 0, 0}, {9.81, 0, 0}, {}};

std::string refusal(const PendulumBody<double>& body,
                    const PendulumGuide<double>& guide = hanging) {
  return message_of([&] { (void)deviation(body, guide, 0.1); });
}

BOOST_AUTO_TEST_CASE(bodies_that_cannot_be) {
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

// Upside down nothing is stable, and without weight there is nothing to compare with.
BOOST_AUTO_TEST_CASE(periods_that_are_none) {
  const auto rod = PendulumBody<double>::thin_rod(0.75);
  const PendulumCoefficients<double> c{.weight = 3};
  const double up = std::acos(-1.0);
  BOOST_CHECK_THROW((void)stiffness_excess(PendulumCoefficients<double>{}, 0.1), InvalidInput);
  BOOST_CHECK_THROW((void)small_period_change(c, up), ComputationFailed);
  BOOST_CHECK_THROW((void)small_period(rod, c, up), ComputationFailed);
  const double infinite = std::numeric_limits<double>::infinity();
  BOOST_CHECK_THROW((void)equilibria(PendulumCoefficients<double>{.weight = infinite}),
                    InvalidInput);
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

BOOST_AUTO_TEST_CASE(of_the_papers_pendulum) {
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

BOOST_AUTO_TEST_CASE(kept_ones_carry_their_size) {
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

// About an upright axis gravity changes as much to one side as to the other.
BOOST_AUTO_TEST_CASE(name_what_a_gradient_lacks) {
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

// What two products make up for is told from what is not there.
BOOST_AUTO_TEST_CASE(name_what_cancels) {
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

BOOST_AUTO_TEST_CASE(of_a_guide_at_rest) {
  const auto answer = deviation(PendulumBody<double>::thin_rod(0.75), refused::hanging);
  BOOST_TEST(answer.terms_kept.size() == 1u);
  BOOST_TEST(answer.equilibrium.exact.value == 0);
  BOOST_TEST(answer.equilibrium.exact.error == 0);
  BOOST_TEST(answer.period.relative_change_exact->value == 0);
  BOOST_TEST(!std::signbit(answer.equilibrium.formula_24.value));
}

// (24) says 0 where E + 2K = 0 and nothing is linear any more.
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
