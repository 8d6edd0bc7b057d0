#pragma once

#include <csignal>
#include <cstdio>
#include <exception>

#include <dynamics/file/scene_file.hpp>
#include <motor/error.hpp>

/// What `program` returns; or, where it throws, 2 for what was put in and 3 for the rest, with the
/// reason on standard error: a line, or one for each mistake of a scene file.
template <class Program>
[[nodiscard]] int exit_status(const char* name, const Program& program) {
  const auto fail = [name](const std::exception& error, int status) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());  // fmt's may throw
    return status;
  };
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away is an error of writing, not a death
  try {
    return program();
  } catch (const kreisel::SceneMistakes& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const kreisel::InvalidInput& error) {
    return fail(error, 2);
  } catch (const std::exception& error) {
    return fail(error, 3);
  }
}
