// Arbitrary bytes as a scene file. They are accepted or refused, with numbers exchanged, and
// nothing else happens. ctest --preset sanitize -R fuzz runs it for a minute.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <dynamics/file/scene_file.hpp>
#include <dynamics/file/scene_numbers.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    (void)kreisel::parse_scene(text, "scene.toml");
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
  const std::vector<std::string> keys{"body[0].inertia[1]", "body[0].mass"};
  std::optional<kreisel::SceneNumbers> numbers;
  try {
    numbers.emplace(text, keys);
  } catch (const kreisel::InvalidInput&) {  // the file lacks these
    return 0;
  }
  // A number written into the text is read back.
  const std::vector<double> others{-1e-300, 0.1};
  if (kreisel::SceneNumbers(numbers->with(others), keys).values() != others) std::abort();
  return 0;
}
