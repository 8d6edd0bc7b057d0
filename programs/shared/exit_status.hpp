#pragma once

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include <dynamics/file/printable.hpp>
#include <dynamics/file/scene_file.hpp>
#include <motor/error.hpp>

#include "signals.hpp"

/// Exit statuses of all programs.
namespace exit_status {

inline constexpr int complete = 0;
inline constexpr int bad_input = 2;
inline constexpr int failed = 3;
inline constexpr int tolerance_missed = 4;

/// The status of a signal, as shells count: 130 after SIGINT, 143 after SIGTERM, `complete` if
/// neither came.
[[nodiscard]] inline int of_signal() {
  return signals::caught() == 0 ? 0 : 128 + signals::caught();
}

/// The end of each --help.
inline constexpr const char* help =
    "Exit status:\n"
    "  0    complete, the tolerance is kept\n"
    "  2    the input is refused; nothing was computed\n"
    "  3    the computation failed, or a result could not be written\n"
    "  4    complete, but the tolerance was not reached\n"
    "  130  interrupted by SIGINT (Ctrl-C), 143 by SIGTERM; what was computed is kept\n";

/// The exit status of `program`. If it throws, the reason is written to standard error, one line
/// for each mistake. The status is then `bad_input`, `failed`, or the status of an earlier signal.
template <class Program>
[[nodiscard]] int of(const char* name, const Program& program) {
  const auto fail = [name](const std::exception& error, int status) {
    if (of_signal() != 0) {
      std::fprintf(stderr, "%s: interrupted\n", name);
      return of_signal();
    }
    const std::string line = kreisel::printable(error.what(), 2000);
    std::fprintf(stderr, "%s: %s\n", name, line.c_str());  // fmt::print may throw
    return status;
  };
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is an error of writing
  try {
    return program();
  } catch (const kreisel::SceneMistakes& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return bad_input;
  } catch (const kreisel::InvalidInput& error) {
    return fail(error, bad_input);
  } catch (const std::exception& error) {
    return fail(error, failed);
  }
}

}  // namespace exit_status
