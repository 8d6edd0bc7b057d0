#pragma once

/// All of the calculus: motors, displacements, tensors, rates with frame and observer, printing.

#include <motor/attitude.hpp>
#include <motor/displacement.hpp>
#include <motor/error.hpp>
#include <motor/frame.hpp>
#include <motor/motor.hpp>
#include <motor/print.hpp>
#include <motor/rate.hpp>
#include <motor/screw.hpp>
#include <motor/spatial_vector_order.hpp>
#include <motor/tensor.hpp>
