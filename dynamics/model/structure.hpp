#pragma once

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>

#include <dynamics/inertia.hpp>
#include <dynamics/load/load.hpp>
#include <motor/error.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

// Quantities of a body and its guide whose components may vanish by structure.

/// Mass times centre of mass, on body axes from O'.
struct FirstMoment {
  static constexpr const char* name = "FirstMoment";
};
/// Products of inertia: about O' of a FixedPointBody, about the centre of mass of a FreeBody.
struct ProductsOfInertia {
  static constexpr const char* name = "ProductsOfInertia";
};
/// Angular velocity u of the guide, on guide axes.
struct GuideRate {
  static constexpr const char* name = "GuideRate";
};
/// g' = g - a of a point that rests in the guide at O', on guide axes.
struct ApparentGravity {
  static constexpr const char* name = "ApparentGravity";
};

/// The centrifugal force m u x (u x r) of a FreeBody at r on a rotating guide. It does not vanish,
/// and Without<> of it is not checked against numbers: prune() reports its effect.
struct CentrifugalForce {
  static constexpr const char* name = "CentrifugalForce";
};

/// Quantities that only prune() may leave out. GuideUnsteadiness is the variation of the guide's u
/// and acceleration about their means. For a Cardan gyro: A_1 - B_1 and both rings' moments of
/// inertia. The last: all loads of the type L.
struct GuideUnsteadiness {
  static constexpr const char* name = "GuideUnsteadiness";
};
struct RotorAsymmetry {
  static constexpr const char* name = "RotorAsymmetry";
};
struct RingInertia {
  static constexpr const char* name = "RingInertia";
};
template <class L>
struct LoadOf {
  static constexpr const char* name = L::kind;
};

enum class Axis { x, y, z };

/// Declares in a scene's type that a quantity's components about these axes vanish (without axes:
/// the whole quantity). Terms multiplied by them are then not compiled.
///
///   FixedPointBody(T, point, guide, gravity, Without<FirstMoment, Axis::x, Axis::y>{},
///            Without<ProductsOfInertia>{})
///
/// Without<> is passed among the loads, as a load without a force. The constructor of the scene
/// checks it against the scene's numbers. GuideRate and ApparentGravity can be checked only on a
/// guide in steady motion.
template <class Quantity, Axis... axes>
struct Without {
  static constexpr bool ignores_spin = true;

  template <class N>
  [[nodiscard]] Force<Body, N> operator()(const LoadContext<N>& /*s*/) const {
    return {};
  }
};

namespace detail {

template <class Part, class Quantity, Axis axis>
inline constexpr bool says_without = false;
template <class Quantity, Axis... axes, Axis axis>
inline constexpr bool says_without<Without<Quantity, axes...>, Quantity, axis> =
    sizeof...(axes) == 0 || ((axes == axis) || ...);

/// True if one of the scene's parts declares that a component vanishes.
template <class Quantity, Axis axis, class... Parts>
inline constexpr bool vanishes = (says_without<Parts, Quantity, axis> || ...);

template <class Quantity, class N, class... Parts>
using Kept = Components<std::conditional_t<vanishes<Quantity, Axis::x, Parts...>, StaticZero, N>,
                        std::conditional_t<vanishes<Quantity, Axis::y, Parts...>, StaticZero, N>,
                        std::conditional_t<vanishes<Quantity, Axis::z, Parts...>, StaticZero, N>>;

/// The type of a number, or StaticZero.
template <class T, class N>
[[nodiscard]] T kept(const N& x) {
  if constexpr (is_static_zero<T>) {
    return {};
  } else {
    return T(x);
  }
}

/// The vector without the components that vanish.
template <class Quantity, class... Parts, class X, class Y, class Z>
[[nodiscard]] auto without(const Components<X, Y, Z>& v) {
  using P = std::conditional_t<vanishes<Quantity, Axis::x, Parts...>, StaticZero, X>;
  using Q = std::conditional_t<vanishes<Quantity, Axis::y, Parts...>, StaticZero, Y>;
  using R = std::conditional_t<vanishes<Quantity, Axis::z, Parts...>, StaticZero, Z>;
  return Components<P, Q, R>{kept<P>(v.x), kept<Q>(v.y), kept<R>(v.z)};
}

/// Throws : InvalidInput if a component that Without<> declares zero is not zero
template <class Quantity, class... Parts>
void check_vanishing(const Vector3<double>& v, const std::string& what) {
  const auto held = [&what](bool vanishing, double x, const char* axis) {
    if (vanishing && x != 0) {
      std::ostringstream text;
      text << what << ": Without<" << Quantity::name << "> was given, but the component " << axis
           << " = " << x << " is not 0";
      throw InvalidInput(text.str());
    }
  };
  held(vanishes<Quantity, Axis::x, Parts...>, v.x(), "x");
  held(vanishes<Quantity, Axis::y, Parts...>, v.y(), "y");
  held(vanishes<Quantity, Axis::z, Parts...>, v.z(), "z");
}

/// The reason why components of a quantity are not computed; empty if no part declares them zero.
template <class Quantity, class... Parts>
[[nodiscard]] std::string reason_for() {
  constexpr bool x = vanishes<Quantity, Axis::x, Parts...>;
  constexpr bool y = vanishes<Quantity, Axis::y, Parts...>;
  constexpr bool z = vanishes<Quantity, Axis::z, Parts...>;
  std::string text;
  if (!(x || y || z)) return text;
  if (!(x && y && z)) {
    text += "without";
    if (x) text += " x";
    if (y) text += " y";
    if (z) text += " z";
    text += ", ";
  }
  text += "declared by Without<";
  text += Quantity::name;
  text += '>';
  return text;
}

/// A tensor of inertia on principal axes:  Theta = diag(A, B, C); P is double or a pack.
template <class P = double>
class PrincipalTensor {
 public:
  explicit PrincipalTensor(const Symmetric3<P>& T)
      : moments_{T.xx, T.yy, T.zz}, differences_{T.yy - T.zz, T.zz - T.xx, T.xx - T.yy} {}

