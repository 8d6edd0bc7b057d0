#pragma once

#include <dynamics/rigid/euler_top.hpp>

#include "trial.hpp"

// Compiled once, in tops.cpp.

namespace kreisel {

extern template Trajectory<EulerTop::State> solve(const EulerTop& scene,
                                                  const EulerTop::State& start,
                                                  const SolveOptions& options);

}  // namespace kreisel

namespace stability {

extern template Row attempt(const Recorder& out, const Trial<kreisel::EulerTop>& trial,
                            kreisel::Method method);

}  // namespace stability
