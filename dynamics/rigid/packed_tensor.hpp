#pragma once

#include <dynamics/model/structure.hpp>
#include <motor/simd.hpp>
#include <motor/static_zero.hpp>

namespace kreisel::detail {

/// The differences of a tensor's entries that appear in gyroscopic torques.
class GyroscopicDifferences {
 public:
  explicit GyroscopicDifferences(const Symmetric3<double>& T)
      : differences_(T.yy - T.zz, T.zz - T.xx, T.xx - T.yy, 0),
        opposite_(T.yz, T.xz, T.xy, 0),
        beside_(T.xy, T.yz, T.xz, 0) {}

  /// -w x (Theta w), from the products (w_y w_z, w_z w_x, w_x w_y) and the squares of w.
  [[nodiscard]] Vec4d torque(const Vec4d& mixed, const Vec4d& squares) const {
    return differences_ * mixed + opposite_ * (squares.after() - squares.next()) +
           (beside_ * mixed.next() - beside_.after() * mixed.after());
  }

 private:
  Vec4d differences_, opposite_, beside_;
};

/// PrincipalTensor or GeneralTensor for vectors stored as Vec4d, with w = 0.
template <class Tensor>
class PackedTensor;

template <>
class PackedTensor<PrincipalTensor<>> {
 public:
  explicit PackedTensor(const PrincipalTensor<>& tensor) {
    const Symmetric3<double> T = tensor.tensor();
    moments_ = {T.xx, T.yy, T.zz, 1};
    differences_ = {T.yy - T.zz, T.zz - T.xx, T.xx - T.yy, 0};
  }

  /// -w x (Theta w), as GyroscopicDifferences.
  [[nodiscard]] Vec4d gyroscopic_torque(const Vec4d& mixed, const Vec4d& /*squares*/) const {
    return differences_ * mixed;
  }

  /// Theta^-1 M
  [[nodiscard]] Vec4d solve(const Vec4d& M) const { return M / moments_; }

  /// The moments of a body of revolution about z.
  [[nodiscard]] double across() const { return moments_[0]; }
  [[nodiscard]] double along() const { return moments_[2]; }

 private:
  Vec4d moments_, differences_;
};

template <>
class PackedTensor<GeneralTensor> {
 public:
  explicit PackedTensor(const GeneralTensor& tensor)
      : tensor_(tensor), differences_(tensor.tensor()) {}

  [[nodiscard]] Vec4d gyroscopic_torque(const Vec4d& mixed, const Vec4d& squares) const {
    return differences_.torque(mixed, squares);
  }

  [[nodiscard]] Vec4d solve(const Vec4d& M) const {
    const Components<double> w = tensor_.solve(Components<double>{M[0], M[1], M[2]});
    return {w.x, w.y, w.z, 0};
  }

 private:
  GeneralTensor tensor_;
  GyroscopicDifferences differences_;
};

}  // namespace kreisel::detail
