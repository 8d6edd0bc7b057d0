// Fast tops on axes that do not spin, through AxisymmetricBody.

#include <fmt/core.h>

#include <cmath>

#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/guide/resting.hpp>
#include <dynamics/rigid/axisymmetric_body.hpp>

#include "any.hpp"
#include "trial.hpp"

namespace stability {

namespace {

using namespace kreisel;
using Fast = AxisymmetricBody<AnyGuide, AnyLoad>;
using State = Fast::State;

constexpr double A = 3e-4;
constexpr double C = 1e-4;
const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

void spins(const Recorder& out) {
  const Fast body(0.1, 0.05, A, C, {0, 0, 0}, {RestingFrame<>{}},
                  {UniformGravity<Guide>{{0, 0, -9.81}}});
  for (const double spin : {0.0, 1e3, 1e5, 1e6}) {
    const exact::LagrangeTop motion(A, C, 0.1 * 9.81 * 0.05, {0, 0, spin}, tilted);
    const double end = spin > 1e3 ? 1e3 / spin : 1;
    // The closed form is on the body's axes. Resal's axes are rotated back by the spin, w_z t.
    const Trial<Fast> trial{
        fmt::format("{:g} rad/s", spin),
        body,
        {tilted, {0, 0, spin}, 0},
        {.output_times = every(end / 5, end), .tolerance = 1e-9},
        [&](double t) {
          const exact::TopMotion m = motion.at(t);
          const double angle = spin * t;
          const Eigen::Quaterniond back(std::cos(angle / 2), 0, 0, -std::sin(angle / 2));
          return State{m.attitude * back, back.conjugate() * m.angular_velocity, angle};
        },
        rounding_of_angle * spin * end};
    attempt_all(out, trial,
                {Method::automatic, Method::verner98, Method::gauss16, Method::radau13});
  }
}

}  // namespace

void fast_bodies(std::vector<Case>& cases) {
  cases.push_back({"resal", "spins to 1e6 rad/s on axes that do not spin", &spins});
}

}  // namespace stability
