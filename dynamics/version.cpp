#include <dynamics/version.hpp>

namespace kreisel {

const char* version() { return KREISEL_VERSION; }

}  // namespace kreisel
