#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/analysis.hpp>
#include <dynamics/file/joints.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/study/floquet_bodies.hpp>
#include <dynamics/study/rotor_spectrum.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel::scene_analysis {

using Eigen::MatrixXd, Eigen::VectorXd;
using kreisel::GyroscopicMode;
using kreisel::InvalidInput;
using namespace steady_motion;

namespace {

/// The verdict from roots, or from multipliers by their excess over 1.
template <class Modes, class Growth>
Verdict verdict(const Modes& modes, bool all_directions, const Growth& growth) {
  Verdict result = all_directions ? Verdict::stable : Verdict::marginal;
  for (const auto& mode : modes) {
    if (growth(mode) > mode.error) return Verdict::unstable;
    if (growth(mode) >= -mode.error) result = Verdict::marginal;
  }
  return result;
}

/// The greatest angular rate of a joint.
double angular_rate(const kreisel::JointType& type, const double* rates) {
  double greatest = 0;
  for (const kreisel::JointQuantity& quantity : type.rates) {
    for (int k = 0; k < quantity.count(); ++k, ++rates) {
      if (quantity.unit == "rad/s") greatest = std::max(greatest, std::abs(*rates));
    }
  }
  return greatest;
}

/// The frame in which a mode about a steady motion is observed. Attitudes vary by angles on the
/// body's own axes, which may rotate in a steady motion. Single coordinates vary relative to the
/// parent.
std::string frame_of(const kreisel::StudySystem& system, const VectorXd& state) {
  const kreisel::BodyTree& tree = system.tree();
  std::string carriers;
  for (int body = 0; body < static_cast<int>(tree.bodies().size()); ++body) {
    const kreisel::BodyDescription& description = tree.body(body);
    const kreisel::JointType& type = kreisel::joint_type(description.joint.kind);
    const double* const rates = state.data() + tree.coordinates() + tree.place(body).v;
    if (description.rotor || angular_rate(type, rates) < 1e-9) continue;
    const std::string& name = description.name;
    if (type.has_attitude()) return "on body axes, which turn with '" + name + "'";
    const bool carries = std::any_of(tree.bodies().begin(), tree.bodies().end(),
                                     [&name](const auto& other) { return other.parent == name; });
    if (carries && carriers.empty()) carriers = name;
  }
  if (carriers.empty()) return "against the guide";
  return "against the parent of each body; '" + carriers + "' turns against the guide";
}

/// The roots s of a loop with samples, from its multipliers z = exp(s period). Multipliers that are
/// rounding have no root: they are dead beats.
std::vector<GyroscopicMode> sampled_modes(const MatrixXd& transition, Linear& linear) {
  std::vector<GyroscopicMode> modes;
  for (const kreisel::Mode& multiplier : kreisel::spectrum(transition)) {
    const double size = std::abs(multiplier.root);
    if (size <= std::max(multiplier.error, 1e-12)) {
      ++linear.dead_beats;
      continue;
    }
    GyroscopicMode mode;
    mode.root = std::log(multiplier.root) / linear.sample_period;
    mode.error = multiplier.error / size / linear.sample_period;
    mode.shape = multiplier.shape;
    modes.push_back(std::move(mode));
  }
  return modes;
}

Linear linear_about(const kreisel::StudySystem& system, const VectorXd& state) {
  const kreisel::steady_motion::Linearization there = linearized(system, system.begin(), state);
  const Directions directions(system);
  const Places out = directions.without_roots(there);
  const std::vector<int> kept = list(out, false);
  Linear linear;
  linear.names = there.names;
  linear.frame = frame_of(system, state);
  linear.rates = directions.rates;
  // Modes have kinds by their change with the rotors' momenta, which is for trees alone.
  linear.has_rotors =
      !system.tree().rotors().empty() && !there.free.bound() && !system.has_samples();
  std::vector<int> left_out;
  for (const int i : list(out)) {
    const bool follows = there.free.is_dependent(i);
    (follows ? linear.dependent : linear.left_out)
        .push_back(there.names[static_cast<std::size_t>(i)]);
    if (!follows) left_out.push_back(i);
  }
  if (kept.empty()) return linear;
  const MatrixXd A = there.A(kept, kept);
  MatrixXd slope = MatrixXd::Zero(A.rows(), A.cols());
  if (linear.has_rotors) slope = system.momenta_slope(system.begin(), state)(kept, kept);
  std::vector<GyroscopicMode> modes;
  if (system.has_samples()) {
    const kreisel::SampledTransition transition = system.sampled_transition(state);
    linear.sample_period = transition.period;
    modes = sampled_modes(transition.matrix(kept, kept), linear);
  } else {
    modes = kreisel::rotor_spectrum(A, slope);
  }
  for (GyroscopicMode& mode : modes) {
    if (mode.root.imag() < 0) continue;
    const Eigen::VectorXcd own = mode.shape;
    mode.shape.setZero(there.A.rows());
    mode.shape(kept) = own;
    if (there.free.bound()) mode.shape = (there.free.N * mode.shape(there.free.independent)).eval();
    linear.modes.push_back(std::move(mode));
  }
  // A coordinate that is neither held nor restored drifts, however slowly.
  const bool drifts = std::any_of(left_out.begin(), left_out.end(), [&directions](int i) {
    return !directions.held[static_cast<std::size_t>(i)];
  });
  linear.verdict =
      verdict(linear.modes, !drifts, [](const GyroscopicMode& mode) { return mode.root.real(); });
  return linear;
}

/// True if a body at rest on the guide has an energy: the guide is at rest or moves steadily.
bool is_steady(const kreisel::SceneFile& scene) {
  using namespace kreisel::scene_guide;
  const auto* const orbit = std::get_if<kreisel::scene_guide::Orbit>(&scene.guide.front());
  const bool is_circle =
      orbit == nullptr || (orbit->elements.eccentricity == 0 && orbit->elements.j2 == 0);
  const auto* const course = std::get_if<kreisel::scene_guide::Course>(&scene.guide.front());
  const bool travels = course != nullptr && !course->plan.rests();
  return scene.guide.size() == 1 && !has_link<Harmonic>(scene) && !has_link<Table>(scene) &&
         !has_link<Motion>(scene) && is_circle && !travels;
}

/// True if the forces on bodies at rest cannot deliver unlimited energy. They are gravity on guide
/// axes or that of the earth below the guide, springs, dampers and constant joint forces. Loads and
/// mounts need a potential.
bool has_potential(const kreisel::SceneFile& scene) {
  const auto* const planet = std::get_if<kreisel::OblateGravitation<>>(&scene.gravity);
  const bool on_earth =
      has_link<kreisel::scene_guide::Earth>(scene) || has_link<kreisel::scene_guide::Course>(scene);
  const bool turns_along =
      planet != nullptr && on_earth && planet->centre.isZero(0) && planet->pole.head<2>().isZero(0);
  const bool stands_still =
      std::holds_alternative<kreisel::UniformGravity<kreisel::Inertial>>(scene.gravity) ||
      (planet != nullptr && !turns_along);
  if (!is_steady(scene) || (stands_still && !scene.rests())) return false;
  if (!scene.controllers.empty()) return false;
  const bool pushes =
      !std::all_of(scene.elements.begin(), scene.elements.end(),
                   [](const kreisel::Element& element) { return kreisel::has_potential(element); });
  if (pushes) return false;
  return std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& body) {
    const bool is_pushed = kreisel::joint_type(body.joint.kind).has_attitude() &&
                           std::any_of(body.forces.begin(), body.forces.end(),
                                       [](const auto& force) { return force.constant != 0; });
    const bool turns = body.rule == kreisel::JointRule::driven;
    const auto keeps = [](const auto& load) { return load.keeps_energy(); };
    return !is_pushed && !turns && std::all_of(body.loads.begin(), body.loads.end(), keeps);
  });
}

