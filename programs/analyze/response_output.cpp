#include "response_output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/printable.hpp>

using namespace kreisel;
using namespace kreisel::scene_analysis;

namespace {

/// The phase in degrees, in (-180, 180].
double degrees(const std::complex<double>& value) {
  return std::arg(value) * 180 / std::numbers::pi;
}

/// Prints the amplitudes at w + k W, a row for each frequency.
void print_harmonics(const Response& response) {
  const HarmonicResponse& all = *response.harmonics;
  fmt::print(
      "  about a motion of the period {:.9g} s: amplitudes at the frequency + k {:.9g} rad/s\n",
      all.period, 2 * std::numbers::pi / all.period);
  fmt::print("  {:>16}", "frequency, rad/s");
  for (int k = -HarmonicResponse::harmonics; k <= HarmonicResponse::harmonics; ++k) {
    fmt::print(" {:>12}", fmt::format("k = {:d}", k));
  }
  fmt::print("\n");
  for (std::size_t i = 0; i < all.values.size(); ++i) {
    fmt::print("  {:16.10g}", response.frequencies[i]);
    for (const std::complex<double>& H : all.values[i]) fmt::print(" {:12.6g}", std::abs(H));
    fmt::print("\n");
  }
  fmt::print("  relative error of the amplitudes {:.1e}\n", all.error);
}

}  // namespace

void print(const Response& response) {
  fmt::print("\nresponse of {}, {}, to {}, {}{}\n", printable(response.output.name),
             response.output.unit, printable(response.input.name),
             response.input.unit.empty() ? "reference" : response.input.unit,
             response.is_first_harmonic ? "; first harmonic" : "");
  fmt::print("  {:>16} {:>14} {:>16} {:>12}\n", "frequency, rad/s", "Hz", "amplitude",
             "phase, deg");
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    const double w = response.frequencies[i];
    fmt::print("  {:16.10g} {:14.6g} {:16.10g} {:12.6g}\n", w, w / (2 * std::numbers::pi),
               std::abs(response.values[i]), degrees(response.values[i]));
  }
  if (response.harmonics) print_harmonics(response);
  if (response.bandwidth) fmt::print("  bandwidth (-3 dB): {:.10g} rad/s\n", *response.bandwidth);
  if (!response.margins) return;
  const auto& [phase, gain] = *response.margins;
  fmt::print("  the loop, opened at this joint force{}:\n",
             response.is_first_harmonic ? ", by the first harmonic" : "");
  if (phase) {
    fmt::print("    phase margin {:.8g} deg at {:.10g} rad/s\n",
               phase->margin * 180 / std::numbers::pi, phase->frequency);
  } else {
    fmt::print("    no phase margin: its gain does not cross 1 in this range\n");
  }
  if (gain) {
    fmt::print("    gain margin {:.8g} at {:.10g} rad/s\n", gain->margin, gain->frequency);
  } else {
    fmt::print("    no gain margin: its phase does not cross -180 deg in this range\n");
  }
}

void write_response(const Response& response, const std::filesystem::path& path) {
  AtomicFile file(path);
  std::string text = "frequency,amplitude,phase";
  const int most = response.harmonics ? HarmonicResponse::harmonics : -1;
  for (int k = -most; k <= most; ++k) text += fmt::format(",amplitude {0:+d},phase {0:+d}", k);
  text += '\n';
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    text += fmt::format("{:.17g},{:.17g},{:.17g}", response.frequencies[i],
                        std::abs(response.values[i]), std::arg(response.values[i]));
    if (response.harmonics) {
      for (const std::complex<double>& H : response.harmonics->values[i]) {
        text += fmt::format(",{:.17g},{:.17g}", std::abs(H), std::arg(H));
      }
    }
    text += '\n';
  }
  file.stream() << text;
  file.commit();
}

void write_state_space(const AnalysisResult& result, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << state_space_json(result).dump(1) << '\n';
  file.commit();
}
