#pragma once

#include <dynamics/scene/euler_top.hpp>

#include "trial.hpp"

namespace stability {

/// Compiled once, in tops.cpp: solve() takes a minute.
extern template Row attempt(const Recorder& out, const Trial<kreisel::EulerTop>& trial,
                            kreisel::Method method);

}  // namespace stability
