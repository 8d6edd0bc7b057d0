// Error against run time: every method on every scene over all tolerances, each result held against a
// truth that no method computes. Writes work_precision.csv, a picture a scene and work_precision.md.
//
// Usage: work_precision [--quick] [--scene NAME] --out DIR

#include <boost/numeric/odeint.hpp>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/exact/pendulum_motion.hpp>
#include <dynamics/guide/posed.hpp>
#include <dynamics/scene/euler_top.hpp>
#include <dynamics/scene/held_body.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/gsl.hpp>
#include <dynamics/step/splitting.hpp>
#include <motor/attitude.hpp>

using namespace kreisel;

namespace {

// --- What is measured ---------------------------------------------------------------------------

/// One run of a method: how far off, how dear. `setting` is a tolerance or a step.
struct Point {
  std::string scene, method;
  double setting, error, seconds, evaluations;
  std::string status;
};

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// What a run gives back: its error and its evaluations.
struct Result {
  double error, evaluations;
};

/// The median CPU time of runs that take 50 ms together, three at least.
Point measure(const std::string& scene, const std::string& method, double setting,
              const std::function<Result()>& run) {
  Point point{scene, method, setting, NAN, NAN, NAN, "ok"};
  std::vector<double> times;
  double all = 0;
  try {
    while (times.size() < 3 || (all < 0.05 && times.size() < 101)) {
      const double begin = cpu_seconds();
      const Result result = run();
      times.push_back(cpu_seconds() - begin);
      all += times.back();
      point.error = result.error;
      point.evaluations = result.evaluations;
      if (all > 1) break;
    }
    std::nth_element(times.begin(), times.begin() + std::ptrdiff_t(times.size() / 2), times.end());
    point.seconds = times[times.size() / 2];
    if (!std::isfinite(point.error)) point.status = "not finite";
  } catch (const std::exception& error) {
    point.status = error.what();
    std::replace(point.status.begin(), point.status.end(), ',', ';');
  }
  return point;
}

// --- The methods, behind one interface: to the checkpoints, worst distance from the truth ---------

constexpr double most_evaluations = 2e7;

template <class Vector, std::size_t n>
struct Problem {
  using State = Vector;
  std::string name;
  std::function<Vector(double, const Vector&)> rates;
  Vector start;
  std::vector<double> times;
  std::array<int, n> blocks;
  std::function<double(std::size_t, const Vector&)> distance;  ///< from the truth at times[i]
};

template <class Steps, class P>
Result follow(Steps&& steps, const P& problem) {
  double worst = 0;
  for (std::size_t i = 0; i < problem.times.size(); ++i) {
    worst = std::max(worst, problem.distance(i, steps.advance_to(problem.times[i])));
  }
  return {worst, steps.effort().evaluations};
}

/// Boost's own adaptive integration.
template <class Stepper, class P>
Result odeint(const P& problem, Stepper stepper) {
  using Array = std::array<double, std::size_t(P::State::RowsAtCompileTime)>;
  Array y;
  std::copy(problem.start.data(), problem.start.data() + y.size(), y.begin());
  double evaluations = 0;
  const auto field = [&](const Array& x, Array& rate, double t) {
    if (++evaluations > most_evaluations) throw std::runtime_error("evaluations are spent");
    typename P::State state;
    std::copy(x.begin(), x.end(), state.data());
    const typename P::State f = problem.rates(t, state);
    std::copy(f.data(), f.data() + rate.size(), rate.begin());
  };
  double worst = 0;
  double t = 0;
  for (std::size_t i = 0; i < problem.times.size(); ++i) {
    boost::numeric::odeint::integrate_adaptive(stepper, field, y, t, problem.times[i], 1e-4);
    t = problem.times[i];
    typename P::State state;
    std::copy(y.begin(), y.end(), state.data());
    worst = std::max(worst, problem.distance(i, state));
  }
  return {worst, evaluations};
}

std::vector<double> tolerances(bool quick) {
  std::vector<double> all;
  for (int k = 3; k <= 14; k += quick ? 3 : 1) all.push_back(std::pow(10.0, -k));
  return all;
}

template <class P>
void general_methods(std::vector<Point>& points, const P& problem, bool quick, double period) {
  using Vector = typename P::State;
  using Array = std::array<double, std::size_t(Vector::RowsAtCompileTime)>;
  namespace od = boost::numeric::odeint;
  const auto note = [&](const char* method, double setting, const std::function<Result()>& run) {
    points.push_back(measure(problem.name, method, setting, run));
  };
  for (const double tolerance : tolerances(quick)) {
    const Accuracy accuracy{.relative = tolerance, .most_evaluations = most_evaluations};
    note("Verner98", tolerance, [&] {
      return follow(ExplicitSteps(problem.rates, 0.0, problem.start, accuracy, problem.blocks),
                    problem);
    });
    const std::pair<const char*, GslMethod> gsl[] = {{"GSL rkf45", GslMethod::rkf45},
                                                     {"GSL rk8pd", GslMethod::rk8pd},
                                                     {"GSL msadams", GslMethod::msadams}};
    for (const auto& [name, method] : gsl) {
      note(name, tolerance, [&, m = method] {
        return follow(GslSteps(m, problem.rates, 0.0, problem.start, accuracy, problem.blocks),
                      problem);
      });
    }
    note("odeint dopri5", tolerance, [&] {
      return odeint(problem,
                    od::make_controlled(tolerance, tolerance, od::runge_kutta_dopri5<Array>()));
    });
    note("odeint rkf78", tolerance, [&] {
      return odeint(problem,
                    od::make_controlled(tolerance, tolerance, od::runge_kutta_fehlberg78<Array>()));
    });
    note("odeint Bulirsch-Stoer", tolerance,
         [&] { return odeint(problem, od::bulirsch_stoer<Array>(tolerance, tolerance)); });
  }
  for (double parts = 3; parts <= 24; parts *= quick ? 2 : std::sqrt(2)) {
    note("Gauss 16", period / parts, [&] {
      return follow(GaussSteps(problem.rates, 0.0, problem.start, period / parts, problem.blocks),
                    problem);
    });
  }
}

// --- The scenes ------------------------------------------------------------------------------------

using TopProblem = Problem<EulerTop::Vector, 2>;

/// A top and the closed form of its motion.
template <class Truth>
TopProblem top_problem(const std::string& name, const EulerTop& top, const EulerTop::State& start,
                       double end, const Truth& truth) {
  TopProblem p;
  p.name = name;
  p.rates = [top](double t, const EulerTop::Vector& y) { return top.rates(t, y); };
  p.start = EulerTop::to_vector(start);
  p.times = {end / 4, end / 2, 3 * end / 4, end};
  p.blocks = EulerTop::blocks;
  std::vector<EulerTop::Vector> exact;
  for (const double t : p.times) {
    exact.push_back(EulerTop::to_vector({truth.at(t).attitude, truth.at(t).angular_velocity}));
  }
  p.distance = [exact, size = start.angular_velocity.norm()](std::size_t i,
                                                             const EulerTop::Vector& y) {
    return detail::ErrorMeasure<EulerTop>(size)(y, exact[i]);
  };
  return p;
}

template <class Truth>
void closed_form_point(std::vector<Point>& points, const TopProblem& p, const Truth& make) {
  points.push_back(measure(p.name, "closed form", 0, [&] {
    const auto motion = make();
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i) {
      const auto m = motion.at(p.times[i]);
      worst = std::max(worst, p.distance(i, EulerTop::to_vector({m.attitude, m.angular_velocity})));
    }
    return Result{worst, 0};
  }));
}

