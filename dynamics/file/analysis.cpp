#include <fmt/core.h>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <utility>

#include <dynamics/decompositions.hpp>
#include <dynamics/file/analysis.hpp>
#include <dynamics/file/joints.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/file/unbalance.hpp>
#include <dynamics/tree/joint/list.hpp>

namespace kreisel::scene_analysis {

using Eigen::MatrixXd, Eigen::VectorXd;
using namespace steady_motion;

namespace {

/// True if a body at rest on the guide has an energy: the guide is at rest or moves steadily.
bool is_steady(const SceneFile& scene) {
  using namespace scene_guide;
  const auto* const orbit = std::get_if<scene_guide::Orbit>(&scene.guide.front());
  const bool is_circle =
      orbit == nullptr || (orbit->elements.eccentricity == 0 && orbit->elements.j2 == 0);
  const auto* const course = std::get_if<scene_guide::Course>(&scene.guide.front());
  const bool travels = course != nullptr && !course->plan.rests();
  return scene.guide.size() == 1 && !has_link<Harmonic>(scene) && !has_link<Table>(scene) &&
         !has_link<Motion>(scene) && is_circle && !travels;
}

/// True if the forces on bodies at rest cannot deliver unlimited energy. They are gravity on guide
/// axes or that of the earth below the guide, springs, dampers and constant joint forces. Loads and
/// mounts need a potential.
bool has_potential(const SceneFile& scene) {
  const auto* const planet = std::get_if<OblateGravitation<>>(&scene.gravity);
  const bool on_earth = has_link<scene_guide::Earth>(scene) || has_link<scene_guide::Course>(scene);
  const bool turns_along =
      planet != nullptr && on_earth && planet->centre.isZero(0) && planet->pole.head<2>().isZero(0);
  const bool stands_still = std::holds_alternative<UniformGravity<Inertial>>(scene.gravity) ||
                            (planet != nullptr && !turns_along);
  if (!is_steady(scene) || (stands_still && !scene.rests())) return false;
  if (!scene.controllers.empty()) return false;
  const bool pushes = !std::all_of(scene.elements.begin(), scene.elements.end(),
                                   [](const Element& element) { return has_potential(element); });
  if (pushes) return false;
  return std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const auto& body) {
    const bool is_pushed = joint_type(body.joint.kind).has_attitude() &&
                           std::any_of(body.forces.begin(), body.forces.end(),
                                       [](const auto& force) { return force.constant != 0; });
    const bool turns = body.rule == JointRule::driven;
    const auto keeps = [](const auto& load) { return load.keeps_energy(); };
    return !is_pushed && !turns && std::all_of(body.loads.begin(), body.loads.end(), keeps);
  });
}

/// True if the potential energy has a minimum at an equilibrium, except along its own family. The
/// matrix from displacements to accelerations is minus mass^-1 stiffness.
///
/// Source : Lagrange and Dirichlet; gyroscopic forces and dampers do not affect it
bool is_lowest(const StudySystem& system, const Equilibrium& equilibrium) {
  const auto there = linearized(system, system.begin(), equilibrium.state);
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
  const Eigen::VectorXd values = eigenvalues(J).real();
  const double zero = 1e-9 * values.cwiseAbs().maxCoeff();
  const auto falls = [zero](double value) { return value < -zero; };
  return values.maxCoeff() <= zero &&
         std::count_if(values.begin(), values.end(), falls) + equilibrium.neutral == values.size();
}

