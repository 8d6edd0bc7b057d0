#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <dynamics/file/readings.hpp>

#include "output.hpp"

/// Output times and states of a run, at most as many as a picture shows.
class Samples {
 public:
  Samples(const Result& result, std::size_t most) : result_(result) {
    const std::size_t n = result.run.times.size();
    const std::size_t stride = std::max<std::size_t>(1, (n + most - 1) / most);
    for (std::size_t i = 0; i < n; i += stride) chosen_.push_back(i);
    if (chosen_.back() != n - 1) chosen_.push_back(n - 1);
  }

  /// The values of a function at each time and state.
  template <class Value>
  [[nodiscard]] auto all(const Value& value) const {
    std::vector<decltype(value(0.0, kreisel::JointState{}))> list;
    for (const std::size_t i : chosen_) {
      list.push_back(value(result_.run.times[i], result_.run.states[i]));
    }
    return list;
  }

  /// The readings of all sensors at each time. Those of a period need all rows.
  [[nodiscard]] std::vector<std::vector<double>> readings() const {
    kreisel::SensorReadings sensors(result_.scene);
    std::vector<std::vector<double>> list;
    for (std::size_t i = 0; i < result_.run.times.size(); ++i) {
      const bool is_chosen = chosen_[list.size()] == i;
      if (!is_chosen && !sensors.need_all_rows()) continue;
      auto row = sensors.row(result_.model, result_.run.times[i], result_.run.states[i]);
      if (is_chosen) list.push_back(std::move(row));
    }
    return list;
  }

  /// The sampled entries of a list with one entry for each output.
  [[nodiscard]] std::vector<double> of(const std::vector<double>& values) const {
    std::vector<double> list;
    for (const std::size_t i : chosen_) list.push_back(values[i]);
    return list;
  }

 private:
  const Result& result_;
  std::vector<std::size_t> chosen_;
};
