#pragma once

#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include <support/scratch.hpp>

namespace kreisel::test {

/// The output and exit status of a program.
struct Outcome {
  int status;
  std::string out;
  std::string err;
};

/// Runs a command line of the shell.
[[nodiscard]] inline Outcome run(const std::string& command) {
  const Scratch folder;
  const std::string redirected = command + " >'" + (folder.path() / "out").string() + "' 2>'" +
                                 (folder.path() / "err").string() + "'";
  const int status = std::system(redirected.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.read("out"), folder.read("err")};
}

}  // namespace kreisel::test
