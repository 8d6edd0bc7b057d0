#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include <dynamics/control/controlled_system.hpp>
#include <dynamics/file/scene_system.hpp>
#include <dynamics/file/study_system.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/precession_admissibility.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/study/rotor_spectrum.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The system of a scene for all guides, also for one at rest: studies evaluate too rarely to gain
/// by a second type.
class StudySystem::Bodies : public ControlledSystem<SceneGuide> {
 public:
  using ControlledSystem::ControlledSystem;
};

namespace {

const char* reason(Obstacle obstacle) {
  switch (obstacle) {
    case Obstacle::none: return "";
    case Obstacle::not_determined: return "G + D is singular: it does not determine the velocities";
    case Obstacle::not_slow: return "the nutations are not fast against the precession";
    case Obstacle::growing_nutation: return "a nutation grows";
    case Obstacle::defective: return "what is neglected takes a multiple slow root apart";
  }
  return "";
}

/// True if the velocities, without the rotors' speeds, are 0.
bool at_rest(const Eigen::VectorXd& u) { return u.size() == 0 || u.cwiseAbs().maxCoeff() < 1e-9; }

}  // namespace

StudySystem::StudySystem(const SceneFile& scene) : begin_(scene.t_begin) {
  SceneBodies in_gravity = bodies_in_gravity(scene);
  BodySystem<SceneGuide> bodies(make_guide_of_equations(scene), std::move(in_gravity.bodies),
                                in_gravity.gravity, std::move(in_gravity.elements),
                                scene.constraints);
  bodies_ =
      std::make_unique<const Bodies>(std::move(bodies), scene.controllers, in_gravity.gravitation);
}

StudySystem::~StudySystem() = default;

void StudySystem::check_stop() const {
  if (stop_.stop_requested()) throw ComputationFailed("the study was stopped");
}

const BodyTree& StudySystem::tree() const { return bodies_->tree(); }

std::vector<int> StudySystem::blocks() const { return bodies_->blocks(); }

StudySystem::Vector StudySystem::start_of(const SceneFile& scene) const {
  const JointState start = kreisel::start_of(scene);
  return Bodies::to_vector(bodies_->start({start.coordinates, start.rates}));
}

JointState StudySystem::joints_of(const Vector& y) const {
  return {y.head(tree().coordinates()), y.segment(tree().coordinates(), tree().rates()),
          y.tail(bodies_->memory())};
}

std::vector<std::string> StudySystem::memory_names() const { return bodies_->memory_names(); }

bool StudySystem::has_samples() const { return bodies_->has_samples(); }

SampledTransition StudySystem::sampled_transition(const Vector& y) const {
  return kreisel::sampled_transition<ControlledSystem<SceneGuide>>(*bodies_, begin_, y);
}

LinearPlant StudySystem::plant(double t, const Vector& y, std::vector<PlantInput> inputs,
                               std::vector<PlantOutput> outputs) const {
  return linear_plant<SceneGuide>(*bodies_, t, y, std::move(inputs), std::move(outputs));
}

LinearPlant StudySystem::plant(double t, const Vector& y, std::vector<PlantInput> inputs,
                               std::vector<PlantOutput> outputs, FreeDirections free) const {
  return linear_plant<SceneGuide>(*bodies_, t, y, std::move(inputs), std::move(outputs),
                                  std::move(free));
}

StudySystem::Vector StudySystem::rates(double t, const Vector& y) const {
  check_stop();
  return bodies_->steady_rates(t, y);
}

std::function<void(double, const StudySystem::Vector&, StudySystem::Vector&)> StudySystem::field()
    const {
  if (has_samples()) {
    return [this](double t, const Vector& y, Vector& result) { result = rates(t, y); };
  }
  auto w = std::make_shared<Bodies::Workspace>(bodies_->workspace());
  return [this, w](double t, const Vector& y, Vector& result) {
    check_stop();
    bodies_->rates(t, y, result, *w);
  };
}

StudySystem::Vector StudySystem::assembled(const Vector& y) const { return bodies_->assembled(y); }

