#pragma once

#include <Eigen/Core>

#include <complex>

#include <dynamics/compiled.hpp>

namespace kreisel::detail {

/// The eigenvalue of the greatest modulus of a real matrix, one of a pair if it is complex; 0 where the
/// matrix is not finite. Plain loops, which take the processor as long as Eigen's real Schur form, and
/// the compiler, per program, two times the seconds of <Eigen/Geometry> less.
///
/// Throws : ComputationFailed if the QR iteration does not converge
KREISEL_DECLARED [[nodiscard]] std::complex<double> fastest_rate(const Eigen::MatrixXd& J);

}  // namespace kreisel::detail

#ifndef KREISEL_COMPILED
#include <dynamics/solve/fastest_rate_defined.hpp>
#endif
