// Runs every operation a thousand times while callgrind counts its instructions:
// tests/support/instructions.sh. Each dump's description contains operation and contender.

#include <valgrind/callgrind.h>

#include "contender.hpp"

int main() {
  for (const kernels::Contender& c : kernels::contenders()) {
    const std::string name = c.operation + ": " + c.name;
    c.run(1);  // what happens once: looking up the sine
    CALLGRIND_ZERO_STATS;
    c.run(1000);
    CALLGRIND_DUMP_STATS_AT(name.c_str());
  }
}
