#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include <motor/api.hpp>
#include <motor/error.hpp>
#include <motor/frame.hpp>
#include <motor/rate.hpp>
#include <motor/tensor.hpp>

namespace kreisel {

/// A symmetric 3x3 matrix, six numbers.
template <class S = double>
struct Symmetric3 {
  S xx = S(0), yy = S(0), zz = S(0), xy = S(0), xz = S(0), yz = S(0);

  /// The symmetric part of a full matrix: the mean of both triangles.
  [[nodiscard]] static Symmetric3 from(const Matrix3<S>& m) {
    return {m(0, 0),
            m(1, 1),
            m(2, 2),
            (m(0, 1) + m(1, 0)) / S(2),
            (m(0, 2) + m(2, 0)) / S(2),
            (m(1, 2) + m(2, 1)) / S(2)};
  }

  [[nodiscard]] Matrix3<S> matrix() const {
    return (Matrix3<S>() << xx, xy, xz, xy, yy, yz, xz, yz, zz).finished();
  }

  /// R m R^t. Cost: 75 flops, since only the six different numbers are computed.
  [[nodiscard]] Symmetric3 rotated(const Matrix3<S>& R) const {
    using detail::component;
    const Vector3<S> x = *this * Vector3<S>(R(0, 0), R(0, 1), R(0, 2));
    const Vector3<S> y = *this * Vector3<S>(R(1, 0), R(1, 1), R(1, 2));
    const Vector3<S> z = *this * Vector3<S>(R(2, 0), R(2, 1), R(2, 2));
    return {component(R, 0, x), component(R, 1, y), component(R, 2, z),
            component(R, 1, x), component(R, 2, x), component(R, 2, y)};
  }

  friend Vector3<S> operator*(const Symmetric3& m, const Vector3<S>& v) {
    return {m.xx * v.x() + m.xy * v.y() + m.xz * v.z(), m.xy * v.x() + m.yy * v.y() + m.yz * v.z(),
            m.xz * v.x() + m.yz * v.y() + m.zz * v.z()};
  }
  friend Symmetric3 operator+(const Symmetric3& a, const Symmetric3& b) {
    return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
  }
  friend Symmetric3 operator*(const S& factor, const Symmetric3& a) {
    return {factor * a.xx, factor * a.yy, factor * a.zz,
            factor * a.xy, factor * a.xz, factor * a.yz};
  }
  friend Symmetric3 operator-(const Symmetric3& a, const Symmetric3& b) {
    return {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz};
  }
};

/// 2 (a . b) 1 - a b^t - b a^t: with b = a it is twice the inertia of a unit mass at a.
template <class S>
[[nodiscard]] Symmetric3<S> offset_product(const Vector3<S>& a, const Vector3<S>& b) {
  const S xx = a.x() * b.x();
  const S yy = a.y() * b.y();
  const S zz = a.z() * b.z();
  const S two(2);
  return {two * (yy + zz),
          two * (xx + zz),
          two * (xx + yy),
          -(a.x() * b.y() + a.y() * b.x()),
          -(a.x() * b.z() + a.z() * b.x()),
          -(a.y() * b.z() + a.z() * b.y())};
}

namespace detail {

/// k a a^t
[[nodiscard]] inline Symmetric3<> square(const Vector3<double>& a, double k) {
  const Vector3<double> b = k * a;
  return {a.x() * b.x(), a.y() * b.y(), a.z() * b.z(), a.x() * b.y(), a.x() * b.z(), a.y() * b.z()};
}

}  // namespace detail

/// The inertia of a rigid body as a motor tensor: ten numbers instead of 36.
///
///   T (u; v) = {m v + u x s; s x v + Theta u},   s = m r_s first moment, Theta about the origin
///
/// Source : paper 002 (10), with the paper's Phi the negative off-diagonals of Theta
/// Frame  : untagged; InertiaTensor puts axes and origin into the type
/// Units  : kg, kg m, kg m^2
template <class S = double>
struct Inertia {
  S mass = S(0);
  Vector3<S> first_moment = Vector3<S>::Zero();
  Symmetric3<S> tensor = {};

  using Scalar = S;

  /// The same tensor as 36 numbers.
  [[nodiscard]] MotorTensor<S> motor_tensor() const {
    const Matrix3<S> s = skew(first_moment);
    return {-s, mass * Matrix3<S>::Identity(), tensor.matrix(), s};
  }

