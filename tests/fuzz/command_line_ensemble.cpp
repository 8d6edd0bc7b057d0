// The command line of ensemble. If it varies a number, the drawn value must not depend on
// uninitialised memory.

#include <cstdlib>
#include <optional>
#include <programs/ensemble/request.hpp>

#include "command_line.hpp"

void examine(int argc, char** argv) {
  const std::optional<Request> request = read_request(argc, argv);
  if (!request) return;
  kreisel::MemberRandom random(request->ensemble.seed, 0);
  for (const kreisel::Variation& variation : request->ensemble.variations) {
    if (variation.keys.empty()) std::abort();
    const double drawn = variation.drawn(0.5, random);
    (void)variation.applied(1, drawn);
  }
}
