// Arbitrary bytes as the command line of a program, one word a line: they are accepted or refused.
// The program does not run.

#include "command_line.hpp"

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include <motor/error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words{"program"};
  for (std::string word; std::getline(text, word);) {
    if (word == "-h" || word == "--help" || word.find('\0') != std::string::npos) return 0;
    words.push_back(word);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  try {
    examine(static_cast<int>(arguments.size()), arguments.data());
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
  return 0;
}
