#pragma once

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <dynamics/file/finite_number.hpp>
#include <dynamics/version.hpp>
#include <motor/error.hpp>

/// Command lines, as all programs read them.
namespace command_line {

/// Reads the command line; false if it printed the help or the version instead.
///
/// Throws : kreisel::InvalidInput
[[nodiscard]] inline bool parse(CLI::App& app, int argc, char** argv) {
  app.set_version_flag("--version", app.get_name() + ' ' + kreisel::version(),
                       "print the version and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", app.help());
    return false;
  } catch (const CLI::CallForVersion& version) {
    fmt::print("{}\n", version.what());
    return false;
  } catch (const CLI::ParseError& error) {
    throw kreisel::InvalidInput(error.what());
  }
  return true;
}

}  // namespace command_line