/// Splitting for a symmetric top whose weight pulls along its axis.
void splitting(std::vector<Point>& points, const TopProblem& p, double A, double C, double k,
               const std::vector<double>& lengths) {
  const auto [q, w] = EulerTop::from_vector(p.start);
  const auto torque = [k](double, const Eigen::Quaterniond& a) {
    const double x = 2 * (a.x() * a.z() - a.w() * a.y());
    const double y = 2 * (a.y() * a.z() + a.w() * a.x());
    return Vector3<double>(Vector3<double>(k * y, -k * x, 0) / a.squaredNorm());
  };
  const auto run = [&]<class Scheme>(const char* name, double step) {
    points.push_back(measure(p.name, name, step, [&, q = q, w = w] {
      SplittingSteps<SymmetricFreeFlow, decltype(torque), Scheme> steps(SymmetricFreeFlow(A, C),
                                                                        torque, 0, q, w, step);
      double worst = 0;
      for (std::size_t i = 0; i < p.times.size(); ++i) {
        steps.advance_to(p.times[i]);
        worst = std::max(
            worst,
            p.distance(i, EulerTop::to_vector({steps.attitude(), steps.angular_velocity()})));
      }
      return Result{worst, steps.effort().evaluations};
    }));
  };
  for (const double step : lengths) {
    run.template operator()<Strang>("Strang", step);
    run.template operator()<Blanes864>("Blanes864", step);
    run.template operator()<KahanLi8>("KahanLi8", step);
  }
}

const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

void dzhanibekov(std::vector<Point>& points, bool quick) {
  const Vector3<double> moments(1, 2, 3), w(1e-3, 2, 1e-3);
  const auto q = Eigen::Quaterniond::Identity();
  const auto make = [&] { return exact::FreeTop(moments, w, q); };
  const auto p = top_problem("dzhanibekov", EulerTop(moments), {q, w}, 100, make());
  closed_form_point(points, p, make);
  general_methods(points, p, quick, 2);
}

