#include <dynamics/processor.hpp>

namespace kreisel::detail {

void KREISEL_SAME_MARCH() {}

}  // namespace kreisel::detail
