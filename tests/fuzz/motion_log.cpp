// Arbitrary bytes as the table of a logged motion, read with options from the last bytes. They are
// accepted or refused, and the resulting frame moves.

#include <cstddef>
#include <cstdint>

#include <dynamics/file/motion_log.hpp>
#include <dynamics/guide/log_noise.hpp>
#include <dynamics/guide/tabulated.hpp>

#include "memory_file.hpp"

namespace {

kreisel::LogOptions options_from(unsigned a, unsigned b) {
  using namespace kreisel;
  constexpr char separators[] = {0, ',', ';', '\t', ' ', 0, 0, 0};
  constexpr LogTimeUnit units[] = {LogTimeUnit::s, LogTimeUnit::ms, LogTimeUnit::us,
                                   LogTimeUnit::ns};
  constexpr LogDuplicates ways[] = {LogDuplicates::error, LogDuplicates::first, LogDuplicates::last,
                                    LogDuplicates::mean};
  LogOptions options;
  options.separator = separators[a & 7U];
  if ((a & 8U) != 0) options.decimal = ',';
  options.skip = (a >> 4U) & 1U;
  options.skip_after_header = (a >> 5U) & 1U;
  options.header = (a & 64U) == 0;
  if ((a & 192U) != 0) {
    options.columns = {{"t", std::size_t(1)},
                       {"yaw", std::size_t(2)},
                       {"pitch", std::size_t(3)},
                       {"roll", std::size_t(2)}};
  }
  options.time_unit = units[b & 3U];
  options.duplicates = ways[(b >> 2U) & 3U];
  if ((b & 16U) != 0) options.time_zero = "first";
  if ((b & 32U) != 0) options.time_zero = "-1.25e-3";
  if ((b & 64U) != 0) options.run = {0, 1};
  if ((b & 128U) != 0) options.degrees = true;
  if ((b & 96U) == 96U) options.window = {0, 1};
  return options;
}

void read(const kreisel::test::MemoryFile& file, const kreisel::LogOptions& options) {
  try {
    const kreisel::TabulatedFrame<> frame(kreisel::read_motion_log(file.path(), options).motion);
    for (const double t : {frame.begin(), (frame.begin() + frame.end()) / 2, frame.end()}) {
      (void)frame(t);
    }
    (void)frame.interpolation_error();
    const auto sigma = smoothing_sigma(noise_of(frame.samples()));
    const kreisel::TabulatedFrame<> smooth(frame.samples(), smoothing(frame.samples(), sigma));
    (void)smooth(smooth.end());
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const kreisel::test::MemoryFile file(data, size);
  read(file, {});
  if (size >= 2) read(file, options_from(data[size - 2], data[size - 1]));
  return 0;
}
