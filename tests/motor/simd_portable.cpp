// The tests of motor/simd.hpp with its portable fallback.
#define KREISEL_PORTABLE_SIMD
#include "simd.cpp"
