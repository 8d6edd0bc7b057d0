#pragma once

#include <boost/numeric/odeint.hpp>
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/gsl/steps.hpp>
#include <dynamics/solve/solve.hpp>
#include <dynamics/step/explicit.hpp>
#include <dynamics/step/gauss.hpp>
#include <dynamics/step/jacobian.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/taylor.hpp>
#ifdef KREISEL_WITH_SUNDIALS
#include <dynamics/step/cvode.hpp>
#endif

#include "point.hpp"
#include "problem.hpp"
#include <tests/support/worst.hpp>

namespace work_precision {

/// The scene's field, for double and for the other numbers that the scene accepts.
template <class Scene>
struct FieldOf {
  const Scene* scene;

  template <class S, class Vector>
  [[nodiscard]] Vector operator()(const S& t, const Vector& y) const {
    return scene->rates(t, y);
  }
};

/// The runs of one problem: every method over all tolerances.
template <class P>
class Methods {
  using Scene = typename P::Scene;
  using Vector = typename P::Vector;
  using Field = FieldOf<Scene>;
  static constexpr int n = Vector::RowsAtCompileTime;
  using Array = std::array<double, std::size_t(n)>;
  using Shared = std::shared_ptr<const P>;

 public:
  Methods(std::vector<Run>& runs, P problem, const Thoroughness& thoroughness)
      : runs_(runs),
        problem_(std::make_shared<const P>(std::move(problem))),
        thoroughness_(thoroughness) {}

  [[nodiscard]] const P& problem() const { return *problem_; }

  /// Runs of a stepper: make(problem, setting) returns one with advance_to() and effort().
  template <class Make>
  void add(const std::string& method, const std::vector<double>& settings, const Make& make) {
    for (const double setting : settings) {
      note(method, setting, [make, setting](const P& p) {
        auto steps = make(p, setting);
        const double worst = follow(p, [&](double t) { return steps.advance_to(t); });
        return Result{worst, steps.effort().evaluations};
      });
    }
  }

  /// Runs of any method: run(problem) returns a Result.
  template <class Do>
  void note(const std::string& method, double setting, const Do& run) {
    runs_.push_back(
        {problem_->name, method, setting, [run, problem = problem_] { return run(*problem); }});
  }

  /// solve() with its defaults, for users without knowledge of integrators.
  void automatic() { solved(work_precision::automatic, kreisel::Method::automatic); }

  /// solve() by a chosen method, with the same error estimate.
  void solved_by(kreisel::Method method) {
    solved(fmt::format("{}{}", fixed_choice, kreisel::name(method)), method);
  }

  /// All methods for fields that are not stiff.
  void not_stiff() {
    solved_by(kreisel::Method::verner98);
    if constexpr (knows_series) solved_by(kreisel::Method::taylor);
    explicit_ones(budget());
    taylor();
    gauss();
    cvode<false>();
  }

  /// The explicit methods, with a part of the evaluations so that they do not fail slowly. Then the
  /// methods for stiff fields, with the scene's exact Jacobian.
  void stiff(double explicit_part) {
    solved_by(kreisel::Method::radau13);
    if (explicit_part == 1) solved_by(kreisel::Method::verner98);
    explicit_ones({explicit_part * thoroughness_.max_evaluations});
    radau<5>("Radau 9");
    radau<7>("Radau 13");
    stiff_gsl("GSL bsimp", kreisel::GslMethod::bsimp);
    stiff_gsl("GSL msbdf", kreisel::GslMethod::msbdf);
    cvode<true>();
  }

 private:
  static constexpr bool knows_series = requires(const Scene& scene) { scene.series(); };

  void solved(const std::string& called, kreisel::Method method) {
    for (const double tolerance : thoroughness_.tolerances) {
      note(called, tolerance, [tolerance, method](const P& p) {
        const auto result = kreisel::solve(p.scene, Scene::from_vector(p.start),
                                           {.output_times = p.times,
                                            .tolerance = tolerance,
                                            .method = method,
                                            .absolute_scale = p.absolute_scale});
        const kreisel::RunReport& report = result.report;
        if (report.status == kreisel::RunStatus::failed) throw std::runtime_error(report.message);
        double worst = 0;
        double promised = 0;
        kreisel::ErrorMeasure<Scene> distance(p.absolute_scale);
        for (std::size_t i = 0; i < p.times.size(); ++i) {
          const Vector y = Scene::to_vector(result.states.at(i));
          worst = kreisel::test::worst_of(worst, p.distance(i, y));
          promised = kreisel::test::worst_of(promised, distance(y, p.truth[i]));
        }
        return Result{
            worst, report.all_evaluations,
            Promise{report.method, promised, report.error_estimate, report.tolerance_kept}};
      });
    }
  }

  /// Copied into the runs, which outlive this object.
  struct Budget {
    double max_evaluations;

    [[nodiscard]] kreisel::Accuracy at(const P& p, double tolerance) const {
      return {.relative = tolerance,
              .absolute_scale = p.absolute_scale,
              .max_evaluations = max_evaluations};
    }
  };
  [[nodiscard]] Budget budget() const { return {thoroughness_.max_evaluations}; }