  /// -w x (Theta w). The differences of moments are formed first. They are exact where two moments
  /// agree, so a symmetric body keeps its spin to the last bit.
  template <class N>
  [[nodiscard]] Components<N> gyroscopic_torque(const Components<N>& w) const {
    return {N(differences_.x * (w.y * w.z)), N(differences_.y * (w.z * w.x)),
            N(differences_.z * (w.x * w.y))};
  }

  [[nodiscard]] Symmetric3<P> tensor() const { return {moments_.x, moments_.y, moments_.z}; }

  /// Theta^-1 M. By division, because a rounded inverse would always have its error to the same
  /// side.
  template <class N>
  [[nodiscard]] Components<N> solve(const Components<N>& M) const {
    return {N(M.x / moments_.x), N(M.y / moments_.y), N(M.z / moments_.z)};
  }

 private:
  Components<P> moments_;
  Components<P> differences_;
};

/// A tensor of inertia on arbitrary axes, with its factors  Theta = L D L^t.
class GeneralTensor {
 public:
  explicit GeneralTensor(const Symmetric3<double>& T)
      : tensor_(T),
        d_x_(T.xx),
        l_xy_(T.xy / d_x_),
        l_xz_(T.xz / d_x_),
        d_y_(T.yy - l_xy_ * T.xy),
        l_yz_((T.yz - l_xy_ * T.xz) / d_y_),
        d_z_(T.zz - l_xz_ * T.xz - l_yz_ * l_yz_ * d_y_) {}

  [[nodiscard]] Symmetric3<double> tensor() const { return tensor_; }

  /// -w x (Theta w)
  template <class N>
  [[nodiscard]] Components<N> gyroscopic_torque(const Components<N>& w) const {
    const Components<N> L{N(tensor_.xx * w.x + tensor_.xy * w.y + tensor_.xz * w.z),
                          N(tensor_.xy * w.x + tensor_.yy * w.y + tensor_.yz * w.z),
                          N(tensor_.xz * w.x + tensor_.yz * w.y + tensor_.zz * w.z)};
    return cross(L, w);
  }

  /// Theta^-1 M. A positive definite matrix needs no pivoting.
  template <class N>
  [[nodiscard]] Components<N> solve(const Components<N>& M) const {
    const N y = M.y - l_xy_ * M.x;
    const N z = M.z - l_xz_ * M.x - l_yz_ * y;
    const N c = z / d_z_;
    const N b = y / d_y_ - l_yz_ * c;
    const N a = M.x / d_x_ - l_xy_ * b - l_xz_ * c;
    return {a, b, c};
  }

  /// True if rounding of the tensor is amplified 1e4 times in the rates about some axis.
  [[nodiscard]] bool is_nearly_singular() const {
    const auto [least, greatest] = std::minmax({d_x_, d_y_, d_z_});
    return least < 1e-4 * greatest;
  }

  /// The tensor with its entries moved by two units in the last place: one for the entries, one for
  /// their factors.
  [[nodiscard]] GeneralTensor perturbed_by_ulps() const {
    const Symmetric3<double>& T = tensor_;
    constexpr double up = 1 + 2 * std::numeric_limits<double>::epsilon();
    constexpr double down = 1 - 2 * std::numeric_limits<double>::epsilon();
    return GeneralTensor({up * T.xx, down * T.yy, up * T.zz, down * T.xy, up * T.xz, down * T.yz});
  }

 private:
  Symmetric3<double> tensor_;
  double d_x_, l_xy_, l_xz_, d_y_, l_yz_, d_z_;
};

template <class... Parts>
inline constexpr bool principal = (std::is_same_v<Parts, Without<ProductsOfInertia>> || ...);

template <class... Parts>
using TensorOf = std::conditional_t<principal<Parts...>, PrincipalTensor<>, GeneralTensor>;

/// The tensor in the form that the scene's parts ask for.
///
/// Throws : InvalidInput if Without<ProductsOfInertia> is given and a product of inertia is not 0
template <class... Parts>
[[nodiscard]] TensorOf<Parts...> tensor_of(const Symmetric3<double>& T, const std::string& what) {
  if (principal<Parts...> && !(T.xy == 0 && T.xz == 0 && T.yz == 0)) {
    std::ostringstream text;
    text << what
         << ": Without<ProductsOfInertia> was given, but xy, xz, yz of the tensor = " << T.xy
         << ", " << T.xz << ", " << T.yz << " kg m^2 are not 0";
    throw InvalidInput(text.str());
  }
  return TensorOf<Parts...>(T);
}

}  // namespace detail

}  // namespace kreisel
