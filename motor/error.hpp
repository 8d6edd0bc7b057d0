#pragma once

#include <stdexcept>

#include <motor/api.hpp>

namespace kreisel {

/// The base class of all exceptions that this library throws.
struct KREISEL_API Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Invalid data from the caller. The message names the value, its location and the reason. Programs
/// exit with 2.
struct KREISEL_API InvalidInput : Error {
  using Error::Error;
};

/// Valid data without a computable answer: singular, not converged. Programs exit with 3.
struct KREISEL_API ComputationFailed : Error {
  using Error::Error;
};

}  // namespace kreisel
