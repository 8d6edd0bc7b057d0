#include <dynamics/decompositions_by_eigen.hpp>
