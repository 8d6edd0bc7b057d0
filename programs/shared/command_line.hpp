#pragma once

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <motor/error.hpp>

#include "number.hpp"

/// Command lines, as all programs read them.
namespace command_line {

/// Reads the command line; false if it printed the help instead.
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
