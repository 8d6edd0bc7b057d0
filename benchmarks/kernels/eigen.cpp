// Matrices of six rows and columns, as without a type for motors; and rotations as quaternions.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <vector>

#include "contender.hpp"

namespace kernels {

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Vector6 vector(const std::array<double, 6>& a) { return Vector6(a.data()); }

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d() << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// The 6x6 matrices of the motor product and of a displacement.
Matrix6 matrix(const Eigen::Matrix3d& diagonal, const Eigen::Matrix3d& below) {
  return (Matrix6() << diagonal, Eigen::Matrix3d::Zero(), below, diagonal).finished();
}

Matrix6 displacement(const std::array<double, 12>& X) {
  const Eigen::Matrix3d R(X.data());
  return matrix(R, skew(Eigen::Vector3d(X.data() + 9)) * R);
}

Matrix6 inertia(const Numbers& n) {
  const auto& [m, x, y, z, xx, yy, zz, xy, xz, yz] = n.inertia;
  const Eigen::Matrix3d s = skew({x, y, z});
  const Eigen::Matrix3d T = (Eigen::Matrix3d() << xx, xy, xz, xy, yy, yz, xz, yz, zz).finished();
  return (Matrix6() << -s, m * Eigen::Matrix3d::Identity(), T, s).finished();
}

std::vector<double> of_vector(const Vector6& a) { return {a.begin(), a.end()}; }

std::vector<double> of_displacement(const Matrix6& X) {
  const Eigen::Matrix3d R = X.topLeftCorner<3, 3>();
  const Eigen::Matrix3d x = X.bottomLeftCorner<3, 3>() * R.transpose();
  std::vector<double> result(R.data(), R.data() + 9);
  for (const double translation : {x(2, 1), x(0, 2), x(1, 0)}) result.push_back(translation);
  return result;
}

std::vector<double> of_inertia(const Matrix6& T) {
  return {T(0, 3), T(5, 4), T(3, 5), T(4, 3), T(3, 0), T(4, 1), T(5, 2), T(3, 1), T(3, 2), T(4, 2)};
}

struct Forms {
  Vector6 a, b;
  Matrix6 X, Y, inverse, T;
  Eigen::Quaterniond turn;
  Eigen::Vector3d shift;
};

Forms forms(const Numbers& n) {
  const Matrix6 X = displacement(n.pose);
  return {vector(n.a),
          vector(n.b),
          X,
          displacement(n.other),
          X.inverse(),
          inertia(n),
          Eigen::Quaterniond(Eigen::Matrix3d(n.pose.data())),
          Eigen::Vector3d(n.pose.data() + 9)};
}

Matrix6 product(const Vector6& V) { return matrix(skew(V.head<3>()), skew(V.tail<3>())); }

}  // namespace

std::vector<Contender> eigen(const All& numbers) {
  const auto all = each(numbers, forms);
  const auto work = [&all](const char* operation, auto flat, auto operate) {
    return contender(operation, "Eigen, 6x6", all, operate, flat);
  };
  return {
      work("motor product", of_vector, [](const Forms& n) { return Vector6(product(n.a) * n.b); }),
      work("inertia times motor", of_vector, [](const Forms& n) { return Vector6(n.T * n.a); }),
      work("displace a motor", of_vector, [](const Forms& n) { return Vector6(n.X * n.a); }),
      contender(
          "displace a motor", "quaternion", all,
          [](const Forms& n) {
            Vector6 result;
            result.head<3>() = n.turn * Eigen::Vector3d(n.a.head<3>());
            result.tail<3>() = n.turn * Eigen::Vector3d(n.a.tail<3>()) +
                               n.shift.cross(Eigen::Vector3d(result.head<3>()));
            return result;
          },
          of_vector),
      work("displace an inertia", of_inertia,
           [](const Forms& n) { return Matrix6(n.X * n.T * n.inverse); }),
      work("compose displacements", of_displacement,
           [](const Forms& n) { return Matrix6(n.X * n.Y); }),
      work("momentum bias", of_vector,
           [](const Forms& n) { return Vector6(product(n.a) * (n.T * n.a)); }),
      work("Newton-Euler residual", of_vector,
           [](const Forms& n) { return Vector6(n.T * n.b + product(n.a) * (n.T * n.a)); }),
  };
}

}  // namespace kernels
