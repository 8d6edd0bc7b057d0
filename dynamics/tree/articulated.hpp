#pragma once

#include <dynamics/inertia.hpp>

namespace kreisel::detail {

/// The articulated inertia of a link: a symmetric motor tensor of 21 numbers that maps
/// accelerations to forces. Because of the free joints outward of the link, its mass depends on the
/// direction.
///
///   (dw; a) -> {linear a + mixed^t dw;  mixed a + angular dw}
struct ArticulatedInertia {
  Symmetric3<> linear = {};
  Matrix3<double> mixed = Matrix3<double>::Zero();
  Symmetric3<> angular = {};
};

[[nodiscard]] inline double trace(const Symmetric3<>& m) { return m.xx + m.yy + m.zz; }

/// Adds the inertia of a rigid body.
inline void add(ArticulatedInertia& A, const Inertia<>& T) {
  const Vector3<double>& s = T.first_moment;
  A.linear.xx += T.mass;
  A.linear.yy += T.mass;
  A.linear.zz += T.mass;
  A.mixed(0, 1) -= s.z();
  A.mixed(0, 2) += s.y();
  A.mixed(1, 0) += s.z();
  A.mixed(1, 2) -= s.x();
  A.mixed(2, 0) -= s.y();
  A.mixed(2, 1) += s.x();
  A.angular = A.angular + T.tensor;
}

/// Adds B, reduced at the origin of A. The vector r leads from this origin to the origin of B:
///
///   linear B,  mixed' = mixed + [r linear],  angular + [r mixed'^t] + [r mixed^t]^t.
inline void add_shifted(ArticulatedInertia& A, const Vector3<double>& r,
                        const ArticulatedInertia& B) {
  const Symmetric3<>& L = B.linear;
  const Matrix3<double>& H = B.mixed;
  const double x = r.x();
  const double y = r.y();
  const double z = r.z();
  Matrix3<double> G;  // mixed'
  G(0, 0) = H(0, 0) + (y * L.xz - z * L.xy);
  G(0, 1) = H(0, 1) + (y * L.yz - z * L.yy);
  G(0, 2) = H(0, 2) + (y * L.zz - z * L.yz);
  G(1, 0) = H(1, 0) + (z * L.xx - x * L.xz);
  G(1, 1) = H(1, 1) + (z * L.xy - x * L.yz);
  G(1, 2) = H(1, 2) + (z * L.xz - x * L.zz);
  G(2, 0) = H(2, 0) + (x * L.xy - y * L.xx);
  G(2, 1) = H(2, 1) + (x * L.yy - y * L.xy);
  G(2, 2) = H(2, 2) + (x * L.yz - y * L.xz);
  A.linear = A.linear + L;
  for (int k = 0; k < 9; ++k) A.mixed(k) += G(k);
  // Row i of [r G^t] is row i of r x (rows of G).
  A.angular.xx += B.angular.xx + (y * G(0, 2) - z * G(0, 1)) + (y * H(0, 2) - z * H(0, 1));
  A.angular.yy += B.angular.yy + (z * G(1, 0) - x * G(1, 2)) + (z * H(1, 0) - x * H(1, 2));
  A.angular.zz += B.angular.zz + (x * G(2, 1) - y * G(2, 0)) + (x * H(2, 1) - y * H(2, 0));
  A.angular.xy += B.angular.xy + (y * G(1, 2) - z * G(1, 1)) + (z * H(0, 0) - x * H(0, 2));
  A.angular.xz += B.angular.xz + (y * G(2, 2) - z * G(2, 1)) + (x * H(0, 1) - y * H(0, 0));
  A.angular.yz += B.angular.yz + (z * G(2, 0) - x * G(2, 2)) + (x * H(1, 1) - y * H(1, 0));
}

/// A -= U U^t k, for a force motor U.
inline void take_square(ArticulatedInertia& A, const Motor<>& U, double k) {
  A.linear = A.linear - square(U.resultant, k);
  A.angular = A.angular - square(U.moment, k);
  const Vector3<double> n = k * U.moment;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) A.mixed(r, c) -= n[r] * U.resultant[c];
  }
}

}  // namespace kreisel::detail
