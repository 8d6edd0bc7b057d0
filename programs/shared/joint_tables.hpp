#pragma once

#include <nlohmann/json.hpp>

#include <string>

/// Tables of joints, their motion and their loads, as text.
namespace joint_tables {

/// A number, or a list of them in brackets, with 15 digits.
[[nodiscard]] std::string text(const nlohmann::ordered_json& numbers);

/// Prints a table of objects by body. Their values are numbers, lists or objects of those.
void print(const char* title, const nlohmann::ordered_json& table);

}  // namespace joint_tables
