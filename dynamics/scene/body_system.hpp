#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <dynamics/body/balance.hpp>
#include <dynamics/body/passes.hpp>
#include <dynamics/body/reaction.hpp>
#include <dynamics/body/terms.hpp>
#include <dynamics/guide/resting.hpp>

namespace kreisel {

namespace detail {

template <class M>
inline constexpr bool rests = std::is_same_v<M, RestingFrame<Guide, Inertial, double>>;

}  // namespace detail

/// A tree of rigid bodies on a moving guide: any number of them, joined to the guide or to each
/// other, with springs, dampers, drives, locks and loads.
///
/// The guide's motion enters by its velocity and acceleration motors where the tree begins, so it
/// costs the same for one body and for a thousand, and a guide at rest costs nothing.
///
/// Everything is const and may be called from several threads, each with its own workspace(). No
/// call that takes a workspace asks for memory, save for results that have not their size yet.
///
/// Source : paper 002 (26), (27): T_i V'*_i + [V'_i (T_i V'_i)] + ... = P_i + sum_j R_ij, with the
///          R_ij eliminated (dynamics/body/elimination.hpp)
/// Error  : accelerations and reactions <= 1e-11 relative, times the condition of the mass matrix
///          where that is above 1e3, against another formulation (tests/dynamics/scene/body_system)
/// Cost   : linear in the number of bodies; benchmarks/body_system.cpp
/// Throws : InvalidInput as BodyTree does, or where a state has the wrong size; ComputationFailed
///          where a motion of a joint meets no inertia, naming body and direction
template <class M>
class BodySystem {
  static_assert(detail::is_guide<M>, "the guide of a system says how Guide moves against Inertial");

 public:
  using S = double;
  using Vector = Eigen::VectorXd;  ///< y = (coordinates of all joints; rates of all joints)

  struct State {
    Vector coordinates;
    Vector rates;
  };

  BodySystem(M guide, std::vector<BodyDescription> bodies, const Gravity& gravity = {})
      : guide_(std::move(guide)), tree_(std::move(bodies)), gravity_(gravity) {
    if (!detail::is_finite(detail::field<double>(gravity_, {})))
      throw InvalidInput("system of bodies: gravity is not finite");
  }

  [[nodiscard]] const M& guide() const { return guide_; }
  [[nodiscard]] const BodyTree& tree() const { return tree_; }
  [[nodiscard]] const Gravity& gravity() const { return gravity_; }
  [[nodiscard]] BodyWorkspace workspace() const { return BodyWorkspace(tree_); }
  [[nodiscard]] int body_count() const { return static_cast<int>(tree_.bodies().size()); }

  /// All coordinates and rates 0, all quaternions 1.
  [[nodiscard]] State rest() const {
    State state{Vector::Zero(tree_.coordinates()), Vector::Zero(tree_.rates())};
    for (const detail::Link& link : tree_.links()) {
      if (detail::coordinate_count(link.kind) >= 4) state.coordinates[link.q + 3] = 1;
    }
    return state;
  }

  [[nodiscard]] static Vector to_vector(const State& state) {
    const Eigen::Index n = state.coordinates.size();
    Vector y(n + state.rates.size());
    std::copy_n(state.coordinates.data(), n, y.data());
    std::copy_n(state.rates.data(), state.rates.size(), y.data() + n);
    return y;
  }

  [[nodiscard]] State from_vector(const Vector& y) const {
    return {y.head(tree_.coordinates()), y.tail(tree_.rates())};
  }

  /// For integrators: components that share unit and size.
  [[nodiscard]] std::vector<int> blocks() const { return tree_.blocks(); }

  /// Forward dynamics: the rates of the joint rates. `extra` are joint forces besides those of the
  /// description, empty or one for each rate.
  ///
  /// Source : paper 002 (26) solved for V'*
  void accelerations(double t, const Vector& y, const Vector& extra, Vector& result,
                     BodyWorkspace& w) const {
    require(y, extra, w);
    result.resize(tree_.rates());
    accelerate(t, y, extra, result.data(), w);
  }

