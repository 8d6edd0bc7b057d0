#pragma once

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <string>
#include <unistd.h>

#include <motor/error.hpp>

namespace kreisel {

/// Maximum size of scene files in bytes; larger ones are refused.
inline constexpr std::size_t largest_scene_file = 64U << 20U;

/// All bytes of a file, of a pipe or, for the name "-", of standard input.
///
/// Throws : InvalidInput naming the path and the reason if it cannot be read, or if it has more
///          than `most` bytes (an endless device has)
[[nodiscard]] inline std::string read_text(const std::filesystem::path& path, std::size_t most) {
  const auto refuse = [&path](const std::string& why) -> InvalidInput {
    return InvalidInput((path == "-" ? "standard input" : path.string()) + ": " + why);
  };
  const int file = path == "-" ? ::dup(STDIN_FILENO)
                               : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT: variadic
  std::string text;
  std::array<char, 65536> part{};
  ssize_t count = file < 0 ? -1 : 1;
  while (count > 0 && text.size() <= most) {
    count = ::read(file, part.data(), part.size());
    if (count > 0) text.append(part.data(), static_cast<std::size_t>(count));
  }
  const int error = errno;
  if (file >= 0) ::close(file);
  if (count < 0) throw refuse(std::string("cannot be read: ") + std::strerror(error));
  if (text.size() > most) {
    throw refuse("is larger than " + std::to_string(most >> 20U) + " MB, the most that is read");
  }
  return text;
}

}  // namespace kreisel
