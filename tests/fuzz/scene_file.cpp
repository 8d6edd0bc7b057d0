// Any bytes at all as a scene file: they are read or refused, and nothing else happens.
//
//   clang++ -std=c++20 -g -O1 -fsanitize=fuzzer,address,undefined
//     -DTOML_HEADER_ONLY=0 -I. -isystem /usr/include/eigen3
//     tests/fuzz/scene_file.cpp dynamics/file/scene_*.cpp -ltomlplusplus -lGeographicLib -o fuzz
//   ./fuzz examples/scenes

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <dynamics/file/scene_file.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    (void)kreisel::parse_scene({reinterpret_cast<const char*>(data), size}, "scene.toml");
  } catch (const kreisel::InvalidInput&) {  // as it should be
  }
  return 0;
}
