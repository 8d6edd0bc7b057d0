#pragma once

#include <array>
#include <cstring>
#include <memory>
#include <mujoco/mujoco.h>
#include <stdexcept>
#include <string>

namespace scenes {

/// A model from its description in MJCF, to be deleted by mj_deleteModel.
///
/// Throws : std::runtime_error with MuJoCo's own message
inline mjModel* load(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();  // megabytes: too large for the stack
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), "model.xml", static_cast<int>(xml.size())) != 0)
    throw std::runtime_error("no room for the model");
  const int file = mj_findFileVFS(files.get(), "model.xml");
  std::memcpy(files->filedata[file], xml.data(), xml.size());
  std::array<char, 500> error{};
  mjModel* model = mj_loadXML("model.xml", files.get(), error.data(), error.size());
  mj_deleteVFS(files.get());
  if (!model) throw std::runtime_error(error.data());
  return model;
}

}  // namespace scenes
