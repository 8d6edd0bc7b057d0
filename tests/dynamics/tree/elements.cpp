// Forces between bodies and between joints, against closed forms, eigenvalue problems set up by
// hand, differences, and the balance of each body.

#include <Eigen/Core>
#include <Eigen/LU>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/tree/body_system.hpp>
#include <motor/error.hpp>

#include <support/random_tree.hpp>
#include <support/sample.hpp>
#include <support/series.hpp>

using namespace kreisel;
using test::Sample;
namespace data = boost::unit_test::data;

namespace {

using Resting = BodySystem<RestingFrame<>>;
using Vector = Vector3<double>;
using Matrix = Matrix3<double>;
const Gravity weightless = {};

BodyDescription described(const std::string& name, const Joint& joint, double mass = 2) {
  BodyDescription b;
  b.name = name;
  b.joint = joint;
  b.inertia = InertiaTensor<Body>::about_centre(
      mass, {0, 0, 0}, Vector(0.2, 0.25, 0.3).asDiagonal().toDenseMatrix());
  return b;
}

BodyDescription slider(const std::string& name, double mass) {
  return described(name, {.kind = JointKind::prismatic, .axis = {1, 0, 0}}, mass);
}

BodyDescription wheel(const std::string& name) {
  return described(name, {.kind = JointKind::revolute, .axis = {0, 0, 1}});
}

BodyDescription floating(const std::string& name, Sample& sample) {
  BodyDescription b;
  b.name = name;
  b.joint = {.kind = JointKind::free};
  b.inertia = test::random_inertia(sample);
  return b;
}

Matrix random_matrix(Sample& sample, double size) {
  Matrix result;
  for (double& x : result.reshaped()) x = sample.uniform(-size, size);
  return result;
}

/// A mount with a positive definite stiffness of these sizes, in general axes.
MountElement random_mount(Sample& sample, const ElementEnd& first, const ElementEnd& second,
                          bool is_symmetric) {
  MountElement mount{"mount", {first, second}, Eigen::Quaterniond(sample.rotation())};
  const auto definite = [&](double size) -> Matrix {
    const Matrix a = random_matrix(sample, size);
    return a * a.transpose() / size + size * Matrix::Identity();
  };
  mount.stiffness.rm = definite(200);
  mount.stiffness.mr = definite(50);
  mount.stiffness.rr = random_matrix(sample, 20);
  mount.stiffness.mm = mount.stiffness.rr.transpose();
  if (is_symmetric) return mount;
  mount.stiffness.rm += skew(Vector(60, -30, 20));
  mount.stiffness.mm += random_matrix(sample, 10);
  mount.damping.rm = definite(2);
  mount.damping.mr = definite(1);
  return mount;
}

/// Two free bodies with a mount and a spring between them, in general motion.
struct Pair {
  explicit Pair(bool is_symmetric) : Pair(is_symmetric, Sample(5)) {}

  Resting system;
  Resting::State start;

 private:
  Pair(bool is_symmetric, Sample sample)
      : system(RestingFrame<>{}, {floating("a", sample), floating("b", sample)}, weightless,
               {random_mount(sample, {"a", {0.1, 0.2, 0}}, {"b", {0, -0.2, 0.1}}, is_symmetric),
                SpringElement{.name = "spring",
                              .ends = {{{"b", {0.5, 0, 0}}, {"a", {0, 0, 0.7}}}},
                              .stiffness = 30,
                              .length = 0.4}}),
        start(system.rest()) {
    for (double& x : start.rates) x = sample.uniform(-1, 1);
    start.coordinates.segment<4>(0) = Eigen::Quaterniond(sample.rotation()).coeffs();
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.5, sample.direction()));
    const Eigen::Quaterniond a(start.coordinates.head<4>().eval());
    start.coordinates.segment<4>(7) = (a * turn).coeffs();
  }
};

/// The value of an invariant, or nothing.
std::optional<double> invariant(const Resting& system, const Resting::State& state,
                                const std::string& name) {
  for (const auto& [own, value] : system.conserved(0, state)) {
    if (own == name) return value;
  }
  return std::nullopt;
}

/// A random tree whose joints rotate no body by more than a third of pi at rest, because mounts are
/// for turns below 3 rad.
std::vector<BodyDescription> mild_tree(std::uint64_t seed) {
  std::vector<BodyDescription> bodies = test::random_tree(seed);
  for (BodyDescription& b : bodies) {
    b.joint.orientation = Eigen::Quaterniond::Identity().slerp(1.0 / 3, b.joint.orientation);
  }
  return bodies;
}