/// True if the potential energy has a minimum at an equilibrium, except along its own family. The
/// matrix from displacements to accelerations is minus mass^-1 stiffness.
///
/// Source : Lagrange and Dirichlet; gyroscopic forces and dampers do not affect it
bool is_lowest(const kreisel::StudySystem& system, const Equilibrium& equilibrium) {
  const kreisel::steady_motion::Linearization there =
      linearized(system, system.begin(), equilibrium.state);
  const Directions directions(system);
  const Places fixed = joined(
      directions.held,
      directions.cyclic(there, linearized(system, system.begin(), off(system, equilibrium.state))));
  std::vector<int> free;
  for (int i = 0; i < directions.rates; ++i) {
    // A condition on velocities alone, as of rolling: the theorem is for others.
    if (there.free.is_dependent(i) != there.free.is_dependent(directions.rates + i)) return false;
    if (!there.free.is_dependent(i) && !fixed[static_cast<std::size_t>(i)]) free.push_back(i);
  }
  if (free.empty() || equilibrium.degenerate) return false;
  const MatrixXd J = there.A.middleRows(directions.rates, directions.rates)(free, free);
  const Eigen::VectorXd values = kreisel::eigenvalues(J).real();
  const double zero = 1e-9 * values.cwiseAbs().maxCoeff();
  const auto falls = [zero](double value) { return value < -zero; };
  return values.maxCoeff() <= zero &&
         std::count_if(values.begin(), values.end(), falls) + equilibrium.neutral == values.size();
}

