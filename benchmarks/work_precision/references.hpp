#pragma once

#include <string>
#include <vector>

namespace work_precision {

/// States that arithmetic in 34 digits has computed.
struct Reference {
  std::vector<double> times;
  std::vector<std::vector<double>> states;
};

/// The scene's from tests/data/ode-scenes.json.
Reference reference(const std::string& scene);

}  // namespace work_precision
