#pragma once

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <motor/error.hpp>

#include "number.hpp"

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

}  // namespace command_line
