#pragma once

#include <string>
#include <vector>

namespace work_precision {

/// States computed in arithmetic of 34 digits.
struct Reference {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
};

/// The states of the scene from tests/data/ode-scenes.json.
Reference reference(const std::string& scene);

}  // namespace work_precision
