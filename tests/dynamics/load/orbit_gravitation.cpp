#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/guide/orbit.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/load/orbit_gravitation.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/tree/body_system.hpp>

#include <support/near.hpp>
#include <support/sample.hpp>

using namespace kreisel;
using test::near;
namespace data = boost::unit_test::data;

namespace {

using Digits = boost::multiprecision::cpp_bin_float_50;
using Wide = std::array<Digits, 3>;

constexpr double earth = 3.986004418e14;
constexpr double j2 = 1.08262982131e-3;

template <class N>
PlanetField<N> planet(double flattening) {
  const N radius(6378137);
  return {N(earth), N(1.5) * N(earth) * N(flattening) * radius * radius, Vector3<N>(0, 0, 1),
          flattening != 0};
}

Digits dot(const Wide& a, const Wide& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Wide sum(const Wide& a, const Wide& b, const Digits& k = 1) {
  return {a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]};
}
Wide wide(const Vector3<double>& v) { return {v.x(), v.y(), v.z()}; }
Vector3<double> rounded(const Wide& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// g at a position, from the formula with a polar axis z.
Wide gravitation(const Wide& p, double flattening) {
  const Digits r2 = dot(p, p);
  const Digits r = sqrt(r2);
  const Digits k = Digits(1.5) * Digits(flattening) * Digits(6378137) * Digits(6378137) / r2;
  const Digits s2 = p[2] * p[2] / r2;
  const Digits across = -Digits(earth) / (r2 * r) * (1 + k * (1 - 5 * s2));
  const Digits along = -Digits(earth) / (r2 * r) * (1 + k * (3 - 5 * s2));
  return {across * p[0], across * p[1], along * p[2]};
}

/// The position of a free particle after a time, by f and g functions.
///
/// Source : R. H. Battin, An Introduction to the Mathematics and Methods of Astrodynamics, 4.3
Wide kepler_place(const Wide& x, const Wide& v, const Digits& t) {
  const Digits mu(earth);
  const Digits r = sqrt(dot(x, x));
  const Digits a = 1 / (2 / r - dot(v, v) / mu);
  const Digits n = sqrt(mu / (a * a * a));
  const Digits slope = dot(x, v) / sqrt(mu * a);
  Digits E = n * t;
  for (int i = 0; i < 60; ++i) {
    const Digits off = E - (1 - r / a) * sin(E) + slope * (1 - cos(E)) - n * t;
    E -= off / (1 - (1 - r / a) * cos(E) + slope * sin(E));
  }
  const Digits f = 1 - a / r * (1 - cos(E));
  const Digits g = t - (E - sin(E)) / n;
  return sum(Wide{f * x[0], f * x[1], f * x[2]}, v, g);
}

/// A cloud of point masses.
struct Cloud {
  std::vector<Vector3<double>> places;
  std::vector<double> masses;

  [[nodiscard]] InertiaTensor<Body> inertia() const {
    InertiaTensor<Body> total;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Pose<> X{Matrix3<double>::Identity(), places[i]};
      total = {total.value + X * Inertia<>{masses[i], Vector3<double>::Zero(), {}}};
    }
    return total;
  }
};

/// A cloud that is symmetric about its centre of mass, which is not its origin.
Cloud cloud(unsigned seed, double size) {
  test::Sample sample(seed);
  const Vector3<double> centre = size * sample.direction();
  Cloud c;
  for (int i = 0; i < 4; ++i) {
    const Vector3<double> d = size * sample.uniform(0.2, 1.0) * sample.direction();
    const double m = sample.uniform(0.5, 2.0);
    for (const double sign : {-1.0, 1.0}) {
      c.places.push_back(centre + sign * d);
      c.masses.push_back(m);
    }
  }
  return c;
}

const OrbitElements<> circle{.semi_major_axis = 7e6, .inclination = 1.2, .node = 0.3};

OrbitElements<> ellipse(double flattening = 0) {
  return {.semi_major_axis = 9e6,
          .eccentricity = 0.2,
          .inclination = 1.2,
          .node = 0.3,
          .perigee = 2,
          .anomaly = 1,
          .j2 = flattening};
}

}  // namespace

