#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace kreisel::test {

using Json = nlohmann::json;

/// What a text says. Here, not where it is wanted: the parser takes g++ a second.
[[nodiscard]] Json parsed(const std::string& text);

/// A file of tests/data.
[[nodiscard]] Json reference_file(const std::string& name);

/// Numbers of many digits stand there as text.
[[nodiscard]] double number(const Json& json);

}  // namespace kreisel::test
