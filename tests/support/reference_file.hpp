#pragma once

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

namespace kreisel::test {

using Json = nlohmann::json;

/// A file of tests/data.
[[nodiscard]] inline Json reference_file(const std::string& name) {
  std::ifstream file(std::string(KREISEL_TEST_DATA) + "/" + name);
  return Json::parse(file);
}

/// Numbers of many digits stand there as text.
[[nodiscard]] inline double number(const Json& json) {
  return json.is_string() ? std::stod(json.get<std::string>()) : json.get<double>();
}

}  // namespace kreisel::test
