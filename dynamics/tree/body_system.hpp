#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/guide/resting.hpp>
#include <dynamics/model/scene.hpp>
#include <dynamics/processor.hpp>
#include <dynamics/rigid/apparent_field.hpp>
#include <dynamics/tree/constraints.hpp>
#include <dynamics/tree/disturbance.hpp>
#include <dynamics/tree/elements.hpp>
#include <dynamics/tree/evaluation.hpp>
#include <dynamics/tree/passes.hpp>
#include <dynamics/tree/series.hpp>

namespace kreisel {

/// A tree of rigid bodies on a moving guide. Any number of bodies are joined to the guide or to
/// each other, with springs, dampers, drives, locks, loads, elements and constraints.
///
/// The guide's motion enters once, by velocity and acceleration at the root of the tree. Its cost
/// does not depend on the number of bodies; a guide at rest costs nothing.
///
/// All functions are const and may be called from several threads, each with its own workspace().
/// Calls with a workspace allocate no memory, except to resize results.
///
/// Source : paper 002 (26), (27): T_i V'*_i + [V'_i (T_i V'_i)] + ... = P_i + sum_j R_ij, with the
///          R_ij eliminated (dynamics/tree/elimination.hpp)
/// Error  : accelerations and reactions <= 1e-11 relative, times the condition of the mass matrix
///          if it is above 1e3, against another formulation (tests/dynamics/tree/body_system)
/// Cost   : linear in the number of bodies; benchmarks/body_system.cpp
/// Throws : InvalidInput as BodyTree does, or if a state has the wrong size; ComputationFailed,
///          naming body and direction, if a motion of a joint moves no inertia
template <class M>
class BodySystem {
  static_assert(detail::is_guide<M>,
                "the guide of a system must return a FrameMotion<Guide, Inertial>");

 public:
  using S = double;
  using Vector = Eigen::VectorXd;  ///< y = (coordinates of all joints; rates of all joints)

  struct State {
    Vector coordinates;
    Vector rates;
  };

  BodySystem(M guide, std::vector<BodyDescription> bodies, const Gravity& gravity = {})
      : guide_(std::move(guide)), tree_(std::move(bodies)), gravity_(gravity) {
    detail::KREISEL_SAME_MARCH();
    detail::check_gravity(gravity_);
  }

  BodySystem(M guide, std::vector<BodyDescription> bodies, const Gravity& gravity,
             std::vector<Element> elements, const std::vector<Constraint>& constraints = {})
      : guide_(std::move(guide)),
        tree_(std::move(bodies), std::move(elements), constraints),
        gravity_(gravity) {
    detail::KREISEL_SAME_MARCH();
    detail::check_gravity(gravity_);
  }

  [[nodiscard]] const M& guide() const { return guide_; }
  [[nodiscard]] const BodyTree& tree() const { return tree_; }
  [[nodiscard]] const Gravity& gravity() const { return gravity_; }
  /// The uniform gravity on guide axes.
  [[nodiscard]] Vector3<S> gravity_at(double t) const { return detail::field(gravity_, guide_(t)); }
  [[nodiscard]] BodyWorkspace workspace() const { return BodyWorkspace(tree_); }
  [[nodiscard]] int body_count() const { return static_cast<int>(tree_.bodies().size()); }

  /// The state with all coordinates and rates 0 and all quaternions 1.
  [[nodiscard]] State rest() const { return from_vector(tree_.rest()); }

  [[nodiscard]] static Vector to_vector(const State& state) {
    return detail::joined(state.coordinates, state.rates);
  }

  [[nodiscard]] State from_vector(const Vector& y) const {
    return {detail::coordinates(tree_, y), detail::rates(tree_, y)};
  }

  /// Lengths of the blocks of components that share unit and size, for integrators.
  [[nodiscard]] std::vector<int> blocks() const { return tree_.blocks(); }

