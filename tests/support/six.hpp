#pragma once

#include <Eigen/Core>

#include <motor/displacement.hpp>
#include <motor/motor.hpp>
#include <motor/tensor.hpp>

/// Motors and their maps as columns and matrices of six, resultant first, as references for the
/// structured ones. Written entry by entry, with only the types of the library.

namespace kreisel::test {

template <class S>
using Vector6 = Eigen::Matrix<S, 6, 1>;

template <class S>
using Matrix6 = Eigen::Matrix<S, 6, 6>;

template <class S>
[[nodiscard]] Vector6<S> six(const Motor<S>& a) {
  Vector6<S> column;
  column << a.resultant, a.moment;
  return column;
}

template <class S>
[[nodiscard]] Matrix6<S> six(const MotorTensor<S>& T) {
  Matrix6<S> matrix;
  matrix << T.rr, T.rm, T.mr, T.mm;
  return matrix;
}

/// The matrix of  b -> a x b.
template <class S>
[[nodiscard]] Matrix3<S> vector_product_matrix(const Vector3<S>& a) {
  Matrix3<S> matrix = Matrix3<S>::Zero();
  matrix(1, 0) = a[2];
  matrix(0, 1) = -a[2];
  matrix(2, 1) = a[0];
  matrix(1, 2) = -a[0];
  matrix(0, 2) = a[1];
  matrix(2, 0) = -a[1];
  return matrix;
}

/// The matrix of  B -> [A B].
template <class S>
[[nodiscard]] Matrix6<S> product_matrix(const Motor<S>& a) {
  Matrix6<S> matrix;
  matrix << vector_product_matrix(a.resultant), Matrix3<S>::Zero(), vector_product_matrix(a.moment),
      vector_product_matrix(a.resultant);
  return matrix;
}

/// The matrix of  A -> X A.
template <class S>
[[nodiscard]] Matrix6<S> displacement_matrix(const Pose<S>& X) {
  Matrix6<S> matrix;
  matrix << X.rotation, Matrix3<S>::Zero(), vector_product_matrix(X.translation) * X.rotation,
      X.rotation;
  return matrix;
}

}  // namespace kreisel::test
