// Any bytes at all as the command line of ensemble, a word a line: they are read or refused. Where
// they vary a number, what is drawn and applied is no accident of the reader's memory.

#include <cstddef>
#include <cstdint>
#include <examples/ensemble/request.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <motor/error.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream text(std::string(reinterpret_cast<const char*>(data), size));
  std::vector<std::string> words{"ensemble"};
  for (std::string word; std::getline(text, word);) {
    if (word == "-h" || word == "--help" || word.find('\0') != std::string::npos) return 0;
    words.push_back(word);
  }
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  try {
    const auto request = read_request(static_cast<int>(arguments.size()), arguments.data());
    if (!request) return 0;
    kreisel::MemberRandom random(request->seed, 0);
    for (const Variation& variation : request->variations) {
      if (variation.keys.empty()) __builtin_trap();
      const double drawn = variation.drawn(0.5, random);
      (void)variation.applied(1, drawn);
    }
  } catch (const kreisel::InvalidInput&) {  // as it should be
  }
  return 0;
}
