#pragma once

/// All studies of a scene: equilibria, linear equations, spectra, whirl, stability with periodic
/// coefficients, precession equations, increments of inertial units, and pruning.

#include <dynamics/study/campbell.hpp>
#include <dynamics/study/deviation.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/floquet.hpp>
#include <dynamics/study/floquet_bodies.hpp>
#include <dynamics/study/frame_terms.hpp>
#include <dynamics/study/harmonic_response.hpp>
#include <dynamics/study/increments.hpp>
#include <dynamics/study/interpolated_motion.hpp>
#include <dynamics/study/linear_error.hpp>
#include <dynamics/study/linear_plant.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/margins.hpp>
#include <dynamics/study/model_bound.hpp>
#include <dynamics/study/precession.hpp>
#include <dynamics/study/precession_admissibility.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/study/precession_gimbals.hpp>
#include <dynamics/study/prune.hpp>
#include <dynamics/study/rotor_spectrum.hpp>
#include <dynamics/study/rotor_sweep.hpp>
#include <dynamics/study/sampled_transition.hpp>
#include <dynamics/study/small_motion.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/study/stability_boundaries.hpp>
#include <dynamics/study/transition.hpp>
#include <dynamics/study/whirl.hpp>