/// Random elements of all kinds between bodies that are not rotors.
std::vector<Element> random_elements(Sample& sample, const std::vector<BodyDescription>& bodies) {
  std::vector<std::string> names;
  std::vector<std::string> single;
  for (const BodyDescription& b : bodies) {
    if (b.rotor) continue;
    names.push_back(b.name);
    if (joint_type(b.joint.kind).rate_count() == 1) single.push_back(b.name);
  }
  const auto end = [&](const std::string& name) {
    return ElementEnd{name, 0.4 * sample.direction()};
  };
  std::vector<Element> elements{random_mount(sample, end(names[0]), end(names[1]), false)};
  elements.emplace_back(SpringElement{.name = "spring",
                                      .ends = {end("guide"), end(names.back())},
                                      .stiffness = 20,
                                      .length = 0.3,
                                      .damping = 0.5});
  if (single.size() > 1) {
    elements.emplace_back(CouplingElement{"coupling", {single[0], single[1]}, -1.7, 3, 0.2});
  }
  return elements;
}

template <class M>
Eigen::VectorXd random_state(const BodySystem<M>& system, std::uint64_t seed) {
  Sample sample(seed + 1000);
  Eigen::VectorXd y = system.to_vector(system.rest());
  for (double& x : y) x += sample.uniform(-0.3, 0.3);
  return y;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(elements)

// Reduced mass mu: x = a exp(-delta t) cos(w t), w^2 = k/mu - delta^2, delta = d/(2 mu).
BOOST_DATA_TEST_CASE(two_masses_on_a_spring, data::make({0.0, 0.4}), damping) {
  const double m1 = 2, m2 = 3, k = 50, length = 0.7;
  const double mu = 1 / (1 / m1 + 1 / m2);
  const Resting system(RestingFrame<>{}, {slider("a", m1), slider("b", m2)}, weightless,
                       {SpringElement{"spring", {{{"a"}, {"b"}}}, k, length, damping}});
  Resting::State start = system.rest();
  start.coordinates[1] = length + 0.1;
  const double delta = damping / (2 * mu);
  const double w = std::sqrt(k / mu - delta * delta);
  start.rates[1] = -delta * 0.1;
  const auto run = solve(system, start, {.output_times = {0.5, 3}, .tolerance = 1e-12});
  BOOST_TEST(run.report.tolerance_kept);
  for (std::size_t i = 0; i < 2; ++i) {
    const double t = run.times[i];
    const double stretch = run.states[i].coordinates[1] - run.states[i].coordinates[0] - length;
    BOOST_TEST(std::abs(stretch - 0.1 * std::exp(-delta * t) * std::cos(w * t)) <= 2e-12);
  }
  BOOST_TEST(invariant(system, start, "energy").has_value() == (damping == 0));
  BOOST_TEST(system.may_be_stiff());
  BOOST_TEST(!system.knows_series());
}

BOOST_AUTO_TEST_CASE(a_table_is_a_polyline_of_the_pull) {
  const SpringElement spring{
      .name = "s", .damping = 2, .table = {{1, -10}, {2, 0}, {3, 30}, {4, 40}}};
  const double lengths[] = {0.5, 1, 1.5, 2.5, 3, 3.5, 6};
  const double pulls[] = {-15, -10, -5, 15, 30, 35, 60};
  double energy = spring.potential({.reach = {0, 0.5, 0}});
  for (std::size_t i = 0; i < 7; ++i) {
    const ElementMotion<> m{.reach = {0, lengths[i], 0}, .velocity = {3, 0.5, 0}};
    BOOST_TEST(spring.force(m).resultant == Vector(0, -pulls[i] - 1, 0));
    BOOST_TEST(spring.force(m).moment == Vector(0, 0, 0));
  }
  for (double x = 0.5; x < 6; x += 0.125) {  // Simpson's rule is exact within a piece.
    const double work =
        0.125 / 6 * (spring.pull(x) + 4 * spring.pull(x + 0.0625) + spring.pull(x + 0.125));
    energy += work;
    BOOST_TEST(std::abs(spring.potential({.reach = {x + 0.125, 0, 0}}) - energy) <= 1e-12);
  }
}

// A mass falls 0.3 m, is caught by a rope, and is thrown up again as fast as it came.
BOOST_AUTO_TEST_CASE(a_rope_catches_and_throws) {
  const double g = 10, m = 2, k = 800, length = 0.5, start_at = -0.2;
  BodyDescription mass = slider("a", m);
  mass.joint.axis = {0, 0, 1};
  const RopeElement rope{
      .name = "r", .ends = {{{"guide"}, {"a"}}}, .stiffness = k, .length = length};
  const Resting system(RestingFrame<>{}, {mass}, UniformGravity<Guide>{{0, 0, -g}}, {rope});
  Resting::State start = system.rest();
  start.coordinates[0] = start_at;
  const double falls = std::sqrt(2 * (length + start_at) / g);
  const double v = g * falls;
  const double w = std::sqrt(k / m);
  const double sag = m * g / k;
  // s = sag (1 - cos w t) + (v/w) sin w t is the stretch, 0 again at pi + 2 atan(sag w/v) over w.
  const double held = (std::numbers::pi + 2 * std::atan(sag * w / v)) / w;
  const double taut = falls + 0.4 * held;
  const double free = falls + held + 0.2;
  const auto run = solve(system, start, {.output_times = {taut, free}, .tolerance = 1e-11});
  BOOST_TEST(run.report.tolerance_kept);
  const double s = sag * (1 - std::cos(0.4 * w * held)) + v / w * std::sin(0.4 * w * held);
  BOOST_TEST(std::abs(run.states[0].coordinates[0] + length + s) <= 1e-10);
  const double up = -length + v * 0.2 - g * 0.02;
  BOOST_TEST(std::abs(run.states[1].coordinates[0] - up) <= 1e-10);
  BOOST_TEST(invariant(system, start, "energy").has_value());
  BOOST_TEST(!has_potential(RopeElement{.length = Signal<double>(1, -0.1, {})}));
}

// A winch tightens a rope for a moment, by 0.1 to 0.5 mm, and pulls a sled that rests. Without a
// look at corners steps of seconds pass over it.
BOOST_AUTO_TEST_CASE(a_winch_pulls_a_sled_at_rest) {
  const double m = 2, k = 500, w = 0.7, l = 1.1;
  for (const double shortened : {0.1005, 0.1001}) {
    const RopeElement rope{.name = "r",
                           .ends = {{{"guide"}, {"a"}}},
                           .stiffness = k,
                           .length = Signal<double>(l, 0, {{-shortened, w, 0}})};
    const Resting system(RestingFrame<>{}, {slider("a", m)}, {}, {rope});
    Resting::State start = system.rest();
    start.coordinates[0] = 1;
    // x'' = -W^2 (x - length) from the time at which the rope becomes taut.
    const double W = std::sqrt(k / m);
    const double taut = std::asin((l - 1) / shortened) / w;
    const double forced = shortened * W * W / (W * W - w * w);
    const double a = 1 - l + forced * std::sin(w * taut);
    const double b = forced * w * std::cos(w * taut) / W;
    const auto x = [&](double t) {
      const double angle = W * (t - taut);
      return l - forced * std::sin(w * t) + a * std::cos(angle) + b * std::sin(angle);
    };
    const auto stretch = [&](double t) { return x(t) - l + shortened * std::sin(w * t); };
    double held = taut + 0.01;
    double slack = taut + 0.2;
    while (slack - held > 1e-15 * slack) {
      const double middle = (held + slack) / 2;
      if (middle <= held || middle >= slack) break;
      (stretch(middle) > 0 ? held : slack) = middle;
    }
    const double thrown = -forced * w * std::cos(w * slack) +
                          W * (b * std::cos(W * (slack - taut)) - a * std::sin(W * (slack - taut)));
    for (const double end : {6.0, 100.0}) {
      const double right = x(slack) + thrown * (end - slack);
      for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
        const auto run =
            solve(system, start, {.output_times = {end}, .tolerance = 1e-8, .method = method});
        BOOST_TEST_CONTEXT(shortened << ", " << end << ", " << name(method)) {
          // After the pull it is rounding for a flight of 98 s.
          BOOST_TEST(run.report.error_estimate <= 1e-7);
          BOOST_TEST(std::abs(run.states[0].coordinates[0] - right) <=
                     1.1 * run.report.error_estimate + 1e-12);
        }
      }
    }
  }
}

