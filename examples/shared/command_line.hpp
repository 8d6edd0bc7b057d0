#pragma once

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <type_traits>

#include <motor/error.hpp>

/// What the programs share in reading their command lines.
namespace command_line {

/// Reads it, or prints the help where that is asked for, and says which.
///
/// Throws : kreisel::InvalidInput
[[nodiscard]] inline bool parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return false;
  } catch (const CLI::ParseError& error) {
    throw kreisel::InvalidInput(error.what());
  }
  return true;
}

/// Throws : kreisel::InvalidInput unless the whole text is a finite number
template <class Real = double>
[[nodiscard]] Real number(const std::string& what, const std::string& text) {
  char* end = nullptr;
  Real value = 0;
  if constexpr (std::is_same_v<Real, long double>) {
    value = std::strtold(text.c_str(), &end);
  } else {
    value = std::strtod(text.c_str(), &end);
  }
  if (text.empty() || *end != '\0' || !std::isfinite(value)) {
    throw kreisel::InvalidInput(fmt::format("{} = '{}' is not a finite number", what, text));
  }
  return value;
}

}  // namespace command_line
