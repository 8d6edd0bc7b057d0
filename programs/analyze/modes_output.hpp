#pragma once

#include <vector>

#include <dynamics/json/modes.hpp>

void print(const kreisel::LinearMotion& linear);
void print(const kreisel::SceneSweep& sweep);
/// The modes of a periodic motion.
void print(const std::vector<kreisel::WhirlingMode>& modes, const kreisel::FloquetMotion& motion,
           int rates);
