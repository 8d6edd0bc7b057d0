#pragma once

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <dynamics/study/exponential_panels.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/motion_samples.hpp>
#include <dynamics/study/nominal_motion.hpp>
#include <dynamics/study/panel_series.hpp>
#include <dynamics/study/tangent.hpp>
#include <motor/api.hpp>

namespace kreisel {

/// A motion by the linear equations about a nominal motion.
class SmallSolution {
 public:
  /// A part of the time axis on which  eta' = A0 eta + sum_k g_k P_k  with the mean A0.
  struct Panel {
    double begin;
    double length;
    Eigen::VectorXd eta;  ///< at the begin
    Eigen::MatrixXd g;
  };

  /// eta at the requested times, and the states.
  [[nodiscard]] const std::vector<Eigen::VectorXd>& deviations() const { return deviations_; }
  [[nodiscard]] const std::vector<Eigen::VectorXd>& states() const { return states_; }

  /// The error of the integration at the end, relative to the greatest deviations, for each
  /// component: of the polynomials g, and rounding of the phases.
  [[nodiscard]] const Eigen::VectorXd& error() const { return error_; }

  /// The ends of all panels.
  [[nodiscard]] KREISEL_API std::vector<double> stops() const;

  /// The motion on any parts of the panels, in order, for ModelBound.
  [[nodiscard]] KREISEL_API MotionSampler sampler() const;

 private:
  friend class SmallMotion;
  std::shared_ptr<const ExponentialPanels> steps_;
  std::shared_ptr<const NominalMotion> nominal_;
  std::vector<Panel> panels_;
  std::vector<Eigen::VectorXd> deviations_;
  std::vector<Eigen::VectorXd> states_;
  Eigen::VectorXd error_;
};

/// Small motion of any system on any moving guide. The equations are linear in the deviation eta
/// from a nominal motion and exact in the motion of the guide.
///
///   eta' = A(t) eta + f(t)
///
/// In the nominal motion coordinates are constant and spins run (NominalMotion). A contains the
/// mass matrix, damping, stiffness and gyroscopic terms of all bodies, elements, constraints and
/// continuous controllers. f contains the forces of the guide's motion and of all loads.
///
/// Source : paper 002, section 8, (41) to (48) from (27); partial linearisation: paper 000, section 3
/// Error  : of second order in eta (ModelBound measures it); of the integration: `error()`
/// Cost   : evaluations of the exact equations resolve A and f, thus the motion of the guide alone.
///          Panels resolve the motion of the bodies only if A depends on time, which is tested at
///          seven times and between all breaks
/// Throws : as linearize(); InvalidInput if constraints do not allow the nominal motion
class SmallMotion {
 public:
  /// scene  : Differentiable; it must outlive this object
  /// breaks : times at which the equations jump, in order
  template <class Scene>
  SmallMotion(const Scene& scene, NominalMotion nominal, double end,
              const std::vector<double>& breaks = {})
      : nominal_(std::make_shared<const NominalMotion>(std::move(nominal))),
        on_constraints_([&scene](const Eigen::VectorXd& y) {
          return Eigen::VectorXd(detail::on_constraints(scene, y));
        }) {
    const auto equations = [&scene, this](double t) {
      const Eigen::VectorXd y = nominal_->at(t);
      const detail::Reduced r =
          detail::reduced(scene, t, y, nominal_->tangent(), detail::InTime::no);
      Eigen::MatrixXd all(r.A.rows(), r.A.cols() + 1);
      all << r.A, r.v - nominal_->rate();
      return all;
    };
    const auto force = [field = tangent_field(scene, nominal_->tangent()), this](double t) {
      return Eigen::VectorXd(field(t, nominal_->at(t)) - nominal_->rate());
    };
    prepare(equations, force, end, breaks);
  }

  [[nodiscard]] const NominalMotion& nominal() const { return *nominal_; }
  /// A, or its mean if it depends on time.
  [[nodiscard]] const Eigen::MatrixXd& matrix() const { return steps_->matrix(); }
  [[nodiscard]] bool is_steady() const { return is_steady_; }  ///< A does not depend on time

  /// The motion from a start at the nominal motion's begin.
  ///
  /// times    : in order, not before the begin
  /// relative : of the deviations, for the integration
  /// Throws   : ComputationFailed if the motion grows beyond all numbers
  [[nodiscard]] KREISEL_API SmallSolution run(const Eigen::VectorXd& start,
                                              const std::vector<double>& times,
                                              double relative = 1e-12) const;

 private:
  /// The columns of A, then f.
  using Equations = std::function<Eigen::MatrixXd(double t)>;

  KREISEL_API void prepare(const Equations& equations, const PanelSeries::Function& force,
                           double end, const std::vector<double>& breaks);

  void check_constraints(double end) const;

  std::shared_ptr<const NominalMotion> nominal_;
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> on_constraints_;
  std::shared_ptr<const ExponentialPanels> steps_;
  bool is_steady_ = false;
  /// f, after the columns of A - mean A if A depends on time.
  std::optional<PanelSeries> equations_;
};

}  // namespace kreisel
