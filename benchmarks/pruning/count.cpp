// Runs every form a thousand times while callgrind counts its instructions:
// tests/support/instructions.sh. Each dump's description contains case and form.

#include <valgrind/callgrind.h>

#include "cases.hpp"

int main() {
  for (const pruning::Case& c : pruning::all_cases()) {
    for (const pruning::Form& form : c.forms) {
      const std::string name = c.name + ": " + form.name;
      form.run(1);  // what happens once: looking up the sine
      CALLGRIND_ZERO_STATS;
      form.run(1000);
      CALLGRIND_DUMP_STATS_AT(name.c_str());
    }
  }
}