  /// Forward dynamics: the derivatives of the joint rates. `extra` is empty or has one further
  /// joint force for each rate.
  ///
  /// Source : paper 002 (26) solved for V'*
  void accelerations(double t, const Vector& y, const Vector& extra, Vector& result,
                     BodyWorkspace& w) const {
    detail::require(tree_, y, extra.size(), w);
    result.resize(tree_.rates());
    w.outside.joint_force = extra;
    detail::accelerate(tree_, at(t, extra.size() ? &w.outside : nullptr), y, result.data(), w);
  }

  /// The vector field  y' = rates(t, y).
  void rates(double t, const Vector& y, Vector& result, BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::rates(tree_, at(t), y, result, w);
  }

  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    BodyWorkspace w = workspace();
    Vector result;
    rates(t, y, result, w);
    return result;
  }

  /// The vector field in dual numbers (Eigen's AutoDiffScalar with derivatives of fixed size), for
  /// the exact linearization:  M d(v') = -d(forces needed for v').
  ///
  /// Error  : time derivatives of guide accelerations and rotor accelerations that are functions of
  ///          double alone are differences, with an error of 2^-42 of their fifth derivatives
  /// Cost   : one evaluation of the inverse dynamics in dual numbers, and one solution for each
  ///          derivative; memory is allocated
  /// Throws : also InvalidInput, naming the body, for a load that takes no dual numbers
  template <class Dual>
  [[nodiscard]] Eigen::Matrix<Dual, Eigen::Dynamic, 1> rates(
      const Dual& t, const Eigen::Matrix<Dual, Eigen::Dynamic, 1>& y) const {
    return rates(t, y, Disturbance<Dual>());
  }

  /// As above, under influences from outside. A guide at rest by its type cannot be moved.
  template <class Dual>
  [[nodiscard]] Eigen::Matrix<Dual, Eigen::Dynamic, 1> rates(
      const Dual& t, const Eigen::Matrix<Dual, Eigen::Dynamic, 1>& y,
      const Disturbance<Dual>& outside) const {
    using Duals = Eigen::Matrix<Dual, Eigen::Dynamic, 1>;
    detail::require_dual_loads(tree_);
    BodyWorkspace w = workspace();
    Vector number(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) number[i] = y[i].value();
    const OutsideForces<double> forces = detail::values(outside.forces);
    Vector rate;
    const double now = t.value();
    detail::require(tree_, number, forces.joint_force.size(), w);
    detail::rates(tree_, at(now, &forces), number, rate, w);
    Duals result = rate.template cast<Dual>();
    const Dual* v = y.data() + tree_.coordinates();
    const Dual* dv = result.data() + tree_.coordinates();
    detail::set_coordinate_rates(tree_, y.data(), v, result.data());
    for (const detail::RotorLink& rotor : tree_.rotors()) {
      const auto& asked = tree_.body(rotor.link.body).rotor->acceleration;
      if (!asked || t.derivatives().isZero(0)) continue;
      result[tree_.coordinates() + rotor.link.v].derivatives() = asked.slope(now) * t.derivatives();
    }

    for (const BodyTree::Drive& drive : tree_.drives()) {
      if (t.derivatives().isZero(0)) continue;
      result[tree_.coordinates() + drive.rate].derivatives() =
          drive.acceleration.slope(now) * t.derivatives();
    }

    detail::MotionSpace<Dual> d(tree_);
    const FrameMotion<Guide, Inertial, Dual> guide = guide_at(t, outside);
    detail::set_poses_and_motions(tree_, detail::root(guide, gravity_, detail::is_resting<M>),
                                  y.data(), v, dv, d);
    detail::take_off_loads(tree_, t, guide, v, d);
    detail::take_off_elements(tree_, t, v, d);
    detail::take_off_outside(tree_, outside.forces, t, v, d);
    detail::add_rotor_forces_at(tree_, v, dv, d);
    detail::sum_inwards(tree_, d);
    Duals taken(tree_.rates());
    detail::project(tree_, d, taken.data());
    detail::project_rotors(tree_, dv, d, taken.data());
    detail::set_joint_forces(tree_, y.data(), v, d);
    detail::add_timed_forces(tree_, t, d);
    detail::add_couplings(tree_, y.data(), v, d.joint_force);
    if (outside.forces.joint_force.size()) d.joint_force += outside.forces.joint_force;

    Vector left(tree_.rates());
    for (Eigen::Index k = 0; k < Dual().derivatives().size(); ++k) {
      for (Eigen::Index i = 0; i < left.size(); ++i) {
        left[i] = d.joint_force[i].derivatives()[k] - taken[i].derivatives()[k];
      }
      if (tree_.constraints().empty()) {
        detail::respond(tree_, left, w);
      } else {
        const auto along = [k](const Dual* from, Eigen::Index count) {
          detail::AlongOnes numbers(count);
          for (Eigen::Index i = 0; i < count; ++i) {
            numbers[i].value() = from[i].value();
            numbers[i].derivatives()[0] = from[i].derivatives()[k];
          }
          return numbers;
        };
        detail::respond_on_constraints(tree_, along(y.data(), tree_.coordinates()),
                                       along(v, tree_.rates()), along(dv, tree_.rates()), left, w);
      }
      for (Eigen::Index i = 0; i < left.size(); ++i) {
        result[tree_.coordinates() + i].derivatives()[k] += w.acceleration[i];
      }
    }
    return result;
  }

