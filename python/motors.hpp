#pragma once

#include <pybind11/pybind11.h>

/// Defines the classes and products of motors in the module: Motor, MotorTensor, Inertia, Pose.
void define_motors(pybind11::module_& m);
