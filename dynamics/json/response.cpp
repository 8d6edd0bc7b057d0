#include <Eigen/Core>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <vector>

#include <dynamics/file/plant.hpp>
#include <motor/error.hpp>

#include "analysis.hpp"

namespace kreisel {

using nlohmann::ordered_json;
using scene_analysis::Response;

namespace {

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

}  // namespace

ordered_json json_of(const Response& response) {
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

ordered_json state_space_json(const AnalysisResult& result) {
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

}  // namespace kreisel
