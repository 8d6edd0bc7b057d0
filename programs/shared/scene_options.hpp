#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include <dynamics/file/scene_file.hpp>

/// Options of all programs that read a scene file.
namespace scene_options {

/// --set KEY=VALUE, as often as wanted.
inline void add_settings(CLI::App& app, kreisel::SolveRequest& request) {
  app.add_option_function<std::vector<std::string>>(
         "--set",
         [&request](const std::vector<std::string>& words) {
           for (const std::string& word : words) {
             request.settings.push_back(kreisel::parse_setting("--set", word));
           }
         },
         "a value of the scene, by its keys, as body.rotor.mass=2; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->group("Instead of the scene's");
}

}  // namespace scene_options