BOOST_AUTO_TEST_SUITE(a_planets_field)

// Against the difference in 50 digits.
BOOST_DATA_TEST_CASE(has_its_tide_to_the_last_digits, data::xrange(300u), seed) {
  test::Sample sample(seed);
  const double flattening = seed % 2 ? j2 : 0;
  const Vector3<double> p = sample.uniform(6.4e6, 4e7) * sample.direction();
  const double exponents[] = {-3, -1, 0, 1, 3, 5, 6};
  const Vector3<double> d = std::pow(10.0, exponents[seed % 7]) * sample.direction();
  const Wide there = gravitation(sum(wide(p), wide(d)), flattening);
  const Vector3<double> truth = rounded(sum(there, gravitation(wide(p), flattening), -1));
  BOOST_TEST(near(planet<double>(flattening).tide(p, d), truth, truth.norm(), 16));
}

// The slope of the potential is the tide: differences of fourth order in long double.
BOOST_DATA_TEST_CASE(has_a_tidal_potential, data::xrange(40u), seed) {
  using Real = long double;
  test::Sample sample(seed);
  const auto field = planet<Real>(seed % 2 ? j2 : 0);
  const Vector3<Real> p = (sample.uniform(6.4e6, 4e7) * sample.direction()).cast<Real>();
  const Vector3<Real> d = (1e5 * sample.direction()).cast<Real>();
  const Vector3<Real> tide = field.tide(p, d);
  for (int i = 0; i < 3; ++i) {
    const Vector3<Real> h = 1e3L * Vector3<Real>::Unit(i);
    const auto U = [&](int k) { return field.tidal_potential(p, Vector3<Real>(d + Real(k) * h)); };
    const Real slope = (8 * (U(1) - U(-1)) - (U(2) - U(-2))) / 12e3L;
    BOOST_TEST(std::abs(slope - tide[i]) < 1e-8L * tide.norm());
  }
  // Without J2 the potential keeps its digits at small distances.
  const Vector3<double> place = p.cast<double>();
  const Vector3<double> near_it = 1e-3 * d.cast<double>().normalized();
  const double r = place.norm();
  const double along = near_it.dot(place) / r;
  const double second = earth / (2 * r * r * r) * (3 * along * along - near_it.squaredNorm());
  BOOST_TEST(near(planet<double>(0).tidal_potential(place, near_it), second, earth / (r * r * r),
                  1e-15 / test::u<>));
}

