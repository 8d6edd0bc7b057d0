#pragma once

#include <vector>

#include "draw.hpp"
#include "random.hpp"
#include "scene.hpp"

/// The parts of which generate() makes a scene. Each adds its part by chance.

namespace differential {

// generate_guide.cpp
[[nodiscard]] Link earth(Random& r);
void add_guide(Random& r, Scene& scene);

/// The acceleration that accelerometers do not measure.
void add_gravity_of_log(Random& r, Scene& scene);
void add_gravity(Random& r, Scene& scene);

// generate_bodies.cpp

/// Principal moments, often equal, or six entries of a tensor that a body may have.
[[nodiscard]] std::vector<double> inertia(Random& r, double size);

/// A damper by its ratio to the critical one of a joint of that inertia.
void add_damping(Random& r, Body& body, int n);
void add_joint_forces(Random& r, Body& body);

/// A drag or a magnet on some bodies that are no rotors.
void add_other_loads(Random& r, Body& body);

/// Sets the start of a drive to its motion.
void start_motion(Body& body, double t);

/// A wheel on the body before it.
[[nodiscard]] Body rotor(Random& r, int carrier);
void add_bodies(Random& r, Scene& scene);

// generate_usual.cpp

/// A pendulum or a chain of two on any guide: the usual first scene.
void add_pendulums(Random& r, Scene& scene);

/// Bodies at rest or nearly so, with axes along those of the guide: cases at the edge to 0.
void add_resting_bodies(Random& r, Scene& scene);

/// Two rings and a rotor.
void add_cardan_gyro(Random& r, Scene& scene);

// generate_models.cpp
void add_approximation(Random& r, Scene& scene);

// generate_sensors.cpp

/// A sensor of an element's force; `at` is a point of the second body.
[[nodiscard]] Sensor sensor_of_element(Random& r, const Scene& scene);
void add_sensors(Random& r, Scene& scene);

// generate_elements.cpp
void add_elements(Random& r, Scene& scene);

// generate_servos.cpp

/// Servos of joints that are free to move.
void add_servos(Random& r, Scene& scene);

// generate_constraints.cpp

/// Makes some joints constraints.
void loosen_joints(Random& r, Scene& scene);

// generate_closed.cpp

/// Adds a constraint of the given kind, bodies and axis, with points and rates that fulfil it. False
/// if it leaves no motion, or the start is near a singular position.
bool add_constraint(Random& r, Scene& scene, Constraint c);
void add_constraints(Random& r, Scene& scene);

// generate_mechanisms.cpp

void add_free_body(Random& r, Scene& scene);

// Each adds bodies, and returns the constraint that they wait for.

/// Two or three hinges with parallel axes.
[[nodiscard]] Constraint add_plane_chain(Random& r, Scene& scene);

/// Two or three joints of several kinds.
[[nodiscard]] Constraint add_spatial_chain(Random& r, Scene& scene);

/// A free body that will roll on the guide or on a body, or glide on a blade.
[[nodiscard]] Constraint add_vehicle(Random& r, Scene& scene);

}  // namespace differential
