#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include <motor/error.hpp>

/// gnuplot, as both programs call it for --plot.
namespace gnuplot {

/// A string of gnuplot's, in which nothing has a meaning.
inline std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += c == '\n' ? ' ' : c;
  }
  return result + "'";
}

/// Throws : kreisel::ComputationFailed where there is none on the PATH
inline void require_installed() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::filesystem::exists(std::filesystem::path(folder) / "gnuplot")) return;
  }
  throw kreisel::ComputationFailed("--plot: gnuplot is not installed");
}

/// Its own complaints are kept from standard error, where a failure is one line.
///
/// Throws : kreisel::ComputationFailed where it does not run to its end
inline void run(const std::string& script) {
  std::FILE* const pipe = popen("gnuplot 2>/dev/null", "w");
  if (pipe == nullptr) throw kreisel::ComputationFailed("--plot: gnuplot does not start");
  const bool sent = std::fwrite(script.data(), 1, script.size(), pipe) == script.size();
  if (pclose(pipe) != 0 || !sent) throw kreisel::ComputationFailed("--plot: gnuplot failed");
}

}  // namespace gnuplot