// A sled flies for 4.8 s to a stop of a tenth of a metre, and comes back. Steps that see no force
// before the stop would end far behind it.
BOOST_AUTO_TEST_CASE(a_stop_throws_a_sled_back) {
  const double m = 2, k = 1000, length = 0.2, v = 1, from = 5;
  const SpringElement stop{.name = "s",
                           .ends = {{{"guide"}, {"a"}}},
                           .table = {{length - 0.1, -0.1 * k}, {length, 0}, {1, 0}}};
  const Resting system(RestingFrame<>{}, {slider("a", m)}, {}, {stop});
  Resting::State start = system.rest();
  start.coordinates[0] = from;
  start.rates[0] = -v;
  const double leaves = (from - length) / v + std::numbers::pi / std::sqrt(k / m);
  for (const double end : {10.0, 40.0, 1000.0}) {
    for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
      const auto run =
          solve(system, start, {.output_times = {end}, .tolerance = 1e-9, .method = method});
      BOOST_TEST_CONTEXT(end << ", " << name(method)) {
        BOOST_TEST(run.report.tolerance_kept);
        const double right = length + v * (end - leaves);
        BOOST_TEST(std::abs(run.states[0].coordinates[0] - right) <=
                   1.1 * right * run.report.error_estimate + 1e-12);
      }
    }
  }
}