std::vector<Rest> rests(const StudySystem& system, const SceneFile& scene,
                        const Equilibria& equilibria, const VectorXd& start) {
  const bool conserves = has_potential(scene);
  std::vector<Rest> result;
  for (const Equilibrium& equilibrium : equilibria.list) {
    Rest rest{equilibrium, linear_motion(system, equilibrium.state)};
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

/// True if a ball joint rotates at the start but in no equilibrium, so that another motion was
/// meant. Constraints may be what stops it.
bool lost_spin(const StudySystem& system, const VectorXd& start, const Steady& steady) {
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
bool opens_loop(const SceneFile& scene, const PlantInput& input, const PlantOutput& output) {
  const auto* const of = std::get_if<PlantOutput::OfController>(&output.kind);
  if (of == nullptr) return false;
  const Controller& controller = scene.controllers[of->controller];
  const BodyTree tree(scene.bodies, scene.elements, scene.constraints);
  const std::vector<Actuator> driven = actuators(controller, tree);
  return input.name == driven[static_cast<std::size_t>(of->component)].name;
}

/// The response about the periodic motion.
Response harmonics_of(const StudySystem& system, const Analysis& analysis, Response response) {
  const std::optional<FloquetMotion>& motion = analysis.floquet;
  if (!motion || !motion->exists()) {
    std::string why = "response: no steady motion: " + analysis.steady.reason;
    if (motion) why += "; no periodic motion: " + motion->reason;
    if (!motion && !analysis.notes.empty()) why += "; " + analysis.notes.back();
    throw ComputationFailed(why);
  }
  response.harmonics =
      harmonic_response(system, *motion, response.input, response.output, response.frequencies);
  for (const auto& row : response.harmonics->values) {
    response.values.push_back(row[HarmonicResponse::harmonics]);
  }
  return response;
}

/// The response to an unbalance, whose frequency is the speed of its rotor.
Response response_to_unbalance(const StudySystem& system, const SceneFile& scene,
                               const Steady& steady, const std::string& body, Response response) {
  response.input = {"unbalance." + body, "kg m"};
  if (!steady.exists()) {
    throw ComputationFailed("response: no steady motion: " + steady.reason);
  }
  response.values =
      unbalance_response(system, scene, body, response.output, response.frequencies, steady.state)
          .values;
  return response;
}

Response response_of(const StudySystem& system, const SceneFile& scene, const Analysis& analysis,
                     const ResponseRequest& request) {
  Response response;
  response.output = plant_output(scene, request.output);
  response.frequencies = request.frequencies;
  const Steady& steady = analysis.steady;
  if (const std::string unbalance = "unbalance."; request.input.starts_with(unbalance)) {
    return response_to_unbalance(system, scene, steady, request.input.substr(unbalance.size()),
                                 std::move(response));
  }
  response.input = plant_input(scene, request.input);
  if (!steady.exists()) {
    return harmonics_of(system, analysis, std::move(response));
  }
  const LinearPlant plant =
      system.plant(system.begin(), steady.state, {response.input}, {response.output});
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
    for (const double w : response.frequencies) response.loop.push_back(loop(w));
  }
  return response;
}

/// The period of the equations that is requested, or that follows from a scene without steady
/// motion.
FoundPeriod period_of(const StudySystem& system, const SceneFile& scene,
                      const AnalysisRequest& request, const VectorXd& start, const Steady& steady) {
  if (request.period) return {*request.period, "", true};
  return steady.exists() ? FoundPeriod{} : find_period(system, scene, start);
}

/// Adds the Floquet multipliers, or a note why there are none.
///
/// Throws : InvalidInput if a requested period does not fit
void add_multipliers(const StudySystem& system, const SceneFile& scene,
                     const AnalysisRequest& request, const VectorXd& start, Analysis& result) {
  const FoundPeriod found = period_of(system, scene, request, start, result.steady);
  const auto refuse = [&](const std::string& why) {
    if (request.period) throw InvalidInput("period: " + why);
    result.notes.push_back("no Floquet multipliers: " + why);
  };
  if (found.period == 0) {
    const bool changes =
        has_link<scene_guide::Harmonic>(scene) || scene.guide_follows_log() || scene.forces_change;
    if (changes && !found.reason.empty()) refuse(found.reason + "; give the period");
    return;
  }
  if (!request.period && !request.response && !found.is_only) {
    return refuse(
        fmt::format("the equations change with several frequencies; the period is {:.9g} s; give "
                    "the period {:.17g} to compute them",
                    found.period, found.period));
  }
  if (system.has_samples()) return refuse("controllers are sampled");
  if (const double misses = field_misses(system, start, found.period); misses > 1e-9) {
    return refuse(
        fmt::format("after {:.9g} s the equations are not the same: rates differ by {:.1e}",
                    found.period, misses));
  }
  result.floquet = floquet_motion(system, start, found.period);
  if (result.floquet->exists()) result.floquet_modes = floquet_modes(system, *result.floquet);
}

}  // namespace

SceneFile with_longer_guide(SceneFile scene, const AnalysisRequest& request) {
  const double period = request.period ? *request.period : find_period(scene).period;
  scene.t_end = scene.t_begin + std::max({scene.duration(), 3 * period, 1.0});
  return scene;
}

Analysis analyze(const StudySystem& system, const SceneFile& scene,
                 const AnalysisRequest& request) {
  const VectorXd start = detail::on_constraints(system, system.start_of(scene));
  if (system.tree().rates() == 0) throw InvalidInput("nothing in this scene can move");
  const auto done = [&](double share) {
    if (request.progress) request.progress(share);
  };
  Analysis result;
  const bool swings = has_link<scene_guide::Harmonic>(scene);
  const bool logged = scene.guide_follows_log();
  const Equilibria equilibria = find_equilibria(system, scene, start);
  done(0.1);
  result.starts = equilibria.starts;
  result.equilibria = rests(system, scene, equilibria, start);
  result.steady = find_steady(system, scene, start, equilibria);
  if (result.steady.exists()) result.linear = linear_motion(system, result.steady.state);
  if (!logged && !swings && lost_spin(system, start, result.steady)) {
    result.notes.emplace_back(
        "a ball or free body turns at the start and not in the equilibrium; its steady turning "
        "under forces is beyond this program: describe it by gimbals and a rotor");
  }
  if (request.campbell) {
    const VectorXd& guess = result.steady.exists() ? result.steady.state : start;
    result.campbell = sweep_speed(system, scene, request.campbell->body, request.campbell->speeds,
                                  {.orders = request.campbell->orders}, guess,
                                  [&](double share) { done(0.1 + 0.7 * share); });
  }
  done(0.8);
  add_multipliers(system, scene, request, start, result);
  done(0.9);
  if (request.response) {
    result.response = response_of(system, scene, result, *request.response);
  }
  result.precession = system.precession(start, result.steady.state, scene.t_end);
  return result;
}

}  // namespace kreisel::scene_analysis