std::vector<Rest> rests(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                        const Equilibria& equilibria, const VectorXd& start) {
  const bool conserves = has_potential(scene);
  std::vector<Rest> result;
  for (const Equilibrium& equilibrium : equilibria.list) {
    Rest rest{equilibrium, linear_about(system, equilibrium.state)};
    rest.distance = distance(system, start, equilibrium.state);
    rest.stability = rest.linear.verdict;
    if (rest.stability == Verdict::marginal && conserves && is_lowest(system, equilibrium)) {
      rest.stability = Verdict::stable;
    }
    result.push_back(std::move(rest));
  }
  std::stable_sort(result.begin(), result.end(), [](const Rest& a, const Rest& b) {
    return a.stability != b.stability ? a.stability < b.stability : a.distance < b.distance - 1e-9;
  });
  return result;
}

bool oscillates(const GyroscopicMode& mode) { return mode.root.imag() > mode.error; }

/// Appends the modes at one more speed to the most similar curves. The other modes start new
/// curves.
void connect(std::vector<Curve>& curves, std::vector<GyroscopicMode> modes) {
  struct Pair {
    double likeness;
    std::size_t curve, mode;
  };
  std::vector<Pair> pairs;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    if (!curves[c].back()) continue;
    for (std::size_t m = 0; m < modes.size(); ++m) {
      pairs.push_back({std::abs(curves[c].back()->shape.dot(modes[m].shape)), c, m});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.likeness > b.likeness; });
  const std::size_t before = curves.empty() ? 0 : curves.front().size();
  std::vector<bool> taken(modes.size(), false);
  for (const auto& [likeness, c, m] : pairs) {
    if (likeness < 0.3 || taken[m] || curves[c].size() > before) continue;
    curves[c].emplace_back(modes[m]);
    taken[m] = true;
  }
  for (Curve& curve : curves) {
    if (curve.size() == before) curve.emplace_back();
  }
  for (std::size_t m = 0; m < modes.size(); ++m) {
    if (taken[m]) continue;
    curves.emplace_back(before);
    curves.back().emplace_back(std::move(modes[m]));
  }
}

/// The index of a body's speed in the state.
Eigen::Index speed_of(const kreisel::StudySystem& system, const std::string& name) {
  const kreisel::BodyTree& tree = system.tree();
  const auto& bodies = tree.bodies();
  const auto is = [&name](const auto& body) { return body.name == name; };
  if (std::none_of(bodies.begin(), bodies.end(), is)) {
    throw InvalidInput("--campbell: body '" + name + "' does not exist");
  }
  const int body = tree.index(name);
  const auto& b = tree.body(body);
  const bool turns = b.joint.kind == kreisel::JointKind::revolute &&
                     (b.rotor ? b.rotor->mode != kreisel::RotorMode::torque
                              : b.rule == kreisel::JointRule::driven);
  if (!turns) {
    throw InvalidInput("--campbell: body '" + name +
                       "' is neither a free or regulated rotor nor driven at a constant rate");
  }
  return tree.coordinates() + tree.place(body).v;
}

Campbell sweep(const kreisel::StudySystem& system, const Sweep& asked, VectorXd guess,
               double t_end) {
  const Eigen::Index speed = speed_of(system, asked.body);
  Campbell campbell{asked.body, asked.speeds, !system.tree().rotors().empty(), {}};
  for (const double now : asked.speeds) {
    guess[speed] = now;
    const Steady steady = find_steady(system, guess, t_end);
    if (!steady.exists()) {
      throw kreisel::ComputationFailed(
          fmt::format("--campbell: no steady motion at {:.9g} rad/s: {}", now, steady.reason));
    }
    guess = steady.state;
    std::vector<GyroscopicMode> modes = linear_about(system, steady.state).modes;
    modes.erase(std::remove_if(modes.begin(), modes.end(),
                               [](const GyroscopicMode& mode) { return !oscillates(mode); }),
                modes.end());
    connect(campbell.curves, std::move(modes));
  }
  return campbell;
}

