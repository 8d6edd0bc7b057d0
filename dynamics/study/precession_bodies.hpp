#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <dynamics/study/precession.hpp>
#include <dynamics/tree/rotor_matrices.hpp>
#include <motor/attitude.hpp>

namespace kreisel {

/// A system of bodies with fast rotors as a model for precession_motion(). A position consists of
/// the system's coordinates, in which the rotors' angles are constant, and the rotors' momenta l.
/// Displacements and u follow the rates without the rotors', RotorMatrices::rates. An attitude is
/// displaced by small angles on the body's axes.
///
/// Source : paper 000 (11)-(15); (G_R) as RotorMatrices has it
/// Error  : of loads' damping that of a central difference over 1e-3 m/s and rad/s: none where they
///          are linear in the velocities
/// Throws : InvalidInput if a joint is locked or driven (make it fixed), a rotor is braked by
///          friction, there is no rotor, or nothing but rotors can move
/// Cost   : one rotor_matrices() for each evaluation; with loads 2n more, for their damping
template <class M>
class PrecessionBodies final : public PrecessionModel {
 public:
  explicit PrecessionBodies(BodySystem<M> system)
      : system_(std::move(system)), workspace_(system_.workspace()) {
    const BodyTree& tree = system_.tree();
    const auto refuse = [&tree](int body, const char* why) {
      throw InvalidInput("precession equations: body '" + tree.body(body).name + "' " + why);
    };
    for (const detail::Link& link : tree.links()) {
      if (link.body >= 0 && link.rule != JointRule::forces)
        refuse(link.body, "is locked or driven");
    }
    std::vector<bool> spins(static_cast<std::size_t>(tree.rates()), false);
    for (const detail::RotorLink& rotor : tree.rotors()) {
      const auto v = static_cast<std::size_t>(rotor.link.v);
      spins[v] = true;
      if (!rotor.regulated() && tree.forces()[v].damping != 0) {
        refuse(rotor.link.body, "is a rotor with friction");
      }
      if (tree.forces()[v].in_time) {
        refuse(rotor.link.body, "is a rotor with a torque that changes with time");
      }
    }
    for (int k = 0; k < tree.rates(); ++k) {
      if (!spins[static_cast<std::size_t>(k)]) rates_.push_back(k);
    }
    if (tree.rotors().empty()) {
      throw InvalidInput("precession equations: there is no rotor among the bodies");
    }
    if (rates_.empty()) {
      throw InvalidInput(
          "precession equations: nothing but rotors can move: another body must be free to move");
    }
  }

  [[nodiscard]] const BodySystem<M>& system() const { return system_; }

  /// Position and u of a state.
  [[nodiscard]] std::pair<Eigen::VectorXd, Eigen::VectorXd> start(double t,
                                                                  const Eigen::VectorXd& y) const {
    const BodyTree& tree = system_.tree();
    const RotorMatrices m = rotor_matrices(system_, t, y, workspace_);
    Eigen::VectorXd position(tree.coordinates() + m.l.size());
    position << y.head(tree.coordinates()), m.l;
    return {position, y.tail(tree.rates())(rates_)};
  }

  /// The state at a position with these velocities.
  [[nodiscard]] Eigen::VectorXd state(double t, const Eigen::VectorXd& position,
                                      const Eigen::VectorXd& u) const {
    Eigen::VectorXd y;
    (void)matrices(t, position, u, y);
    return y;
  }

  [[nodiscard]] GyroForces forces(double t, const Eigen::VectorXd& position) const override {
    const auto n = static_cast<Eigen::Index>(rates_.size());
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(n);
    const RotorMatrices m = matrices(t, position, zero);
    GyroForces f{m.A_eff, m.G_R, Eigen::MatrixXd::Zero(n, n), m.Q - m.c};
    const BodyTree& tree = system_.tree();
    if (tree.loaded().empty() && tree.elements().empty()) {
      for (Eigen::Index k = 0; k < n; ++k) {
        const int rate = rates_[static_cast<std::size_t>(k)];
        f.D(k, k) = tree.forces()[static_cast<std::size_t>(rate)].damping;
      }
      return f;
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      // Small, because terms of higher order in the velocities are no damping.
      const double small = 1e-3;
      const Eigen::VectorXd u = small * Eigen::VectorXd::Unit(n, k);
      f.D.col(k) = (matrices(t, position, -u).Q - matrices(t, position, u).Q) / (2 * small);
    }
    return f;
  }

  [[nodiscard]] Eigen::VectorXd motion_forces(double t, const Eigen::VectorXd& position,
                                              const Eigen::VectorXd& u) const override {
    const GyroForces f = forces(t, position);
    const RotorMatrices m = matrices(t, position, u);
    return f.Q - (m.Q - m.c) - f.D * u;
  }

