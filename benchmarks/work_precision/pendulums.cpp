// Pendulums: plane, at rest and on the earth, and in a ball joint on the earth.

#include <Eigen/Geometry>

#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/guide/rotating.hpp>
#include <dynamics/pendulum/physical_pendulum.hpp>
#include <dynamics/rigid/fixed_point_body.hpp>

#include "methods.hpp"
#include "references.hpp"
#include "scenes.hpp"
#include <tests/support/worst.hpp>

namespace work_precision {

namespace {

using kreisel::Vector3;

constexpr double earth_rate = 7.292115e-5;
constexpr double weight = 19.62;  // m g a/Theta, 1/s^2

/// A plane physical pendulum with this weight; on the earth it swings in the meridian of 45
/// degrees:
///
///   phi'' = -19.62 sin phi + wE^2 sin(phi - 45 deg) cos(phi - 45 deg)
template <class Motion>
auto plane_problem(const std::string& name, const Motion& motion) {
  using kreisel::PendulumBody, kreisel::PhysicalPendulum;
  const PendulumBody<> body{.mass = 1, .arm = 0.5, .theta_b = 1, .theta_c = 1};
  return Problem<PhysicalPendulum<Motion>>{name, PhysicalPendulum(body, motion), {0.1, 0}, {},
                                           {},   {Unit::angle, Unit::relative},  1.4185};
}

template <class P>
void add_all(std::vector<Run>& runs, const P& problem, const Thoroughness& thoroughness) {
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.not_stiff();
}

/// The closed form of a plane pendulum, with its construction.
template <class P>
void add_closed_form(std::vector<Run>& runs, const P& problem, const Thoroughness& thoroughness) {
  Methods methods(runs, problem, thoroughness);
  methods.note("closed form", 0, [](const P& p) {
    const auto motion = closed_form(p.scene, 0, P::Scene::from_vector(p.start)).value();
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i) {
      worst =
          kreisel::test::worst_of(worst, p.distance(i, P::Scene::to_vector(motion.at(p.times[i]))));
    }
    return Result{worst, 0};
  });
}

}  // namespace

void pendulum(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  auto problem = plane_problem("pendulum", kreisel::RestingPendulumGuide<>{2 * weight});
  const kreisel::exact::PendulumMotion truth(weight, 0.1, 0);
  const double end = 1000 * truth.period();
  // Nearly quarter periods: at rest and upright an error of time would not show.
  for (const double part : {0.2501, 0.5002, 0.7503, 1.0004}) {
    problem.times.push_back(part * end);
    const auto m = truth.at(part * end);
    problem.truth.push_back({m.angle, m.rate});
  }
  add_all(runs, problem, thoroughness);
  add_closed_form(runs, problem, thoroughness);
}

void earth_pendulum(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  const double across = earth_rate * std::sqrt(0.5);
  auto problem = plane_problem("earth_pendulum",
                               kreisel::PendulumGuide<>{.angular_velocity = {across, across, 0},
                                                        .effective_gravity = {2 * weight, 0, 0}});
  const Reference all = reference("S3_earthpend");
  problem.times = all.times;
  for (const auto& s : all.states) problem.truth.push_back({s[0], s[1]});
  add_all(runs, problem, thoroughness);
  add_closed_form(runs, problem, thoroughness);
}

/// The reference has the absolute rate, FixedPointBody the rate against the earth.
void earth_ball(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  using kreisel::Body, kreisel::Guide;
  const double up = std::sqrt(0.5);
  const Vector3<double> earth(-earth_rate * up, 0, earth_rate * up);  // x south, z up, 45 degrees
  const kreisel::FixedPointBody body(
      kreisel::InertiaTensor<Body>::about_origin(
          1, {0, 0, -0.45}, Vector3<double>(0.25, 0.25, 0.01).asDiagonal().toDenseMatrix()),
      Vector3<double>::Zero(), kreisel::RotatingFrame<>{earth},
      kreisel::UniformGravity<Guide>{{0, 0, -9.81}});
  using Scene = std::remove_const_t<decltype(body)>;
  const Eigen::Quaterniond q(std::cos(0.05), std::sin(0.05), 0, 0);
  Problem<Scene> problem{"earth_ball", body, Scene::to_vector({q, Vector3<double>::Zero()}),
                         {},           {},   {Unit::attitude, Unit::relative},
                         1.4185,       1e-3};
  const Reference all = reference("S3q_earthpend_ball");
  problem.times = all.times;
  for (const auto& s : all.states) {
    const Eigen::Quaterniond attitude(s[0], s[1], s[2], s[3]);
    const Vector3<double> rate = Vector3<double>(s[4], s[5], s[6]) - attitude.conjugate() * earth;
    problem.truth.push_back(Scene::to_vector({attitude, rate}));
  }
  add_all(runs, problem, thoroughness);
}

}  // namespace work_precision
