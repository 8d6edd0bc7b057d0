#include "joint_tables.hpp"

#include <fmt/core.h>

#include <dynamics/file/printable.hpp>

using nlohmann::ordered_json;

namespace joint_tables {

std::string text(const ordered_json& numbers) {
  if (numbers.is_number()) return fmt::format("{:.15g}", numbers.get<double>());
  std::string all;
  for (const auto& x : numbers) {
    all += fmt::format("{}{:.15g}", all.empty() ? "" : ", ", x.get<double>());
  }
  return "(" + all + ")";
}

void print(const char* title, const ordered_json& table) {
  fmt::print("\n{}\n", title);
  for (const auto& [name, values] : table.items()) {
    const std::string body = kreisel::printable(name, 60);
    for (const auto& [quantity, numbers] : values.items()) {
      if (numbers.is_object()) {
        for (const auto& [part, vector] : numbers.items()) {
          fmt::print("  {:20} {:17} {}\n", body, fmt::format("{} {}", quantity, part),
                     text(vector));
        }
      } else {
        fmt::print("  {:20} {:17} {}\n", body, quantity, text(numbers));
      }
    }
  }
}

}  // namespace joint_tables