// A mass m falls into a rope with damping. From there it is a damped oscillation about the sag, until
// the pull k s + c s' = -m (s'' - g) ends, while the rope is still stretched. Then the mass flies. The
// pull ends at the first zero of s'' - g, where it falls.
BOOST_AUTO_TEST_CASE(a_damped_rope_lets_go_before_it_is_slack) {
  const long double g = 9.81L, m = 1, k = 1000, c = 20, length = 1, start_at = -0.5L;
  BodyDescription mass = slider("a", double(m));
  mass.joint.axis = {0, 0, 1};
  const RopeElement rope{.name = "r",
                         .ends = {{{"guide"}, {"a"}}},
                         .stiffness = double(k),
                         .length = double(length),
                         .damping = double(c)};
  const Resting system(RestingFrame<>{}, {mass}, UniformGravity<Guide>{{0, 0, -9.81}}, {rope});
  Resting::State start = system.rest();
  start.coordinates[0] = double(start_at);
  const long double falls = std::sqrt(2 * (length + start_at) / g), v = g * falls;
  const long double d = c / (2 * m), w = std::sqrt(k / m - d * d), sag = m * g / k;
  const long double b = (v - d * sag) / w;  // s = sag + exp(-d t) (b sin w t - sag cos w t)
  const auto stretch = [&](long double t) {
    return sag + std::exp(-d * t) * (b * std::sin(w * t) - sag * std::cos(w * t));
  };
  const auto rate = [&](long double t) {
    return std::exp(-d * t) *
           ((b * w + d * sag) * std::cos(w * t) + (sag * w - d * b) * std::sin(w * t));
  };
  long double held = 0.5L / w;
  long double free = 3.14L / w;
  while (free - held > 1e-18L) {
    const long double middle = (held + free) / 2;
    (k * stretch(middle) + c * rate(middle) > 0 ? held : free) = middle;
  }
  BOOST_TEST(stretch(free) > 0.01L);
  const auto place = [&](long double t) {
    if (t <= falls) return start_at - g * t * t / 2;
    if (t <= falls + free) return -length - stretch(t - falls);
    const long double flies = t - falls - free;
    return -length - stretch(free) - rate(free) * flies - g * flies * flies / 2;
  };
  for (const double tolerance : {1e-6, 1e-10, 1e-12}) {
    for (const Method method : {Method::automatic, Method::verner98, Method::radau13}) {
      const auto run =
          solve(system, start,
                {.output_times = {0.33, 0.36, 0.55}, .tolerance = tolerance, .method = method});
      BOOST_TEST_CONTEXT(tolerance << ", " << name(method)) {
        BOOST_TEST(run.report.tolerance_kept);
        BOOST_TEST(run.report.all_evaluations <= 20000);
        for (std::size_t i = 0; i < run.times.size(); ++i) {
          const auto off = double(run.states[i].coordinates[0] - place(run.times[i]));
          BOOST_TEST(std::abs(off) <= 1.1 * run.report.error_estimate + 1e-15);
        }
      }
    }
  }
}

// A damper alone never makes a rope push.
BOOST_AUTO_TEST_CASE(a_rope_never_pushes) {
  const RopeElement rope{.name = "r", .stiffness = 10, .length = 1, .damping = 3};
  const auto force = [&rope](double reach, double rate) {
    return rope.force(ElementMotion<>{.reach = {reach, 0, 0}, .velocity = {rate, 0, 0}})
        .resultant.x();
  };
  BOOST_TEST(force(0.9, 5) == 0);
  BOOST_TEST(force(0, 0) == 0);
  BOOST_TEST(std::abs(force(1.5, 2) + 11) <= 1e-14);
  BOOST_TEST(force(1.5, -2) == 0);
}

BOOST_AUTO_TEST_CASE(ends_that_meet) {
  const ElementMotion<> m{.velocity = {0, 0, 2}};
  const SpringElement bare{.name = "s", .stiffness = 3, .damping = 0.5};
  BOOST_TEST(bare.force(m).resultant == Vector(0, 0, -1));
  SpringElement long_one = bare;
  long_one.length = 0.1;
  BOOST_CHECK_THROW((void)long_one.force(m), ComputationFailed);
}

