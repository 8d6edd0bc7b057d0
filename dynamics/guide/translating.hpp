#pragma once

#include <utility>

#include <dynamics/guide/motion.hpp>

namespace kreisel {

/// The position and motion of a point at one time.
///
/// Units  : metre, m/s, m/s^2
template <class S = double>
struct Translation {
  Vector3<S> position = Vector3<S>::Zero();
  Vector3<S> velocity = Vector3<S>::Zero();
  Vector3<S> acceleration = Vector3<S>::Zero();
};

/// A frame that moves without rotating, its axes parallel to those of the other frame: a lift, a
/// shaker, a sledge. The type declares u = ou = 0, so scenes on it compute no term with u or ou.
///
///   const TranslatingFrame lift([](double t) {
///     return Translation<>{{0, 0, 1 - std::cos(t)}, {0, 0, std::sin(t)}, {0, 0, std::cos(t)}};
///   });
///
/// `Path` is a function of time that returns a Translation, on I's axes.
///
/// Error  : the error of the path, whose velocity and acceleration are taken as given
template <class Path, class G = Guide, class I = Inertial, class S = double>
class TranslatingFrame {
 public:
  static constexpr bool never_turns = true;

  explicit TranslatingFrame(Path path) : path_(std::move(path)) {}

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const {
    const Translation<S> now = path_(t);
    FrameMotion<G, I, S> motion;
    motion.X.value.translation = now.position;
    motion.V.value.moment = now.velocity;
    motion.dV.value.moment = now.acceleration;
    return motion;
  }

 private:
  Path path_;
};

}  // namespace kreisel
