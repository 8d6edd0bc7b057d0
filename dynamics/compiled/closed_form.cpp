#include <dynamics/solve/closed_form_defined.hpp>
