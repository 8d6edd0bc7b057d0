#pragma once

#include <motor/api.hpp>

namespace kreisel {

/// The version of the compiled library, "MAJOR.MINOR.PATCH". CONTRIBUTING.md has the rules by which
/// the numbers change.
KREISEL_API [[nodiscard]] const char* version();

}  // namespace kreisel