// M x'' = -K x for the six displacements of the centre of mass. The displacement at the mount is
// x + theta x p.
BOOST_DATA_TEST_CASE(six_modes_of_an_engine, data::make({true, false}), is_symmetric) {
  Sample sample(3);
  const Vector p(0.1, -0.3, 0.2);
  BodyDescription block = floating("block", sample);
  MountElement mount = random_mount(sample, {"guide", p}, {"block", p}, is_symmetric);
  mount.damping = {};
  const Resting system(RestingFrame<>{}, {block}, weightless, {mount});
  const auto A = linearize<Guide, Guide>(system, 0, system.to_vector(system.rest())).A;
  Eigen::VectorXcd squares = eigenvalues(A);
  for (auto& root : squares) root *= root;

  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Inertia<>& T = block.inertia.value;
  const Vector centre = T.first_moment / T.mass;
  const Matrix arm = skew(Vector(p - centre));
  Matrix6 K, M = Matrix6::Zero(), at_mount = Matrix6::Identity(), turn = Matrix6::Zero();
  K << mount.stiffness.rm, mount.stiffness.rr, mount.stiffness.mm, mount.stiffness.mr;
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = mount.axes.toRotationMatrix();
  at_mount.topRightCorner<3, 3>() = -arm;
  K = at_mount.transpose() * turn * K * turn.transpose() * at_mount;
  M.topLeftCorner<3, 3>() = T.mass * Matrix::Identity();
  M.bottomRightCorner<3, 3>() =
      T.tensor.matrix() + T.mass * skew(centre) * skew(centre);  // about the centre
  const Eigen::VectorXcd expected = eigenvalues(-M.inverse() * K);
  const double greatest = expected.cwiseAbs().maxCoeff();
  for (const std::complex<double>& root : expected) {
    const Eigen::ArrayXd off = (squares.array() - root).abs();
    BOOST_TEST((off <= 1e-11 * greatest).count() == 2);
  }
  BOOST_TEST(invariant(system, system.rest(), "energy").has_value() == is_symmetric);
}

// The bodies are rotated by up to 2 rad relative to each other.
BOOST_DATA_TEST_CASE(free_bodies_keep_their_momenta, data::make({true, false}), is_symmetric) {
  const Pair pair(is_symmetric);
  const auto before = pair.system.conserved(0, pair.start);
  BOOST_TEST(before.size() == (is_symmetric ? 7U : 6U));
  Integrator run(pair.system, 0, pair.start, {.relative = 1e-12});
  for (const double t : {0.1, 0.3, 0.6}) {
    const auto now = pair.system.conserved(t, run.to(t));
    for (std::size_t i = 0; i < now.size(); ++i) {
      BOOST_TEST(std::abs(now[i].second - before[i].second) <= 1e-9 * 300, now[i].first);
    }
  }
}

BOOST_AUTO_TEST_CASE(claims_no_invariant_that_elements_break) {
  Sample sample(8);
  const BodyDescription a = floating("a", sample);
  const SpringElement to_guide{
      .name = "s", .ends = {{{"guide"}, {"a", {1, 0, 0}}}}, .stiffness = 1};
  const Resting held(RestingFrame<>{}, {a}, weightless, {to_guide});
  BOOST_TEST(held.conserved(0, held.rest()).size() == 1U);
  const SpringElement to_slider{
      .name = "s", .ends = {{{"slider"}, {"a", {1, 0, 0}}}}, .stiffness = 1};
  const Resting mixed(RestingFrame<>{}, {a, slider("slider", 1)}, weightless, {to_slider});
  BOOST_TEST(mixed.conserved(0, mixed.rest()).size() == 1U);
  const CouplingElement coupling{"c", {"p", "q"}, 2, 3, 0};
  const Resting wheels(RestingFrame<>{}, {wheel("p"), wheel("q")}, weightless, {coupling});
  BOOST_TEST(wheels.conserved(0, wheels.rest()).size() == 1U);
  const Resting apart(RestingFrame<>{}, {wheel("p"), wheel("q")});
  BOOST_TEST(apart.conserved(0, apart.rest()).size() == 3U);
}

// The force depends on the relative motion alone, on the axes of the first body.
BOOST_AUTO_TEST_CASE(the_carrying_body_may_turn_at_will) {
  Pair pair(false);
  BodyWorkspace w = pair.system.workspace();
  std::vector<Motor<>> here, there;
  pair.start.rates.setZero();
  pair.system.element_forces(0, pair.system.to_vector(pair.start), here, w);
  const Eigen::Quaterniond turn(Sample(11).rotation());
  for (const int at : {0, 7}) {
    const Eigen::Quaterniond q(pair.start.coordinates.segment<4>(at).eval());
    pair.start.coordinates.segment<4>(at) = (turn * q).coeffs();
    pair.start.coordinates.segment<3>(at + 4) =
        turn * Vector(pair.start.coordinates.segment<3>(at + 4));
  }
  pair.system.element_forces(0, pair.system.to_vector(pair.start), there, w);
  for (std::size_t k = 0; k < 2; ++k) {
    BOOST_TEST((here[k].resultant - there[k].resultant).norm() <= 1e-12);
    BOOST_TEST((here[k].moment - there[k].moment).norm() <= 1e-12);
  }
}

