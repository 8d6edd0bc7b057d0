#pragma once

#include <motor/motor.hpp>

namespace kreisel {

/// A motor tensor: a linear map of motors to motors, 36 numbers in four 3x3 blocks.
///
///   (T A).resultant = rr a + rm a0,   (T A).moment = mr a + mm a0     for A = (a; a0)
///
/// Source : paper 002 section 2 and (10), "Motortensor", "Motordyade"; the paper's matrix (10) is
///          [rm rr; mm mr], because it acts on (moment; resultant) and gives {momentum; moment}
/// Frame  : untagged; the argument and the value are reduced at the same point, on the same axes
/// Units  : [rm] = [rr] / metre,  [mm] = [rr],  [mr] = [rr] * metre
template <class S = double>
struct MotorTensor {
  Matrix3<S> rr = Matrix3<S>::Zero();
  Matrix3<S> rm = Matrix3<S>::Zero();
  Matrix3<S> mr = Matrix3<S>::Zero();
  Matrix3<S> mm = Matrix3<S>::Zero();

  using Scalar = S;

  [[nodiscard]] static MotorTensor identity() {
    return {Matrix3<S>::Identity(), Matrix3<S>::Zero(), Matrix3<S>::Zero(), Matrix3<S>::Identity()};
  }

  /// T A. Cost: 66 flops.
  friend Motor<S> operator*(const MotorTensor& T, const Motor<S>& a) {
    return {T.rr * a.resultant + T.rm * a.moment, T.mr * a.resultant + T.mm * a.moment};
  }

  friend MotorTensor operator+(const MotorTensor& a, const MotorTensor& b) {
    return {a.rr + b.rr, a.rm + b.rm, a.mr + b.mr, a.mm + b.mm};
  }
  friend MotorTensor operator-(const MotorTensor& a, const MotorTensor& b) {
    return {a.rr - b.rr, a.rm - b.rm, a.mr - b.mr, a.mm - b.mm};
  }
  friend MotorTensor operator*(const S& s, const MotorTensor& a) {
    return {s * a.rr, s * a.rm, s * a.mr, s * a.mm};
  }
};

/// The transposed tensor T^t:  reciprocal(A, T B) = reciprocal(T^t A, B)  for all A and B.
///
/// The reciprocal product is the natural product of motors, so this is not the transposed 6x6
/// matrix: the blocks rr and mm are exchanged. Inertia tensors are symmetric in this sense.
template <class S>
[[nodiscard]] MotorTensor<S> transpose(const MotorTensor<S>& T) {
  return {T.mm.transpose(), T.rm.transpose(), T.mr.transpose(), T.rr.transpose()};
}

/// The tensor of rank one  X -> a reciprocal(b, X).
///
/// Source : von Mises 1924, "Motordyade"
template <class S>
[[nodiscard]] MotorTensor<S> dyad(const Motor<S>& a, const Motor<S>& b) {
  return {a.resultant * b.moment.transpose(), a.resultant * b.resultant.transpose(),
          a.moment * b.moment.transpose(), a.moment * b.resultant.transpose()};
}

/// The product [V T]:  [V T] X = [V (T X)]  for every motor X.
///
/// Source : paper 002 section 2, footnote on products of motor and motor tensor
template <class S>
[[nodiscard]] MotorTensor<S> cross(const Motor<S>& V, const MotorTensor<S>& T) {
  const Matrix3<S> r = skew(V.resultant);
  const Matrix3<S> m = skew(V.moment);
  return {r * T.rr, r * T.rm, r * T.mr + m * T.rr, r * T.mm + m * T.rm};
}

/// The product [T V]:  [T V] X = T [V X]  for every motor X.
///
/// Source : paper 002 section 2, footnote on products of motor and motor tensor
template <class S>
[[nodiscard]] MotorTensor<S> cross(const MotorTensor<S>& T, const Motor<S>& V) {
  const Matrix3<S> r = skew(V.resultant);
  const Matrix3<S> m = skew(V.moment);
  return {T.rr * r + T.rm * m, T.rm * r, T.mr * r + T.mm * m, T.mm * r};
}

}  // namespace kreisel
