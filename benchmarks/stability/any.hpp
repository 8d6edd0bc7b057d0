#pragma once

#include <functional>

#include <dynamics/guide/motion.hpp>
#include <dynamics/load/load.hpp>

namespace stability {

/// Any guide and any load, so that solve() is compiled for one scene and not for each pair of them.
struct AnyGuide {
  std::function<kreisel::FrameMotion<kreisel::Guide, kreisel::Inertial>(double)> motion;

  [[nodiscard]] kreisel::FrameMotion<kreisel::Guide, kreisel::Inertial> operator()(
      const double& t) const {
    return motion(t);
  }
};

struct AnyLoad {
  std::function<kreisel::Force<kreisel::Body>(const kreisel::LoadContext<>&)> force;

  [[nodiscard]] kreisel::Force<kreisel::Body> operator()(const kreisel::LoadContext<>& s) const {
    return force(s);
  }
};

[[nodiscard]] inline AnyLoad no_load() {
  return {[](const kreisel::LoadContext<>&) { return kreisel::Force<kreisel::Body>{}; }};
}

}  // namespace stability
