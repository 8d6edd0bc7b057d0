// The cost of a gyro on springs at equal accuracy as its rotor turns faster, in three curves:
//
//   spin       the same momentum L at higher and higher speeds: as a rotor whose angle no step
//              resolves, regulated and free, and as a body with its angle resolved
//   momentum   L rises, and with it the nutation, of a frequency of about L/J, which exact equations
//              must follow, excited or not
//   technical  the same from the velocity of the precession by the technical equations, which leave
//              the nutation out, and the bound of their error
//
// Writes spin_cost.csv, spin.svg, momentum.svg and technical.svg.
//
// Usage: spin_cost [--quick] --out DIR

#include <fmt/core.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <optional>
#include <programs/shared/gnuplot.hpp>
#include <programs/shared/progress.hpp>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/step/integrator.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/tree/body_system.hpp>

using namespace kreisel;
using Eigen::VectorXd;

namespace {

using System = BodySystem<RestingFrame<>>;

/// rad, the error of both gimbals' angles together at the end.
constexpr double wanted = 1e-9;

constexpr double about_fork = 1.5e-3, about_ring = 1.5e-3;  // kg m^2, with the rotor across

/// Two rings on springs and a rotor in them, in a mode of rotors or as an ordinary body. The body's
/// transverse moments differ by a fraction of 2e-3, if that is possible for a body, so that its
/// angle matters.
System gyro(const std::optional<RotorMode>& mode, double momentum, double speed) {
  const double C = momentum / speed, A = 5e-4;
  const auto ring = [](double mass, const Vector3<double>& moments) {
    return InertiaTensor<Body>::about_centre(mass, {0, 0, 0}, moments.asDiagonal());
  };
  BodyDescription outer;
  outer.name = "fork";
  outer.joint = {.kind = JointKind::revolute, .axis = {0, 0, 1}};
  outer.inertia = ring(0.1, Vector3<double>::Constant((about_fork - A) / 2));
  outer.forces = {{.stiffness = 0.4, .constant = 0.02}};
  BodyDescription inner = outer;
  inner.name = "ring";
  inner.parent = "fork";
  inner.joint.axis = {1, 0, 0};
  inner.inertia = ring(0.1, {about_ring - A, (about_ring - A) / 2, (about_fork - A) / 2});
  inner.forces = {{.stiffness = 0.3, .constant = -0.01}};
  BodyDescription rotor;
  rotor.name = "rotor";
  rotor.parent = "ring";
  rotor.joint = {.kind = JointKind::revolute, .axis = {0, 1, 0}};
  const double apart = mode ? 0 : std::min(1e-3 * A, C / 4);
  rotor.inertia = ring(0.2, {A + apart, C, A - apart});
  if (mode) rotor.rotor = Rotor{.mode = *mode};
  return {RestingFrame<>{}, {outer, inner, rotor}};
}

System::State start(const System& system, const Eigen::Vector2d& rates, double speed) {
  System::State state = system.rest();
  state.coordinates << 0.2, -0.1, 0;
  state.rates << rates, speed;
  return state;
}

struct Run {
  Eigen::Vector2d angles;
  double evaluations;
  double seconds;  ///< of computing
};

double clock_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Run run(const System& system, const System::State& from, double span, double tolerance) {
  const double begin = clock_seconds();
  Integrator steps(system, 0, from, {.relative = tolerance, .max_evaluations = 1e10});
  const System::State end = steps.to(span);
  return {end.coordinates.head<2>(), steps.effort().evaluations, clock_seconds() - begin};
}

/// A row of the file. Costs are per second of the motion.
struct Point {
  std::string curve;
  std::string row;
  double speed = 0;
  double momentum = 0;
  double evaluations = 0;
  double seconds = 0;
  double error = 0;  ///< 0: not known, as the bound is of exact equations
  double bound = 0;  ///< the technical equations' own
};

/// The exact equations at a tolerance for the wanted error. Where two steps of a ladder enclose the
/// error, the result is between them.
Point at_equal_accuracy(const System& system, const System::State& from, double span,
                        const Eigen::Vector2d& truth) {
  struct Rung {
    double error, evaluations, seconds;
  };
  std::optional<Rung> before;
  for (int halves = 8; halves <= 26; ++halves) {
    const Run r = run(system, from, span, std::pow(10, -halves / 2.0));
    const Rung rung{std::max((r.angles - truth).norm(), 1e-16), r.evaluations, r.seconds};
    if (rung.error <= wanted) {
      double share = 1;
      if (before) share = std::log(before->error / wanted) / std::log(before->error / rung.error);
      const Rung& other = before ? *before : rung;
      const auto between = [&](double a, double b) { return std::exp(std::lerp(a, b, share)); };
      Point p;
      p.evaluations = between(std::log(other.evaluations), std::log(rung.evaluations)) / span;
      p.seconds = std::lerp(other.seconds, rung.seconds, share) / span;
      p.error = before ? wanted : rung.error;
      return p;
    }
    before = rung;
  }
  throw ComputationFailed("spin_cost: no tolerance leaves the error that is wanted");
}

Eigen::Vector2d truth(const System& system, const System::State& from, double span) {
  return run(system, from, span, 1e-14).angles;
}

Point exact(const System& system, const System::State& from, double span) {
  return at_equal_accuracy(system, from, span, truth(system, from, span));
}

/// The technical equations' forces, counted.
class Counted final : public PrecessionModel {
 public:
  explicit Counted(const PrecessionModel& model) : model_(&model) {}

