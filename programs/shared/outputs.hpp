#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <motor/error.hpp>

/// Files that a program writes.
namespace outputs {

/// Throws : kreisel::InvalidInput if the output file is one of the input files
inline void refuse_input(const char* option, const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    std::error_code error;  // files that do not exist are not the same
    if (std::filesystem::is_regular_file(output, error) &&
        std::filesystem::equivalent(output, input, error)) {
      throw kreisel::InvalidInput(std::string(option) + " " + output.string() + ": is the input " +
                                  input.string() +
                                  ", which would be overwritten; give another name");
    }
  }
}

/// Redirects standard output to standard error if a table called "-" needs standard output alone.
inline void leave_standard_output_to(const std::filesystem::path& table) {
  if (table != "-") return;
  std::fflush(stdout);
  ::dup2(STDERR_FILENO, STDOUT_FILENO);
}

}  // namespace outputs