void heavy_top(std::vector<Point>& points, bool quick, const std::string& name, double spin,
               double end) {
  const double A = 3e-4, C = 1e-4, k = 0.049;
  const Vector3<double> w(0, 0, spin);
  const auto make = [&] { return exact::LagrangeTop(A, C, k, w, tilted); };
  const auto p = top_problem(name, EulerTop({A, A, C}, {0, 0, k}), {tilted, w}, end, make());
  closed_form_point(points, p, make);
  std::vector<double> lengths;
  for (double s = 8 / spin; s > 0.2 / spin; s /= quick ? 4 : 2) lengths.push_back(s);
  splitting(points, p, A, C, k, lengths);
  general_methods(points, p, quick, 7 / spin);
}

void pendulum(std::vector<Point>& points, bool quick) {
  using Vector = Eigen::Vector2d;
  const double k = 19.62;
  const exact::PendulumMotion truth(k, 0.1, 0);
  const double end = (quick ? 100 : 1000) * truth.period();
  Problem<Vector, 1> p;
  p.name = "pendulum";
  p.rates = [k](double, const Vector& y) { return Vector(y[1], -k * std::sin(y[0])); };
  p.start = {0.1, 0};
  p.times = {end / 4, end / 2, 3 * end / 4, end};
  p.blocks = {2};
  p.distance = [truth, times = p.times](std::size_t i, const Vector& y) {
    return std::abs(y[0] - truth.at(times[i]).angle);
  };
  general_methods(points, p, quick, truth.period());
}

/// A body on a rolling ship; the truth is Verner98 at 1e-16, which two other accuracies confirm to
/// 1e-14: below that this scene says nothing.
void ship(std::vector<Point>& points, bool quick) {
  const auto guide = posed([](const auto& t) {
    using std::sin;
    using T = std::decay_t<decltype(t)>;
    const YawPitchRoll<T> turn{T(0.3 * t), T(0.1 * sin(1.3 * t + 0.4)), T(0.2 * sin(0.9 * t))};
    return Pose<T>{turn.rotation(),
                   Vector3<T>(T(5.0 * t), T(0.5 * sin(0.7 * t)), T(0.3 * sin(1.1 * t)))};
  });
  Matrix3<double> theta;
  theta << 0.25, 0.004, 0.02, 0.004, 0.27, -0.01, 0.02, -0.01, 0.06;
  const HeldBody body(InertiaTensor<Body>::about_origin(2, {0.05, -0.02, -0.3}, theta),
                      {0.2, -0.1, 0.4}, guide, UniformGravity<Inertial>{{0, 0, -9.81}});
  using Scene = std::remove_const_t<decltype(body)>;
  Problem<Scene::Vector, 2> p;
  p.name = "ship";
  p.rates = [body](double t, const Scene::Vector& y) { return body.rates(t, y); };
  p.start = Scene::to_vector({tilted, {0.5, -0.4, 0.7}});
  p.times = {5, 10, 15, 20};
  p.blocks = Scene::blocks;
  std::vector<Scene::Vector> exact;
  ExplicitSteps reference(p.rates, 0.0, p.start, {.relative = 1e-16}, p.blocks);
  for (const double t : p.times) exact.push_back(reference.advance_to(t));
  p.distance = [exact](std::size_t i, const Scene::Vector& y) {
    return detail::ErrorMeasure<Scene>(1)(y, exact[i]);
  };
  general_methods(points, p, quick, 1);
}

// --- What is written -------------------------------------------------------------------------------

void write_csv(const std::string& path, const std::vector<Point>& points) {
  fmt::ostream out = fmt::output_file(path);
  out.print("scene,method,setting,error,cpu_s,evaluations,status\n");
  for (const Point& p : points) {
    out.print("{},{},{:.3e},{:.3e},{:.4e},{:.0f},{}\n", p.scene, p.method, p.setting, p.error,
              p.seconds, p.evaluations, p.status);
  }
}

bool ours(const std::string& method) {
  return method.find("GSL") != 0 && method.find("odeint") != 0;
}

/// The least time of a method to an error, from its points; infinite where it does not get there.
double time_to(const std::vector<Point>& points, const std::string& scene,
               const std::string& method, double error) {
  double best = INFINITY;
  for (const Point& p : points) {
    if (p.scene == scene && p.method == method && p.status == "ok" && p.error <= error) {
      best = std::min(best, p.seconds);
    }
  }
  return best;
}