  [[nodiscard]] Eigen::VectorXd rate(double t, const Eigen::VectorXd& position,
                                     const Eigen::VectorXd& u) const override {
    const BodyTree& tree = system_.tree();
    Eigen::VectorXd result(position.size());
    const Eigen::VectorXd v = scattered(u);
    detail::set_coordinate_rates(tree, position.data(), v.data(), result.data());
    for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
      const detail::RotorLink& rotor = tree.rotors()[k];
      const auto& asked = tree.body(rotor.link.body).rotor->acceleration;
      const double torque = tree.forces()[static_cast<std::size_t>(rotor.link.v)].constant;
      result[tree.coordinates() + static_cast<Eigen::Index>(k)] = !rotor.regulated() ? torque
                                                                  : asked ? rotor.about * asked(t)
                                                                          : 0.0;
    }
    return result;
  }

  [[nodiscard]] Eigen::VectorXd moved(const Eigen::VectorXd& position,
                                      const Eigen::VectorXd& e) const override {
    Eigen::VectorXd result = position;
    const Eigen::VectorXd v = scattered(e);
    for (const detail::Link& link : system_.tree().links()) {
      if (detail::rate_count(link.kind) == 1) result[link.q] += v[link.v];
      if (detail::rate_count(link.kind) < 3) continue;
      const Eigen::Quaterniond q(Eigen::Vector4d(position.segment<4>(link.q)));
      result.segment<4>(link.q) = rotated(q, Vector3<double>(v.segment<3>(link.v))).coeffs();
      if (link.kind == detail::LinkKind::free) {
        result.segment<3>(link.q + 4) += v.segment<3>(link.v + 3);
      }
    }
    return result;
  }

  [[nodiscard]] Eigen::VectorXd turning_along(const Eigen::VectorXd& /*position*/,
                                              const Eigen::VectorXd& u,
                                              const Eigen::VectorXd& e) const override {
    const Eigen::VectorXd w = scattered(u), x = scattered(e);
    Eigen::VectorXd result = Eigen::VectorXd::Zero(x.size());
    for (const detail::Link& link : system_.tree().links()) {
      if (detail::rate_count(link.kind) < 3) continue;
      const Vector3<double> turn = w.segment<3>(link.v), angles = x.segment<3>(link.v);
      result.segment<3>(link.v) = angles.cross(turn);
    }
    return result(rates_);
  }

  [[nodiscard]] std::vector<int> blocks() const override {
    const BodyTree& tree = system_.tree();
    std::vector<int> result;
    for (int sum = 0; const int size : tree.blocks()) {
      if (sum == tree.coordinates()) break;
      result.push_back(size);
      sum += size;
    }
    result.insert(result.end(), tree.rotors().size(), 1);
    return result;
  }

 private:
  [[nodiscard]] Eigen::VectorXd scattered(const Eigen::VectorXd& u) const {
    Eigen::VectorXd v = Eigen::VectorXd::Zero(system_.tree().rates());
    v(rates_) = u;
    return v;
  }

  /// With the rotors at the rates that belong to their momenta.
  [[nodiscard]] RotorMatrices matrices(double t, const Eigen::VectorXd& position,
                                       const Eigen::VectorXd& u) const {
    Eigen::VectorXd y;
    return matrices(t, position, u, y);
  }

  /// As above; y becomes the state with these rates.
  [[nodiscard]] RotorMatrices matrices(double t, const Eigen::VectorXd& position,
                                       const Eigen::VectorXd& u, Eigen::VectorXd& y) const {
    const BodyTree& tree = system_.tree();
    const Eigen::VectorXd l = position.tail(static_cast<Eigen::Index>(tree.rotors().size()));
    y.resize(tree.coordinates() + tree.rates());
    y << position.head(tree.coordinates()), scattered(u);
    const auto set_rate = [&](std::size_t k, double momentum) {
      const detail::RotorLink& rotor = tree.rotors()[k];
      y[tree.coordinates() + rotor.link.v] += momentum / rotor.about;
    };
    for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
      set_rate(k, l[static_cast<Eigen::Index>(k)]);
    }
    RotorMatrices m = rotor_matrices(system_, t, y, workspace_);
    // A free rotor's momentum is absolute: its carrier's rotation is subtracted for the rate.
    const Eigen::VectorXd carried = m.l - l;
    if (carried.isZero(0)) return m;
    for (std::size_t k = 0; k < tree.rotors().size(); ++k) {
      set_rate(k, -carried[static_cast<Eigen::Index>(k)]);
    }
    return rotor_matrices(system_, t, y, workspace_);
  }

  BodySystem<M> system_;
  std::vector<int> rates_;
  mutable BodyWorkspace workspace_;
};

}  // namespace kreisel
