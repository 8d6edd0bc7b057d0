#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include <dynamics/exact/free_cardan_gyro.hpp>
#include <dynamics/solve/closed_form_parts.hpp>
#include <dynamics/tree/cardan_chain.hpp>
#include <motor/error.hpp>

/// The closed form of a free Cardan gyro.

namespace kreisel::detail {

bool is_free_of_forces(const BodyTree& tree) {
  const bool alone = tree.loaded().empty() && tree.elements().empty() &&
                     tree.constraints().empty() && tree.timed_forces().empty();
  return alone && std::all_of(tree.forces().begin(), tree.forces().end(), [](const JointForce& f) {
           return f.stiffness == 0 && f.damping == 0 && f.constant == 0;
         });
}

namespace {

/// True for a rotor of constant speed, false for one without torque about its axis; nothing for
/// others.
[[nodiscard]] std::optional<bool> is_regulated(const BodyDescription& body) {
  if (body.rule == JointRule::driven) {
    return body.acceleration ? std::nullopt : std::optional(true);
  }
  if (body.rule != JointRule::forces) return std::nullopt;
  if (!body.rotor || body.rotor->mode == RotorMode::free) return false;
  const bool constant = body.rotor->mode == RotorMode::regulated && !body.rotor->acceleration;
  return constant ? std::optional(true) : std::nullopt;
}

/// The moments of inertia of a free Cardan gyro.
struct FreeGyro {
  Vector3<double> rotor, inner_ring, outer_ring;
  double sign;  ///< of the rotor's angle
  bool regulated;

  [[nodiscard]] exact::FreeCardanGyro motion(const Eigen::VectorXd& y) const {
    return {rotor,
            inner_ring,
            outer_ring,
            regulated,
            {y[0], y[1], exact::Real(sign) * y[2], y[3], y[4], exact::Real(sign) * y[5]}};
  }

  [[nodiscard]] Eigen::VectorXd state(const exact::FreeCardanGyro& motion, exact::Real time) const {
    const auto now = motion.at(time);
    Eigen::VectorXd y(6);
    y << double(now.alpha), double(now.beta), sign * double(now.phi), double(now.alpha_rate),
        double(now.beta_rate), sign * double(now.phi_rate);
    return y;
  }
};

/// The tree as a free Cardan gyro. Axes must be coordinate axes and products of inertia exactly 0:
/// a deviation of rounding size would not be in the error.
[[nodiscard]] std::optional<FreeGyro> free_gyro(const BodyTree& tree) {
  if (tree.bodies().size() != 3 || !is_free_of_forces(tree)) return std::nullopt;
  const auto found = cardan_chain(tree.bodies());
  const CardanChain* chain = std::get_if<CardanChain>(&found);
  if (!chain || (chain->axes.array().abs() != chain->axes.array().square()).any()) {
    return std::nullopt;
  }
  for (const Inertia<>* body : {&chain->outer_ring, &chain->inner_ring, &chain->rotor}) {
    const Symmetric3<>& t = body->tensor;
    if (!body->first_moment.isZero(0) || t.xy != 0 || t.xz != 0 || t.yz != 0) return std::nullopt;
  }
  for (const int ring : {0, 1}) {
    if (tree.body(ring).rule != JointRule::forces || tree.body(ring).rotor) return std::nullopt;
  }
  const auto moments = [](const Inertia<>& body) {
    return Vector3<double>(body.tensor.xx, body.tensor.yy, body.tensor.zz);
  };
  const auto regulated = is_regulated(tree.body(2));
  const Vector3<double> rotor = moments(chain->rotor);
  if (!regulated || rotor.x() != rotor.y() || !(rotor.z() > 0)) return std::nullopt;
  return FreeGyro{rotor, moments(chain->inner_ring), moments(chain->outer_ring), chain->sign,
                  *regulated};
}

/// The error of a free Cardan gyro, in the measure of RunReport::error_estimate: the distance from
/// gyros whose moments differ in the last digits. The rounding of the phase in exact::Real is far
/// less.
class FreeGyroError {
 public:
  /// Throws : ComputationFailed as exact::FreeCardanGyro
  FreeGyroError(const FreeGyro& gyro, const Eigen::VectorXd& start, double begin)
      : gyro_(gyro), motion_(gyro.motion(start)), begin_(begin), size_(start.cwiseAbs()) {
    constexpr double more = 1 + 2 * of_inputs;
    FreeGyro spin = gyro, across = gyro, inner = gyro, outer = gyro;
    spin.rotor.z() *= more;
    across.rotor.head(2) *= more;
    inner.inner_ring *= more;
    outer.outer_ring *= more;
    for (const FreeGyro& other : {spin, across, inner, outer}) {
      beside_.push_back(other.motion(start));
    }
  }

  [[nodiscard]] double operator()(double t, double smallest) {
    const exact::Real time = exact::Real(t) - begin_;
    const Eigen::VectorXd y = gyro_.state(motion_, time);
    size_ = size_.cwiseMax(y.cwiseAbs()).cwiseMax(smallest);
    Eigen::VectorXd off = of_inputs * y.cwiseAbs();
    for (const auto& other : beside_) off += (gyro_.state(other, time) - y).cwiseAbs();
    double worst = 0;
    for (Eigen::Index i = 0; i < off.size(); ++i) {
      if (off[i] > 0) worst = std::max(worst, off[i] / size_[i]);
    }
    return worst;
  }

 private:
  FreeGyro gyro_;
  exact::FreeCardanGyro motion_;
  double begin_;
  std::vector<exact::FreeCardanGyro> beside_;
  Eigen::VectorXd size_;  ///< the greatest of each component so far
};

}  // namespace

std::optional<ClosedForm<Eigen::VectorXd>> gyro_motion(const BodyTree& tree, double begin,
                                                       const Eigen::VectorXd& y) {
  const auto gyro = free_gyro(tree);
  if (!gyro || !y.allFinite()) return std::nullopt;
  try {
    const exact::FreeCardanGyro motion = gyro->motion(y);
    return ClosedForm<Eigen::VectorXd>{
        "free Cardan gyro, Fourier series",
        [=, gyro = *gyro](double t) { return gyro.state(motion, exact::Real(t) - begin); },
        FreeGyroError(*gyro, y, begin)};
  } catch (const ComputationFailed&) {  // its rings turn over, or nearly
    return std::nullopt;
  }
}

}  // namespace kreisel::detail
