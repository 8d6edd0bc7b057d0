#include <dynamics/solve/solve_defined.hpp>
#include <dynamics/step/radau_defined.hpp>