  /// The vector field in dual numbers at a time without derivatives.
  template <class Dual>
  requires(!std::same_as<Dual, double>) [[nodiscard]] Eigen::Matrix<Dual, Eigen::Dynamic, 1> rates(
      double t, const Eigen::Matrix<Dual, Eigen::Dynamic, 1>& y) const {
    return rates(Dual(t), y);
  }

  /// The motion of the guide in dual numbers, under influences from outside.
  template <class Dual>
  [[nodiscard]] FrameMotion<Guide, Inertial, Dual> guide_at(
      const Dual& t, const Disturbance<Dual>& outside) const {
    FrameMotion<Guide, Inertial, Dual> now = detail::guide_at<Dual>(guide_, t);
    if (!outside.moves_guide) return now;
    Matrix3<Dual>& R = now.X.value.rotation;
    const Matrix3<Dual> turned = R * skew(outside.guide_turn);
    R += turned;
    auto& [turning, slide] = now.dV.value;
    turning += outside.guide_angular_acceleration;
    slide += outside.guide_acceleration - outside.guide_rate.cross(now.V.value.moment);
    now.V.value.resultant += outside.guide_rate;
    return now;
  }

  /// True if series() is available. The guide is then analytic, loads are AnalyticLoads, and
  /// prescribed accelerations are analytic functions of time. There are no constraints, no elements
  /// except couplings, and no free joint between two bodies.
  [[nodiscard]] bool knows_series() const requires(detail::feels_analytically<M>) {
    return detail::has_series(guide_) && detail::knows_series(tree_, detail::is_resting<M>);
  }

  /// The Taylor series of the motion, for TaylorSteps. This system must outlive the series.
  /// Formulas: dynamics/tree/series.hpp.
  [[nodiscard]] detail::TreeSeries series() const requires(detail::feels_analytically<M>) {
    const auto field = [this](double t, const Vector& y, Vector& rate, BodyWorkspace& w) {
      rates(t, y, rate, w);
    };
    const auto attitude = [this](double t) { return guide_(t).X.value.rotation; };
    return {tree_, detail::is_resting<M>, field, felt_at_origin(), attitude};
  }

  /// Moves a state that is close to the constraints onto them, by the least change of the motion
  /// weighted with the mass matrix. Integrators call it after each step.
  ///
  /// Throws : ComputationFailed, naming the constraint, if the state is too far from them
  void project(Vector& y, BodyWorkspace& w) const {
    if (tree_.constraints().empty()) return;
    detail::require(tree_, y, 0, w);
    detail::project_on_constraints(tree_, y, w);
  }

