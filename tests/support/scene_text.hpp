#pragma once

#include <string>

#include <dynamics/file/scene_file.hpp>

/// Scenes from texts, for the tests of scene files.
namespace kreisel::test {

/// The scene of a text, whose file is called s.toml in messages.
[[nodiscard]] inline SceneFile scene(const std::string& text) {
  return parse_scene(text, "s.toml");
}

/// The mistakes in a text, one in a line; "none" if there are none.
[[nodiscard]] inline std::string mistakes(const std::string& text) {
  try {
    (void)scene(text);
  } catch (const SceneMistakes& error) {
    return error.what();
  }
  return "none";
}

}  // namespace kreisel::test