// A body of point masses: the error is of fourth order, (size/r)^2 of the terms.
BOOST_DATA_TEST_CASE(acts_on_a_body_of_finite_size, data::xrange(40u), seed) {
  const double flattening = seed % 2 ? j2 : 0;
  const double size = 1000;
  const Cloud c = cloud(seed, size);
  test::Sample sample(seed + 1000);
  LoadContext<> s;
  s.inertia = c.inertia();
  s.X.value = {sample.rotation(), sample.uniform(6.5e6, 9e6) * sample.direction()};
  const auto load = [&](bool gradient) {
    return OblateGravitation<>{.j2 = flattening, .gradient = gradient}(s).value;
  };
  Wide force{}, moment{};
  for (std::size_t i = 0; i < c.places.size(); ++i) {
    const Vector3<double>& place = c.places[i];
    const Matrix3<double>& R = s.X.value.rotation;
    Wide p = wide(s.X.value.translation);
    for (std::size_t k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) p[k] += Digits(R(Eigen::Index(k), j)) * place[j];
    }
    const Wide g = gravitation(p, flattening);
    Wide on_body{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) {
        on_body[k] += Digits(R(Eigen::Index(j), Eigen::Index(k))) * g[j] * c.masses[i];
      }
    }
    const Wide at = wide(place);
    force = sum(force, on_body);
    moment = sum(moment, Wide{at[1] * on_body[2] - at[2] * on_body[1],
                              at[2] * on_body[0] - at[0] * on_body[2],
                              at[0] * on_body[1] - at[1] * on_body[0]});
  }
  // About the centre of mass.
  const Vector3<double> centre = s.centre();
  const Wide C = wide(centre);
  moment = sum(moment,
               Wide{C[1] * force[2] - C[2] * force[1], C[2] * force[0] - C[0] * force[2],
                    C[0] * force[1] - C[1] * force[0]},
               -1);
  const auto about_centre = [&](const Motor<>& P) -> Vector3<double> {
    return P.moment - centre.cross(P.resultant);
  };
  const double r = s.X.value.translation.norm();
  const double mass = c.inertia().value.mass;
  const double torque = 3 * earth * mass * size * size / (r * r * r);
  const double left = 20 * size * size / (r * r);
  const double rounding = mass * 10 * size * 1e-15;
  BOOST_TEST((about_centre(load(true)) - rounded(moment)).norm() < left * torque + rounding);
  BOOST_TEST((load(true).resultant - rounded(force)).norm() <
             left * torque / r + mass * 10 * 4e-16);
  BOOST_TEST((load(false).resultant - rounded(force)).norm() > 1e-3 * torque / r);
  BOOST_TEST(about_centre(load(false)).norm() < rounding);
}

// On a precessing orbit gravitation differs from the orbit's acceleration by some 1e-2 m/s^2, which
// the potential contains. Differences over 1 m are off by some u of 1.5 mu J2/r = 9e4 m^2/s^2, 1e-11.
BOOST_AUTO_TEST_CASE(potential_on_a_precessing_orbit) {
  const OrbitGravitation<> load(
      OrbitElements<>{.semi_major_axis = 7e6, .inclination = 1.2, .anomaly = 1, .j2 = j2}, false);
  const auto at = [](const Vector3<double>& place) {
    LoadContext<> s{.t = 100};
    s.X.value.translation = place;
    s.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
    return s;
  };
  const Vector3<double> d(300, -500, 800);
  const Vector3<double> force = load(at(d)).value.resultant;
  BOOST_TEST(force.norm() > 1e-3);
  for (int i = 0; i < 3; ++i) {
    const Vector3<double> h = Vector3<double>::Unit(i);
    const double slope = (load.potential(at(d + h)) - load.potential(at(d - h))) / 2;
    BOOST_TEST(std::abs(slope + force[i]) <= 1e-10);
  }
}

// Both terms come from one potential: even bodies as large as a fifth of the distance conserve
// energy and the angular momentum about the pole.
BOOST_DATA_TEST_CASE(keeps_energy_of_large_bodies, data::xrange(2), oblate) {
  const OblateGravitation<> load{.parameter = 1000,
                                 .radius = 3,
                                 .j2 = oblate ? 0.05 : 0.0,
                                 .centre = {1, 2, 3},
                                 .gradient = true};
  const FreeBody body(cloud(3, 2).inertia(), RestingFrame<>{}, load);
  typename decltype(body)::State start;
  start.position = {11, 3, 5};
  start.velocity.value = {{0.5, -1, 0.7}, {1, 8, 4}};
  const auto energy = [&](const auto& state) {
    const auto r = body.body_outputs(0, state);
    return r.kinetic_energy + r.potential_energy;
  };
  const auto momentum = [&](const auto& state) {
    const LoadContext<> s = body.situation(0, state);
    const Motor<> p = (s.X * (s.inertia * s.V_rel)).value.reduced_at({1, 2, 3});
    return p.moment;
  };
  const auto end = Integrator(body, 0, start).to(20);
  BOOST_TEST((end.position - start.position).norm() > 1);
  BOOST_TEST(near(energy(end), energy(start), std::abs(energy(start)), 2000));
  const Vector3<double> L = momentum(start);
  BOOST_TEST(near(momentum(end).z(), L.z(), L.norm(), 2000));
  if (!oblate) BOOST_TEST(near(momentum(end), L, L.norm(), 2000));
  const auto kept = body.conserved(0, start);
  BOOST_TEST(std::string(kept.front().first) == "energy");
}