  /// The vector field  y' = rates(t, y).
  void rates(double t, const Vector& y, Vector& result, BodyWorkspace& w) const {
    require(y, {}, w);
    result.resize(y.size());
    detail::set_coordinate_rates(tree_, y.data(), rates_of(y), result.data());
    accelerate(t, y, {}, result.data() + tree_.coordinates(), w);
  }

  [[nodiscard]] Vector rates(double t, const Vector& y) const {
    BodyWorkspace w = workspace();
    Vector result;
    rates(t, y, result, w);
    return result;
  }

  /// The vector field for dual numbers (Eigen's AutoDiffScalar with derivatives of fixed size), as
  /// the exact linearisation takes it:  M d(v') = -d(forces that v' takes).
  ///
  /// Error  : rates in time of a guide's accelerations and of rotors' speeds that take doubles alone
  ///          are differences, which err by 2^-42 of their fifth derivatives
  /// Cost   : one evaluation in dual numbers of the inverse dynamics, and a solution for each
  ///          derivative; memory is asked for
  /// Throws : InvalidInput besides, naming the body, for a load that takes no dual numbers
  template <class Dual>
  [[nodiscard]] Eigen::Matrix<Dual, Eigen::Dynamic, 1> rates(
      const Dual& t, const Eigen::Matrix<Dual, Eigen::Dynamic, 1>& y) const {
    using Duals = Eigen::Matrix<Dual, Eigen::Dynamic, 1>;
    for (const int body : tree_.loaded()) {
      const auto& loads = tree_.body(body).loads;
      if (std::all_of(loads.begin(), loads.end(),
                      [](const BodyLoad& load) { return load.takes_dual_numbers(); })) {
        continue;
      }
      detail::refuse_body(tree_.body(body).name,
                          "a load of it takes no dual numbers, so it has no linear equations: make "
                          "it a template on the number type N,  Force<Body, N> operator()(const "
                          "Situation<N>&) const");
    }
    BodyWorkspace w = workspace();
    Vector number(y.size());
    for (Eigen::Index i = 0; i < y.size(); ++i) number[i] = y[i].value();
    Vector rate;
    const double now = t.value();
    rates(now, number, rate, w);
    Duals result = rate.template cast<Dual>();
    const Dual* v = y.data() + tree_.coordinates();
    const Dual* dv = result.data() + tree_.coordinates();
    detail::set_coordinate_rates(tree_, y.data(), v, result.data());
    for (const detail::RotorLink& rotor : tree_.rotors()) {
      const auto& asked = tree_.body(rotor.link.body).rotor->acceleration;
      if (!asked || t.derivatives().isZero(0)) continue;
      result[tree_.coordinates() + rotor.link.v].derivatives() =
          detail::slope_in_time(asked, now) * t.derivatives();
    }

    detail::MotionSpace<Dual> d(tree_);
    const FrameMotion<Guide, Inertial, Dual> guide = detail::guide_at<Dual>(guide_, t);
    detail::set_poses_and_motions(tree_, root(guide), y.data(), v, dv, d);
    detail::take_off_loads(tree_, t, guide, v, d);
    detail::add_rotor_forces_at(tree_, v, dv, d);
    detail::sum_inwards(tree_, d);
    Duals taken(tree_.rates());
    detail::project(tree_, d, taken.data());
    detail::project_rotors(tree_, dv, d, taken.data());
    detail::set_joint_forces(tree_, y.data(), v, d);

    Vector left(tree_.rates());
    for (Eigen::Index k = 0; k < Dual().derivatives().size(); ++k) {
      for (Eigen::Index i = 0; i < left.size(); ++i) {
        left[i] = d.joint_force[i].derivatives()[k] - taken[i].derivatives()[k];
      }
      respond(left, w);
      for (Eigen::Index i = 0; i < left.size(); ++i) {
        result[tree_.coordinates() + i].derivatives()[k] += w.acceleration[i];
      }
    }
    return result;
  }