  void explicit_ones(Budget budget) {
    add("Verner98", thoroughness_.tolerances, [budget](const P& p, double tolerance) {
      return kreisel::ExplicitRungeKutta(Field{&p.scene}, 0.0, p.start, budget.at(p, tolerance),
                                         Scene::blocks);
    });
    gsl("GSL rkf45", kreisel::GslMethod::rkf45, budget);
    gsl("GSL rk8pd", kreisel::GslMethod::rk8pd, budget);
    gsl("GSL msadams", kreisel::GslMethod::msadams, budget);
    namespace od = boost::numeric::odeint;
    odeint("Odeint dopri5", budget, [](double tolerance) {
      return od::make_controlled(tolerance, tolerance, od::runge_kutta_dopri5<Array>());
    });
    odeint("Odeint rkf78", budget, [](double tolerance) {
      return od::make_controlled(tolerance, tolerance, od::runge_kutta_fehlberg78<Array>());
    });
    odeint("Odeint Bulirsch-Stoer", budget,
           [](double tolerance) { return od::bulirsch_stoer<Array>(tolerance, tolerance); });
  }

  void taylor() {
    if constexpr (knows_series) {
      add("Taylor", thoroughness_.tolerances, [budget = budget()](const P& p, double tolerance) {
        return kreisel::TaylorSteps(p.scene.series(), 0.0, p.start, budget.at(p, tolerance),
                                    Scene::blocks);
      });
    }
  }

  void gauss() {
    std::vector<double> steps;
    for (double parts = 3; parts <= 24; parts *= thoroughness_.quick ? 2 : std::sqrt(2)) {
      steps.push_back(problem_->period / parts);
    }
    add("Gauss 16", steps, [](const P& p, double step) {
      return kreisel::GaussIRK(Field{&p.scene}, 0.0, p.start, step, Scene::blocks);
    });
  }

  /// The greatest error at the problem's times.
  template <class Integrator>
  [[nodiscard]] static double follow(const P& p, const Integrator& advance_to) {
    double worst = 0;
    for (std::size_t i = 0; i < p.times.size(); ++i) {
      const double error = p.distance(i, advance_to(p.times[i]));
      worst = error <= worst || worst != worst ? worst : error;  // a NaN stays
    }
    return worst;
  }

  void gsl(const std::string& name, kreisel::GslMethod method, Budget budget) {
    add(name, thoroughness_.tolerances, [method, budget](const P& p, double tolerance) {
      return kreisel::GslSteps(method, Field{&p.scene}, 0.0, p.start, budget.at(p, tolerance),
                               Scene::blocks);
    });
  }

  void stiff_gsl(const std::string& name, kreisel::GslMethod method) {
    add(name, thoroughness_.tolerances, [method, budget = budget()](const P& p, double tolerance) {
      return kreisel::GslSteps(method, Field{&p.scene},
                               kreisel::forward_jacobian<n>(Field{&p.scene}), 0.0, p.start,
                               budget.at(p, tolerance), Scene::blocks);
    });
  }

  template <int stages>
  void radau(const std::string& name) {
    add(name, thoroughness_.tolerances, [budget = budget()](const P& p, double tolerance) {
      const Field field{&p.scene};
      const auto jacobian = kreisel::forward_jacobian<n>(field);
      return kreisel::RadauSteps<Vector, Field, decltype(jacobian), stages>(
          field, jacobian, 0.0, p.start, budget.at(p, tolerance), Scene::blocks);
    });
  }

  /// Boost's own adaptive integration.
  template <class Make>
  void odeint(const std::string& name, Budget budget, const Make& make) {
    for (const double tolerance : thoroughness_.tolerances) {
      note(name, tolerance, [make, tolerance, most = budget.max_evaluations](const P& p) {
        auto stepper = make(tolerance);
        Array y;
        std::copy(p.start.data(), p.start.data() + n, y.begin());
        double evaluations = 0;
        const auto field = [&](const Array& x, Array& rate, double t) {
          if (++evaluations > most) throw std::runtime_error("evaluations are spent");
          Eigen::Map<Vector>{rate.data()} =
              p.scene.rates(t, Vector(Eigen::Map<const Vector>(x.data())));
        };
        double t = 0;
        const double worst = follow(p, [&](double end) {
          boost::numeric::odeint::integrate_adaptive(stepper, field, y, t, end,
                                                     std::min(1e-4, end - t));
          t = end;
          return Vector(Eigen::Map<const Vector>(y.data()));
        });
        return Result{worst, evaluations};
      });
    }
  }

#ifdef KREISEL_WITH_SUNDIALS
  template <bool exact_jacobian>
  void cvode() {
    using kreisel::CvodeMethod;
    // Evaluations are the least part of its cost.
    const Budget few{thoroughness_.max_evaluations / 10};
    add("CVODE Adams", thoroughness_.tolerances, [few](const P& p, double tolerance) {
      return kreisel::CvodeSteps(CvodeMethod::adams, Field{&p.scene}, 0.0, p.start,
                                 few.at(p, tolerance), Scene::blocks);
    });
    add("CVODE BDF", thoroughness_.tolerances, [few](const P& p, double tolerance) {
      const Field field{&p.scene};
      if constexpr (exact_jacobian) {
        return kreisel::CvodeSteps(CvodeMethod::bdf, field, kreisel::forward_jacobian<n>(field),
                                   0.0, p.start, few.at(p, tolerance), Scene::blocks);
      } else {
        return kreisel::CvodeSteps(CvodeMethod::bdf, field, 0.0, p.start, few.at(p, tolerance),
                                   Scene::blocks);
      }
    });
  }
#else
  template <bool exact_jacobian>
  void cvode() {}
#endif

  std::vector<Run>& runs_;
  Shared problem_;
  Thoroughness thoroughness_;
};

template <class P>
Methods(std::vector<Run>&, P, Thoroughness) -> Methods<P>;

}  // namespace work_precision
