#pragma once

#include <Eigen/Core>

#include <complex>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <dynamics/solve/levels.hpp>
#include <dynamics/solve/radau_run.hpp>
#include <dynamics/solve/run.hpp>
#include <dynamics/solve/solve_options.hpp>
#include <dynamics/step/accuracy.hpp>
#include <dynamics/step/checkpoint.hpp>

namespace kreisel::detail {

/// The eigenvalue of greatest modulus of the Jacobian; 0 if the Jacobian is not finite, because a
/// failed stiffness check must not end the run.
[[nodiscard]] std::complex<double> dominant_eigenvalue(const SteppedScene& scene, bool other,
                                                       double t, const Eigen::VectorXd& y);

/// A run by verner98 or taylor that changes to radau13 and back where that takes fewer evaluations.
/// It changes to verner98 where the series of taylor fails or allows only short steps.
///
/// A field is stiff where stability limits explicit steps, although the motion is damped away. A
/// trial decides: one step of radau13, ten times as long, must be accepted. It is rejected while an
/// oscillation that radau13 would damp exceeds the accuracy.
class SwitchingRun final : public SteppedRun {
 public:
  SwitchingRun(const SteppedScene& scene, bool other, const SolveOptions& options, Method first,
               const Eigen::VectorXd& start, const Accuracy& accuracy);

  void step_towards(double end, double output) override;
  void cross(double end, double output) override { run_->cross(end, output); }
  void follow(const SteppedRun& other) override;

  [[nodiscard]] double t() const override { return run_->t(); }
  [[nodiscard]] std::span<const double> state() const override { return run_->state(); }
  [[nodiscard]] double length() const override { return run_->length(); }
  [[nodiscard]] bool covers(double t) const override { return run_->covers(t); }
  void read(double t, double* y) override { run_->read(t, y); }
  void prepare_undo() override { run_->prepare_undo(); }
  [[nodiscard]] bool undo_step() override { return run_->undo_step(); }
  void know_sizes(std::span<const double> sizes) override { run_->know_sizes(sizes); }

  [[nodiscard]] IntegrationStatistics effort() const override;
  /// The noise of the last method: a stiff, damped motion forgets the noise of explicit steps.
  [[nodiscard]] double noise() const override { return run_->noise(); }
  [[nodiscard]] std::optional<Method> changed_to() const override;
  [[nodiscard]] std::string changes() const override;

  void pass(Checkpoint& checkpoint) override;

 private:
  struct Change {
    double t = 0;
    Method to = Method::verner98;
  };

  /// A run that begins at the present time.
  [[nodiscard]] std::unique_ptr<SteppedRun> run_by(Method method, const Eigen::VectorXd& y) const;
  [[nodiscard]] std::unique_ptr<RadauRun> radau_run(const Eigen::VectorXd& y,
                                                    Accuracy accuracy) const;
  [[nodiscard]] Eigen::VectorXd present();
  void change_to(Method method);
  void adopt(Method method, std::unique_ptr<SteppedRun> run, double t);
  void choose_method(double end, double output);
  [[nodiscard]] bool try_verner98(double end, double output);
  [[nodiscard]] bool try_radau(double end, double output);
  [[nodiscard]] bool try_run(Method method, std::unique_ptr<SteppedRun> trial, double length,
                             double end, double output);
  [[nodiscard]] bool was_implicit() const;
  void pass_changes(Checkpoint& checkpoint);

  static constexpr double first_look = 16;  // steps
  static constexpr double first_look_back = 50;

  const SteppedScene& scene_;
  bool other_;
  Accuracy accuracy_;
  Method first_;
  Method explicit_;  ///< the last one before radau13
  Method method_;
  bool looks_;
  SolveOptions here_;  ///< begins at the state from which the last method began
  std::unique_ptr<SteppedRun> run_;
  std::vector<Change> changes_;
  IntegrationStatistics finished_;  ///< of the methods before
  double next_look_ = first_look;   ///< number of steps
  double needless_ = 0;             ///< consecutive steps of radau13 that could have been explicit
};

}  // namespace kreisel::detail