/// The frequency of all oscillations of the guide, if there is only one.
std::optional<double> frequency_of_guide(const kreisel::SceneFile& scene) {
  std::optional<double> only;
  bool several = false;
  for (const auto& link : scene.guide) {
    const auto* const harmonic = std::get_if<kreisel::scene_guide::Harmonic>(&link);
    if (harmonic == nullptr) continue;
    for (const auto* const series : {&harmonic->angular_velocity, &harmonic->origin_acceleration}) {
      for (const auto& term : series->terms) {
        const double w = std::abs(term.frequency);
        if (w == 0) continue;
        several = several || (only && std::abs(*only - w) > 1e-12 * w);
        only = w;
      }
    }
  }
  return several ? std::nullopt : only;
}

std::optional<double> period_of(const kreisel::SceneFile& scene, const AnalysisRequest& request) {
  if (request.period) return request.period;
  const std::optional<double> w = frequency_of_guide(scene);
  return w ? std::optional(2 * std::numbers::pi / *w) : std::nullopt;
}

/// The relative change of the field after a period.
double field_misses(const kreisel::StudySystem& system, const VectorXd& start, double period) {
  const Directions directions(system);
  const kreisel::Tangent tangent = tangent_of(system, start);
  double worst = 0;
  VectorXd y = start;
  for (const double share : {0.0, 0.3, 0.7}) {
    const auto turned = [&](double t) {
      VectorXd eta = VectorXd::Zero(tangent.dimension());
      for (const int i : list(directions.running)) {
        eta[i] = t * start[system.tree().coordinates() + i];
      }
      return tangent.moved(y, eta);
    };
    const double t = system.begin() + share * period;
    const VectorXd now = system.rates(t, turned(t));
    const VectorXd then = system.rates(t + period, turned(t + period));
    worst = std::max(worst, (then - now).norm() / (1 + now.norm()));
    y = off(system, y);
  }
  return worst;
}

Floquet multipliers(const kreisel::StudySystem& system, const VectorXd& start, double period,
                    double t_of_guide) {
  constexpr double max_evaluations = 2e5;  // for one period: seconds, and at most 20 periods
  Floquet floquet;
  floquet.period = period;
  const Directions directions(system);
  const double middle = (system.begin() + t_of_guide) / 2;
  const Places cyclic = directions.cyclic(linearized(system, middle, start),
                                          linearized(system, middle, off(system, start)));
  try {
    const auto motion =
        kreisel::periodic_motion(system, system.begin(), period, start,
                                 {.held = list(joined(directions.held, cyclic)),
                                  .running = list(joined(directions.running, cyclic)),
                                  .most_iterations = 20},
                                 {.relative = 1e-12, .max_evaluations = max_evaluations});
    floquet.start = motion.start;
    floquet.residual = motion.residual;
    Places out = joined(directions.given, joined(directions.running, cyclic));
    for (const int i : linearized(system, system.begin(), motion.start).free.dependent) {
      out[static_cast<std::size_t>(i)] = true;
    }
    const std::vector<int> kept = list(out, false);
    const MatrixXd X = motion.period.matrix(kept, kept);
    if (X.size() == 0) return floquet;
    floquet.multipliers = kreisel::spectrum(X, motion.period.error.norm());
  } catch (const kreisel::ComputationFailed& error) {
    floquet.reason = error.what();
    return floquet;
  }
  std::stable_sort(
      floquet.multipliers.begin(), floquet.multipliers.end(),
      [](const auto& a, const auto& b) { return std::abs(a.root) > std::abs(b.root); });
  floquet.verdict =
      verdict(floquet.multipliers, true, [](const auto& m) { return std::abs(m.root) - 1; });
  return floquet;
}

/// True if a ball joint rotates at the start but in no equilibrium, so that another motion was
/// meant. Constraints may be what stops it.
bool lost_spin(const kreisel::StudySystem& system, const VectorXd& start, const Steady& steady) {
  if (steady.kind == Steady::Kind::start || !system.tree().constraints().empty()) return false;
  const int q = system.tree().coordinates();
  const auto attitudes = Directions(system).attitudes;
  return std::any_of(attitudes.begin(), attitudes.end(), [&](int first) {
    const VectorXd before = start.segment(q + first, 3);
    if (!steady.exists()) return before.norm() > 0;
    return (steady.state.segment(q + first, 3) - before).norm() > 0.5 * before.norm();
  });
}

/// True if the input is the force that the output, of a controller, is.
bool opens_loop(const kreisel::SceneFile& scene, const kreisel::PlantInput& input,
                const kreisel::PlantOutput& output) {
  const auto* const of = std::get_if<kreisel::PlantOutput::OfController>(&output.kind);
  if (of == nullptr) return false;
  const kreisel::Controller& controller = scene.controllers[of->controller];
  const kreisel::BodyTree tree(scene.bodies, scene.elements, scene.constraints);
  const std::vector<kreisel::Actuator> driven = actuators(controller, tree);
  return input.name == driven[static_cast<std::size_t>(of->component)].name;
}

