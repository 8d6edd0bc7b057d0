// Orocos KDL. Its twists are (velocity; angular velocity), its wrenches (force; torque).

#include <kdl/frames.hpp>
#include <kdl/rigidbodyinertia.hpp>

#include "contender.hpp"

namespace kernels {

namespace {

KDL::Vector vector(const double* v) { return {v[0], v[1], v[2]}; }

KDL::Twist twist(const std::array<double, 6>& a) {
  return {vector(a.data() + 3), vector(a.data())};
}

KDL::Frame frame(const std::array<double, 12>& X) {
  return {KDL::Rotation(vector(X.data()), vector(X.data() + 3), vector(X.data() + 6)),
          vector(X.data() + 9)};
}

std::vector<double> of_twist(const KDL::Twist& t) {
  return {t.rot[0], t.rot[1], t.rot[2], t.vel[0], t.vel[1], t.vel[2]};
}

std::vector<double> of_wrench(const KDL::Wrench& w) {
  return {w.force[0], w.force[1], w.force[2], w.torque[0], w.torque[1], w.torque[2]};
}

std::vector<double> of_frame(const KDL::Frame& X) {
  std::vector<double> result;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) result.push_back(X.M(row, column));
  }
  for (int row = 0; row < 3; ++row) result.push_back(X.p[row]);
  return result;
}

std::vector<double> of_inertia(const KDL::RigidBodyInertia& T) {
  const KDL::Vector s = T.getMass() * T.getCOG();
  const KDL::RotationalInertia tensor = T.getRotationalInertia();
  const double* I = tensor.data;
  return {T.getMass(), s[0], s[1], s[2], I[0], I[4], I[8], I[1], I[2], I[5]};
}

struct Forms {
  KDL::Twist a, b;
  KDL::Frame X, Y;
  KDL::RigidBodyInertia T;
};

Forms forms(const Numbers& n) {
  const auto& [xx, yy, zz, xy, xz, yz] = n.tensor_about_centre;
  return {twist(n.a), twist(n.b), frame(n.pose), frame(n.other),
          KDL::RigidBodyInertia(n.mass, vector(n.centre.data()),
                                KDL::RotationalInertia(xx, yy, zz, xy, xz, yz))};
}

}  // namespace

std::vector<Contender> kdl(const All& numbers) {
  const auto all = each(numbers, forms);
  const auto work = [&all](const char* operation, auto flat, auto operate) {
    return contender(operation, "KDL", all, operate, flat);
  };
  return {
      work("motor product", of_twist, [](const Forms& n) { return n.a * n.b; }),
      work("inertia times motor", of_wrench, [](const Forms& n) { return n.T * n.a; }),
      work("displace a motor", of_twist, [](const Forms& n) { return n.X * n.a; }),
      work("displace an inertia", of_inertia, [](const Forms& n) { return n.X * n.T; }),
      work("compose displacements", of_frame, [](const Forms& n) { return n.X * n.Y; }),
      work("momentum bias", of_wrench, [](const Forms& n) { return n.a * (n.T * n.a); }),
      work("Newton-Euler residual", of_wrench,
           [](const Forms& n) { return n.T * n.b + n.a * (n.T * n.a); }),
  };
}

}  // namespace kernels