  /// T V: the momentum of a velocity, or the force of an acceleration. Cost: 48 flops.
  [[gnu::always_inline]] friend Motor<S> operator*(const Inertia& T, const Motor<S>& V) {
    using detail::Read;
    Read<S> ux = V.resultant.x(), uy = V.resultant.y(), uz = V.resultant.z();
    Read<S> vx = V.moment.x(), vy = V.moment.y(), vz = V.moment.z();
    Read<S> m = T.mass, sx = T.first_moment.x(), sy = T.first_moment.y(), sz = T.first_moment.z();
    const Symmetric3<S>& t = T.tensor;
    Read<S> xx = t.xx, yy = t.yy, zz = t.zz, xy = t.xy, xz = t.xz, yz = t.yz;
    return {
        {m * vx + (uy * sz - uz * sy), m * vy + (uz * sx - ux * sz), m * vz + (ux * sy - uy * sx)},
        {sy * vz - sz * vy + xx * ux + xy * uy + xz * uz,
         sz * vx - sx * vz + xy * ux + yy * uy + yz * uz,
         sx * vy - sy * vx + xz * ux + yz * uy + zz * uz}};
  }

  /// The inertia of two rigidly joined bodies, both reduced at the same origin on the same axes.
  friend Inertia operator+(const Inertia& a, const Inertia& b) {
    using detail::operator+;
    return {a.mass + b.mass, a.first_moment + b.first_moment, a.tensor + b.tensor};
  }
  friend Inertia operator-(const Inertia& a, const Inertia& b) {
    using detail::operator-;
    return {a.mass - b.mass, a.first_moment - b.first_moment, a.tensor - b.tensor};
  }
  friend Inertia operator-(const Inertia& a) { return Inertia{} - a; }

  /// T rotated by R, then shifted by x: the origin of the old frame lies at x in the new one.
  ///
  /// Theta' = R Theta R^t + offset_product(R s, x) + m offset_product(x, x) / 2
  friend Inertia operator*(const Pose<S>& X, const Inertia& T) {
    using detail::operator+, detail::operator*;
    const Vector3<S> s = detail::product(X.rotation, T.first_moment);
    const Vector3<S>& x = X.translation;
    const S half = T.mass / S(2);
    return {T.mass, s + T.mass * x,
            T.tensor.rotated(X.rotation) + offset_product(x, Vector3<S>(s + half * x))};
  }
};

/// [V T] - [T V]: the rate of T seen by an observer against whom the body moves with V. The rate
/// has ten numbers too, and the rate of the mass is 0.
///
/// Source : paper 002 section 2, oT = [V' T] - [T V']
template <class S>
[[nodiscard]] Inertia<S> carried_rate(const Motor<S>& V, const Inertia<S>& T) {
  const Vector3<S>& u = V.resultant;
  const Matrix3<S> turning = skew(u) * T.tensor.matrix();
  return {S(0), u.cross(T.first_moment) + T.mass * V.moment,
          Symmetric3<S>::from(turning + turning.transpose()) +
              offset_product(T.first_moment, V.moment)};
}

namespace detail {

/// The factors L D L^t of a symmetric positive definite 3x3 matrix, ready to solve. Such matrices
/// need no pivoting. Eigen's factorisation takes longer to compile than a whole scene.
template <class S = double>
class FactoredSymmetric3 {
 public:
  FactoredSymmetric3() = default;

  explicit FactoredSymmetric3(const Symmetric3<S>& m) : yx_(m.xy / m.xx), zx_(m.xz / m.xx) {
    const S yy = m.yy - yx_ * m.xy;
    const S yz = m.yz - yx_ * m.xz;
    zy_ = yz / yy;
    pivots_ = {m.xx, yy, m.zz - zx_ * m.xz - zy_ * yz};
  }

  /// D. No pivot is smaller than the least eigenvalue. Pivots after one that is 0 are not numbers.
  [[nodiscard]] const Vector3<S>& pivots() const { return pivots_; }

  /// A vector x for which  x^t m x  is the k-th pivot.
  [[nodiscard]] Vector3<S> witness(int k) const {
    if (k == 0) return {S(1), S(0), S(0)};
    if (k == 1) return {-yx_, S(1), S(0)};
    return {yx_ * zy_ - zx_, -zy_, S(1)};
  }