BOOST_AUTO_TEST_CASE(a_mount_is_for_turns_below_3_rad) {
  MountElement mount{.name = "m"};
  mount.stiffness.mr = Matrix::Identity();
  const auto turned = [](double angle) {
    return ElementMotion<>{.turn = Eigen::AngleAxisd(angle, Vector::UnitY()).toRotationMatrix()};
  };
  BOOST_TEST((mount.force(turned(2.99)).moment - Vector(0, -2.99, 0)).norm() <= 1e-14);
  BOOST_CHECK_THROW((void)mount.force(turned(3.01)), ComputationFailed);
  mount.stiffness = {.rm = Matrix::Identity()};
  BOOST_TEST(mount.force(turned(3.01)).moment.norm() == 0);
}

// The elastic force is minus the derivative of the potential, also for large turns.
BOOST_AUTO_TEST_CASE(a_symmetric_mount_has_a_potential) {
  Sample sample(2);
  MountElement mount = random_mount(sample, {}, {}, true);
  mount.preload = {{3, -4, 5}, {2, 1, -6}};
  for (const double angle : {0.0, 1e-9, 0.05, 0.0999, 0.1001, 1.3, 2.9}) {
    const Matrix turn = Eigen::AngleAxisd(angle, sample.direction()).toRotationMatrix();
    const Vector reach = sample.direction();
    const Motor<> force = mount.force(ElementMotion<>{.reach = reach, .turn = turn});
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-3;
      const auto work = [&](double step, bool rotates) {
        const Vector way = step * Vector::Unit(k);
        const Matrix by = Eigen::AngleAxisd(step, Vector::Unit(k)).toRotationMatrix();
        return rotates ? mount.potential({.reach = reach, .turn = by * turn})
                       : mount.potential({.reach = reach + way, .turn = turn});
      };
      for (const bool rotates : {false, true}) {
        const auto slope = [&](double step) {
          return (work(step, rotates) - work(-step, rotates)) / (2 * step);
        };
        const double expected = -(4 * slope(h) - slope(2 * h)) / 3;
        const double found = rotates ? force.moment[k] : force.resultant[k];
        BOOST_TEST(std::abs(found - expected) <= 1e-7, angle << ", " << k << ", " << rotates);
      }
    }
  }
}

// Two wheels: w^2 = k (1/I + ratio^2/I).
BOOST_AUTO_TEST_CASE(a_gear_between_two_wheels) {
  const double ratio = -2.5, k = 7, I = 0.3;
  const Resting system(RestingFrame<>{}, {wheel("a"), wheel("b")}, weightless,
                       {CouplingElement{"gear", {"a", "b"}, ratio, k, 0}});
  Resting::State start = system.rest();
  start.coordinates[0] = 0.4;
  const double w = std::sqrt(k * (1 + ratio * ratio) / I);
  BOOST_TEST_REQUIRE(system.knows_series());
  for (const Method method : {Method::taylor, Method::verner98}) {
    const auto run =
        solve(system, start, {.output_times = {2}, .tolerance = 1e-12, .method = method});
    const auto& q = run.states[0].coordinates;
    BOOST_TEST(std::abs(q[0] - ratio * q[1] - 0.4 * std::cos(2 * w)) <= 2e-12);
  }
  std::vector<Motor<>> forces;
  BodyWorkspace workspace = system.workspace();
  system.element_forces(0, system.to_vector(start), forces, workspace);
  const Vector on_b(0, 0, ratio * k * 0.4);
  BOOST_TEST((forces[0].moment - Eigen::AngleAxisd(-0.4, Vector::UnitZ()) * on_b).norm() <= 1e-15);
}

BOOST_DATA_TEST_CASE(couplings_have_their_series, data::xrange(40), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto bodies = test::random_tree(number);
  Sample sample(number);
  auto elements = random_elements(sample, bodies);
  if (elements.size() < 3) return;
  const BodySystem system(RotatingFrame<>{{0.3, -0.8, 0.5}, {1, 2, 3}}, bodies, weightless,
                          {elements.back()});
  test::hold_series("coupled", system, random_state(system, number), 0.05, 1e-13);
}

