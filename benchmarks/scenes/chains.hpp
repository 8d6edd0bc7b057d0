#pragma once

#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include <dynamics/tree/description.hpp>

#include "peer.hpp"

/// The chains as bodies of BodySystem.
namespace scenes {

inline kreisel::Vector3<double> vector(const Triple& v) { return {v[0], v[1], v[2]}; }

inline std::vector<kreisel::BodyDescription> described(const Chain& chain) {
  std::vector<kreisel::BodyDescription> bodies;
  for (const Link& link : chain.links) {
    kreisel::BodyDescription body;
    body.name = std::to_string(bodies.size());
    if (!bodies.empty()) body.parent = bodies.back().name;
    body.joint = {.kind = kreisel::JointKind::revolute,
                  .axis = vector(link.axis),
                  .position = vector(link.position)};
    body.inertia = kreisel::InertiaTensor<kreisel::Body>::about_centre(
        link.mass, vector(link.centre), vector(link.moments).asDiagonal().toDenseMatrix());
    bodies.push_back(body);
  }
  return bodies;
}

/// Unequal bodies, so that zeros and equal numbers save nothing.
inline Chain random_chain(std::size_t n) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto triple = [&] {
    Triple v;
    for (double& x : v) x = uniform(random);
    return v;
  };
  Chain chain;
  chain.gravity = {0.5, -1, -9.75};
  for (std::size_t i = 0; i < n; ++i) {
    Link link{triple(), triple(), 1.25, triple(), {0.1, 0.12, 0.15}};
    const double length = vector(link.axis).norm();
    for (double& x : link.axis) x /= length;
    for (double& x : link.centre) x *= 0.25;
    chain.links.push_back(link);
  }
  return chain;
}

}  // namespace scenes