  /// The same at a time that is given.
  template <class Dual>
  requires(!std::same_as<Dual, double>) [[nodiscard]] Eigen::Matrix<Dual, Eigen::Dynamic, 1> rates(
      double t, const Eigen::Matrix<Dual, Eigen::Dynamic, 1>& y) const {
    return rates(Dual(t), y);
  }

  /// Inverse dynamics: the joint forces, besides those of the description, that bring about the
  /// accelerations dv.
  void joint_forces(double t, const Vector& y, const Vector& dv, Vector& result,
                    BodyWorkspace& w) const {
    require(y, dv, w);
    result.resize(tree_.rates());
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    detail::set_poses_and_motions(tree_, root(guide), y.data(), rates_of(y),
                                  dv.size() ? dv.data() : nullptr, w);
    detail::take_off_loads(tree_, t, guide, rates_of(y), w);
    const double* given = dv.size() ? dv.data() : w.still.data();
    detail::add_rotor_forces_at(tree_, rates_of(y), given, w);
    detail::sum_inwards(tree_, w);
    detail::project(tree_, w, result.data());
    detail::project_rotors(tree_, given, w, result.data());
    detail::set_joint_forces(tree_, y.data(), rates_of(y), w);
    result -= w.joint_force;
  }

  /// The mass matrix of all joints, drives and locks taken as free. Does not depend on the guide.
  ///
  /// Cost : the number of rates times the depth of the tree
  void mass_matrix(const Vector& y, Eigen::MatrixXd& result, BodyWorkspace& w) const {
    require(y, {}, w);
    detail::set_poses(tree_, y.data(), w);
    detail::mass_matrix(tree_, w, result);
  }

  /// The reaction motors R_ij of all joints.
  ///
  /// Source : paper 002 (26), read from the ends of the tree inwards
  void reactions(double t, const Vector& y, JointReactions& result, BodyWorkspace& w) const {
    accelerations(t, y, {}, w.acceleration, w);
    joint_forces(t, y, w.acceleration, result.drive, w);
    for (const detail::Link& link : tree_.links()) {
      if (!link.moved_by_forces()) continue;
      for (int k = 0; k < detail::rate_count(link.kind); ++k) result.drive[link.v + k] = 0;
    }
    for (const detail::RotorLink& rotor : tree_.rotors()) {
      if (!rotor.regulated()) result.drive[rotor.link.v] = 0;
    }
    detail::set_rotor_poses(tree_, y.data(), w);
    detail::complete_rotor_forces(tree_, rates_of(y), w.acceleration.data(), w);
    result.on_body.resize(tree_.bodies().size());
    for (int i = 0; i < body_count(); ++i) {
      result.on_body[index(i)] = detail::joint_reaction(tree_, i, w);
    }
  }

  /// The same by causes. Costs about four times as much.
  void reaction_parts(double t, const Vector& y, std::vector<ReactionParts>& result,
                      BodyWorkspace& w) const {
    require(y, {}, w);
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    const LinkMotion moving{guide.V.value.resultant, guide.dV.value.resultant,
                            guide.origin_acceleration()};
    const Vector3<double> zero = Vector3<double>::Zero();
    const LinkMotion weight{zero, zero, -detail::field(gravity_, guide)};
    result.resize(tree_.bodies().size());
    detail::set_poses(tree_, y.data(), w);
    detail::eliminate_all(tree_, w);
    const double* v = rates_of(y);
    const double* still = w.still.data();
    const auto note = [&](Force<Body> ReactionParts::*part) {
      for (int i = 0; i < body_count(); ++i) {
        result[index(i)].*part = detail::joint_reaction(tree_, i, w);
      }
    };
    w.joint_force.setZero();
    detail::ask_spin_up(tree_, t, w);
    answer({}, v, nullptr, y, w);
    note(&ReactionParts::spin);
    answer(moving, v, nullptr, y, w);
    note(&ReactionParts::guide);
    for (ReactionParts& parts : result) parts.guide = parts.guide - parts.spin;
    detail::ask_no_spin_up(w);
    answer(weight, still, nullptr, y, w);
    note(&ReactionParts::gravity);
    detail::set_joint_forces(tree_, y.data(), v, w);
    const Situation<> now{t, {}, {}, guide, {}};
    answer({}, still, &now, y, w);
    note(&ReactionParts::forces);
  }