  [[nodiscard]] Vector3<S> solve(const Vector3<S>& b) const {
    const S half = b.y() - yx_ * b.x();
    const S z = (b.z() - zx_ * b.x() - zy_ * half) / pivots_.z();
    const S y = half / pivots_.y() - zy_ * z;
    return {b.x() / pivots_.x() - yx_ * y - zx_ * z, y, z};
  }

 private:
  S yx_ = S(0);
  S zx_ = S(0);
  S zy_ = S(0);
  Vector3<S> pivots_ = {S(1), S(1), S(1)};
};

}  // namespace detail

/// An inertia factored to solve  T A = P  for A: the acceleration of a free body under a force.
///
/// Throws : ComputationFailed when T is singular (mass 0, point, needle); the message names the
///          missing quantity
/// Error  : angular half <= 8u |Theta| |M_S| / lambda^2, M_S the torque about the centre of mass,
///          lambda the least moment of inertia about it
template <class S = double>
class FactoredInertia {
 public:
  explicit FactoredInertia(const Inertia<S>& T) : mass_(T.mass) {
    if (!(T.mass > S(0))) throw ComputationFailed("Inertia: solve needs a mass above 0");
    centre_ = T.first_moment / T.mass;
    const Symmetric3<S>& t = T.tensor;
    factor_ = detail::FactoredSymmetric3<S>(
        t - offset_product(centre_, Vector3<S>(T.first_moment / S(2))));
    const S rounding = std::numeric_limits<S>::epsilon() * (t.xx + t.yy + t.zz);
    for (int k = 0; k < 3; ++k) {
      if (factor_.pivots()[k] > rounding) continue;
      throw ComputationFailed(
          "Inertia: the tensor about the centre of mass is singular (a point or a needle): its "
          "rotation is not determined by the force");
    }
  }

  [[nodiscard]] Motor<S> solve(const Motor<S>& P) const {
    const Vector3<S> du = factor_.solve(P.moment - centre_.cross(P.resultant));
    return {du, P.resultant / mass_ - du.cross(centre_)};
  }

