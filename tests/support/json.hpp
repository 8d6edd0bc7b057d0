#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace kreisel::test {

using Json = nlohmann::json;

/// Parses a JSON text. Defined here in one place: the parser costs g++ a second.
[[nodiscard]] Json parsed(const std::string& text);

/// A file of tests/data.
[[nodiscard]] Json reference_file(const std::string& name);

/// A number; numbers of many digits are stored as text.
[[nodiscard]] double number(const Json& json);

}  // namespace kreisel::test
