// Whirl, critical speeds and stability of rotors by the program analyze. They are compared with
// equations in complex coordinates, in coordinates that turn, and in multiblade coordinates.

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <dynamics/decompositions.hpp>

#include <support/json.hpp>
#include <support/program.hpp>

using kreisel::test::Outcome;
using kreisel::test::Scratch;
using nlohmann::json;
using std::numbers::pi;
using Complex = std::complex<double>;
using Eigen::MatrixXcd, Eigen::MatrixXd;

namespace {

Outcome analyze(const std::string& scene, const std::string& arguments) {
  const Scratch folder;
  const std::string file = folder.write("scene.toml", scene + "[solve]\nt_end = 1\n").string();
  return kreisel::test::run(std::string(KREISEL_ANALYZE) + " " + file + " " + arguments);
}

json answer(const std::string& scene, const std::string& arguments) {
  const Outcome outcome = analyze(scene, arguments + " --json");
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, arguments << ": " << outcome.err);
  return kreisel::test::parsed(outcome.out);
}

void check_near(const std::string& what, double found, double wanted, double bound) {
  BOOST_TEST(std::abs(found - wanted) <= bound, what << ": " << found << " differs from " << wanted
                                                     << " by " << found - wanted << ", allowed "
                                                     << bound);
}

/// A body in a joint; `more` are further keys.
std::string body(const std::string& name, const std::string& parent, const std::string& joint,
                 double mass, const std::array<double, 3>& inertia, const std::string& more = "") {
  std::ostringstream text;
  text.precision(17);
  text << "[[body]]\nname = \"" << name << "\"\nparent = \"" << parent << "\"\njoint = { " << joint
       << " }\nmass = " << mass << "\ninertia = [" << inertia[0] << ", " << inertia[1] << ", "
       << inertia[2] << "]\n"
       << more << '\n';
  return text.str();
}

std::string spring(double stiffness, double damping) {
  std::ostringstream text;
  text.precision(17);
  text << "spring = { stiffness = " << stiffness << " }\ndamping = " << damping;
  return text.str();
}

std::string along(const char* axis) { return std::string("kind = \"prismatic\", axis = ") + axis; }

const std::string about_z = "kind = \"revolute\", axis = [0, 0, 1]";

/// The eigenvalues of  M x'' + C x' + K x = 0.
std::vector<Complex> roots(const MatrixXd& M, const MatrixXd& C, const MatrixXd& K) {
  const Eigen::Index n = M.rows();
  MatrixXd A(2 * n, 2 * n);
  A << MatrixXd::Zero(n, n), MatrixXd::Identity(n, n), -M.inverse() * K, -M.inverse() * C;
  const Eigen::VectorXcd values = kreisel::eigenvalues(A);
  return {values.begin(), values.end()};
}

double growth(const std::vector<Complex>& roots) {
  double greatest = -1e300;
  for (const Complex& root : roots) greatest = std::max(greatest, root.real());
  return greatest;
}

