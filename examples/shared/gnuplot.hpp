#pragma once

#include <fmt/core.h>

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <system_error>

#include <dynamics/file/atomic_file.hpp>
#include <motor/error.hpp>

/// gnuplot, as the programs call it for --plot.
namespace gnuplot {

/// For the pictures of scene files; texts are taken as they are.
inline constexpr const char* style =
    "set termoption noenhanced\nset grid xtics ytics lt 1 lc rgb '#dddddd'\n"
    "set border 31 lc rgb '#555555'\n"
    "set tics tc rgb '#333333'\n";

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

/// Makes the folder of --plot.
///
/// Throws : kreisel::InvalidInput; and as require_installed()
inline void open_folder(const std::filesystem::path& folder) {
  require_installed();
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw kreisel::InvalidInput("--plot " + folder.string() + ": " + error.message());
}

/// The picture `place`.svg and .png, 800 wide.
inline void draw(const std::filesystem::path& place, std::size_t height,
                 const std::string& script) {
  for (const bool svg : {true, false}) {
    kreisel::AtomicFile picture(place.string() + (svg ? ".svg" : ".png"));
    const std::string terminal =
        svg ? fmt::format("set terminal svg size 800,{} font 'Helvetica,14' background 'white'\n",
                          height)
            : fmt::format("set terminal pngcairo size 800,{} font 'Helvetica,11'\n", height);
    run(fmt::format("{}set output {}\n{}", terminal, quoted(picture.draft().string()), script));
    picture.commit();
  }
}

}  // namespace gnuplot
