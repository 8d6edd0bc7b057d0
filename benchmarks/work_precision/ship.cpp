// A body on a rolling ship.

#include <Eigen/Geometry>

#include <cmath>
#include <type_traits>

#include <dynamics/guide/analytic.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>
#include <motor/attitude.hpp>

#include "methods.hpp"
#include "scenes.hpp"

namespace work_precision {

/// The truth is Verner98 at 1e-16, which two other accuracies confirm to 1e-14. Below that the
/// scene is not informative.
void ship(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  using namespace kreisel;
  const auto guide = analytic([](const auto& t) {
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const YawPitchRoll<T> turn{T(0.3 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.2 * sin(0.9 * t))};
    return Pose<T>{turn.rotation(),
                   Vector3<T>(T(5.0 * t), T(0.5 * sin(0.7 * t)), T(0.3 * sin(1.1 * t)))};
  });
  Matrix3<double> theta;
  theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  const FixedPointBody body(InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, theta),
                            {0.2, -0.1, 0.4}, guide, UniformGravity<Inertial>{{0, 0, -9.81}});
  using HeldOnShip = std::remove_const_t<decltype(body)>;
  const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);
  Problem<HeldOnShip> problem{"ship",
                              body,
                              HeldOnShip::to_vector({tilted, {0.5, -0.4, 0.7}}),
                              {5, 10, 15, 20},
                              {},
                              {Unit::attitude, Unit::relative},
                              1,
                              1e-3};
  ExplicitRungeKutta truth(FieldOf<HeldOnShip>{&body}, 0.0, problem.start, {.relative = 1e-16},
                           HeldOnShip::blocks);
  for (const double t : problem.times) problem.truth.push_back(truth.advance_to(t));
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.not_stiff();
}

}  // namespace work_precision