 private:
  S mass_;
  Vector3<S> centre_;
  detail::FactoredSymmetric3<S> factor_;
};

/// The solution A of  T A = P, for a single P.
///
/// Throws : ComputationFailed, as FactoredInertia
template <class S>
[[nodiscard]] Motor<S> solve(const Inertia<S>& T, const Motor<S>& P) {
  return FactoredInertia<S>(T).solve(P);
}

namespace detail {

/// The greatest violation that counts as rounding of a given tensor: 1e-12 of the greatest entry,
/// or more for numbers with fewer digits.
template <class S>
[[nodiscard]] S tensor_slack(const Symmetric3<S>& t) {
  using std::abs;
  S largest(0);
  for (const S& entry : {t.xx, t.yy, t.zz, t.xy, t.xz, t.yz}) {
    if (abs(entry) > largest) largest = abs(entry);
  }
  const S digits = S(64) * std::numeric_limits<S>::epsilon();
  return (digits > S(1e-12) ? digits : S(1e-12)) * largest;
}

/// The value of a number, without its derivatives (Eigen's AutoDiffScalar); for a pack, the first
/// lane. Checks look only at this value.
template <class S>
[[nodiscard]] auto number_in(const S& x) {
  if constexpr (requires { x.derivatives(); }) {
    return number_in(x.value());
  } else if constexpr (requires { x.lane(0); }) {
    return x.lane(0);
  } else {
    return x;
  }
}

/// The eigenvalues in ascending order, by Jacobi rotations. Eigen's solver takes half as long to
/// compile as a scene.
template <class S>
[[nodiscard]] std::array<S, 3> principal_moments(const Symmetric3<S>& t) {
  using std::abs;
  using std::sqrt;
  S m[3][3] = {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
  constexpr int planes[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  bool diagonal = false;
  for (int sweep = 0; sweep < 16 && !diagonal; ++sweep) {
    diagonal = true;
    for (const auto& [p, q] : planes) {
      const S off = m[p][q];
      m[p][q] = m[q][p] = S(0);
      if (abs(off) <= std::numeric_limits<S>::epsilon() / S(1000) * (abs(m[p][p]) + abs(m[q][q]))) {
        continue;
      }
      diagonal = false;
      const S half = (m[q][q] - m[p][p]) / (S(2) * off);
      const S root = abs(half) + sqrt(S(1) + half * half);
      const S tangent = half < S(0) ? S(-1) / root : S(1) / root;
      const S cosine = S(1) / sqrt(S(1) + tangent * tangent);
      const S sine = tangent * cosine;
      m[p][p] -= tangent * off;
      m[q][q] += tangent * off;
      const int other = 3 - p - q;
      const S a = m[p][other];
      const S b = m[q][other];
      m[p][other] = m[other][p] = cosine * a - sine * b;
      m[q][other] = m[other][q] = sine * a + cosine * b;
    }
  }
  // Three comparisons, because the library's sort for any number of elements is longer.
  const auto order = [](S& less, S& more) {
    if (more < less) std::swap(less, more);
  };
  std::array<S, 3> moments = {m[0][0], m[1][1], m[2][2]};
  order(moments[0], moments[1]);
  order(moments[1], moments[2]);
  order(moments[0], moments[1]);
  return moments;
}

/// Throws : InvalidInput with the name of the tensor, the reason and the numbers
KREISEL_API [[noreturn]] void refuse_inertia(const std::string& what, const char* why, double a = 0,
                                             double b = 0, double c = 0);

/// Refuses principal moments. If the violation is at most 1e-3, as with rounded numbers, the
/// message ends with the nearest legal tensor.
///
/// Throws : InvalidInput
KREISEL_API [[noreturn]] void refuse_moments(const std::string& what, const char* why,
                                             const Symmetric3<double>& t,
                                             const std::array<double, 3>& moments);

}  // namespace detail

/// The rule for bodies without mass: some scenes allow a massless ring as a limit.
enum class Mass { positive, zero_allowed };

/// Refuses an inertia that no distribution of mass can have.
///
/// It refuses a mass below 0 and a tensor about the centre of mass that is not positive
/// semidefinite. It also refuses a tensor that violates the triangle inequality of its principal
/// moments. Needles, discs and points are legal limits. Violations up to 1e-12 of the given tensor
/// (in float 8e-6) pass as rounding.
///
/// Throws : InvalidInput with the violated inequality and its numbers. If rounding to three digits
///          or more explains the violation, the message adds the nearest legal tensor
template <class S>
KREISEL_API void check(const Inertia<S>& T, Mass rule = Mass::positive,
                       const std::string& what = "inertia") {
  using Number = decltype(detail::number_in(T.mass));
  const auto refuse = [&what](const char* why, const auto&... numbers) {
    detail::refuse_inertia(what, why, static_cast<double>(numbers)...);
  };
  const Symmetric3<S>& t = T.tensor;
  for (const S& number : {T.mass, T.first_moment.x(), T.first_moment.y(), T.first_moment.z(), t.xx,
                          t.yy, t.zz, t.xy, t.xz, t.yz}) {
    const bool finite = number - number == S(0);
    if (!finite) refuse("not a finite number among mass, first moment and tensor");
  }
  const Number mass = detail::number_in(T.mass);
  if (mass < Number(0)) refuse("mass >= 0 fails: mass = %.10g kg", mass);
  const Vector3<S>& s = T.first_moment;
  if (mass == Number(0)) {
    if (rule == Mass::positive) refuse("mass > 0 fails: mass = 0 kg");
    if (!(s.x() == S(0) && s.y() == S(0) && s.z() == S(0))) {
      refuse("mass = 0 kg, but its first moment is not 0");
    }
  }
  Symmetric3<S> about_centre = t;
  if (mass > Number(0)) {
    const Vector3<S> r(s.x() / T.mass, s.y() / T.mass, s.z() / T.mass);
    about_centre = t - offset_product(r, Vector3<S>(s.x() / S(2), s.y() / S(2), s.z() / S(2)));
  }
  const auto numbers = [](const Symmetric3<S>& m) {
    const auto in = [](const S& x) -> Number { return detail::number_in(x); };
    return Symmetric3<Number>{in(m.xx), in(m.yy), in(m.zz), in(m.xy), in(m.xz), in(m.yz)};
  };
  const auto [a, b, c] = detail::principal_moments(numbers(about_centre));
  const Number slack = detail::tensor_slack(numbers(t));
  const std::array<double, 3> moments{static_cast<double>(a), static_cast<double>(b),
                                      static_cast<double>(c)};
  const auto refuse_moments = [&](const char* why) {
    const auto in = [](const S& x) { return static_cast<double>(detail::number_in(x)); };
    const Symmetric3<S>& m = about_centre;
    detail::refuse_moments(what, why, {in(m.xx), in(m.yy), in(m.zz), in(m.xy), in(m.xz), in(m.yz)},
                           moments);
  };
  if (a < -slack) {
    refuse_moments(
        "principal moments about the centre of mass >= 0 fails: %.10g, %.10g, %.10g kg m^2");
  }
  if (a + b < c - slack) {
    refuse_moments(
        "triangle inequality about the centre of mass fails: %.10g + %.10g >= %.10g kg m^2");
  }
}

extern template void check(const Inertia<double>& T, Mass rule, const std::string& what);

/// The inertia tensor of a rigid body, written in In: T of the paper.
///
/// Braces take numbers unchecked; about_centre and about_origin check them.
///
/// Source : paper 002 (1), (10)
/// Units  : kg, kg m, kg m^2
template <class In, class S = double>
struct InertiaTensor {
  Inertia<S> value;

  using Frame = In;
  using Scalar = S;
  using Value = Inertia<S>;
  template <class E>
  using WrittenIn = InertiaTensor<E, S>;

  /// The inertia tensor from mass, centre of mass and the tensor about the centre of mass.
  ///
  /// Throws : InvalidInput as check() does
  [[nodiscard]] static InertiaTensor about_centre(const S& mass, const Vector3<S>& centre,
                                                  const Matrix3<S>& tensor,
                                                  Mass rule = Mass::positive) {
    const Inertia<S> centred{mass, Vector3<S>::Zero(), symmetric(tensor)};
    check(centred, rule);
    const Vector3<S> s(mass * centre.x(), mass * centre.y(), mass * centre.z());
    const Vector3<S> half(s.x() / S(2), s.y() / S(2), s.z() / S(2));
    return {{mass, s, centred.tensor + offset_product(centre, half)}};
  }

  /// The inertia tensor from mass, centre of mass and the tensor about the origin of In.
  ///
  /// Throws : InvalidInput as check() does
  [[nodiscard]] static InertiaTensor about_origin(const S& mass, const Vector3<S>& centre,
                                                  const Matrix3<S>& tensor,
                                                  Mass rule = Mass::positive) {
    const Inertia<S> inertia{
        mass, {mass * centre.x(), mass * centre.y(), mass * centre.z()}, symmetric(tensor)};
    check(inertia, rule);
    return {inertia};
  }

 private:
  [[nodiscard]] static Symmetric3<S> symmetric(const Matrix3<S>& m) {
    using std::abs;
    const Symmetric3<S> mean = Symmetric3<S>::from(m);
    const S slack = detail::tensor_slack(mean);
    const auto differ = [&](int i, int k) { return abs(S(m(i, k) - m(k, i))) > slack; };
    if (differ(0, 1) || differ(0, 2) || differ(1, 2)) {
      throw InvalidInput("inertia: the tensor is not symmetric");
    }
    return mean;
  }
};

template <class E, class S>
struct Sum<InertiaTensor<E, S>, InertiaTensor<E, S>> {
  using Type = InertiaTensor<E, S>;
};

/// The momentum motor  T V.
///
/// Source : paper 002 section 3: T V' = {m(v' + u' x r_s); m r_s x v' + T u'}
template <class E, class S, class Of, class From, class E2>
[[nodiscard, gnu::always_inline]] inline auto operator*(const InertiaTensor<E, S>& T,
                                                        const Velocity<Of, From, E2, S>& V) {
  static_assert(std::is_same_v<E, E2>, "inertia and velocity are not written in one frame");
  if constexpr (std::is_same_v<E, E2>) return Momentum<E, S>{T.value * V.value};
}

/// The force motor  T dV, dV the derivative of a velocity.
template <class E, class S, class O, class Of, class From, class E2>
[[nodiscard, gnu::always_inline]] inline auto operator*(
    const InertiaTensor<E, S>& T, const Rate<O, Velocity<Of, From, E2, S>>& dV) {
  static_assert(std::is_same_v<E, E2>, "inertia and acceleration are not written in one frame");
  if constexpr (std::is_same_v<E, E2>) return Force<E, S>{T.value * dV.value};
}

/// The rate of the inertia of a body B seen from an observer O against whom B moves with V.
///
/// Source : paper 002 section 2, oT = [V' T] - [T V']
template <class B, class O, class E, class S>
[[nodiscard]] Rate<O, InertiaTensor<E, S>> rate(const std::type_identity_t<InertiaTensor<E, S>>& T,
                                                const Velocity<B, O, E, S>& V) {
  return {carried_rate(V.value, T.value)};
}

}  // namespace kreisel
