#pragma once

#include <fmt/core.h>

#include <cctype>
#include <cstddef>
#include <filesystem>
#include <string>

/// gnuplot for the option --plot of the programs.
namespace gnuplot {

/// The style of pictures of scene files; texts are shown as they are.
inline constexpr const char* style =
    "set termoption noenhanced\nset grid xtics ytics lt 1 lc rgb '#dddddd'\n"
    "set border 31 lc rgb '#555555'\n"
    "set tics tc rgb '#333333'\n";

/// A gnuplot string that shows the text as it is. Punctuation is written by its code, so that an
/// apostrophe at the beginning or a backquote, which runs a command, has no meaning. gnuplot reads
/// digits after a code as part of it: they are written by their codes, too.
inline std::string quoted(const std::string& text) {
  std::string result = "\"";
  bool after_code = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte >= 0x80 || c == ' ' || std::isalnum(byte) != 0;
    after_code = !is_plain || (after_code && std::isdigit(byte) != 0);
    if (!after_code) {
      result += c;
    } else {
      result += fmt::format("\\{:03o}", byte < 0x20 || byte == 0x7f ? ' ' : byte);
    }
  }
  return result + '"';
}

/// True if gnuplot is on the PATH.
[[nodiscard]] bool is_installed();

/// Throws : kreisel::ComputationFailed if gnuplot is not on the PATH
void require_installed();

/// Makes the folder of --plot.
///
/// Throws : kreisel::InvalidInput
void open_folder(const std::filesystem::path& folder);

/// Draws one picture by a script that sets a terminal and no output. gnuplot gets no file name: it
/// writes to a pipe, and its complete output becomes the file.
///
/// Throws : kreisel::ComputationFailed if gnuplot fails, if the picture cannot be written, and
///          after a signal
void draw_picture(const std::filesystem::path& file, const std::string& script);

/// Draws the pictures `place`.svg, 800 wide, and .png of twice that.
///
/// Throws : as draw_picture()
void draw(const std::filesystem::path& place, std::size_t height, const std::string& script);

/// Prints the name of a file that was written, on standard error.
void wrote(const std::filesystem::path& file);

/// The first line of a script: the terminal for an SVG, 800 wide, or for a PNG of twice that.
std::string terminal(bool svg, std::size_t height);

}  // namespace gnuplot
