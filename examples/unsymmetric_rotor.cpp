#include <fmt/os.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <string>

#include <dynamics/gimbal/unsymmetric_rotor.hpp>
#include <dynamics/study/stability_boundaries.hpp>

// A rotor with unequal transverse moments A and B runs at constant speed between springs of 1 and
// 1.5 N m/rad; (A+B)/2 = 1 kg m^2, C = 0.5 kg m^2. Prints the unstable ranges of speed;
// lower speeds have more, far narrower ones. With a file name (.svg) it draws them.

using namespace kreisel;

namespace {

PairedMultipliers multipliers(double unequal, double speed) {
  const CardanMoments moments{{1 + unequal, 1 - unequal, 0.5}};
  return paired_multipliers(UnsymmetricRotor<>(moments, {{1}, {1.5}}, speed), {.relative = 1e-12});
}

auto ranges(double unequal) {
  return unstable_intervals([=](double s) { return multipliers(unequal, s); }, 0.6, 2.4, 60);
}

constexpr std::array tongues = {"backward", "both", "forward"};

void draw(const std::string& picture) {
  fmt::ostream out = fmt::output_file(picture + ".gp");
  std::array<std::string, 3> outline = {};  // up along the one side, down along the other
  for (int i = 1; i <= 25; ++i) {
    for (std::size_t k = 0; const auto& [begin, end, growth] : ranges(i * i / 2500.0)) {
      std::string& l = outline.at(k++);
      l = fmt::format("{0} {1}\n{2}{3} {1}\n", begin.parameter, i * i / 2500.0, l, end.parameter);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) out.print("${} << E\n{}E\n", tongues[k], outline[k]);
  out.print("$growth << E\n");
  for (int i = 0; i <= 360; ++i) {
    const double speed = 0.6 + 0.005 * i;
    const auto rate = [speed](double unequal) {
      return std::log(multipliers(unequal, speed).growth()) * speed / std::acos(-1.0);
    };
    out.print("{} {} {} {}\n", speed, rate(0.05), rate(0.1), rate(0.2));
  }
  out.print(R"(E
set terminal svg size 800,640 background 'white'; set output '{}'; set lmargin 9
set multiplot layout 2,1 title 'Unstable whirl of an unsymmetric rotor between two springs'
set xrange [0.6:2.4]; set yrange [0:0.25]; set grid; set format x ''; set bmargin 1; unset key
set ylabel '(A - B)/(A + B)'; set label 'backward' at 0.87,0.2 right; set style data filledcurves
set label 'both' at 1.2,0.2; set label 'forward' at 1.62,0.2 center front tc rgb 'white'
plot $backward lc rgb '#0072b2', $both lc rgb '#e69f00', $forward lc rgb '#006b4f'
unset label; set key top left reverse Left title '(A - B)/(A + B)'; set tmargin 1; set bmargin 3.5
set xlabel 'speed of the rotor, rad/s'; set ylabel 'rate of growth, 1/s'; set format x '%g'
set style data lines; plot $growth using 1:4 lw 2 lc rgb '#cc79a7' title '0.2', '' using 1:3 \
  lw 2 lc rgb '#0072b2' dt 2 title '0.1', '' using 1:2 lw 2 lc rgb '#000000' dt 3 title '0.05'
)",
            picture);
  out.close();
  if (std::system(("gnuplot '" + picture + ".gp'").c_str())) throw ComputationFailed("gnuplot");
}

}  // namespace

int main(int argc, char** argv) try {
  fmt::print("tongue    (A-B)/(A+B)   unstable from and to, rad/s   growth per half turn\n");
  for (const double unequal : {0.05, 0.1, 0.2}) {
    for (std::size_t k = 0; const auto& [begin, end, growth] : ranges(unequal)) {
      fmt::print("{:8}{:10.2f}{:18.10f}{:15.10f}{:14.5f}\n", tongues.at(k++), unequal,
                 begin.parameter, end.parameter, growth);
    }
  }
  if (argc > 1) draw(argv[1]);
} catch (const std::exception& error) {
  fmt::print(stderr, "unsymmetric_rotor: {}\n", error.what());
  return 3;
}