Response response_of(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                     const Steady& steady, const ResponseRequest& request) {
  Response response;
  response.input = plant_input(scene, request.input);
  response.output = plant_output(scene, request.output);
  response.frequencies = request.frequencies;
  if (!steady.exists()) {
    throw kreisel::ComputationFailed("--response: no steady motion: " + steady.reason);
  }
  const kreisel::LinearPlant plant =
      system.plant(steady.state, {response.input}, {response.output});
  const auto at = [&plant](double w) { return plant.response(w)(0, 0); };
  for (const double w : response.frequencies) response.values.push_back(at(w));
  response.is_first_harmonic = plant.period > 0;
  response.bandwidth = bandwidth(at, response.frequencies);
  if (opens_loop(scene, response.input, response.output)) {
    // A disturbance d of the joint force makes the controller answer -L/(1 + L) d.
    const auto loop = [&at](double w) {
      const std::complex<double> closed = at(w);
      return -closed / (1.0 + closed);
    };
    response.margins = loop_margins(loop, response.frequencies);
  }
  return response;
}

/// Adds the Floquet multipliers, or a note why there are none.
///
/// Throws : InvalidInput if a requested period does not fit
void add_multipliers(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                     const AnalysisRequest& request, const VectorXd& start, Analysis& result) {
  const bool swings = has_link<kreisel::scene_guide::Harmonic>(scene);
  const bool logged = scene.guide_follows_log();
  if (logged && !request.period) {
    result.notes.emplace_back("the guide follows a log: Floquet multipliers only with --period");
  } else if (swings && !period_of(scene, request)) {
    result.notes.emplace_back(
        "the guide swings with several frequencies: Floquet multipliers only with --period, if "
        "they have a common one");
  }
  const auto period = period_of(scene, request);
  if (period && system.has_samples()) {
    const std::string why = "controllers are sampled: there are no Floquet multipliers";
    if (request.period) throw InvalidInput("--period: " + why);
    result.notes.push_back(why);
  } else if (period) {
    if (const double misses = field_misses(system, start, *period); misses > 1e-9) {
      const std::string why = fmt::format(
          "after {:.9g} s the equations are not the same: rates differ by {:.1e}", *period, misses);
      if (request.period) throw InvalidInput("--period: " + why);
      result.notes.push_back(why + ", so there are no Floquet multipliers");
    } else {
      result.floquet = multipliers(system, start, *period, with_longer_guide(scene, request).t_end);
    }
  }
}

}  // namespace

kreisel::SceneFile with_longer_guide(kreisel::SceneFile scene, const AnalysisRequest& request) {
  const double period = period_of(scene, request).value_or(0);
  scene.t_end = scene.t_begin + std::max({scene.duration(), 3 * period, 1.0});
  return scene;
}

Analysis analyze(const kreisel::StudySystem& system, const kreisel::SceneFile& scene,
                 const AnalysisRequest& request) {
  const VectorXd start = kreisel::detail::on_constraints(system, system.start_of(scene));
  if (system.tree().rates() == 0) throw InvalidInput("nothing in this scene can move");
  Analysis result;
  const bool swings = has_link<kreisel::scene_guide::Harmonic>(scene);
  const bool logged = scene.guide_follows_log();
  const Equilibria equilibria = find_equilibria(system, scene, start);
  result.starts = equilibria.starts;
  result.equilibria = rests(system, scene, equilibria, start);
  result.steady = find_steady(system, scene, start, equilibria);
  if (result.steady.exists()) result.linear = linear_about(system, result.steady.state);
  if (!logged && !swings && lost_spin(system, start, result.steady)) {
    result.notes.emplace_back(
        "a ball or free body turns at the start and not in the equilibrium; its steady turning "
        "under forces is beyond this program: describe it by gimbals and a rotor");
  }
  if (request.campbell) {
    if (!result.steady.exists()) {
      throw kreisel::ComputationFailed("--campbell: no steady motion: " + result.steady.reason);
    }
    result.campbell = sweep(system, *request.campbell, result.steady.state, scene.duration());
  }
  add_multipliers(system, scene, request, start, result);
  if (request.response) {
    result.response = response_of(system, scene, result.steady, *request.response);
  }
  result.precession = system.precession(start, result.steady.state, scene.t_end);
  return result;
}

}  // namespace kreisel::scene_analysis
