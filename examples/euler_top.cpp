#include <fmt/os.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/step/integrator.hpp>

// Euler's top turns about its middle axis, which is unstable: every 30 s it turns over and back
// (Dzhanibekov's nut). Prints its rates and the error of the steps against the closed form. With a
// file name (.svg) it also draws the polhodes, the paths of the angular momentum in the body.

using namespace kreisel;

namespace {

const Vector3<double> moments(1, 2, 3);
const Vector3<double> start(1e-3, 2, 1e-3);

void turn_over() {
  const EulerTop top(moments);
  const exact::FreeTop truth(moments, start, Eigen::Quaterniond::Identity());
  Integrator run(top, 0, {Eigen::Quaterniond::Identity(), start});
  fmt::print("    t        p          q          r     attitude off by, rad\n");
  for (int i = 0; i <= 12; ++i) {
    const auto [attitude, w] = run.to(2.5 * i);
    const double off = attitude.angularDistance(truth.at(run.t()).attitude);
    fmt::print("{:5.1f}{:11.6f}{:11.6f}{:11.6f}   {:.0e}\n", run.t(), w.x(), w.y(), w.z(), off);
  }
  fmt::print("period {:.9f} s, {:.0f} evaluations\n", truth.period(), run.effort().evaluations);
}

/// The path of L/|L| in the body, seen from the direction (1, 1, 1): its front or its back.
void polhode(fmt::ostream& out, const Vector3<double>& L, bool front) {
  const Vector3<double> right(-std::sqrt(0.5), std::sqrt(0.5), 0);
  const Vector3<double> up = Vector3<double>(-1, -1, 2).normalized();
  const exact::FreeTop top(moments, L.cwiseQuotient(moments), Eigen::Quaterniond::Identity());
  for (int i = 0; i <= 400; ++i) {
    const double t = std::min(top.period(), 60.0) * (i / 400.0 - 0.5);
    const Vector3<double> now = top.at(t).angular_velocity.cwiseProduct(moments);
    if ((now.sum() >= 0) == front) out.print("{} {}", right.dot(now), up.dot(now));
    out.print("\n");  // a line without a point ends the curve
  }
  out.print("\n");
}

void draw(const std::string& picture) {
  fmt::ostream out = fmt::output_file(picture + ".gp");
  for (const bool front : {false, true}) {
    out.print("${} << END\n", front ? "front" : "back");
    for (int i = 0; i < 48; ++i) {  // i = 8, 16, 32, 40: the separatrix
      const double angle = i * std::acos(-1.0) / 24;
      polhode(out, {std::cos(angle), 1e-9, std::sin(angle)}, front);
    }
    out.print("END\n");
  }
  out.print(
      "set terminal svg size 640,640 background 'white'\nset output '{}'\nset size ratio -1\n"
      "unset key\nunset tics\nunset border\nset title 'Polhodes of a body with moments 1, 2, 3'\n"
      "set object 1 circle at 0,0 size 1 fc rgb '#f4f4f4' fs solid\n"
      "plot $back with lines lc rgb '#cccccc', $front with lines lw 1.5 lc rgb '#0072b2'\n",
      picture);
  out.close();
  if (std::system(("gnuplot '" + picture + ".gp'").c_str())) throw ComputationFailed("gnuplot");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    turn_over();
    if (argc > 1) draw(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "euler_top: {}\n", error.what());
    return 3;
  }
}