BOOST_AUTO_TEST_CASE(has_no_direction_at_its_centre) {
  LoadContext<> s;
  s.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity());
  BOOST_CHECK_THROW((void)OblateGravitation<>{}(s), ComputationFailed);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(gravitation_on_an_orbit)

// The exact motion is the difference of two Kepler orbits, in 50 digits.
BOOST_DATA_TEST_CASE(moves_particles_as_two_orbits_do, data::xrange(6), k) {
  const OrbitElements<> orbit = k % 2 ? ellipse() : circle;
  const double size = k < 2 ? 1 : k < 4 ? 1000 : 1e-2;
  const OrbitAxes<> axes(orbit);
  const FreeBody particle(
      InertiaTensor<Body>::about_centre(1, {0, 0, 0}, Matrix3<double>::Identity()), axes,
      OrbitGravitation<>(orbit));
  typename decltype(particle)::State start;
  start.position = size * Vector3<double>(0.6, -0.5, 0.4);
  start.velocity.value.moment = 1e-3 * size * Vector3<double>(0.2, 0.5, -0.3);
  const double t = 6000;
  const auto end = Integrator(particle, 0, start).to(t);
  // Both orbits use the same numbers, so the guide's position and velocity need no further digits.
  const OrbitFrame<> frame(orbit);
  const auto now = frame(0.0);
  const auto then = frame(t);
  const Matrix3<double>& R = now.X.value.rotation;
  const Wide x = wide(now.X.value.translation);
  const Wide v = wide(R * now.V.value.moment);
  const Vector3<double> dx = R * start.position;
  const Vector3<double> dv =
      R * (start.velocity.value.moment + now.V.value.resultant.cross(start.position));
  const Wide other = kepler_place(sum(x, wide(dx)), sum(v, wide(dv)), t);
  const Vector3<double> apart = rounded(sum(other, kepler_place(x, v, t), -1));
  const Vector3<double> truth = then.X.value.rotation.transpose() * apart;
  BOOST_TEST((end.position - truth).norm() < 1e-12 * truth.norm());
}

// 3 mu/r^3 r x (I r) on the body's axes; the torque on a sphere is 0.
BOOST_DATA_TEST_CASE(turns_bodies_by_its_gradient, data::xrange(10u), seed) {
  test::Sample sample(seed);
  const Vector3<double> moments(10, 70, 75);
  LoadContext<> s;
  s.t = 100;
  s.guide = OrbitAxes<>(circle)(s.t);
  s.inertia = InertiaTensor<Body>::about_centre(100, {0, 0, 0}, moments.asDiagonal());
  s.X.value.rotation = sample.rotation();
  const Vector3<double> r = s.X.value.rotation.transpose() * Vector3<double>::UnitX();
  const double rate2 = earth / (7e6 * 7e6 * 7e6);
  const Vector3<double> torque = 3 * rate2 * r.cross(moments.cwiseProduct(r));
  BOOST_TEST(near(OrbitGravitation<>(circle)(s).value.moment, torque, 200 * rate2, 8));
  BOOST_TEST((OrbitGravitation<>(circle, false)(s).value.moment == Vector3<double>::Zero()));
}

