// A Cardan gyro with massive rings whose inner bearing is stiffer and stiffer.

#include <dynamics/gimbal/cardan_gyro.hpp>
#include <dynamics/guide/resting.hpp>

#include "methods.hpp"
#include "references.hpp"
#include "scenes.hpp"

namespace work_precision {

namespace {

using Gyro = kreisel::CardanGyro<kreisel::RestingFrame<>>;

const kreisel::CardanMoments moments{{5e-4, 5e-4, 8e-4}, {2e-4, 3e-4, 2.5e-4}, {4e-4, 4e-4, 4e-4}};
constexpr double reference_angle = 0.3;

/// phi counts turns, so its error is relative, as that of the rates. The reference's beta counts
/// from `beta_from`.
Problem<Gyro> gyro_problem(const char* name, const char* reference_name, double stiffness,
                           double damping, double beta_from = 0) {
  using enum Unit;
  Problem<Gyro> problem{name,
                        Gyro(moments, {{0.5, 1e-3}, {stiffness, damping, reference_angle}}, {}),
                        Gyro::to_vector({.alpha_rate = 0.5, .phi_rate = 500}),
                        {},
                        {},
                        {angle, angle, relative, relative, relative, relative},
                        1e-2,
                        1e-3};
  const Reference all = reference(reference_name);
  problem.times = all.times;
  for (const auto& s : all.states) {
    problem.truth.emplace_back(Gyro::Vector(s.data()));
    problem.truth.back()[1] -= reference_angle - beta_from;
  }
  return problem;
}

void add_all(std::vector<Run>& runs, const Problem<Gyro>& problem, const Thoroughness& thoroughness,
             double explicit_part = 1) {
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.stiff(explicit_part);
}

}  // namespace

void bearing_1e3(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_all(runs, gyro_problem("bearing_1e3", "S4a_cardan_k1e3_d2", 1e3, 2), thoroughness);
}

void bearing_1e6(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_all(runs, gyro_problem("bearing_1e6", "S4b_cardan_k1e6_d2e3", 1e6, 2e3), thoroughness, 0.1);
}

void bearing_1e9(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_all(runs, gyro_problem("bearing_1e9", "S4c_cardan_k1e9_d2e6", 1e9, 2e6), thoroughness, 0.1);
}

void bearing_undamped(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_all(runs, gyro_problem("bearing_undamped", "S4d_cardan_k1e6_d0", 1e6, 0), thoroughness);
}

void bearing_1e12(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  add_all(runs, gyro_problem("bearing_1e12", "S4e_cardan_k1e12_d2e9", 1e12, 2e9), thoroughness,
          0.1);
}

/// The bearing's deviation of 1e-13 rad is measured by its own size.
void bearing_deviation(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  auto problem =
      gyro_problem("bearing_deviation", "S4f_cardan_k1e12_d2e9_dev", 1e12, 2e9, reference_angle);
  problem.units[1] = Unit::relative;
  problem.absolute_scale = 1e-13;
  add_all(runs, problem, thoroughness, 0.1);
}

}  // namespace work_precision
