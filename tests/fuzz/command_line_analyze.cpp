// The command line of analyze. Speeds of a sweep are finite numbers, frequencies rise from above 0.

#include <cmath>
#include <cstdlib>
#include <optional>
#include <programs/analyze/request.hpp>

#include "command_line.hpp"

void examine(int argc, char** argv) {
  const std::optional<Request> request = read_request(argc, argv);
  if (!request) return;
  if (request->period && !(*request->period > 0)) std::abort();
  if (request->response) {
    double before = 0;
    for (const double w : request->response->frequencies) {
      if (!(w > before && std::isfinite(w))) std::abort();
      before = w;
    }
  }
  if (!request->campbell) return;
  for (const double order : request->campbell->orders) {
    if (!(order > 0 && std::isfinite(order))) std::abort();
  }
  if (request->campbell->body.empty() || request->campbell->speeds.size() < 2) std::abort();
  for (const double speed : request->campbell->speeds) {
    if (!std::isfinite(speed)) std::abort();
  }
}