// Jacobi's integral of a large satellite on a circle, rotation and position together.
BOOST_AUTO_TEST_CASE(keeps_jacobis_integral_on_a_circle) {
  const OrbitGravitation<> load(circle);
  const OrbitAxes<> axes(circle);
  const FreeBody body(cloud(5, 1e5).inertia(), axes, load);
  typename decltype(body)::State start;
  start.position = {3e4, 1e5, -2e4};
  start.velocity.value = {{1e-3, -2e-3, 1e-3}, {20, -10, 30}};
  const auto integral = [&](double t, const auto& state) {
    const LoadContext<> s = body.situation(t, state);
    const Velocity<Guide, Inertial, Guide> turning{
        {s.guide.V.value.resultant, Vector3<double>::Zero()}};
    const Motor<> u = (s.X.inverse() * turning).value;
    const Motor<>& V = s.V_rel.value;
    const Inertia<>& T = s.inertia.value;
    return (reciprocal(T * V, V) - reciprocal(T * u, u)) / 2 + load.potential(s);
  };
  const double H = integral(0, start);
  const auto end = Integrator(body, 0, start).to(10000);
  BOOST_TEST((end.position - start.position).norm() > 1e4);
  const LoadContext<> s = body.situation(0, start);
  const double size = reciprocal(s.inertia.value * s.V_rel.value, s.V_rel.value);
  BOOST_TEST(near(integral(10000, end), H, size, 4000));
}

// The orbit with mean rates is not in free fall, but bodies are: compared with the motion in space.
BOOST_DATA_TEST_CASE(moves_bodies_as_j2_does, data::xrange(2), k) {
  const OrbitElements<> orbit =
      k ? ellipse(j2)
        : OrbitElements<>{.semi_major_axis = 7e6, .inclination = 1.2, .anomaly = 1, .j2 = j2};
  const OrbitAxes<> axes(orbit);
  const InertiaTensor<Body> inertia = cloud(7, 10).inertia();
  const FreeBody on_orbit(inertia, axes, OrbitGravitation<>(orbit));
  const FreeBody in_space(inertia, RestingFrame<>{}, OblateGravitation<>{.gradient = true});
  typename decltype(on_orbit)::State start;
  start.position = {5, -30, 10};
  start.velocity.value = {{1e-3, 2e-3, -1e-3}, {0.1, 0.2, -0.1}};
  const OrbitFrame<> frame(orbit);
  const auto now = frame(0.0);
  typename decltype(in_space)::State from;
  from.attitude = Eigen::Quaterniond(now.X.value.rotation);
  from.position = now.X.point(start.position);
  const Motor<> carried = now.V.value.reduced_at(start.position);
  from.velocity.value = {start.velocity.value.resultant + carried.resultant,
                         start.velocity.value.moment + carried.moment};
  const double t = 3000;
  const auto a = Integrator(on_orbit, 0, start).to(t);
  const auto b = Integrator(in_space, 0, from).to(t);
  const auto then = frame(t);
  // In space each step rounds positions of 7e6 m to 1e-9 m: 1e-8 m and 6e-12 rad are measured.
  BOOST_TEST((then.X.point(a.position) - b.position).norm() < 5e-8);
  const Matrix3<double> turn = then.X.value.rotation * a.attitude.toRotationMatrix();
  BOOST_TEST((turn - b.attitude.toRotationMatrix()).norm() < 3e-11);
  // Without the field of J2 at the origin they would be kilometres apart.
  BOOST_TEST(a.position.norm() > 1000);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(a_satellite_on_a_circular_orbit)

namespace {

/// The greatest growth rate of small motions about the attitude of the orbit's axes, over n.
double growth(const Vector3<double>& moments) {
  BodyDescription body;
  body.name = "satellite";
  body.joint.kind = JointKind::spherical;
  body.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, moments.asDiagonal());
  body.loads = {OrbitGravitation<>(circle)};
  const BodySystem<OrbitAxes<>> system(OrbitAxes<>(circle), {body});
  const Eigen::VectorXd y = system.to_vector(system.rest());
  const auto linear = linearize<Guide, Body>(system, 0, y);
  return eigenvalues(linear.A).real().maxCoeff() / Orbit<>(circle).mean_motion();
}

/// k1 = (C - A)/B, k3 = (C - B)/A of the moments A along the radius, B along the velocity, C about
/// the orbit's normal. No result within rounding of a boundary.
///
/// Source : D. B. DeBra, R. H. Delp, Rigid Body Attitude Stability and Natural Frequencies in a
///          Circular Orbit, J. Astronaut. Sci. 8 (1961)
std::optional<bool> is_stable(double k1, double k3) {
  const double pitch = k1 - k3;
  const double product = k1 * k3;
  const double sum = 1 + 3 * k1 + product;
  const double discriminant = sum * sum - 16 * product;
  if (std::min({std::abs(pitch), std::abs(product), std::abs(discriminant)}) < 1e-9) return {};
  return pitch > 0 && product > 0 && sum > 0 && discriminant > 0;
}

}  // namespace