// Differences of fourth order with steps of 1e-3 have errors of some 1e-9.
BOOST_DATA_TEST_CASE(dual_numbers_against_differences, data::xrange(40), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  const auto bodies = mild_tree(number);
  Sample sample(number);
  const BodySystem system(RotatingFrame<>{{0.3, -0.8, 0.5}, {1, 2, 3}}, bodies,
                          UniformGravity<Guide>{{0, 0, -9.81}}, random_elements(sample, bodies));
  const Eigen::VectorXd y = random_state(system, number);
  using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
  const Eigen::VectorXd way =
      Eigen::VectorXd::NullaryExpr(y.size(), [&] { return sample.uniform(-1, 1); });
  Eigen::Matrix<Dual, Eigen::Dynamic, 1> along(y.size());
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    along[i].value() = y[i];
    along[i].derivatives()[0] = way[i];
  }
  const auto found = system.rates(0.2, along);
  const auto slope = [&](double h) -> Eigen::VectorXd {
    return (system.rates(0.2, Eigen::VectorXd(y + h * way)) -
            system.rates(0.2, Eigen::VectorXd(y - h * way))) /
           (2 * h);
  };
  const Eigen::VectorXd expected = (4 * slope(5e-4) - slope(1e-3)) / 3;
  const double size = expected.norm();
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    BOOST_TEST(std::abs(found[i].derivatives()[0] - expected[i]) <= 2e-8 * size, i);
  }
}

// Newton and Euler for each body. The terms of its motion are the reactions of its joints and the
// forces of the elements at their ends.
BOOST_DATA_TEST_CASE(reactions_balance_every_body, data::xrange(40), seed) {
  const auto number = static_cast<std::uint64_t>(seed);
  auto bodies = mild_tree(number);
  std::erase_if(bodies, [](const BodyDescription& b) { return b.rotor.has_value(); });
  Sample sample(number);
  const auto all = random_elements(sample, bodies);
  const std::vector<Element> elements(all.begin(), all.begin() + 2);
  const BodySystem system(RotatingFrame<>{{0.3, -0.8, 0.5}, {1, 2, 3}}, bodies, weightless, all);
  const Eigen::VectorXd y = random_state(system, number);
  BodyWorkspace w = system.workspace();
  JointReactions reactions;
  std::vector<Motor<>> forces;
  std::vector<ReactionParts> parts;
  system.reactions(0.2, y, reactions, w);
  system.reaction_parts(0.2, y, parts, w);
  system.element_forces(0.2, y, forces, w);
  std::vector<Motor<>> sum(bodies.size());  // about the guide's origin, on its axes
  const auto pose = [&](int body) {
    return body < 0 ? Pose<>{} : system.situation(0.2, y, body, w).X.value;
  };
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Motor<> P = pose(int(i)) * reactions.on_body[i].value;
    sum[i] += P;
    if (bodies[i].parent != "guide") sum[std::size_t(system.tree().index(bodies[i].parent))] -= P;
    const Motor<> off = parts[i].total().value - reactions.on_body[i].value;
    BOOST_TEST(off.resultant.norm() + off.moment.norm() <= 1e-9);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const ElementPlace& place = system.tree().element_places()[k];
    const auto& ends =
        k == 0 ? std::get<MountElement>(all[0]).ends : std::get<SpringElement>(all[1]).ends;
    const Pose<> first = pose(place.body[0]);
    const Vector end = pose(place.body[1]).point(ends[1].at);
    const Motor<> P = Pose<>{first.rotation, end} * forces[k];
    if (place.body[0] >= 0) sum[std::size_t(place.body[0])] -= P;
    sum[std::size_t(place.body[1])] += P;
    if (k == 0) continue;
    const Vector reach = end - first.point(ends[0].at);
    BOOST_TEST(P.resultant.cross(reach).norm() <= 1e-12);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Motor<> motion = pose(int(i)) * system.terms(0.2, y, int(i), w).total().value;
    BOOST_TEST((motion - sum[i]).resultant.norm() <= 1e-9, i);
    BOOST_TEST((motion - sum[i]).moment.norm() <= 1e-9, i);
  }
}

BOOST_AUTO_TEST_CASE(a_locked_joint_counts_as_at_rest) {
  BodyDescription locked = wheel("b");
  locked.rule = JointRule::held;
  const Resting system(RestingFrame<>{}, {wheel("a"), locked}, weightless,
                       {CouplingElement{"c", {"a", "b"}, 1, 3, 2}});
  Resting::State state = system.rest();
  state.coordinates << 0.5, 0.2;
  state.rates << 1, 9;
  const Eigen::VectorXd rate = system.rates(0, system.to_vector(state));
  BOOST_TEST(std::abs(rate[2] + (3 * 0.3 + 2 * 1) / 0.3) <= 1e-14);
}