  [[nodiscard]] GyroForces forces(double t, const VectorXd& place) const override {
    ++count_;
    return model_->forces(t, place);
  }
  [[nodiscard]] VectorXd motion_forces(double t, const VectorXd& place,
                                       const VectorXd& u) const override {
    ++count_;
    return model_->motion_forces(t, place, u);
  }
  [[nodiscard]] VectorXd rate(double t, const VectorXd& place, const VectorXd& u) const override {
    return model_->rate(t, place, u);
  }
  [[nodiscard]] VectorXd moved(const VectorXd& place, const VectorXd& e) const override {
    return model_->moved(place, e);
  }
  [[nodiscard]] VectorXd turning_along(const VectorXd& place, const VectorXd& u,
                                       const VectorXd& e) const override {
    return model_->turning_along(place, u, e);
  }
  [[nodiscard]] std::vector<int> blocks() const override { return model_->blocks(); }

  [[nodiscard]] double count() const { return count_; }

 private:
  const PrecessionModel* model_;
  mutable double count_ = 0;
};

struct Measurement {
  std::string what;
  double weight;  ///< of its duration among the others'
  std::function<void(std::vector<Point>&)> work;
};

Point named(Point p, const char* curve, const char* row, double speed, double momentum) {
  p.curve = curve;
  p.row = row;
  p.speed = speed;
  p.momentum = momentum;
  return p;
}

void add_spin(std::vector<Measurement>& tasks, double speed) {
  constexpr double momentum = 0.08, span = 3;  // s
  for (const auto& [row, mode] :
       {std::pair{"regulated", RotorMode::regulated}, std::pair{"free", RotorMode::free}}) {
    tasks.push_back({fmt::format("{} rotor at {:.0f} rad/s", row, speed), 1e4,
                     [row = row, mode = mode, speed](std::vector<Point>& points) {
                       const System system = gyro(mode, momentum, speed);
                       const auto from = start(system, {0, 0}, speed);
                       points.push_back(
                           named(exact(system, from, span), "spin", row, speed, momentum));
                     }});
  }
  const double shorter = std::min(span, 3e5 / speed);
  tasks.push_back({fmt::format("its angle resolved at {:.0f} rad/s", speed), speed * shorter * 1e2,
                   [speed, shorter](std::vector<Point>& points) {
                     const System system = gyro({}, momentum, speed);
                     const auto from = start(system, {0, 0}, speed);
                     points.push_back(named(exact(system, from, shorter), "spin", "angle resolved",
                                            speed, momentum));
                   }});
}

void add_momentum(std::vector<Measurement>& tasks, double momentum, bool exactly) {
  constexpr double C = 1e-4, span = 1;  // s
  const double speed = momentum / C;
  const auto work = [=](std::vector<Point>& points) {
    const System system = gyro(RotorMode::regulated, momentum, speed);
    const PrecessionBodies<RestingFrame<>> bodies(system);
    const auto [place, still] = bodies.start(0, System::to_vector(start(system, {0, 0}, speed)));
    const PrecessionOptions options{.accuracy = {.relative = 1e-11}, .tolerated_error = wanted};
    const auto slow =
        precession_motion(bodies, 0, place, still, 1e-6, options).samples.front().velocity;
    std::optional<Eigen::Vector2d> end;
    if (exactly) {
      const auto excited = start(system, {0.5, 0}, speed), from = start(system, slow, speed);
      points.push_back(
          named(exact(system, excited, span), "momentum", "nutation excited", speed, momentum));
      end = truth(system, from, span);
      points.push_back(named(at_equal_accuracy(system, from, span, *end), "momentum",
                             "nutation not excited", speed, momentum));
    }

    const Counted model(bodies);
    const double begin = clock_seconds();
    const PrecessionMotion motion = precession_motion(model, 0, place, slow, span, options);
    if (!motion.slow) return;
    const PrecessionSample& last = motion.samples.back();
    Point p;
    p.evaluations = model.count() / span;
    p.seconds = (clock_seconds() - begin) / span;
    if (end) p.error = (last.position.head<2>() - *end).norm();
    p.bound = last.bound;
    points.push_back(named(p, "technical", "technical", speed, momentum));
  };
  tasks.push_back({fmt::format("momentum {:.3g} N m s", momentum),
                   (exactly ? momentum / about_ring * 1e3 : 0) + 1e4, work});
}

std::vector<double> decades(double from, double to, int in_a_decade) {
  std::vector<double> values;
  const int count = static_cast<int>(std::lround(std::log10(to / from) * in_a_decade));
  for (int i = 0; i <= count; ++i) values.push_back(from * std::pow(10, double(i) / in_a_decade));
  return values;
}

std::vector<Point> measure(bool quick) {
  std::vector<Measurement> tasks;
  for (const double speed : decades(1e2, quick ? 1e4 : 1e6, quick ? 1 : 2)) add_spin(tasks, speed);
  // The technical equations are computed also where the exact ones would take hours.
  const double last = quick ? 1 : 100;
  for (const double momentum : decades(0.1, 1e3, 3)) {
    add_momentum(tasks, momentum, momentum < 1.01 * last);
  }
  double all = 0, done = 0;
  for (const Measurement& task : tasks) all += task.weight;
  std::vector<Point> points;
  Progress progress;
  for (const Measurement& task : tasks) {
    progress.report((done + 1e-3) / all, [&] { return task.what; });
    task.work(points);
    done += task.weight;
  }
  return points;
}

void write(const std::string& file, const std::vector<Point>& points) {
  fmt::ostream out = fmt::output_file(file);
  out.print(
      "curve,row,speed (rad/s),momentum (N m s),nutation (rad/s),evaluations a second of "
      "motion,CPU seconds a second of motion,error (rad),bound (rad)\n");
  for (const Point& p : points) {
    const double nutation = p.momentum / std::sqrt(about_fork * about_ring);
    const auto known = [](double x) { return x > 0 ? fmt::format("{:.3g}", x) : std::string(); };
    out.print("{},{},{:.6g},{:.6g},{:.4g},{:.5g},{:.3g},{},{}\n", p.curve, p.row, p.speed,
              p.momentum, nutation, p.evaluations, p.seconds, known(p.error), known(p.bound));
  }
}

/// A data block for gnuplot: x, evaluations, error, bound.
std::string data(const char* name, const std::vector<Point>& points, const char* row,
                 double Point::*x, bool certified = false) {
  std::string text = fmt::format("${} << END\n", name);
  for (const Point& p : points) {
    if (p.row != row || (certified && p.bound > wanted)) continue;
    text += fmt::format("{} {} {} {}\n", p.*x, p.evaluations, p.error, p.bound);
  }
  return text + "END\n";
}

// The colours are those of Okabe and Ito, which colour-blind people can distinguish.
void draw(const std::string& directory, const std::vector<Point>& points) {
  const std::string format =
      "set terminal svg size 800,560 font 'Helvetica,14' background 'white'\n"
      "set logscale xy; set format '10^{%T}'; set grid lc rgb '#dddddd'\n"
      "set style data linespoints; set key top left; set pointsize 0.7\n"
      "set linetype 1 lw 2.5 pt 7 lc rgb '#000000'; set linetype 2 lw 2.5 pt 5 lc rgb '#e69f00'\n"
      "set linetype 3 lw 2.5 pt 9 lc rgb '#0072b2'; set linetype 4 lw 2.5 pt 13 lc rgb '#d55e00'\n"
      "set ylabel 'evaluations of the field a second of motion'\n";
  const auto picture = [&](const char* name, const std::string& script) {
    gnuplot::draw_picture(directory + "/" + name + ".svg", format + script);
  };
  picture(
      "spin",
      data("r", points, "regulated", &Point::speed) + data("f", points, "free", &Point::speed) +
          data("a", points, "angle resolved", &Point::speed) +
          "set title 'Gyro on springs, L = 0.08 N m s, to 1e-9 rad'\n"
          "set xlabel 'speed of the rotor, rad/s'; set yrange [500:*]\n"
          "plot $a using 1:2 lt 4 title 'angle resolved', $r using 1:2 lt 1 ps 1.3 title 'rotor, "
          "regulated', $f using 1:2 lt 2 dt 2 title 'rotor, free'\n");
  const std::string by_momentum =
      "set xlabel 'momentum L, N m s'; set title 'Gyro on springs, to 1e-9 rad'\n" +
      data("e", points, "nutation excited", &Point::momentum) +
      data("n", points, "nutation not excited", &Point::momentum) +
      data("t", points, "technical", &Point::momentum) +
      data("c", points, "technical", &Point::momentum, true);
  picture("momentum",
          by_momentum +
              "set yrange [10:*]\n"
              "plot $e using 1:2 lt 1 title 'exact, nutation excited', $n using 1:2 lt 2 dt 2 "
              "title 'exact, from the precession', $t using 1:2 with lines lt 3 dt 3 title "
              "'technical', $c using 1:2 with points lt 3 title 'technical, error certified below "
              "1e-9 rad'\n");
  picture("technical",
          by_momentum +
              "set title 'Precession equations over 1 s, from the precession'\n"
              "set ylabel 'error, rad'; set key top right; set yrange [1e-16:1]\n"
              "plot $t using 1:4 lt 3 dt 2 title 'bound', $t using 1:3 lt 1 title 'true', 1e-9 lw "
              "1 lc rgb '#888888' title 'wanted'\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    bool quick = false;
    std::string directory;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--quick") {
        quick = true;
      } else if (word == "--out" && i + 1 < argc) {
        directory = argv[++i];
      } else {
        throw InvalidInput("no such option: " + word);
      }
    }
    if (directory.empty()) throw InvalidInput("usage: spin_cost [--quick] --out DIR");
    gnuplot::require_installed();
    std::filesystem::create_directories(directory);
    const std::vector<Point> points = measure(quick);
    write(directory + "/spin_cost.csv", points);
    draw(directory, points);
    return 0;
  } catch (const InvalidInput& error) {
    fmt::print(stderr, "spin_cost: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "spin_cost: {}\n", error.what());
    return 3;
  }
}