// The map of DeBra and Delp; KREISEL_GRID = 101 makes it finer.
BOOST_AUTO_TEST_CASE(is_stable_where_debra_and_delp_say) {
  const char* const asked = std::getenv("KREISEL_GRID");
  const int n = asked ? std::atoi(asked) : 32;
  int wrong = 0, judged = 0, stable = 0;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const double k1 = -1 + 2 * (i + 0.5) / n;
      const double k3 = -1 + 2 * (k + 0.47) / n;
      const auto expected = is_stable(k1, k3);
      if (!expected) continue;
      const double A = (1 - k1) / (1 - k3);
      const bool found = growth({A, 1, k1 + A}) < 1e-6;
      ++judged;
      stable += *expected ? 1 : 0;
      wrong += found != *expected ? 1 : 0;
    }
  }
  BOOST_TEST(wrong == 0);
  BOOST_TEST(judged > n * n * 99 / 100);
  BOOST_TEST(stable > n * n / 8);
  BOOST_TEST_MESSAGE(judged << " of " << n * n << " points judged, " << stable << " stable, "
                            << wrong << " wrong");
}

// The frequency n sqrt(3 (B - A)/C) in the plane of the orbit, from the roots and from the motion.
BOOST_AUTO_TEST_CASE(swings_at_its_frequency) {
  const Vector3<double> moments(10, 75, 80);
  const double n = Orbit<>(circle).mean_motion();
  const double frequency = n * std::sqrt(3 * 65 / 80.0);
  BodyDescription body;
  body.name = "satellite";
  body.joint.kind = JointKind::spherical;
  body.inertia = InertiaTensor<Body>::about_centre(1, {0, 0, 0}, moments.asDiagonal());
  body.loads = {OrbitGravitation<>(circle)};
  const BodySystem<OrbitAxes<>> system(OrbitAxes<>(circle), {body});
  auto start = system.rest();
  const auto linear = linearize<Guide, Body>(system, 0, system.to_vector(start));
  double off = 1;
  for (const auto& root : eigenvalues(linear.A)) {
    off = std::min(off, std::abs(root.imag() - frequency) + std::abs(root.real()));
  }
  BOOST_TEST(off < 1e-13 * n);
  const double amplitude = 1e-5;
  start.coordinates.head<4>() << 0, 0, std::sin(amplitude / 2), std::cos(amplitude / 2);
  const double t = 10000;
  SolveOptions options;
  options.output_times = {t};
  options.tolerance = 1e-12;
  const auto run = solve(system, start, options);
  const auto& q = run.states.back().coordinates;
  const double angle = 2 * std::atan2(q[2], q[3]);
  // A pendulum's period grows by amplitude^2/4 (the angle counts twice).
  BOOST_TEST(std::abs(angle - amplitude * std::cos(frequency * t)) <
             20 * amplitude * amplitude * amplitude + 2e-12);
}

BOOST_AUTO_TEST_SUITE_END()
