#pragma once

#include <stdexcept>

#include <motor/api.hpp>

namespace kreisel {

/// Everything this library throws: one type to catch.
struct KREISEL_API Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The caller's data are at fault: the message names what, where and why. Programs exit with 2.
struct KREISEL_API InvalidInput : Error {
  using Error::Error;
};

/// The data are legal, the answer cannot be had: singular, not converged. Programs exit with 3.
struct KREISEL_API ComputationFailed : Error {
  using Error::Error;
};

}  // namespace kreisel
