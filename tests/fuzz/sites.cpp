// Arbitrary bytes as pendulum_deviation's table of sites: they are accepted or refused.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <programs/pendulum_deviation/sites.hpp>

#include <motor/error.hpp>

#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const kreisel::test::MemoryFile file(data, size);
  try {
    for (const Site& site : listed_sites(file.path(), Real(7.292115e-5))) {
      if (!(abs(site.place.latitude) <= 90)) std::abort();
    }
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
  return 0;
}
