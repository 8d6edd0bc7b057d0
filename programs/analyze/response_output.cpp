#include "response_output.hpp"

#include <fmt/core.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include <dynamics/file/atomic_file.hpp>
#include <dynamics/file/plant.hpp>
#include <dynamics/file/printable.hpp>

using namespace kreisel;
using namespace kreisel::scene_analysis;
using nlohmann::ordered_json;

namespace {

/// The phase in degrees, in (-180, 180].
double degrees(const std::complex<double>& value) {
  return std::arg(value) * 180 / std::numbers::pi;
}

/// The amplitudes at w + k W of one frequency.
ordered_json harmonics_json(const Response& response, std::size_t row) {
  const HarmonicResponse& all = *response.harmonics;
  ordered_json list = ordered_json::array();
  for (int k = -HarmonicResponse::harmonics; k <= HarmonicResponse::harmonics; ++k) {
    const std::complex<double>& H = *(all.values[row].begin() + HarmonicResponse::harmonics + k);
    list.push_back(
        {{"k", k},
         {"frequency", response.frequencies[row] + k * 2 * std::numbers::pi / all.period},
         {"amplitude", std::abs(H)},
         {"phase", std::arg(H)}});
  }
  return list;
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

ordered_json json(const Response& response) {
  ordered_json rows = ordered_json::array();
  for (std::size_t i = 0; i < response.values.size(); ++i) {
    rows.push_back({{"frequency", response.frequencies[i]},
                    {"amplitude", std::abs(response.values[i])},
                    {"phase", std::arg(response.values[i])}});
    if (response.harmonics) rows.back()["harmonics"] = harmonics_json(response, i);
  }
  ordered_json result{{"input", response.input.name},
                      {"input_unit", response.input.unit},
                      {"output", response.output.name},
                      {"output_unit", response.output.unit},
                      {"first_harmonic", response.is_first_harmonic},
                      {"rows", rows}};
  if (response.harmonics) {
    result["period"] = response.harmonics->period;
    result["error"] = response.harmonics->error;
  }
  if (response.bandwidth) result["bandwidth"] = *response.bandwidth;
  if (response.margins) {
    const auto crossing = [](const auto& found, const char* margin) {
      if (!found) return ordered_json();
      return ordered_json{{"frequency", found->frequency}, {margin, found->margin}};
    };
    result["phase_margin"] = crossing(response.margins->phase, "angle");
    result["gain_margin"] = crossing(response.margins->gain, "factor");
  }
  return result;
}

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

ordered_json state_space_json(const Result& result) {
  const Steady& steady = result.analysis.steady;
  if (!steady.exists()) {
    throw ComputationFailed("--state-space: no steady motion: " + steady.reason);
  }
  const LinearPlant plant = result.system.plant(
      result.system.begin(), steady.state, plant_inputs(result.scene), plant_outputs(result.scene));
  const StateSpace matrices = state_space(plant);
  const auto rows = [](const Eigen::MatrixXd& M) {
    ordered_json all = ordered_json::array();
    for (Eigen::Index i = 0; i < M.rows(); ++i) {
      const Eigen::VectorXd row = M.row(i);
      all.push_back(std::vector<double>(row.begin(), row.end()));
    }
    return all;
  };
  const auto named = [](const auto& all) {
    ordered_json list = ordered_json::array();
    for (const auto& one : all) list.push_back({{"name", one.name}, {"unit", one.unit}});
    return list;
  };
  ordered_json inputs = ordered_json::array();
  for (const auto& input : matrices.inputs) {
    inputs.push_back({{"name", input.name}, {"unit", input.unit}, {"derivative", input.power}});
  }
  return {{"title", result.scene.title},
          {"frame", result.analysis.linear ? result.analysis.linear->frame : ""},
          {"dt", plant.period},
          {"states", plant.names},
          {"inputs", inputs},
          {"outputs", named(plant.outputs)},
          {"A", rows(matrices.A)},
          {"B", rows(matrices.B)},
          {"C", rows(plant.C)},
          {"D", rows(matrices.D)}};
}

void write_state_space(const Result& result, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << state_space_json(result).dump(1) << '\n';
  file.commit();
}
