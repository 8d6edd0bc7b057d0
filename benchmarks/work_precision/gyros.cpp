// Gyros in massive rings: free, on a turning base, and with an unsymmetric regulated rotor. A
// satellite with a control moment gyro is a tree of bodies.

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/harmonic.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/tree/body_system.hpp>

#include "methods.hpp"
#include "scenes.hpp"
#include <tests/dynamics/tree/rotors_reference.hpp>
#include <tests/support/json.hpp>

namespace work_precision {

namespace {

using namespace kreisel;

const CardanMoments moments{{0.005, 0.005, 0.008}, {0.002, 0.0015, 0.0028}, {0.006, 0.0045, 0.005}};

/// A trajectory of tests/data/cardan-gyro.json. phi counts turns, so its error is relative.
template <class Gyro>
void add_gyro(std::vector<Run>& runs, const char* name, const char* reference, const Gyro& gyro,
              const Thoroughness& thoroughness) {
  using enum Unit;
  using Vector = typename Gyro::Vector;
  Problem<Gyro> problem{
      name, gyro, {}, {}, {}, {angle, angle, relative, relative, relative, relative}, 0.1, 1e-3};
  const test::Json all = test::reference_file("cardan-gyro.json");
  for (const test::Json& trajectory : all["trajectories"]) {
    if (trajectory["name"] != reference) continue;
    for (const test::Json& point : trajectory["points"]) {
      Vector y;
      y << test::numbers(point["q"]), test::numbers(point["qd"]);
      if (test::number(point["t"]) == 0) {
        problem.start = y;
      } else {
        problem.times.push_back(test::number(point["t"]));
        problem.truth.push_back(y);
      }
    }
  }
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.not_stiff();
}

/// A BodySystem with the size of the satellite, for steppers whose size is fixed at compile time.
class Satellite {
 public:
  using Vector = Eigen::Matrix<double, 17, 1>;
  using State = Vector;

  /// Attitude, position, gimbal and rotor; their rates.
  static constexpr std::array<int, 8> blocks = {4, 3, 1, 1, 3, 3, 1, 1};
  static Vector to_vector(const State& state) { return state; }
  static State from_vector(const Vector& y) { return y; }

  explicit Satellite(std::vector<BodyDescription> bodies) : system_({}, std::move(bodies)) {}

  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    y_ = y;
    system_.rates(t, y_, rate_, workspace_);
    return rate_;
  }

  [[nodiscard]] auto series() const { return system_.series(); }

 private:
  BodySystem<RestingFrame<>> system_;
  mutable BodyWorkspace workspace_ = system_.workspace();
  mutable Eigen::VectorXd y_;
  mutable Eigen::VectorXd rate_;
};

}  // namespace

void cardan_free(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_gyro(runs, "cardan_free", "T1_free_symmetric", CardanGyro(moments, {}, RestingFrame<>{}),
           thoroughness);
}

void cardan_on_base(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  const HarmonicSeries<> u{
      {0.3, -0.2, 0.5},
      {{{0.1, 0, 0}, 3, 0}, {{0, 0.15, 0}, 2, std::numbers::pi / 2}, {{0, 0, -0.2}, 5, 0}}};
  add_gyro(runs, "cardan_on_base", "T6b_fast_base_free",
           CardanGyro(moments, {}, HarmonicFrame<>(u, {}, 0, 2)), thoroughness);
}

void cardan_blades(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  CardanMoments unsymmetric = moments;
  unsymmetric.rotor = {0.0055, 0.0045, 0.008};
  add_gyro(runs, "cardan_blades", "T8b_regulated_inertial",
           CardanGyro(unsymmetric, {{2}, {1.5}}, RestingFrame<>{}, RegulatedRotor{}), thoroughness);
}

void satellite(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  using enum Unit;
  const test::Json& reference = test::rotors_reference()["trajectories"]["T3_cmgsat_regulated"];
  const Satellite body(test::model_bodies(
      "cmgsat", test::Root::free, reference["springs_dampers_const"], RotorMode::regulated));
  Problem<Satellite> problem{
      "satellite", body,
      {},          {},
      {},          {attitude, relative, angle, relative, relative, relative, relative, relative},
      0.1,         1e-3};
  for (const test::Json& row : reference["results"]) {
    const Eigen::VectorXd q = test::numbers(row["quat"]);
    const Eigen::Quaterniond attitude(q[0], q[1], q[2], q[3]);
    const Vector3<double> velocity = test::numbers(row["v_root_axes"]);
    Satellite::Vector y;
    y << attitude.coeffs(), test::numbers(row["pos"]), test::numbers(row["q"]),
        test::numbers(row["Omega"]), attitude * velocity, test::numbers(row["qd"]);
    if (test::number(row["t"]) == 0) {
      problem.start = y;
    } else {
      problem.times.push_back(test::number(row["t"]));
      problem.truth.push_back(y);
    }
  }
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.not_stiff();
}

}  // namespace work_precision