  /// The state nearest to a given one that fulfils the constraints, by Newton's method.
  ///
  /// Throws : ComputationFailed, naming the constraint that stays open, if there is none near
  [[nodiscard]] State assembled(const State& state) const {
    BodyWorkspace w = workspace();
    return from_vector(detail::assembled(tree_, to_vector(state), w));
  }

  /// The same for a state as one vector.
  [[nodiscard]] Vector assembled(const Vector& y) const {
    BodyWorkspace w = workspace();
    detail::require(tree_, y, 0, w);
    return detail::assembled(tree_, y, w);
  }

  /// The derivatives of the gaps of all conditions along the columns of E, then those of the gaps'
  /// rates: exact, by dual numbers.
  ///
  /// Units : m or rad and their rates, per unit of the columns
  [[nodiscard]] Eigen::MatrixXd constraint_slopes(const Vector& y, const Eigen::MatrixXd& E) const {
    return detail::constraint_slopes(tree_, y, E);
  }

  /// How far a state is from the constraints.
  [[nodiscard]] std::vector<ConstraintGap> constraint_gaps(const State& state) const {
    BodyWorkspace w = workspace();
    return detail::constraint_gaps(tree_, to_vector(state), w);
  }

  /// Constraints of which some conditions follow from those of earlier ones. They are solved for
  /// the smallest reactions.
  [[nodiscard]] std::vector<RedundantConstraint> redundant_constraints(const State& state) const {
    BodyWorkspace w = workspace();
    return detail::redundant_constraints(tree_, to_vector(state), w);
  }

  /// The reactions of the constraints.
  ///
  /// Source : paper 002 (26): the R_ij of the cut joints
  [[nodiscard]] std::vector<ConstraintReaction> constraint_reactions(double t, const Vector& y,
                                                                     BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::accelerate(tree_, at(t), y, w.acceleration.data(), w);
    return detail::constraint_reactions(tree_, w);
  }

  /// True if a spring, a damper or an element may be so stiff that it limits the step.
  [[nodiscard]] bool may_be_stiff() const {
    if (!tree_.elements().empty()) return true;
    const auto& forces = tree_.forces();
    return std::any_of(forces.begin(), forces.end(),
                       [](const JointForce& f) { return f.stiffness != 0 || f.damping != 0; });
  }

  /// Where ropes become taut or slack, and at the points of a spring's table, the forces have corners.
  [[nodiscard]] bool has_corners() const { return detail::has_corners(tree_); }
  [[nodiscard]] double corner_frequency() const { return detail::corner_frequency(tree_); }
  [[nodiscard]] std::vector<Corner> corners(double t, const Vector& y) const {
    BodyWorkspace w = workspace();
    detail::require(tree_, y, 0, w);
    return detail::corners(tree_, at(t), y, w);
  }

  /// Inverse dynamics: the joint forces, in addition to those of the description, that cause the
  /// accelerations dv.
  void joint_forces(double t, const Vector& y, const Vector& dv, Vector& result,
                    BodyWorkspace& w) const {
    detail::require(tree_, y, dv.size(), w);
    detail::joint_forces(tree_, at(t), y, dv, result, w);
  }

  /// The mass matrix of all joints, with drives and locks treated as free. It does not depend on
  /// the guide.
  ///
  /// Cost : the number of rates times the depth of the tree
  void mass_matrix(const Vector& y, Eigen::MatrixXd& result, BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::mass_matrix(tree_, y, result, w);
  }

  /// The reaction motors R_ij of all joints.
  ///
  /// Source : paper 002 (26), summed from the ends of the tree inwards
  void reactions(double t, const Vector& y, JointReactions& result, BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::reactions(tree_, at(t), y, result, w);
  }

