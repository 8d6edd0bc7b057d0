// Any bytes at all as the table of a logged motion: they are read or refused, and the frame that they
// give moves.

#include <cstddef>
#include <cstdint>

#include <dynamics/file/motion_log.hpp>
#include <dynamics/guide/tabulated.hpp>

#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const kreisel::test::MemoryFile file(data, size);
  try {
    const kreisel::TabulatedFrame<> frame(kreisel::read_motion_log(file.path()).motion);
    for (const double t : {frame.begin(), (frame.begin() + frame.end()) / 2, frame.end()}) {
      (void)frame(t);
    }
    (void)frame.interpolation_error();
  } catch (const kreisel::InvalidInput&) {  // as it should be
  }
  return 0;
}
