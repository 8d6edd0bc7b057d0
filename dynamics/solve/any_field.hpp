#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include <dynamics/guide/series.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/radau.hpp>
#include <dynamics/step/shared.hpp>
#include <motor/api.hpp>

/// Scenes whose number of components is fixed only at run time: trees of bodies and users' scenes.
/// The cost of a call by pointer is negligible beside their evaluations, so one integrator serves
/// all of them.

namespace kreisel::detail {

/// The field of a scene of any type, with the projection onto the scene's conditions if it has one.
class AnyField {
 public:
  template <class Field>
  requires(!std::is_same_v<Field, AnyField>) explicit AnyField(Field field)
      : rate_(field_of(field)), project_(projection_of(field)) {}

  void operator()(const double& t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) const {
    rate_(t, y, rate);
  }

  void project(Eigen::VectorXd& y) const {
    if (project_) project_(y);
  }

 private:
  using Rate =
      std::function<void(const double& t, const Eigen::VectorXd& y, Eigen::VectorXd& rate)>;
  using Projection = std::function<void(Eigen::VectorXd& y)>;

  template <class Field>
  static Rate field_of(Field field) {
    return [field = std::move(field)](const double& t, const Eigen::VectorXd& y,
                                      Eigen::VectorXd& rate) mutable { call(field, t, y, rate); };
  }

  template <class Field>
  static Projection projection_of(Field field) {
    if constexpr (requires(Eigen::VectorXd & y) { field.project(y); }) {
      return [field = std::move(field)](Eigen::VectorXd& y) mutable { field.project(y); };
    } else {
      return nullptr;
    }
  }

  Rate rate_;
  Projection project_;
};

/// The Taylor series of a scene of any type.
class AnySeries {
 public:
  static constexpr int most_order = most_series_order;
  static constexpr double relative_order = 1.15;  ///< as for trees

  template <class Series>
  requires(!std::is_same_v<Series, AnySeries>) explicit AnySeries(Series series)
      : fill_(std::move(series)) {}

  template <class Coefficients>
  void operator()(double t, double h, int order, Coefficients& c) const {
    fill_(t, h, order, c);
  }

 private:
  std::function<void(double t, double h, int order, Eigen::Ref<Eigen::MatrixXd> c)> fill_;
};

/// The functions of runs_of_steps.hpp, for scenes of any type.
KREISEL_API [[nodiscard]] std::unique_ptr<SteppedRun> run_explicit_steps(
    const SteppedScene& scene, const AnyField& field, const SolveOptions& options,
    const Eigen::VectorXd& start, const Accuracy& accuracy);
KREISEL_API [[nodiscard]] std::unique_ptr<Run> run_gauss_steps(const SteppedScene& scene,
                                                               const AnyField& field,
                                                               const SolveOptions& options,
                                                               const Eigen::VectorXd& start,
                                                               const EqualLength& length);
KREISEL_API [[nodiscard]] std::unique_ptr<SteppedRun> run_taylor_steps(const SteppedScene& scene,
                                                                       const AnySeries& series,
                                                                       const SolveOptions& options,
                                                                       const Eigen::VectorXd& start,
                                                                       const Accuracy& accuracy);

/// The field with a Jacobian by differences.
KREISEL_API [[nodiscard]] std::unique_ptr<StiffField> stiff_field(const AnyField& field);

}  // namespace kreisel::detail