  /// Where the body is and how it moves: what a Load is given.
  [[nodiscard]] Situation<> situation(double t, const Vector& y, int body, BodyWorkspace& w) const {
    require(y, {}, w);
    detail::set_poses(tree_, y.data(), w);
    detail::set_places(tree_, rates_of(y), w);
    detail::set_rotor_places(tree_, y.data(), rates_of(y), w);
    return detail::situation(tree_, t, guide_(t), body, w);
  }

  /// The left side of the law of one body, with the accelerations that the forces bring about.
  ///
  /// Source : paper 002 (26), its relative, guide and Coriolis terms in turn
  [[nodiscard]] ForceParts<Body> terms(double t, const Vector& y, int body,
                                       BodyWorkspace& w) const {
    accelerations(t, y, {}, w.acceleration, w);
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    detail::set_motions(tree_, root(guide), rates_of(y), w.acceleration.data(), w);
    detail::set_places(tree_, rates_of(y), w);
    detail::set_rotor_places(tree_, y.data(), rates_of(y), w);
    detail::set_rotor_motions(tree_, rates_of(y), w.acceleration.data(), w);
    return detail::terms(tree_, detail::situation(tree_, t, guide, body, w), body,
                         detail::field(gravity_, guide), w);
  }

  /// What rates() computes of (26), whatever the state: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    return detail::equation_terms(tree_, detail::rests<M>, gravity_);
  }

  [[nodiscard]] BodyBalance balance(double t, const Vector& y, BodyWorkspace& w) const {
    require(y, {}, w);
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    detail::set_poses(tree_, y.data(), w);
    detail::set_places(tree_, rates_of(y), w);
    detail::set_rotor_places(tree_, y.data(), rates_of(y), w);
    return detail::balance(tree_, t, guide, gravity_, y.data(), rates_of(y), w);
  }

  /// What does not change during a motion, as far as the description shows it: the energy where the
  /// guide rests and all forces have a potential, without that of the spin where rotors are
  /// regulated; the momentum where nothing acts from outside; the cyclic momentum C (phi' + e.w) of
  /// every free rotor.
  ///
  /// Source : paper 000 (4), and (9): T2 + V = const for L = const
  [[nodiscard]] std::vector<std::pair<std::string, S>> conserved(double t,
                                                                 const State& state) const {
    std::vector<std::pair<std::string, S>> result;
    BodyWorkspace w = workspace();
    const BodyBalance now = balance(t, to_vector(state), w);
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    for (std::size_t k = 0; k < tree_.rotors().size(); ++k) {
      const detail::RotorLink& rotor = tree_.rotors()[k];
      if (rotor.mode != RotorMode::free) continue;
      result.emplace_back("cyclic momentum of '" + tree_.body(rotor.link.body).name + "'",
                          detail::momentum_weight(tree_, k, guide, state.rates.data(), w));
    }
    if constexpr (detail::rests<M>) {
      switch (detail::energy_law(tree_)) {
        case detail::EnergyLaw::none: break;
        case detail::EnergyLaw::all:
          result.emplace_back("energy", now.kinetic_energy + now.potential_energy);
          break;
        case detail::EnergyLaw::without_spin:
          result.emplace_back("energy without spin", now.carrier_energy + now.potential_energy);
          break;
      }
      if (detail::keeps_momentum(tree_, gravity_)) {
        const auto& [p, L] = now.momentum.value;
        static constexpr const char* linear[] = {"momentum x", "momentum y", "momentum z"};
        static constexpr const char* angular[] = {"angular momentum x", "angular momentum y",
                                                  "angular momentum z"};
        for (int k = 0; k < 3; ++k) result.emplace_back(linear[k], p[k]);
        for (int k = 0; k < 3; ++k) result.emplace_back(angular[k], L[k]);
      }
    }
    return result;
  }

