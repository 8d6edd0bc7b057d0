#pragma once

#include <Eigen/Geometry>

#include <cstddef>
#include <string>
#include <vector>

#include <dynamics/tree/body_system.hpp>

#include <support/json.hpp>

/// The systems of tests/data/rotors.json: models with rotors in exact decimals, and the results of
/// plain Newton-Euler in 66 digits.

namespace kreisel::test {

[[nodiscard]] inline Eigen::VectorXd numbers(const Json& json) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(json.size()));
  for (std::size_t i = 0; i < json.size(); ++i) v[Eigen::Index(i)] = number(json[i]);
  return v;
}

[[nodiscard]] inline Eigen::MatrixXd rows(const Json& json) {
  Eigen::MatrixXd m(Eigen::Index(json.size()), Eigen::Index(json.at(0).size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i) m.row(i) = numbers(json[std::size_t(i)]).transpose();
  return m;
}

[[nodiscard]] inline const Json& rotors_reference() {
  static const Json json = reference_file("rotors.json");
  return json;
}

/// The root's joint in a model; none if there is no root.
enum class Root { none, fixed, ball, free };

[[nodiscard]] inline InertiaTensor<Body> model_inertia(const Json& body) {
  return InertiaTensor<Body>::about_centre(number(body["m"]), numbers(body["c"]), rows(body["I"]));
}

/// A model, its rotors all in one mode, or as ordinary bodies.
[[nodiscard]] inline std::vector<BodyDescription> model_bodies(const std::string& name, Root root,
                                                               const Json& springs,
                                                               std::optional<RotorMode> mode) {
  const Json& model = rotors_reference()["models"][name];
  std::vector<BodyDescription> bodies;
  if (root != Root::none) {
    BodyDescription b;
    b.name = "root";
    b.joint.kind = root == Root::fixed  ? JointKind::fixed
                   : root == Root::ball ? JointKind::spherical
                                        : JointKind::free;
    b.inertia = model_inertia(model["root"]);
    bodies.push_back(b);
  }
  const std::string base = root == Root::none ? "guide" : "root";
  for (const Json& body : model["bodies"]) {
    BodyDescription b;
    b.name = body["name"].get<std::string>();
    const int parent = body["parent"].get<int>();
    b.parent = parent < 0
                   ? base
                   : model["bodies"][static_cast<std::size_t>(parent)]["name"].get<std::string>();
    b.joint = {
        .kind = JointKind::revolute, .axis = numbers(body["axis"]), .position = numbers(body["r"])};
    b.inertia = model_inertia(body);
    if (body["rotor"].get<bool>() && mode) b.rotor = Rotor{.mode = *mode};
    if (springs.contains(b.name)) {
      const Json& s = springs[b.name];
      b.forces = {
          {.stiffness = number(s["k"]), .damping = number(s["d"]), .constant = number(s["Q0"])}};
    }
    bodies.push_back(b);
  }
  return bodies;
}

}  // namespace kreisel::test
