// The command line of pendulum_deviation, which reads the list of sites too; see sites.cpp.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <programs/pendulum_deviation/request.hpp>

#include "command_line.hpp"

void examine(int argc, char** argv) {
  static const bool nothing_comes = std::freopen("/dev/null", "r", stdin) != nullptr;
  if (!nothing_comes) std::abort();
  const std::optional<Request> request = read_request(argc, argv);
  if (!request) return;
  if (request->sites.empty()) std::abort();
  if (request->plot && request->mode == Request::Mode::single) std::abort();
  for (const Site& site : request->sites) {
    if (!(abs(site.place.latitude) <= 90 && isfinite(site.place.azimuth))) std::abort();
  }
}
