// The command line of simulate.

#include <cstdlib>
#include <optional>
#include <programs/simulate/request.hpp>

#include "command_line.hpp"

void examine(int argc, char** argv) {
  const std::optional<Request> request = read_request(argc, argv);
  if (!request) return;
  const auto& [t_end, tolerance, method, settings] = request->solve;
  if (t_end && !(*t_end > 0)) std::abort();
  if (tolerance && !(*tolerance >= 1e-15 && *tolerance <= 1e-2)) std::abort();
  if (request->resume && !request->csv) std::abort();
}
