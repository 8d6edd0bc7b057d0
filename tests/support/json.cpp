#include <fstream>
#include <stdexcept>

#include <support/json.hpp>

namespace kreisel::test {

Json parsed(const std::string& text) { return Json::parse(text); }

Json reference_file(const std::string& name) {
  std::ifstream file(std::string(KREISEL_TEST_DATA) + "/" + name);
  if (!file) throw std::runtime_error("no " + name + " in " KREISEL_TEST_DATA);
  return Json::parse(file);
}

double number(const Json& json) {
  return json.is_string() ? std::stod(json.get<std::string>()) : json.get<double>();
}

}  // namespace kreisel::test
