#pragma once

/// What is no template comes in two ways. Headers are complete: they declare it, and include its
/// definitions from a header that ends in _defined.hpp, where all are templates of nothing, so that
/// a program compiles those that it calls. Whoever links kreisel::compiled, which defines
/// KREISEL_COMPILED, gets the declarations alone: the definitions are compiled once, with the flags
/// of the program, on which the layout of Eigen's matrices depends.
#ifdef KREISEL_COMPILED
#define KREISEL_DECLARED
#define KREISEL_DEFINED
#else
#define KREISEL_DECLARED template <int = 0>
#define KREISEL_DEFINED template <int>
#endif
