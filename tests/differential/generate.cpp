#include "generate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "generate_parts.hpp"

namespace differential {

namespace {

void add_solve(Random& r, Scene& scene) {
  scene.tolerance = r.pick({1e-10, 1e-10, 1e-8, 1e-6, 1e-9, 1e-3, 1e-12});
  scene.t_end = r.chance(0.85) ? r.pick({0.1, 1.0, 2.0, 5.0, 10.0, 20.0})
                               : r.pick({1e-6, 1e-3, 60.0, 1e3, 1e4});
  const bool harmonic = std::any_of(scene.guide.begin(), scene.guide.end(), [](const Link& link) {
    return link.kind == LinkKind::harmonic;
  });
  if (harmonic) scene.t_end = std::min(scene.t_end, 1e3);
  const bool is_course = !scene.guide.empty() && scene.guide.front().kind == LinkKind::course;
  if (is_course) scene.t_end = std::min(scene.t_end, 100.0);  // its turn rate may grow
  if (scene.has_log()) scene.t_end = std::min(scene.t_end, 10.0);
  scene.outputs = r.pick({1, 2, 20, 20, 20, 100});
  scene.reports = r.chance(0.3);
  if (r.chance(0.2)) {
    scene.method = r.pick<std::string>({"auto", "automatic", "closed form", "taylor", "verner98",
                                        "gauss16", "radau13", "splitting"});
  }
}

/// Writes some of the smooth functions of time as logs.
void add_logs_of_signals(Random& r, Scene& scene) {
  int count = 0;
  const auto take = [&](Signal& s) {
    if (s.empty() || !s.jumps.times.empty() || r.chance(0.6)) return;
    s.file = fmt::format("s{}.csv", count++);
    scene.t_end = std::min(scene.t_end, 10.0);
  };
  for (Body& body : scene.bodies) {
    take(body.force_in_time);
    take(body.motion);
    if (body.rotor) take(body.rotor->torque_in_time);
    for (Load& load : body.loads) {
      take(load.force_in_time);
      take(load.field);
    }
  }
}

/// Moves the run to a later time, unless the guide is given by its start at t = 0.
void add_begin(Random& r, Scene& scene) {
  const bool has_start = std::any_of(scene.guide.begin(), scene.guide.end(), [](const Link& link) {
    return link.kind == LinkKind::rotating || link.kind == LinkKind::harmonic ||
           link.kind == LinkKind::course;
  });
  if (has_start || r.chance(0.7)) return;
  scene.t_begin = r.pick({0.5, 1.0, 3.0});
  scene.t_end += scene.t_begin;
  for (Body& body : scene.bodies) {
    if (!body.motion.empty()) start_motion(body, scene.t_begin);
  }
}

}  // namespace

Scene generate(Random r) {
  Scene scene;
  add_guide(r, scene);
  add_gravity(r, scene);
  add_gravity_of_log(r, scene);
  if (r.chance(0.1)) scene.title = "Made by chance";
  const double u = r.uniform();
  if (u < 0.06) {
    add_approximation(r, scene);
    scene.outputs = 20;
    return scene;
  }
  std::optional<Constraint> wanted;
  if (u < 0.2) {
    add_pendulums(r, scene);
  } else if (u < 0.35) {
    add_cardan_gyro(r, scene);
  } else if (u < 0.5) {
    add_resting_bodies(r, scene);
  } else if (u < 0.53) {
    wanted = add_plane_chain(r, scene);
  } else if (u < 0.56) {
    wanted = add_spatial_chain(r, scene);
  } else if (u < 0.62) {
    wanted = add_vehicle(r, scene);
  } else {
    add_bodies(r, scene);
  }
  add_solve(r, scene);
  add_sensors(r, scene);
  for (Body& body : scene.bodies) body.has_units = r.chance(0.1);
  for (Body& body : scene.bodies) add_other_loads(r, body);
  add_logs_of_signals(r, scene);
  add_begin(r, scene);
  add_elements(r, scene);
  loosen_joints(r, scene);
  for (int tries = 0; wanted && tries < 5; ++tries) {
    if (add_constraint(r, scene, *wanted)) break;
  }
  add_constraints(r, scene);
  add_servos(r, scene);
  return scene;
}

}  // namespace differential