/// The zero of an increasing or decreasing function between a and b.
template <class F>
double zero(const F& f, double a, double b) {
  const bool rises = f(a) < 0;
  for (int i = 0; i < 100; ++i) {
    const double middle = (a + b) / 2;
    ((f(middle) < 0) == rises ? a : b) = middle;
  }
  return (a + b) / 2;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(overhung_rotor)

namespace {

constexpr double m = 10, A = 0.2, C = 0.35, k = 4e5, k_c = 1e5, k_t = 4e4;

/// A disc at the end of a shaft: an elastic mount of a bending beam.
const std::string scene =
    body("x", "guide", along("[1, 0, 0]"), 0, {0, 0, 0}) +
    body("y", "x", along("[0, 1, 0]"), 0, {0, 0, 0}) +
    body("tilt", "y", "kind = \"universal\", axis = [1, 0, 0], second_axis = [0, 1, 0]", 0,
         {0, 0, 0}) +
    body("disc", "tilt", about_z, m, {A, A, C}, "rotor = { mode = \"regulated\", speed = 100 }") +
    "[[element]]\nname = \"shaft\"\nkind = \"mount\"\nbetween = [\"guide\", \"tilt\"]\n"
    "stiffness = [[4e5, 0, 0], [0, 4e5, 0], [0, 0, 1e6]]\n"
    "turning_stiffness = [[4e4, 0, 0], [0, 4e4, 0], [0, 0, 0]]\n"
    "coupling = [[0, -1e5, 0], [1e5, 0, 0], [0, 0, 0]]\n";

/// In z = x + i y and the tilt a circular mode exp(i w t), w < 0 backward, has
///
///   (k - m w^2) (k_t - A w^2 + C W w) = k_c^2.
double defect(double w, double speed) {
  return (k - m * w * w) * (k_t - A * w * w + C * speed * w) - k_c * k_c;
}

/// The speeds at which w = W (sign 1) or w = -W (sign -1), from a quadratic equation for W^2.
std::vector<double> critical(double sign) {
  const double a = -m * (sign * C - A), b = k * (sign * C - A) - m * k_t, c = k * k_t - k_c * k_c;
  std::vector<double> speeds;
  for (const double root : {-1.0, 1.0}) {
    const double square = (-b + root * std::sqrt(b * b - 4 * a * c)) / (2 * a);
    if (square > 0) speeds.push_back(std::sqrt(square));
  }
  return speeds;
}

}  // namespace

BOOST_AUTO_TEST_CASE(whirls_by_its_quartic) {
  const json curves = answer(scene, "--campbell disc --speeds 0:900:10")["campbell"]["curves"];
  BOOST_TEST_REQUIRE(curves.size() == 4U);
  int forward = 0;
  for (const json& curve : curves) {
    BOOST_TEST(curve[0]["whirl"] == "plane");
    for (int i = 1; i < 10; ++i) {
      const double speed = 100 * i;
      const bool is_forward = curve[static_cast<std::size_t>(i)]["whirl"] == "forward";
      const double w = curve[static_cast<std::size_t>(i)]["frequency"].get<double>();
      forward += is_forward ? 1 : 0;
      const double s = is_forward ? w : -w;
      const double slope = (defect(s * (1 + 1e-6), speed) - defect(s * (1 - 1e-6), speed)) / 2e-6;
      check_near("frequency", 1 + defect(s, speed) / slope, 1, 1e-11);
      check_near("circle",
                 std::abs(curve[static_cast<std::size_t>(i)]["circulation"].get<double>()), 1,
                 1e-9);
    }
  }
  BOOST_TEST(forward == 18);
}

BOOST_AUTO_TEST_CASE(has_its_critical_speeds) {
  const json found =
      answer(scene, "--campbell disc --speeds 0:900:10")["campbell"]["critical_speeds"];
  std::vector<std::pair<double, std::string>> wanted;
  for (const double speed : critical(1)) wanted.emplace_back(speed, "forward");
  for (const double speed : critical(-1)) wanted.emplace_back(speed, "backward");
  std::sort(wanted.begin(), wanted.end());
  BOOST_TEST_REQUIRE(found.size() == wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    check_near("speed", found[i]["speed"].get<double>() / wanted[i].first, 1, 1e-10);
    BOOST_TEST(found[i]["whirl"] == wanted[i].second);
    BOOST_TEST(found[i]["order"] == 1);
  }
}

// An unbalance of 1 kg m turns with W:  (k - m W^2) z + .. = W^2 in complex coordinates.
BOOST_AUTO_TEST_CASE(answers_to_unbalance) {
  const json response = answer(
      scene, "--response unbalance.disc --to y.displacement --frequencies 10:900:12")["response"];
  BOOST_TEST(response["input_unit"] == "kg m");
  for (const json& row : response["rows"]) {
    const double W = row["frequency"], tilt = k_t + (C - A) * W * W;
    const double z = W * W * tilt / ((k - m * W * W) * tilt - k_c * k_c);
    // y lags behind x by a right angle.
    const Complex found = std::polar(row["amplitude"].get<double>(), row["phase"].get<double>());
    BOOST_TEST(std::abs(found - Complex(0, -z)) < 1e-11 * std::abs(z) + 1e-13);
  }
  BOOST_TEST(
      analyze(scene, "--response unbalance.tilt --to y.displacement --frequencies 1:9:2").status ==
      2);
}

BOOST_AUTO_TEST_CASE(meets_orders_and_marks_them) {
  const json result = answer(scene, "--campbell disc --speeds 0:900:10 --orders 2,0.5");
  for (const json& one : result["campbell"]["critical_speeds"]) {
    const double speed = one["speed"].get<double>(), order = one["order"].get<double>();
    BOOST_TEST((order == 2 || order == 0.5));
    const double w = order * speed * (one["whirl"] == "forward" ? 1 : -1);
    const double slope = (defect(w * (1 + 1e-6), speed) - defect(w * (1 - 1e-6), speed)) / 2e-6;
    BOOST_TEST(std::abs(defect(w, speed) / slope) < 1e-9);
  }
  const Outcome text = analyze(scene, "--campbell disc --speeds 0:900:10");
  BOOST_TEST(text.out.find("critical speeds") != std::string::npos);
  BOOST_TEST(analyze(scene, "--orders 1").status == 2);
  BOOST_TEST(analyze(scene, "--campbell disc --speeds 0:9:2 --orders 1,0").status == 2);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(rotors_described_on_their_shaft)

namespace {

/// A disc of 1 kg on a shaft that turns: springs and internal damping turn with it.
std::string jeffcott(double k_x, double k_y, double internal, double external) {
  std::ostringstream drag;
  drag << spring(k_y, internal) << "\nload = { kind = \"drag\", linear = [" << external << ", "
       << external << ", 0] }";
  return body("shaft", "guide", about_z, 0, {1, 1, 1},
              "drive = \"constant-rate\"\ninitial = { rate = 5 }") +
         body("x", "shaft", along("[1, 0, 0]"), 0, {0, 0, 0}, spring(k_x, internal)) +
         body("disc", "x", along("[0, 1, 0]"), 1, {0.01, 0.01, 0.02}, drag.str());
}

}  // namespace

// z'' + (c_e + c_i) z' + (w^2 - i c_i W) z = 0 is stable up to W = w (1 + c_e/c_i).
BOOST_AUTO_TEST_CASE(internal_damping_ends_stability) {
  const double w = 10, c_i = 0.2, c_e = 0.3;
  const json sweep =
      answer(jeffcott(w * w, w * w, c_i, c_e), "--campbell shaft --speeds 1:30:30")["campbell"];
  BOOST_TEST_REQUIRE(sweep["stability_limits"].size() == 1U);
  check_near("limit", sweep["stability_limits"][0]["speed"], w * (1 + c_e / c_i), 1e-8);
  BOOST_TEST(sweep["stability_limits"][0]["mode"]["whirl"] == "forward");
  for (std::size_t i = 0; i < 30; ++i) {
    const double W = 1 + static_cast<double>(i), c = c_e + c_i;
    const Complex root = std::sqrt(c * c / 4 - Complex(w * w, -c_i * W));
    for (const json& curve : sweep["curves"]) {
      const double sense = curve[i]["whirl"] == "forward" ? 1 : -1;
      const Complex s(curve[i]["growth_rate"].get<double>(),
                      sense * curve[i]["frequency_against_guide"].get<double>());
      const double off = std::min(std::abs(s + c / 2 - root), std::abs(s + c / 2 + root));
      BOOST_TEST(off < 1e-11);
    }
  }
}

BOOST_AUTO_TEST_CASE(asymmetric_shaft_between_its_critical_speeds) {
  const json limits = answer(jeffcott(64, 100, 0, 0),
                             "--campbell shaft --speeds 1:15:15")["campbell"]["stability_limits"];
  BOOST_TEST_REQUIRE(limits.size() == 2U);
  BOOST_TEST(limits[0]["growth"] == "begins");
  BOOST_TEST(limits[1]["growth"] == "ends");
  // A double root 0: rounding is seen by its square root.
  check_near("begin", limits[0]["speed"], 8, 1e-6);
  check_near("end", limits[1]["speed"], 10, 1e-6);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(rotors_with_hinged_blades)

namespace {

/// Blades hinged at the distance e on a hub that springs hold: Coleman and Feingold, NACA report
/// 1351 (1958). S and J are the blade's first and second moment about its hinge.
struct Helicopter {
  int blades = 3;
  double k_x = 900, k_y = 1500, c_h = 1.5, k_b = 3, c_b = 0.03;
  double hub = 4, mass = 0.5, e = 0.2, r = 0.6, J_c = 0.03;

  [[nodiscard]] double S() const { return mass * r; }
  [[nodiscard]] double J() const { return J_c + mass * r * r; }
  [[nodiscard]] double all() const { return hub + blades * mass; }
  [[nodiscard]] double K(double W) const { return k_b + W * W * e * S(); }

  [[nodiscard]] std::string scene(double speed) const {
    std::ostringstream text;
    text.precision(17);
    text << body("x", "guide", along("[1, 0, 0]"), 0, {0, 0, 0}, spring(k_x, c_h))
         << body("y", "x", along("[0, 1, 0]"), 0, {0, 0, 0}, spring(k_y, c_h));
    std::ostringstream drive;
    drive.precision(17);
    drive << "drive = \"constant-rate\"\ninitial = { rate = " << speed << " }";
    text << body("rotor", "y", about_z, hub, {0.1, 0.1, 0.2}, drive.str());
    for (int i = 0; i < blades; ++i) {
      const double angle = 2 * pi * i / blades, c = std::cos(angle), s = std::sin(angle);
      std::ostringstream joint, centre;
      joint.precision(17);
      centre.precision(17);
      joint << about_z << ", position = [" << e * c << ", " << e * s << ", 0]";
      centre << "centre = [" << r * c << ", " << r * s << ", 0]\n" << spring(k_b, c_b);
      text << body("blade " + std::to_string(i + 1), "rotor", joint.str(), mass, {J_c, J_c, J_c},
                   centre.str());
    }
    return text.str();
  }

  /// Three blades: x, y, a_0, a, b of the angles a_0 + a cos(psi) + b sin(psi) of the blades.
  void multiblade(double W, MatrixXd& M, MatrixXd& C, MatrixXd& K_all) const {
    M = MatrixXd::Zero(5, 5);
    C = M;
    K_all = M;
    M.diagonal() << all(), all(), J(), J(), J();
    M(0, 4) = -1.5 * S();
    M(1, 3) = 1.5 * S();
    M(3, 1) = S();
    M(4, 0) = -S();
    C.diagonal() << c_h, c_h, c_b, c_b, c_b;
    C(3, 4) = 2 * J() * W;
    C(4, 3) = -2 * J() * W;
    K_all.diagonal() << k_x, k_y, K(W), K(W) - J() * W * W, K(W) - J() * W * W;
    K_all(3, 4) = c_b * W;
    K_all(4, 3) = -c_b * W;
  }

  /// Two blades on equal springs: the hub's coordinates u, v on axes that turn, and half of the
  /// difference of the angles.
  [[nodiscard]] std::vector<Complex> turning(double W) const {
    MatrixXd M = MatrixXd::Zero(3, 3), C = M, K_all = M;
    M.diagonal() << all(), all(), J();
    M(1, 2) = 2 * S();
    M(2, 1) = S();
    C.diagonal() << c_h, c_h, c_b;
    C(0, 1) = -2 * all() * W;
    C(1, 0) = 2 * all() * W;
    C(0, 2) = -4 * S() * W;
    C(2, 0) = 2 * S() * W;
    K_all.diagonal() << k_x - all() * W * W, k_x - all() * W * W, K(W);
    K_all(0, 1) = -c_h * W;
    K_all(1, 0) = c_h * W;
    K_all(1, 2) = -2 * S() * W * W;
    K_all(2, 1) = -S() * W * W;
    return roots(M, C, K_all);
  }

  [[nodiscard]] std::vector<Complex> multiblade_roots(double W) const {
    MatrixXd M, C, K_all;
    multiblade(W, M, C, K_all);
    return roots(M, C, K_all);
  }
};

/// Checks that each multiplier is exp(s T) of one of the roots.
void check_multipliers(const json& floquet, const std::vector<Complex>& wanted) {
  const double T = floquet["period"];
  for (const json& one : floquet["multipliers"]) {
    const Complex z(one["real"].get<double>(), one["imag"].get<double>());
    double least = 1e300;
    for (const Complex& s : wanted) least = std::min(least, std::abs(z - std::exp(s * T)));
    BOOST_TEST(least < 1e-9, z << " is off by " << least);
  }
}

/// Checks the limits of stability, one within each of the intervals.
template <class Growth>
void check_limits(const json& sweep, const Growth& growth_at,
                  const std::vector<std::array<double, 2>>& within) {
  const json& limits = sweep["stability_limits"];
  BOOST_TEST_REQUIRE(limits.size() == within.size());
  for (std::size_t i = 0; i < within.size(); ++i) {
    const auto [a, b] = within[i];
    BOOST_TEST_REQUIRE((growth_at(a) > 0) != (growth_at(b) > 0));
    check_near("limit", limits[i]["speed"], zero(growth_at, a, b), 1e-7);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(three_blades_have_multiblade_roots) {
  const Helicopter craft;
  for (const double W : {6.0, 14.0, 25.0}) {
    const json floquet = answer(craft.scene(W), "")["floquet"];
    check_near("period", floquet["period"], 2 * pi / W, 1e-14);
    BOOST_TEST(floquet["multipliers"].size() == 10U);
    check_multipliers(floquet, craft.multiblade_roots(W));
  }
}

BOOST_AUTO_TEST_CASE(three_blades_meet_ground_resonance) {
  const Helicopter craft;
  const json sweep = answer(craft.scene(10), "--campbell rotor --speeds 20:50:11")["campbell"];
  check_limits(sweep, [&](double W) { return growth(craft.multiblade_roots(W)); },
               {{20, 26}, {47, 50}});
  // A mode is named by the frequency of its greatest amplitude: reduced by k W.
  for (const json& curve : sweep["curves"]) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if (curve[i].is_null()) continue;
      const double W = sweep["speeds"][i], w = curve[i]["frequency"];
      BOOST_TEST(std::abs(w) <= W / 2 * (1 + 1e-9));
      const double k = curve[i].value("harmonic", 0);
      check_near("greatest", curve[i]["frequency_against_guide"], w + k * W, 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(two_blades_on_equal_springs_turn_along) {
  Helicopter craft;
  craft.blades = 2;
  craft.k_y = craft.k_x;
  for (const double W : {9.0, 16.0}) {
    std::vector<Complex> wanted = craft.turning(W);
    // Both blades by equal angles do not move the hub.
    const Complex half = -craft.c_b / (2 * craft.J());
    const Complex root = std::sqrt(half * half - craft.K(W) / craft.J());
    wanted.push_back(half + root);
    wanted.push_back(half - root);
    check_multipliers(answer(craft.scene(W), "")["floquet"], wanted);
  }
}

BOOST_AUTO_TEST_CASE(two_blades_are_unstable_in_an_interval) {
  Helicopter craft;
  craft.blades = 2;
  craft.k_y = craft.k_x;
  const json sweep = answer(craft.scene(10), "--campbell rotor --speeds 9:15:4")["campbell"];
  check_limits(sweep, [&](double W) { return growth(craft.turning(W)); }, {{11, 13}, {13, 15}});
}

// A torque on the first blade acts on a_0, a and b by 1/3, 2/3 cos(psi) and 2/3 sin(psi): the hub
// answers with w + W and w - W.
BOOST_AUTO_TEST_CASE(harmonics_are_those_of_multiblades) {
  const Helicopter craft;
  const double W = 7;
  MatrixXd M, C, K_all;
  craft.multiblade(W, M, C, K_all);
  const json rows = answer(
      craft.scene(W),
      "--response 'joint.blade 1' --to x.displacement --frequencies 2:40:7")["response"]["rows"];
  for (const json& row : rows) {
    const double w = row["frequency"];
    for (const json& one : row["harmonics"]) {
      const int order = one["k"];
      const Complex found = std::polar(one["amplitude"].get<double>(), one["phase"].get<double>());
      Complex wanted = 0;
      if (std::abs(order) == 1) {
        const Complex s(0, w + order * W);
        const MatrixXcd open = s * s * M + s * C + K_all.cast<Complex>();
        Eigen::VectorXcd force = Eigen::VectorXcd::Zero(5);
        force[3] = 1.0 / 3;
        force[4] = Complex(0, -order / 3.0);
        wanted = open.fullPivLu().solve(force)[0];
      }
      BOOST_TEST(std::abs(found - wanted) < 1e-10 * (1 + std::abs(wanted)),
                 "k = " << order << " at " << w << ": " << found << ", not " << wanted);
    }
  }
}

BOOST_AUTO_TEST_CASE(harmonics_are_drawn_and_tabled) {
  const Scratch folder;
  const Outcome outcome =
      analyze(Helicopter().scene(7),
              "--response 'joint.blade 1' --to x.displacement --frequencies 2:40:7 " +
                  ("--plot " + folder.path().string()) + " --csv " +
                  (folder.path() / "table.csv").string());
  BOOST_TEST(outcome.status == 0, outcome.err);
  BOOST_TEST(folder.read("response.svg").find("<svg") != std::string::npos);
  const std::string table = folder.read("table.csv");
  BOOST_TEST(table.starts_with("frequency,amplitude,phase,amplitude -3,phase -3,"), table);
  BOOST_TEST(std::count(table.begin(), table.end(), '\n') == 8);
}

BOOST_AUTO_TEST_CASE(sweeps_without_a_period_are_refused) {
  const Helicopter craft;
  const std::string pulse = "force = { points = [[0.1, 0], [0.2, 1], [0.3, 0]] }\n";
  const Outcome outcome = analyze(craft.scene(10) + pulse, "--campbell rotor --speeds 5:9:3");
  BOOST_TEST(outcome.status == 3);
  BOOST_TEST(outcome.err.find("jumps or bends at 0.1 s") != std::string::npos, outcome.err);
  const Outcome response = analyze(craft.scene(10) + pulse,
                                   "--response joint.x --to x.displacement --frequencies 1:9:3");
  BOOST_TEST(response.status == 3);
  BOOST_TEST(response.err.find("jumps or bends at 0.1 s") != std::string::npos, response.err);
  const Outcome rest = analyze(craft.scene(10), "--campbell rotor --speeds 0:9:3");
  BOOST_TEST(rest.status == 3);
  BOOST_TEST(rest.err.find("leave out 0 rad/s") != std::string::npos, rest.err);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(attitude_held_by_a_wheel)

// The torque u on the wheel has the reaction -u on the body, whose moment is J without the wheel's:
// J s^2 + P + D s/(1 + tau s) = 0.
BOOST_AUTO_TEST_CASE(has_the_roots_of_its_loop) {
  const double J = 5, P = 2, D = 3, tau = 0.1;
  const std::string scene =
      body("craft", "guide", about_z, 10, {4, 4, J}) +
      body("wheel", "craft", about_z, 1, {0.1, 0.1, 0.15},
           "rotor = { mode = \"torque\", torque = 0 }") +
      "[[sensor]]\nname = \"star\"\nkind = \"joint\"\njoint = \"craft\"\n"
      "[[controller]]\nname = \"hold\"\nreads = [\"star.angle\"]\ndrives = [\"wheel\"]\n"
      "law = { kind = \"pid\", proportional = -2, derivative = -3, filter = 0.1 }\n";
  const auto law = [&](Complex s) { return P + D * s / (1.0 + tau * s); };
  const json result =
      answer(scene, "--response hold.reference --to craft.angle --frequencies 0.01:100:20");
  BOOST_TEST(result["linear"]["roots"].size() >= 2U);
  for (const json& root : result["linear"]["roots"]) {
    const Complex s(root["growth_rate"].get<double>(), root["frequency"].get<double>());
    BOOST_TEST(std::abs((J * s * s + law(s)) * (1.0 + tau * s)) < 1e-10);
  }
  for (const json& row : result["response"]["rows"]) {
    const Complex s(0, row["frequency"].get<double>());
    const Complex found = std::polar(row["amplitude"].get<double>(), row["phase"].get<double>());
    BOOST_TEST(std::abs(found - law(s) / (J * s * s + law(s))) < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