  /// The reaction motors by causes. Costs about four times as much as reactions().
  void reaction_parts(double t, const Vector& y, std::vector<ReactionParts>& result,
                      BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::reaction_parts(tree_, at(t), y, result, w);
  }

  /// The forces of all elements in their order: force and torque on the SECOND body about its end,
  /// on the first body's axes. The force of a coupling is that on the second joint's body, about
  /// its origin.
  ///
  /// Units  : N, N m
  void element_forces(double t, const Vector& y, std::vector<Motor<>>& result,
                      BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    detail::element_forces(tree_, at(t), y, result, w);
  }

  /// The situation of a body, pose and motion: the argument of a Load.
  [[nodiscard]] LoadContext<> situation(double t, const Vector& y, int body,
                                        BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    return detail::situation(tree_, at(t), y, body, w);
  }

  /// The left side of the equation of motion of one body, with the actual accelerations.
  ///
  /// Source : paper 002 (26): relative, guide and Coriolis terms
  [[nodiscard]] ForceParts<Body> terms(double t, const Vector& y, int body,
                                       BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    return detail::terms(tree_, at(t), y, body, w);
  }

  /// The terms of (26) that rates() computes in any state: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    return detail::terms(tree_, detail::is_resting<M>, gravity_);
  }

  [[nodiscard]] BodyBalance balance(double t, const Vector& y, BodyWorkspace& w) const {
    detail::require(tree_, y, 0, w);
    return detail::balance(tree_, at(t), y, w);
  }

  /// Invariants of a motion, by name, as far as they follow from the description:
  ///
  ///   energy            guide at rest, all loads and elements conserve it (see Load), no damper;
  ///                     without the energy of the spin if rotors are regulated
  ///   linear and angular momentum   guide at rest, along the rates of root joints without forces:
  ///                     about the joint of a spherical root, along gravity if there is one; of
  ///                     free bodies with elements between them together
  ///   cyclic momentum   C (phi' + e.w) of every free rotor, on any guide
  ///
  /// Source : paper 000 (4), and (9): T2 + V = const for L = const
  [[nodiscard]] std::vector<std::pair<std::string, S>> conserved(double t,
                                                                 const State& state) const {
    BodyWorkspace w = workspace();
    const Vector y = to_vector(state);
    detail::require(tree_, y, 0, w);
    return detail::conserved(tree_, at(t), y, w);
  }

  /// Time, guide motion and gravity at t, with forces from outside; null: none.
  [[nodiscard]] detail::Surroundings at(double t,
                                        const OutsideForces<double>* outside = nullptr) const {
    return {t, guide_(t), detail::is_resting<M>, gravity_, outside};
  }

 private:
  [[nodiscard]] auto felt_at_origin() const {
    const auto* on_guide = std::get_if<UniformGravity<Guide>>(&gravity_);
    const auto* at_rest = std::get_if<UniformGravity<Inertial>>(&gravity_);
    const Vector3<S> zero = Vector3<S>::Zero();
    const auto moving = detail::components(on_guide ? on_guide->g : zero);
    const auto resting = detail::components(at_rest ? at_rest->g : zero);
    if constexpr (AnalyticGuide<M>) {
      return [felt = detail::ApparentSeries(guide_, detail::ZeroVector{}, moving, resting)](
                 double t, double h, int order) mutable { return felt.at(t, h, order); };
    } else {
      return [guide = guide_, moving, resting](double t, double h, int order) {
        GuideSeries felt = detail::series_of(guide, t, h, order, resting);
        felt.g[0] = felt.g[0] + moving;
        return felt;
      };
    }
  }

  M guide_;
  BodyTree tree_;
  Gravity gravity_;
};

static_assert(Scene<BodySystem<RestingFrame<>>> && HasTree<BodySystem<RestingFrame<>>> &&
              HasStiffness<BodySystem<RestingFrame<>>>);

}  // namespace kreisel
