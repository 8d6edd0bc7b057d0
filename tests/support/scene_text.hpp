#pragma once

#include <boost/test/unit_test.hpp>

#include <string>

#include <dynamics/file/model.hpp>
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

/// A body of 2 kg.
[[nodiscard]] inline std::string body(const std::string& name, const std::string& joint,
                                      const std::string& rest = "") {
  return "[[body]]\nname = \"" + name + "\"\njoint = " + joint +
         "\nmass = 2\ninertia = [0.3, 0.3, 0.5]\n" + rest + "\n";
}

/// The last state of a run.
[[nodiscard]] inline JointState end(const std::string& text) {
  const auto motion = run_scene(scene(text));
  BOOST_TEST(motion.report.tolerance_kept);
  return motion.states.back();
}

}  // namespace kreisel::test
