// Orocos KDL. Mass matrix and Newton-Euler recursion; joints cannot be prescribed.

#include <Eigen/Cholesky>

#include <algorithm>
#include <kdl/chain.hpp>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/config.h>
#include <stdexcept>

#include "peer.hpp"

namespace scenes {

namespace {

KDL::Vector vector(const Triple& v) { return {v[0], v[1], v[2]}; }

void add(KDL::Chain& chain, const Link& link) {
  const auto& [A, B, C] = link.moments;
  chain.addSegment(KDL::Segment(
      KDL::Joint("", vector(link.position), vector(link.axis), KDL::Joint::RotAxis),
      KDL::Frame(vector(link.position)),
      KDL::RigidBodyInertia(link.mass, vector(link.centre), KDL::RotationalInertia(A, B, C))));
}

KDL::Chain described(const Chain& chain) {
  KDL::Chain result;
  if (chain.moves()) add(result, base_joint(chain).link);
  for (const Link& link : chain.links) add(result, link);
  return result;
}

void require(int code) {
  if (code < 0) throw std::runtime_error("KDL: error " + std::to_string(code));
}

class Kdl final : public Peer {
 public:
  explicit Kdl(const Chain& chain)
      : n_(static_cast<Eigen::Index>(chain.links.size())),
        chain_(described(chain)),
        forward_(chain_, vector(chain.gravity)),
        inverse_(chain_, vector(chain.gravity)),
        parameters_(chain_, vector(chain.gravity)),
        q_(chain_.getNrOfJoints()),
        v_(chain_.getNrOfJoints()),
        dv_(chain_.getNrOfJoints()),
        force_(chain_.getNrOfJoints()),
        mass_(static_cast<int>(chain_.getNrOfJoints())),
        outside_(chain_.getNrOfSegments(), KDL::Wrench::Zero()),
        on_base_(chain.moves()) {
    if (on_base_) v_.data[0] = base_joint(chain).rate;
  }

  void forward(const double* q, const double* v, double* dv) override {
    take(q, v);
    if (!on_base_) {
      require(forward_.CartToJnt(q_, v_, force_, outside_, dv_));
      std::copy_n(dv_.data.data(), n_, dv);
      return;
    }
    require(inverse_.CartToJnt(q_, v_, dv_, outside_, force_));
    require(parameters_.JntToMass(q_, mass_));
    factor_.compute(mass_.data.bottomRightCorner(n_, n_));
    Eigen::Map<Eigen::VectorXd>(dv, n_) = factor_.solve(-force_.data.tail(n_));
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) override {
    take(q, v);
    std::copy_n(dv, n_, dv_.data.data() + (on_base_ ? 1 : 0));
    require(inverse_.CartToJnt(q_, v_, dv_, outside_, force_));
    std::copy_n(force_.data.data() + (on_base_ ? 1 : 0), n_, force);
  }

 private:
  void take(const double* q, const double* v) {
    std::copy_n(q, n_, q_.data.data() + (on_base_ ? 1 : 0));
    std::copy_n(v, n_, v_.data.data() + (on_base_ ? 1 : 0));
  }

  Eigen::Index n_;
  KDL::Chain chain_;
  KDL::ChainFdSolver_RNE forward_;
  KDL::ChainIdSolver_RNE inverse_;
  KDL::ChainDynParam parameters_;
  KDL::JntArray q_, v_, dv_, force_;
  KDL::JntSpaceInertiaMatrix mass_;
  KDL::Wrenches outside_;
  Eigen::LDLT<Eigen::MatrixXd> factor_;
  bool on_base_;
};

}  // namespace

Library kdl() {
  return {"Orocos KDL",
          KDL_VERSION_STRING,
          "ChainFdSolver_RNE",
          "ChainIdSolver_RNE",
          "ChainIdSolver_RNE, JntToMass with a joint more; the others' corner solved here",
          [](const Chain& chain) -> std::unique_ptr<Peer> { return std::make_unique<Kdl>(chain); }};
}

}  // namespace scenes
