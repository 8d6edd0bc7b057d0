#include <dynamics/solve/any_field_defined.hpp>