void write_table(const std::string& path, const std::vector<Point>& points) {
  fmt::ostream out = fmt::output_file(path);
  std::map<std::string, std::vector<std::string>> methods;
  for (const Point& p : points) {
    auto& list = methods[p.scene];
    if (std::find(list.begin(), list.end(), p.method) == list.end()) list.push_back(p.method);
  }
  out.print(
      "| scene | error | best stepper of ours | ms | best library | ms | library / ours | closed "
      "form, ms |\n");
  out.print("|---|---|---|---|---|---|---|---|\n");
  for (const auto& [scene, list] : methods) {
    for (const double error : {1e-4, 1e-8, 1e-10, 1e-12}) {
      std::string best[2] = {"none", "none"};
      double time[2] = {INFINITY, INFINITY};
      for (const std::string& method : list) {
        if (method == "closed form") continue;
        const int side = ours(method) ? 0 : 1;
        const double t = time_to(points, scene, method, error);
        if (t < time[side]) time[side] = t, best[side] = method;
      }
      const auto ms = [](double s) {
        return std::isfinite(s) ? fmt::format("{:.3g}", 1e3 * s) : "-";
      };
      const double closed = time_to(points, scene, "closed form", error);
      out.print("| {} | {:.0e} | {} | {} | {} | {} | {} | {} |\n", scene, error, best[0],
                ms(time[0]), best[1], ms(time[1]),
                std::isfinite(time[1]) ? fmt::format("{:.2g}", time[1] / time[0]) : "-",
                ms(closed));
    }
  }
}

void draw(const std::string& dir, const std::vector<Point>& points) {
  std::map<std::string, std::map<std::string, std::vector<Point>>> all;
  for (const Point& p : points) {
    if (p.status == "ok" && p.error > 0) all[p.scene][p.method].push_back(p);
  }
  for (const auto& [scene, methods] : all) {
    const std::string script = dir + "/" + scene + ".gp";
    fmt::ostream out = fmt::output_file(script);
    std::string plot;
    int index = 0;
    for (const auto& [method, list] : methods) {
      out.print("$m{} << END\n", index);
      for (const Point& p : list) out.print("{:.4e} {:.4e}\n", p.error, 1e3 * p.seconds);
      out.print("END\n");
      const bool own = ours(method);
      plot += fmt::format("{}$m{} using 1:2 with linespoints lw {} dt {} pt {} ps 0.7 title '{}'",
                          index == 0 ? "plot " : ", ", index, own ? 2 : 1, own ? 1 : 2, index + 1,
                          method);
      index += 1;
    }
    out.print(
        "set terminal svg size 900,600 font 'Helvetica,13' background 'white'\n"
        "set output '{}/{}.svg'\nset logscale xy\nset xrange [1e-1:1e-16] reverse\n"
        "set format x '10^{{%T}}'\nset format y '10^{{%T}}'\n"
        "set xlabel 'error (rad, relative)'\nset ylabel 'CPU time, ms'\nset title '{}' noenhanced\n"
        "set grid lc rgb '#dddddd'\nset key outside right\n{}\n",
        dir, scene, scene, plot);
    out.close();
    if (std::system(("gnuplot '" + script + "'").c_str()) != 0)
      throw ComputationFailed("gnuplot failed");
    std::filesystem::remove(script);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    bool quick = false;
    std::string only = "all";
    std::string dir;
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (word == "--quick") {
        quick = true;
      } else if (word == "--scene" && i + 1 < argc) {
        only = argv[++i];
      } else if (word == "--out" && i + 1 < argc) {
        dir = argv[++i];
      } else {
        throw InvalidInput("no such option: " + word);
      }
    }
    if (dir.empty())
      throw InvalidInput("usage: work_precision [--quick] [--scene NAME|all] --out DIR");
    std::filesystem::create_directories(dir);
    const std::pair<std::string, std::function<void(std::vector<Point>&)>> scenes[] = {
        {"dzhanibekov", [&](auto& p) { dzhanibekov(p, quick); }},
        {"fast_top", [&](auto& p) { heavy_top(p, quick, "fast_top", 3000, quick ? 1 : 10); }},
        {"slow_top", [&](auto& p) { heavy_top(p, quick, "slow_top", 100, 10); }},
        {"pendulum", [&](auto& p) { pendulum(p, quick); }},
        {"ship", [&](auto& p) { ship(p, quick); }}};
    std::vector<Point> points;
    bool known = false;
    for (const auto& [name, run] : scenes) {
      if (only != "all" && only != name) continue;
      known = true;
      fmt::print(stderr, "{} ...\n", name);
      run(points);
    }
    if (!known) throw InvalidInput("no such scene: " + only);
    write_csv(dir + "/work_precision.csv", points);
    write_table(dir + "/work_precision.md", points);
    draw(dir, points);
  } catch (const InvalidInput& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "work_precision: {}\n", error.what());
    return 3;
  }
}
