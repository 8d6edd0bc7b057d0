// Fixed-point tops: Dzhanibekov's, a fast and a slow one of Lagrange, the fast one's axis.

#include <Eigen/Geometry>

#include <cmath>
#include <type_traits>

#include <dynamics/exact/free_top.hpp>
#include <dynamics/exact/lagrange_top.hpp>
#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/step/splitting.hpp>

#include "methods.hpp"
#include "references.hpp"
#include "scenes.hpp"
#include <tests/support/worst.hpp>

namespace work_precision {

namespace {

using kreisel::EulerTop;
using kreisel::Vector3;
using TopProblem = Problem<EulerTop>;

// kg m^2 across and along the axis, N m.
constexpr double A = 3e-4;
constexpr double C = 1e-4;
constexpr double k = 0.1 * 9.81 * 0.05;
const Eigen::Quaterniond tilted(std::cos(0.25), std::sin(0.25), 0, 0);

TopProblem top_problem(const std::string& name, const EulerTop& top, const EulerTop::State& start,
                       double period) {
  return {name, top, EulerTop::to_vector(start), {}, {}, {Unit::attitude, Unit::relative}, period};
}

/// States w x y z, w.
void take_reference(TopProblem& problem, const std::string& name) {
  const Reference all = reference(name);
  problem.times = all.times;
  for (const auto& s : all.states) {
    problem.truth.push_back(
        (EulerTop::Vector() << s[1], s[2], s[3], s[0], s[4], s[5], s[6]).finished());
  }
}

template <class Make>
void closed_form(Methods<TopProblem>& methods, const Make& make) {
  methods.note("closed form", 0, [make](const TopProblem& p) {
    const auto motion = make();
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i) {
      const auto m = motion.at(p.times[i]);
      const auto y = EulerTop::to_vector({m.attitude, m.angular_velocity});
      worst = kreisel::test::worst_of(worst, p.distance(i, y));
    }
    return Result{worst, 0};
  });
}

/// Splitting for a symmetric top whose weight pulls along its axis.
void splitting(Methods<TopProblem>& methods, double spin, bool quick) {
  const auto torque = [](double, const Eigen::Quaterniond& a) {
    const double x = 2 * (a.x() * a.z() - a.w() * a.y());
    const double y = 2 * (a.y() * a.z() + a.w() * a.x());
    return Vector3<double>(Vector3<double>(k * y, -k * x, 0) / a.squaredNorm());
  };
  const auto runs = [&]<class Scheme>(const char* name) {
    for (double step = 8 / spin; step > 0.2 / spin; step /= quick ? 4 : 2) {
      methods.note(name, step, [torque, step](const TopProblem& p) {
        const auto [q, w] = EulerTop::from_vector(p.start);
        kreisel::SplittingSteps<kreisel::SymmetricFreeFlow, std::decay_t<decltype(torque)>, Scheme>
            steps(kreisel::SymmetricFreeFlow(A, C), torque, 0, q, w, step);
        double worst = 0;
        for (std::size_t i = 0; i < p.times.size(); ++i) {
          steps.advance_to(p.times[i]);
          worst = kreisel::test::worst_of(
              worst,
              p.distance(i, EulerTop::to_vector({steps.attitude(), steps.angular_velocity()})));
        }
        return Result{worst, steps.effort().evaluations};
      });
    }
  };
  runs.template operator()<kreisel::Strang>("Strang");
  runs.template operator()<kreisel::Blanes864>("Blanes864");
  runs.template operator()<kreisel::KahanLi8>("KahanLi8");
}

/// The axis of a symmetric heavy top and its angular momentum, both on inertial axes. The spin is
/// left out, because nothing depends on it.
///
///   e' = (L x e)/A,   L' = -k e x vertical
struct AxisOfTop {
  using Vector = Eigen::Matrix<double, 6, 1>;
  struct State {
    Vector3<double> axis;
    Vector3<double> momentum;
  };

