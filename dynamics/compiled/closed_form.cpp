#include <dynamics/solve/closed_form_defined.hpp>
#include <dynamics/solve/closed_form_of_bodies_defined.hpp>
