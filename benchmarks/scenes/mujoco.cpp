// MuJoCo. Sparse mass matrix; joints cannot be prescribed. Only the needed calls of mj_forward and
// mj_inverse are made, because these two also do the work of a simulator.

#include <Eigen/Cholesky>

#include <algorithm>
#include <mujoco/mujoco.h>
#include <sstream>

#include "mujoco_model.hpp"
#include "peer.hpp"

namespace scenes {

namespace {

void write(std::ostream& xml, const char* name, const Triple& v) {
  xml << ' ' << name << "=\"" << v[0] << ' ' << v[1] << ' ' << v[2] << '"';
}

void open(std::ostream& xml, const Link& link) {
  xml << "<body";
  write(xml, "pos", link.position);
  xml << "><joint type=\"hinge\"";
  write(xml, "axis", link.axis);
  xml << "/><inertial mass=\"" << link.mass << '"';
  write(xml, "pos", link.centre);
  write(xml, "diaginertia", link.moments);
  xml << "/>";
}

std::string described(const Chain& chain) {
  std::ostringstream xml;
  xml.precision(17);
  xml << "<mujoco><compiler angle=\"radian\"/><option";
  write(xml, "gravity", chain.gravity);
  xml << "/><worldbody>";
  std::size_t depth = chain.links.size();
  if (chain.moves()) {
    open(xml, base_joint(chain).link);
    ++depth;
  }
  for (const Link& link : chain.links) open(xml, link);
  for (std::size_t i = 0; i < depth; ++i) xml << "</body>";
  xml << "</worldbody></mujoco>";
  return xml.str();
}

class Mujoco final : public Peer {
 public:
  explicit Mujoco(const Chain& chain)
      : n_(static_cast<int>(chain.links.size())),
        first_(chain.moves() ? 1 : 0),
        model_(load(described(chain)), mj_deleteModel),
        data_(mj_makeData(model_.get()), mj_deleteData),
        force_(model_->nv),
        mass_(model_->nv, model_->nv) {
    if (chain.moves()) data_->qvel[0] = base_joint(chain).rate;
  }

  void forward(const double* q, const double* v, double* dv) override {
    take(q, v);
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_crb(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    mj_rne(model_.get(), data_.get(), 0, force_.data());
    force_ = -force_;
    if (first_ == 0) {
      mj_factorM(model_.get(), data_.get());
      mj_solveM(model_.get(), data_.get(), dv, force_.data(), 1);
      return;
    }
    mj_fullM(model_.get(), mass_.data(), data_->qM);
    factor_.compute(mass_.bottomRightCorner(n_, n_));
    Eigen::Map<Eigen::VectorXd>(dv, n_) = factor_.solve(force_.tail(n_));
  }

  void inverse(const double* q, const double* v, const double* dv, double* force) override {
    take(q, v);
    std::copy_n(dv, n_, data_->qacc + first_);
    mj_kinematics(model_.get(), data_.get());
    mj_comPos(model_.get(), data_.get());
    mj_comVel(model_.get(), data_.get());
    mj_rne(model_.get(), data_.get(), 1, force_.data());
    std::copy_n(force_.data() + first_, n_, force);
  }

 private:
  void take(const double* q, const double* v) {
    std::copy_n(q, n_, data_->qpos + first_);
    std::copy_n(v, n_, data_->qvel + first_);
  }

  int n_;
  int first_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  Eigen::VectorXd force_;
  Eigen::MatrixXd mass_;
  Eigen::LDLT<Eigen::MatrixXd> factor_;
};

}  // namespace

Library mujoco() {
  return {
      "MuJoCo",
      mj_versionString(),
      "mj_crb, mj_rne, mj_factorM, mj_solveM",
      "mj_rne",
      "mj_rne, mj_fullM with a joint more; the others' corner solved here",
      [](const Chain& chain) -> std::unique_ptr<Peer> { return std::make_unique<Mujoco>(chain); }};
}

}  // namespace scenes
