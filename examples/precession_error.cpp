#include <fmt/os.h>

#include <cstdlib>
#include <exception>
#include <string>

#include <dynamics/step/explicit.hpp>
#include <dynamics/study/precession_gimbals.hpp>

// A gyro on springs in two gimbals is released from rest. Prints the error of the precession
// (technical) equations after 1 s and their bound of it; with a file name (.svg) it draws both.

using namespace kreisel;

namespace {

using Gyro = CardanGyro<RestingFrame<>, RegulatedRotor>;
const Gyro gyro({{1e-4, 1e-4, 1.6e-4}, {2.1e-4, 2.3e-4, 2.4e-4}, {1.5e-3, 1e-3, 1.2e-3}},
                {{.stiffness = 0.4}, {.stiffness = 0.3}}, RestingFrame<>{}, RegulatedRotor{});

std::pair<IntegrationStatistics, IntegrationStatistics> compare(double speed, const auto& note) {
  const Gyro::State start{.alpha = 0.2, .beta = -0.1, .phi_rate = speed};
  const Eigen::Vector2d angles(start.alpha, start.beta), rest(0, 0);
  const auto motion = precession_motion(PrecessionGimbals(gyro, 0, start), 0, angles, rest, 1);
  const auto field = [](double t, const Gyro::Vector& y) { return gyro.rates(t, y); };
  ExplicitRungeKutta exact(field, 0.0, gyro.to_vector(start), {.relative = 1e-12}, gyro.blocks);
  for (double from = 0, error = 0; const PrecessionSample& s : motion.samples) {
    for (int i = 1; i <= 8; ++i) {  // the nutation is finer than the steps
      const double t = i < 8 ? from + (s.t - from) * i / 8 : s.t;
      while (!exact.covers(t)) exact.step_towards(1);
      const Eigen::Vector2d place = exact.at(t).head(2);
      if (i == 8) error = std::max(error, (place - s.position).norm());
      note(s, place, error);
    }
    from = s.t;
  }
  return {motion.effort, exact.effort()};
}

void draw(const std::string& picture) {
  fmt::ostream out = fmt::output_file(picture + ".gp");
  for (const int speed : {500, 1000, 4000}) {
    out.print("$speed{} << E\n", speed);
    compare(speed, [&out](const auto& s, const auto& x, double error) {
      out.print("{} {} {} {} {} {} {}\n", s.t, x[0], x[1], s.position[0], s.position[1], error,
                s.bound);
    });
    out.print("E\n");
  }
  out.print(R"(set terminal svg size 960,460 background 'white'; set output '{}'
set multiplot layout 1,2 title 'Precession of a gyro on springs, by exact and technical equations'
set grid; set size ratio -1; set xlabel 'alpha, rad (500 rad/s)'; set ylabel 'beta, rad'
set key center; set xtics 0.1; set style data lines; set linetype 1 lw 2 lc rgb '#0072b2'
set linetype 2 lw 2 dt 2 lc rgb '#d55e00'
plot $speed500 u 2:3 title 'exact', '' every 8::7 u 4:5 title 'technical'
set size noratio; set logscale y; set format y '10^{{%L}}'; set xlabel 't, s'; set xtics 0.2
set ylabel 'greatest error so far, rad'; set key bottom right; set yrange [1e-5:1]
set label '500 rad/s' at 0.2,0.085; set label '1000' at 0.2,0.016; set label '4000' at 0.2,8e-4
plot for [s in '500 1000 4000'] '$speed'.s every 8::7 using 1:6 lt 1 notitle, \
  for [s in '500 1000 4000'] '$speed'.s every 8::7 using 1:7 lt 2 notitle, \
  1/0 lt 1 title 'true', 1/0 lt 2 title 'bound'
)",
            picture);
  out.close();
  if (std::system(("gnuplot '" + picture + ".gp'").c_str())) throw ComputationFailed("gnuplot");
}

}  // namespace

int main(int argc, char** argv) try {
  fmt::print("rotor, rad/s    error, rad    bound, rad   steps   exact ones\n");
  for (double most = 0, bound = 0; const double speed : {500., 1000., 2000., 4000., 8000.}) {
    const auto [technical, exact] = compare(
        speed, [&](const auto& s, const auto&, double error) { most = error, bound = s.bound; });
    fmt::print("{:<12.0f}{:14.6e}{:14.6e}{:8}{:13}\n", speed, most, bound, technical.steps,
               exact.steps);
  }
  if (argc > 1) draw(argv[1]);
} catch (const std::exception& error) {
  fmt::print(stderr, "precession_error: {}\n", error.what());
  return 3;
}