Eigen::MatrixXd StudySystem::constraint_slopes(const Vector& y, const Eigen::MatrixXd& E) const {
  return bodies_->constraint_slopes(y, E);
}

template <class Dual>
requires(!std::same_as<Dual, double>)
    StudySystem::Numbers<Dual> StudySystem::rates(const Dual& t, const Numbers<Dual>& y)
const {
  check_stop();
  return bodies_->steady_rates(t, y);
}

using Duals = detail::Duals<detail::directions<StudySystem>>;
template Eigen::Matrix<Duals, Eigen::Dynamic, 1> StudySystem::rates(
    const Duals&, const Eigen::Matrix<Duals, Eigen::Dynamic, 1>&) const;

JointReactions StudySystem::reactions(double t, const Vector& y) const {
  JointReactions result;
  auto w = bodies_->workspace();
  bodies_->reactions(t, y, result, w);
  return result;
}

Eigen::MatrixXd StudySystem::momenta_slope(double t, const Vector& y) const {
  const Eigen::Index joints = tree().coordinates() + tree().rates();
  BodyWorkspace w = bodies_->bodies().workspace();
  const Eigen::MatrixXd slope =
      kreisel::momenta_slope<SceneGuide>(bodies_->bodies(), t, y.head(joints), w);
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(slope.rows() + bodies_->memory(), slope.cols() + bodies_->memory());
  result.topLeftCorner(slope.rows(), slope.cols()) = slope;
  return result;
}

PrecessionCheck StudySystem::precession(const Vector& start, const Vector& rest,
                                        double t_end) const {
  PrecessionCheck check;
  if (tree().rotors().empty()) {
    check.beyond = "there is no rotor among the bodies";
    return check;
  }
  if (!bodies_->loops().empty()) {
    check.beyond = "precession equations are for scenes without controllers";
    return check;
  }
  if (!tree().constraints().empty()) {
    check.beyond = "precession equations are for scenes without constraints";
    return check;
  }
  PrecessionOptions options;
  try {
    const PrecessionBodies<SceneGuide> model(bodies_->bodies());
    const auto [place, u] = model.start(begin_, start);
    check.velocities = static_cast<int>(u.size());
    if (rest.size() == 0) {
      check.not_tested = "there is no equilibrium about which";
    } else if (const auto [middle, still] = model.start(begin_, rest); !at_rest(still)) {
      check.not_tested = "the carriers turn in the steady motion; the test is for a rest";
    } else {
      const auto a = admissibility(model.forces(begin_, middle), stiffness(model, begin_, middle));
      check.rank = a.rank;
      check.test = {a.admissible(), reason(a.obstacle), a.greatest_shift, {}};
      for (const SlowRoot& root : a.slow) {
        check.test.slow.push_back({root.precession, root.exact});
      }
      options.kept = a.kept;
    }
    try {
      const auto motion = precession_motion(model, begin_, place, u, t_end, options);
      const PrecessionSample& last = motion.samples.back();
      check.kept = motion.kept;
      check.motion = {last.t, last.bound, 0, motion.valid_until, motion.slow};
      for (const auto& sample : motion.samples) {
        if (sample.nutation.size() == 0) continue;
        check.motion.nutation =
            std::max(check.motion.nutation, sample.nutation.cwiseAbs().maxCoeff());
      }
    } catch (const ComputationFailed& error) {
      check.no_motion = error.what();
    }
  } catch (const InvalidInput& error) {
    check.beyond = error.what();
  }
  return check;
}

std::vector<StudySystem::Vector> StudySystem::technical(const Vector& start,
                                                        const std::vector<double>& times) const {
  const PrecessionBodies<SceneGuide> model(bodies_->bodies());
  const auto [place, u] = model.start(begin_, start);
  PrecessionOptions options;
  for (const double t : times) options.output_times.push_back(begin_ + t);
  const auto motion =
      precession_motion(model, begin_, place, u, options.output_times.back(), options);
  std::vector<Vector> states;
  for (const auto& sample : motion.outputs) {
    states.push_back(model.state(sample.t, sample.position, sample.velocity));
  }
  return states;
}

}  // namespace kreisel