BOOST_AUTO_TEST_CASE(refuses_what_is_no_element) {
  Sample sample(1);
  BodyDescription rotor = wheel("rotor");
  rotor.inertia = InertiaTensor<Body>::about_centre(
      1, {0, 0, 0}, Vector(0.2, 0.2, 0.3).asDiagonal().toDenseMatrix());
  rotor.rotor = Rotor{};
  const std::vector<BodyDescription> bodies{wheel("a"), wheel("b"), floating("c", sample), rotor};
  const double nan = std::nan("");
  const SpringElement s{.name = "s", .ends = {{{"a"}, {"b", {1, 0, 0}}}}, .stiffness = 1};
  const CouplingElement c{"c", {"a", "b"}, 1, 1, 0};
  const auto spring = [s](const std::function<void(SpringElement&)>& change) {
    SpringElement changed = s;
    change(changed);
    return std::vector<Element>{changed};
  };
  const auto rope = [](const std::function<void(RopeElement&)>& change) {
    RopeElement changed{
        .name = "r", .ends = {{{"a"}, {"b", {1, 0, 0}}}}, .stiffness = 1, .length = 2};
    change(changed);
    return std::vector<Element>{changed};
  };
  const auto coupling = [c](const std::function<void(CouplingElement&)>& change) {
    CouplingElement changed = c;
    change(changed);
    return std::vector<Element>{changed};
  };
  const auto mount = [](const std::function<void(MountElement&)>& change) {
    MountElement changed{.name = "m", .ends = {{{"a"}, {"b"}}}};
    changed.stiffness.rm.setIdentity();
    change(changed);
    return std::vector<Element>{changed};
  };
  const std::pair<std::vector<Element>, const char*> cases[] = {
      {spring([](auto& e) { e.name = ""; }), "needs a name"},
      {{s, s}, "used twice"},
      {spring([](auto& e) { e.ends[1].body = "x"; }), "'x' does not exist"},
      {spring([](auto& e) { e.ends[1].body = "a"; }), "both of its ends"},
      {spring([](auto& e) { e.ends[1].body = "rotor"; }), "is a rotor"},
      {spring([&](auto& e) { e.ends[1].at[0] = nan; }), "points is not finite"},
      {spring([&](auto& e) { e.stiffness = nan; }), "stiffness is not finite"},
      {spring([](auto& e) { e.stiffness = 0; }), "no stiffness and no damping"},
      {spring([](auto& e) { e.damping = -1; }), "damping must be"},
      {spring([](auto& e) { e.length = -1; }), "length must be"},
      {spring([](auto& e) {
         e.table = {{1, 0}, {2, 1}};
       }),
       "replaces stiffness"},
      {spring([](auto& e) {
         e.stiffness = 0;
         e.table = {{1, 0}};
       }),
       "two points"},
      {spring([](auto& e) {
         e.stiffness = 0;
         e.table = {{1, 0}, {1, 2}};
       }),
       "must increase"},
      {spring([](auto& e) {
         e.stiffness = 0;
         e.table = {{-1, 0}, {1, 2}};
       }),
       "below 0"},
      {spring([&](auto& e) {
         e.stiffness = 0;
         e.table = {{1, nan}, {2, 2}};
       }),
       "not finite"},
      {mount([](auto& e) { e.stiffness = {}; }), "and so no force"},
      {mount([&](auto& e) { e.stiffness.mr(0, 1) = nan; }), "stiffness is not finite"},
      {mount([&](auto& e) { e.damping.mr(0, 1) = nan; }), "damping is not finite"},
      {mount([](auto& e) { e.damping.rm(1, 1) = -1; }), "must not be below 0"},
      {mount([&](auto& e) { e.preload.moment[1] = nan; }), "preload is not finite"},
      {mount([](auto& e) { e.axes.coeffs().setZero(); }), "no quaternion"},
      {rope([](auto& e) { e.stiffness = 0; }), "and so no force"},
      {rope([](auto& e) { e.stiffness = -1; }), "stiffness must be above 0"},
      {rope([&](auto& e) { e.stiffness = nan; }), "stiffness is not finite"},
      {rope([](auto& e) { e.damping = -1; }), "damping must be"},
      {rope([](auto& e) { e.length = -1; }), "length must not be below 0"},
      {rope([](auto& e) { e.ends[1].body = "a"; }), "both of its ends"},
      {coupling([](auto& e) { e.ratio = 0; }), "ratio must be"},
      {coupling([](auto& e) { e.joints[1] = "a"; }), "to itself"},
      {coupling([](auto& e) { e.joints[1] = "guide"; }), "the guide has none"},
      {coupling([](auto& e) { e.joints[1] = "c"; }), "not exactly one coordinate"},
      {coupling([](auto& e) { e.joints[1] = "rotor"; }), "is a rotor"}};
  for (const auto& [elements, why] : cases) {
    const auto named = [&, part = std::string(why)](const InvalidInput& error) {
      const std::string text = error.what();
      return text.starts_with("element '") && text.find(part) != std::string::npos;
    };
    BOOST_CHECK_EXCEPTION(Resting(RestingFrame<>{}, bodies, weightless, elements), InvalidInput,
                          named);
  }
}

BOOST_AUTO_TEST_SUITE_END()
