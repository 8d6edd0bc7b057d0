#pragma once

#include <Eigen/Core>

#include <complex>
#include <concepts>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/file/joints.hpp>
#include <dynamics/file/scene_file.hpp>
#include <dynamics/study/linear_plant.hpp>
#include <dynamics/tree/reaction.hpp>
#include <dynamics/tree/tree.hpp>

namespace kreisel {

/// The validity of the precession equations for a scene.
struct PrecessionCheck {
  struct Root {
    std::complex<double> technical;
    std::complex<double> exact;
  };

  /// A test by all roots about an equilibrium.
  struct Test {
    bool admissible = false;
    std::string reason;  ///< why not admissible
    double greatest_shift = 0;
    std::vector<Root> slow;
  };

  /// The motion from the start in the file.
  struct Motion {
    double end = 0;
    double bound = 0;
    double nutation = 0;  ///< greatest amplitude that is left out
    double valid_until = 0;
    bool slow = true;
  };

  std::string beyond;  ///< why there is no answer at all
  int velocities = 0;
  int rank = 0;  ///< of G
  int kept = 0;  ///< number of accelerations that the equations keep
  std::string not_tested;
  Test test;
  std::string no_motion;
  Motion motion;
};

/// The bodies of a scene on their guide, with its controllers, as a system for studies.
/// ControlledSystem and the templates that use it are compiled in study_system.cpp alone.
///
/// A state has coordinates, rates and the memory of the controllers. The field of sampled
/// controllers is ControlledSystem::steady_rates().
class StudySystem {
  template <class N>
  using Numbers = Eigen::Matrix<N, Eigen::Dynamic, 1>;

 public:
  using Vector = Eigen::VectorXd;

  /// The guide is defined from the scene's t_begin to its t_end.
  explicit StudySystem(const SceneFile& scene);
  StudySystem(const StudySystem&) = delete;
  StudySystem& operator=(const StudySystem&) = delete;
  ~StudySystem();

  /// Every evaluation after a request of this stop throws ComputationFailed, which ends the study.
  void stop_by(std::stop_token stop) { stop_ = std::move(stop); }

  [[nodiscard]] const BodyTree& tree() const;
  /// The time of the start.
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] std::vector<int> blocks() const;

  /// The state at the start of the scene, and the joints of a state.
  [[nodiscard]] Vector start_of(const SceneFile& scene) const;
  [[nodiscard]] JointState joints_of(const Vector& y) const;

  /// The names of the memory of controllers.
  [[nodiscard]] std::vector<std::string> memory_names() const;

  /// True if a controller is sampled. The roots are then those of sampled_transition().
  [[nodiscard]] bool has_samples() const;
  [[nodiscard]] SampledTransition sampled_transition(const Vector& y) const;

  /// The linear plant about a state at the time t.
  [[nodiscard]] LinearPlant plant(double t, const Vector& y, std::vector<PlantInput> inputs,
                                  std::vector<PlantOutput> outputs) const;
  [[nodiscard]] LinearPlant plant(double t, const Vector& y, std::vector<PlantInput> inputs,
                                  std::vector<PlantOutput> outputs, FreeDirections free) const;

  [[nodiscard]] Vector rates(double t, const Vector& y) const;

  /// rates() with scratch memory of its own, for many evaluations in one thread.
  [[nodiscard]] std::function<void(double t, const Vector& y, Vector& rates)> field() const;

  /// As BodySystem has them.
  [[nodiscard]] Vector assembled(const Vector& y) const;
  [[nodiscard]] Eigen::MatrixXd constraint_slopes(const Vector& y, const Eigen::MatrixXd& E) const;

  /// The rates in the dual numbers of the studies.
  template <class Dual>
  requires(!std::same_as<Dual, double>)
      [[nodiscard]] Numbers<Dual> rates(const Dual& t, const Numbers<Dual>& y) const;

  [[nodiscard]] JointReactions reactions(double t, const Vector& y) const;

  /// The derivative of the state matrix by ln of all rotors' momenta.
  [[nodiscard]] Eigen::MatrixXd momenta_slope(double t, const Vector& y) const;

  /// `rest` is the equilibrium for the test of the roots; empty if there is none.
  [[nodiscard]] PrecessionCheck precession(const Vector& start, const Vector& rest,
                                           double t_end) const;

  /// States by the precession equations at increasing times since the start, until the motion is no longer slow.
  /// Angles of rotors do not change.
  ///
  /// Throws : InvalidInput if there are no such equations; ComputationFailed
  [[nodiscard]] std::vector<Vector> technical(const Vector& start,
                                              const std::vector<double>& times) const;

 private:
  class Bodies;
  void check_stop() const;

  double begin_;
  std::stop_token stop_;
  std::unique_ptr<const Bodies> bodies_;
};

}  // namespace kreisel
