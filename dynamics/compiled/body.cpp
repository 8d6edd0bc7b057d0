#include <dynamics/body/evaluation_defined.hpp>
#include <dynamics/body/series_defined.hpp>
#include <dynamics/body/tree_defined.hpp>
