#pragma once

#include <fmt/core.h>

#include <cctype>
#include <cstddef>
#include <filesystem>
#include <string>

/// gnuplot, as the programs call it for --plot.
namespace gnuplot {

/// For the pictures of scene files; texts are taken as they are.
inline constexpr const char* style =
    "set termoption noenhanced\nset grid xtics ytics lt 1 lc rgb '#dddddd'\n"
    "set border 31 lc rgb '#555555'\n"
    "set tics tc rgb '#333333'\n";

/// A string of gnuplot's that shows the text as it is. Punctuation is written by its number: neither
/// an apostrophe at the beginning nor a backquote, which runs a command, has a meaning then.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 || c == ' ' || std::isalnum(byte) != 0) {
      result += c;
    } else {
      result += fmt::format("\\{:03o}", byte < 0x20 || byte == 0x7f ? ' ' : byte);
    }
  }
  return result + '"';
}

/// Throws : kreisel::ComputationFailed where there is none on the PATH
void require_installed();

/// Makes the folder of --plot.
///
/// Throws : kreisel::InvalidInput; and as require_installed()
void open_folder(const std::filesystem::path& folder);

/// Draws one picture by a script that sets a terminal and no output. gnuplot is given no name of a
/// file: it writes to a pipe, and what comes out of it is put in its place whole.
///
/// Throws : kreisel::ComputationFailed where gnuplot does not run to its end, where the disk does not
///          take the picture, and after a signal
void draw_picture(const std::filesystem::path& file, const std::string& script);

/// The pictures `place`.svg and .png, 800 wide.
///
/// Throws : as draw_picture()
void draw(const std::filesystem::path& place, std::size_t height, const std::string& script);

/// The first line of a script: the terminal for an SVG or a PNG, 800 wide.
std::string terminal(bool svg, std::size_t height);

}  // namespace gnuplot