 private:
  using LinkMotion = detail::LinkMotion<>;

  [[nodiscard]] static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  [[nodiscard]] const double* rates_of(const Vector& y) const {
    return y.data() + tree_.coordinates();
  }

  void require(const Vector& y, const Vector& per_rate, const BodyWorkspace& w) const {
    if (y.size() != tree_.coordinates() + tree_.rates()) {
      throw InvalidInput("system of bodies: a state of " + std::to_string(y.size()) +
                         " components, not " + std::to_string(tree_.coordinates() + tree_.rates()));
    }
    if (per_rate.size() != 0 && per_rate.size() != tree_.rates()) {
      throw InvalidInput("system of bodies: " + std::to_string(per_rate.size()) + " numbers for " +
                         std::to_string(tree_.rates()) + " rates");
    }
    if (w.pose.size() != tree_.slots() || w.joint_force.size() != tree_.rates()) {
      throw InvalidInput("system of bodies: the workspace is of another system");
    }
  }

  /// Where the tree begins. In a uniform field the weights of all bodies are what a guide
  /// accelerated by -g would ask for.
  template <class N>
  [[nodiscard]] detail::LinkMotion<N> root(const FrameMotion<Guide, Inertial, N>& guide) const {
    if constexpr (detail::rests<M>) {
      return {Vector3<N>::Zero(), Vector3<N>::Zero(), -detail::field(gravity_, guide)};
    } else {
      return {guide.V.value.resultant, guide.dV.value.resultant,
              guide.origin_acceleration() - detail::field(gravity_, guide)};
    }
  }

  void accelerate(double t, const Vector& y, const Vector& extra, double* result,
                  BodyWorkspace& w) const {
    const FrameMotion<Guide, Inertial> guide = guide_(t);
    detail::set_poses_and_motions(tree_, root(guide), y.data(), rates_of(y), nullptr, w);
    detail::take_off_loads(tree_, t, guide, rates_of(y), w);
    detail::set_joint_forces(tree_, y.data(), rates_of(y), w);
    if (extra.size()) w.joint_force += extra;
    detail::ask_spin_up(tree_, t, w);
    detail::add_rotor_forces(tree_, rates_of(y), w.joint_force.data(), w);
    detail::eliminate_and_solve(tree_, w.joint_force.data(), result, w);
  }

  /// The accelerations  M dv = joint_force  of a system at rest, once the joints are eliminated.
  void respond(const Vector& joint_force, BodyWorkspace& w) const {
    const double* still = w.still.data();
    detail::set_motions(tree_, LinkMotion{}, still, nullptr, w);
    detail::ask_no_spin_up(w);
    detail::add_rotor_forces(tree_, still, joint_force.data(), w);
    detail::solve(tree_, joint_force.data(), w.acceleration.data(), w);
  }

  /// Reactions to a part of the causes; the joints are eliminated and w.joint_force is set.
  void answer(const LinkMotion& root, const double* v, const Situation<>* loads_at, const Vector& y,
              BodyWorkspace& w) const {
    const auto set_forces = [&](const double* dv) {
      detail::set_motions(tree_, root, v, dv, w);
      if (loads_at) detail::take_off_loads(tree_, loads_at->t, loads_at->guide, rates_of(y), w);
    };
    set_forces(nullptr);
    detail::add_rotor_forces(tree_, v, w.joint_force.data(), w);
    detail::solve(tree_, w.joint_force.data(), w.acceleration.data(), w);
    const double* dv = w.acceleration.data();
    set_forces(dv);
    detail::add_rotor_forces_at(tree_, v, dv, w);
    detail::sum_inwards(tree_, w);
    detail::set_rotor_poses(tree_, y.data(), w);
    detail::complete_rotor_forces(tree_, v, dv, w);
  }

  M guide_;
  BodyTree tree_;
  Gravity gravity_;
};

}  // namespace kreisel
