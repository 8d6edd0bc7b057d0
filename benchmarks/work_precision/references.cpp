#include "references.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>

namespace work_precision {

Reference reference(const std::string& scene) {
  const std::string path = std::string(KREISEL_TEST_DATA) + "/ode-scenes.json";
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  const nlohmann::json all = nlohmann::json::parse(file);
  const nlohmann::json& found = all.at("scenes").at(scene);
  Reference reference{found.at("times").get<std::vector<double>>(), {}};
  for (const auto& state : found.at("states")) {
    auto& numbers = reference.states.emplace_back();
    for (const auto& number : state) numbers.push_back(std::stod(number.get<std::string>()));
  }
  return reference;
}

}  // namespace work_precision
