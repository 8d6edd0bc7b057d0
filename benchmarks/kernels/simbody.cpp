// Simbody. Its spatial vectors are (angular velocity; velocity) and (torque; force). It has no
// product of two of them, and moves inertias, not vectors, between frames.

#include <SimTKcommon.h>

#include "contender.hpp"

namespace kernels {

namespace {

SimTK::Vec3 vector(const double* v) { return {v[0], v[1], v[2]}; }

SimTK::SpatialVec motion(const std::array<double, 6>& a) {
  return {vector(a.data()), vector(a.data() + 3)};
}

SimTK::Transform transform(const std::array<double, 12>& X) {
  SimTK::Mat33 R;
  for (int column = 0; column < 3; ++column) R(column) = vector(X.data() + 3 * column);
  return {SimTK::Rotation(R, true), vector(X.data() + 9)};
}

std::vector<double> of_momentum(const SimTK::SpatialVec& p) {
  return {p[1][0], p[1][1], p[1][2], p[0][0], p[0][1], p[0][2]};
}

std::vector<double> of_transform(const SimTK::Transform& X) {
  std::vector<double> result;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) result.push_back(X.R()[row][column]);
  }
  for (int row = 0; row < 3; ++row) result.push_back(X.p()[row]);
  return result;
}

std::vector<double> of_inertia(const SimTK::SpatialInertia& T) {
  const double m = T.getMass();
  const SimTK::Vec3 s = T.calcMassMoment();
  const SimTK::SymMat33& I = T.getUnitInertia().asSymMat33();
  return {m,           s[0],        s[1],        s[2],        m * I(0, 0),
          m * I(1, 1), m * I(2, 2), m * I(1, 0), m * I(2, 0), m * I(2, 1)};
}

struct Forms {
  SimTK::SpatialVec a;
  SimTK::Transform X, Y;
  SimTK::SpatialInertia T;
};

Forms forms(const Numbers& n) {
  const double m = n.mass;
  const auto& [mass, x, y, z, xx, yy, zz, xy, xz, yz] = n.inertia;
  return {
      motion(n.a), transform(n.pose), transform(n.other),
      SimTK::SpatialInertia(m, vector(n.centre.data()),
                            SimTK::UnitInertia(xx / m, yy / m, zz / m, xy / m, xz / m, yz / m))};
}

}  // namespace

std::vector<Contender> simbody(const All& numbers) {
  const auto all = each(numbers, forms);
  const auto work = [&all](const char* operation, auto flat, auto operate) {
    return contender(operation, "Simbody", all, operate, flat);
  };
  return {
      work("inertia times motor", of_momentum, [](const Forms& n) { return n.T * n.a; }),
      work("displace an inertia", of_inertia, [](const Forms& n) { return n.T.transform(~n.X); }),
      work("compose displacements", of_transform, [](const Forms& n) { return n.X * n.Y; }),
  };
}

}  // namespace kernels
