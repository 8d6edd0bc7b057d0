// Arbitrary bytes as a scene file, and as the value of a key. They are accepted or refused, and
// nothing else happens. ctest --preset sanitize -R fuzz runs it for a minute.

#include <cstddef>
#include <cstdint>
#include <string>

#include <dynamics/file/scene_file.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    (void)kreisel::parse_scene(text, "scene.toml");
  } catch (const kreisel::InvalidInput&) {  // the expected refusal
  }
  // The same with the value of a key from elsewhere, which may be any bytes too.
  const std::string value = text.substr(0, text.find('\n'));
  try {
    (void)kreisel::number_in_scene(text, "body[0].mass");
    (void)kreisel::parse_scene(text, "scene.toml", {.settings = {{"body[0].mass", value, "set"}}});
  } catch (const kreisel::InvalidInput&) {
  }
  return 0;
}
