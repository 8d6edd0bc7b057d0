#pragma once

/// All studies of a scene: rests, linear equations, spectra, stability with periodic coefficients,
/// precession equations, and what may be left out.

#include <dynamics/study/campbell.hpp>
#include <dynamics/study/departure.hpp>
#include <dynamics/study/equilibrium.hpp>
#include <dynamics/study/floquet.hpp>
#include <dynamics/study/floquet_bodies.hpp>
#include <dynamics/study/linear_error.hpp>
#include <dynamics/study/linearize.hpp>
#include <dynamics/study/precession.hpp>
#include <dynamics/study/precession_admissibility.hpp>
#include <dynamics/study/precession_bodies.hpp>
#include <dynamics/study/precession_gimbals.hpp>
#include <dynamics/study/prune.hpp>
#include <dynamics/study/rotor_spectrum.hpp>
#include <dynamics/study/spectrum.hpp>
#include <dynamics/study/stability_boundaries.hpp>
#include <dynamics/study/transition.hpp>
