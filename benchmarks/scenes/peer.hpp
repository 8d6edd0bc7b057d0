#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

/// The common interface of all libraries. It contains no type of any library and none of ours, so
/// that their headers never meet.
namespace scenes {

using Triple = std::array<double, 3>;

/// A body with a revolute joint in its origin that connects it to the body before; at angle 0 all
/// are on the parent's axes.
struct Link {
  Triple axis;      ///< of length 1
  Triple position;  ///< of the joint, from the parent's origin
  double mass;
  Triple centre;   ///< of mass, from the body's origin
  Triple moments;  ///< of inertia about the centre of mass, along the body's axes
};

/// A chain of such bodies on a base that rests or turns at a constant rate about its origin.
struct Chain {
  std::vector<Link> links;
  Triple gravity = {};
  Triple turning = {};  ///< angular velocity of the base, on its axes

  [[nodiscard]] bool moves() const { return turning != Triple{}; }
};

class Peer {
 public:
  Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  virtual ~Peer() = default;

  virtual void forward(const double* q, const double* v, double* dv) = 0;
  virtual void inverse(const double* q, const double* v, const double* dv, double* force) = 0;
};

struct Library {
  std::string name;
  std::string version;
  std::string forward;
  std::string inverse;
  std::string moving_base;
  std::unique_ptr<Peer> (*make)(const Chain&);  ///< throws where the library cannot
};

[[gnu::visibility("default")]] Library dart();
[[gnu::visibility("default")]] Library kdl();
[[gnu::visibility("default")]] Library mujoco();
[[gnu::visibility("default")]] Library simbody();

/// The joint of a turning base in libraries whose trees start from a body at rest, with a body of
/// arbitrary inertia.
struct BaseJoint {
  Link link;
  double rate;
};

inline BaseJoint base_joint(const Chain& chain) {
  const auto& [x, y, z] = chain.turning;
  const double rate = std::hypot(x, y, z);
  return {{{x / rate, y / rate, z / rate}, {}, 1, {}, {1, 1, 1}}, rate};
}

}  // namespace scenes