  static constexpr std::array<int, 2> blocks = {3, 3};
  static Vector to_vector(const State& s) { return (Vector() << s.axis, s.momentum).finished(); }
  static State from_vector(const Vector& y) { return {y.head<3>(), y.tail<3>()}; }

  template <class S>
  [[nodiscard]] Eigen::Matrix<S, 6, 1> rates(const std::type_identity_t<S>& /*t*/,
                                             const Eigen::Matrix<S, 6, 1>& y) const {
    return {(y[4] * y[2] - y[5] * y[1]) / A,
            (y[5] * y[0] - y[3] * y[2]) / A,
            (y[3] * y[1] - y[4] * y[0]) / A,
            -k * y[1],
            k * y[0],
            S(0)};
  }

  /// The same equations coefficient by coefficient, for Taylor steps.
  struct Series {
    static constexpr int most_order = kreisel::most_series_order;

    template <class Coefficients>
    void operator()(double /*t*/, double h, int order, Coefficients& c) const {
      for (int n = 0; n < order; ++n) {
        Vector3<double> turn = Vector3<double>::Zero();
        for (int i = 0; i <= n; ++i) {
          turn += c.col(i).template tail<3>().cross(c.col(n - i).template head<3>());
        }
        const double weight = h / (n + 1);
        c.col(n + 1) << weight / A * turn, -weight * k * c(1, n), weight * k * c(0, n), 0;
      }
    }
  };
  [[nodiscard]] static Series series() { return {}; }
};

}  // namespace

void dzhanibekov(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  const Vector3<double> moments(1, 2, 3);
  const EulerTop::State start{Eigen::Quaterniond::Identity(), {1e-3, 2, 1e-3}};
  TopProblem problem = top_problem("dzhanibekov", EulerTop(moments), start, 2);
  take_reference(problem, "S1_dzhanibekov");
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  closed_form(methods, [=] {
    return kreisel::exact::FreeTop(moments, start.angular_velocity, start.attitude);
  });
  methods.not_stiff();
}

namespace {

void heavy_top(std::vector<Run>& runs, TopProblem problem, double spin,
               const Thoroughness& thoroughness) {
  Methods methods(runs, std::move(problem), thoroughness);
  methods.automatic();
  closed_form(methods, [=] { return kreisel::exact::LagrangeTop(A, C, k, {0, 0, spin}, tilted); });
  splitting(methods, spin, thoroughness.quick);
  methods.not_stiff();
}

}  // namespace

void fast_top(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  TopProblem problem =
      top_problem("fast_top", EulerTop({A, A, C}, {0, 0, k}), {tilted, {0, 0, 3000}}, 7.0 / 3000);
  take_reference(problem, "S2_fasttop_body");
  heavy_top(runs, problem, 3000, thoroughness);
}

void slow_top(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  const Vector3<double> w(0, 0, 100);
  TopProblem problem =
      top_problem("slow_top", EulerTop({A, A, C}, {0, 0, k}), {tilted, w}, 7.0 / 100);
  const kreisel::exact::LagrangeTop truth(A, C, k, w, tilted);
  problem.times = {2.5, 5, 7.5, 10};
  for (const double t : problem.times) {
    problem.truth.push_back(
        EulerTop::to_vector({truth.at(t).attitude, truth.at(t).angular_velocity}));
  }
  heavy_top(runs, problem, 100, thoroughness);
}

void fast_top_axis(std::vector<Run>& runs, const Thoroughness& thoroughness) {
  const Vector3<double> axis = tilted * Vector3<double>::UnitZ();
  Problem<AxisOfTop> problem{"fast_top_axis",
                             {},
                             AxisOfTop::to_vector({axis, C * 3000 * axis}),
                             {},
                             {},
                             {Unit::angle, Unit::relative},
                             7e-3,
                             1e-3};
  const Reference all = reference("S2b_fasttop_axis");
  problem.times = all.times;
  for (const auto& s : all.states) problem.truth.push_back(AxisOfTop::Vector(s.data()));
  Methods methods(runs, problem, thoroughness);
  methods.automatic();
  methods.not_stiff();
}

}  // namespace work_precision
