#include <fmt/os.h>

#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>

#include <dynamics/gimbal/gyro_platform.hpp>
#include <dynamics/study/campbell.hpp>

// A freely floating platform, stabilised by three gyros whose frames are on springs. Prints the
// modes at 1000 rad/s, also by the paper's (26), whose rows 1 to 3 do not hold for an angular
// velocity. With a file name (.svg) it draws the modes over the rotors' speed.

using namespace kreisel;

namespace {

struct Coefficients {
  GyroPlatform::Matrix8 mass, damping, stiffness;
};

Coefficients platform(double speed, bool as_printed = false) {
  Matrix3<double> tensor;
  tensor << .3, .01, -.008, .01, .25, .012, -.008, .012, .35;
  GyroPlatform p;
  p.platform = InertiaTensor<Body>::about_centre(10, {0, 0, 0}, tensor);
  p.position_4 = {.05, 0, .04}, p.position_9 = {-.05, .02, .03}, p.arm_5 = .06, p.arm_7 = -.06;
  p.frame_4 = {.5, {1.2e-3, 1.5e-3, 1e-3}}, p.frame_9 = {.4, {.8e-3, .9e-3, 1.1e-3}};
  p.housing_5 = {.3, {2.4e-4, 2.1e-4, 2.3e-4}}, p.housing_7 = {.3, {2.5e-4, 2e-4, 2.2e-4}};
  p.housing_10 = {.3, {2.2e-4, 2e-4, 2.5e-4}};
  p.rotor_6 = {.2, 1.6e-4, 1e-4}, p.rotor_8 = {.2, 1.5e-4, .9e-4};
  p.rotor_11 = {.2, 1.7e-4, 1e-4};
  p.L = speed * p.spin_inertias();
  const GyroPlatform::Angles none = GyroPlatform::Angles::Zero();
  Coefficients c{
      p.carrier_inertia(none) + p.spin_inertia(none), p.gyroscopic(none, as_printed), {}};
  c.stiffness.setZero().diagonal().tail<5>().setConstant(0.5);  // N m/rad
  return c;
}

void draw(const std::string& picture) {
  std::vector<double> speeds;
  for (int i = 0; i <= 300; ++i) speeds.push_back(std::pow(10, 0.5 + 0.01 * i));
  const auto diagram = campbell([](double s) { return platform(s); }, speeds);
  fmt::ostream out = fmt::output_file(picture + ".gp");
  out.print(R"(set terminal svg size 800,560 background 'white'; set output '{}'; set logscale xy
set title 'Modes of a free platform with three gyros'; set xlabel 'speed of the rotors, rad/s'
set ylabel 'frequency, rad/s'; set xrange [3:3200]; set yrange [0.001:1000]; set format y '%g'
set palette defined (-1 '#d55e00', 0 '#aaaaaa', 1 '#0072b2'); set cbrange [-1:1]; set rmargin 15
set cbtics ('precession, -1' -1, '0' 0, 'nutation, +1' 1);set label 'springs alone' at 2800,26 right
set label 'gyros nutate' at 250,150 right; set label 'gyros precess' at 250,6 right; set grid
set label 'platform nutates' at 60,0.02; set cblabel 'd ln(frequency)/d ln(speed)' offset -3
plot '-' using 1:($2 > 1e-6 ? $2 : 1/0):3 with points pt 7 ps 0.35 lc palette notitle
)",
            picture);
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    for (const GyroscopicMode& mode : diagram.modes[i]) {
      out.print("{} {} {}\n", speeds[i], mode.root.imag(), mode.spin_growth);
    }
  }
  out.close();
  if (std::system(("gnuplot '" + picture + ".gp'").c_str())) throw ComputationFailed("gnuplot");
}

}  // namespace

int main(int argc, char** argv) try {
  const char* kinds[] = {"nutation", "precession", "oscillation"};
  const auto printed = conservative_spectrum(platform(1000, true));
  fmt::print("rad/s         by the paper's (26)   kind          grows with speed as\n");
  for (std::size_t i = 0; const GyroscopicMode& mode : conservative_spectrum(platform(1000))) {
    fmt::print("{:<14.8f}{:<22.8f}{:<14}{:.4f}\n", mode.root.imag(), printed[i++].root.imag(),
               kinds[static_cast<int>(mode.kind())], mode.spin_growth);
  }
  if (argc > 1) draw(argv[1]);
} catch (const std::exception& error) {
  fmt::print(stderr, "platform_stability: {}\n", error.what());
  return 3;
}
