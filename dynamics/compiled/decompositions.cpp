#include <dynamics/decompositions_defined.hpp>
