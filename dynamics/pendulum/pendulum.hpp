#pragma once

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>
#include <utility>

#include <dynamics/guide/earth.hpp>
#include <dynamics/inertia.hpp>
#include <dynamics/model/structure.hpp>
#include <dynamics/model/terms.hpp>
#include <dynamics/pendulum/pendulum_series.hpp>
#include <motor/error.hpp>
#include <motor/motor.hpp>
#include <motor/static_zero.hpp>

namespace kreisel {

/// A rigid body on an axis fixed in the guide frame: the physical pendulum.
///
/// The axis A goes from the pivot through the centre of mass, C lies in the pendulum's axis, B
/// completes the right-handed triad. The tensor is about the pivot. Its off-diagonals are -Phi:
/// phi_a = int BC dm, phi_b = int CA dm, phi_c = int AB dm.
///
/// Source : paper 002 section 5: m, a, Theta_A .. Theta_C, Phi_A .. Phi_C
/// Units  : kg, m, kg m^2
template <class S = double>
struct PendulumBody {
  S mass = S(1);
  S arm = S(1);
  S theta_a = S(0), theta_b = S(0), theta_c = S(0);
  S phi_a = S(0), phi_b = S(0), phi_c = S(0);

  /// A needle that hangs from its end:  a = length/2,  Theta_B = Theta_C = m length^2/3.
  [[nodiscard]] static PendulumBody thin_rod(const S& length, const S& mass = S(1)) {
    const S theta = mass * length * length / S(3);
    return {mass, length / S(2), S(0), theta, theta};
  }

  /// The needle of reduced length Theta_C/(m a) = l, which is 3l/2 long. Every body with the same
  /// l, Theta_B = Theta_C and Theta_A = 0 moves like it.
  [[nodiscard]] static PendulumBody from_reduced_length(const S& length, const S& mass = S(1)) {
    return thin_rod(S(1.5) * length, mass);
  }

  /// The same body in another scalar.
  template <class T>
  [[nodiscard]] PendulumBody<T> cast() const {
    return {T(mass), T(arm), T(theta_a), T(theta_b), T(theta_c), T(phi_a), T(phi_b), T(phi_c)};
  }
};

/// Refuses parameters that no body can have.
///
/// Throws : InvalidInput: arm or Theta_C not a finite number above 0; or as check(Inertia): mass >
///          0, the tensor about the centre of mass positive semidefinite and within the triangle
///          inequality to 1e-12 (needles and discs are legal)
template <class S>
void check(const PendulumBody<S>& body) {
  detail::require_positive("mass", body.mass, "kg");
  detail::require_positive("arm", body.arm, "m");
  detail::require_positive("theta_c", body.theta_c, "kg m^2");
  const Vector3<S> first_moment(body.mass * body.arm, S(0), S(0));
  const Inertia<S> inertia{
      body.mass,
      first_moment,
      {body.theta_a, body.theta_b, body.theta_c, -body.phi_c, -body.phi_b, -body.phi_a}};
  check(inertia, Mass::positive, "pendulum body (theta, phi about the pivot)");
}

/// The effective gravity at the pivot for a body at rest in the guide:  g' = g - (ov + u x v).
///
/// Source : paper 002 section 5, "effektive Schwere"; ov = dv is the rate, seen from the guide, of
///          the velocity of the guide-fixed pivot
/// Frame  : all on guide axes
template <class S>
[[nodiscard]] Vector3<S> effective_gravity(const Vector3<S>& g,
                                           const std::type_identity_t<Vector3<S>>& u,
                                           const std::type_identity_t<Vector3<S>>& v,
                                           const std::type_identity_t<Vector3<S>>& dv) {
  return g - dv - u.cross(v);
}

/// The motion of the guide frame at one time, as far as it affects the pendulum.
///
/// Frame  : guide axes: x down when the pendulum hangs straight, z the pendulum's axis
/// Units  : rad/s, rad/s^2, m/s^2, 1/s^2
template <class S = double>
struct PendulumGuide {
  Vector3<S> angular_velocity = Vector3<S>::Zero();      ///< u
  Vector3<S> angular_acceleration = Vector3<S>::Zero();  ///< ou = .u
  Vector3<S> effective_gravity = Vector3<S>::Zero();     ///< g' at the pivot
  std::optional<Matrix3<S>> gravity_gradient = {};  ///< symmetric; left out, gravity is uniform

  /// The same motion in another scalar.
  template <class T>
  [[nodiscard]] PendulumGuide<T> cast() const {
    PendulumGuide<T> other{angular_velocity.template cast<T>(),
                           angular_acceleration.template cast<T>(),
                           effective_gravity.template cast<T>(),
                           {}};
    if (gravity_gradient) other.gravity_gradient = gravity_gradient->template cast<T>();
    return other;
  }
};

/// A guide at rest with gravity straight down: the pendulum of the inertial frame, whose only
/// coefficient is E.
///
/// Units  : m/s^2
template <class S = double>
struct RestingPendulumGuide {
  S gravity = S(0);
};

/// Gravity on the earth: uniform, or with its gradient.
enum class GravityGradient { left_out, taken_in };

template <class S>
[[nodiscard]] PendulumGuide<S> pendulum_guide(const EarthGuide<S>& earth,
                                              GravityGradient rule = GravityGradient::left_out) {
  PendulumGuide<S> guide{earth.angular_velocity, Vector3<S>::Zero(), earth.effective_gravity, {}};
  if (rule == GravityGradient::taken_in) guide.gravity_gradient = earth.gravity_gradient;
  return guide;
}

/// A restoring moment  e sin(phi) + f cos(phi) + h cos(2 phi) + k sin(2 phi).     [N m]
template <class S = double>
struct PendulumTerms {
  S e = S(0), f = S(0), h = S(0), k = S(0);

  friend PendulumTerms operator+(const PendulumTerms& a, const PendulumTerms& b) {
    return {a.e + b.e, a.f + b.f, a.h + b.h, a.k + b.k};
  }
};

/// The origins of E, F, H and K of (23). The weight is the simple pendulum's. The rest is small on
/// the earth and is stored apart from the weight, so that nothing cancels.
template <class S = double>
struct PendulumParts {
  S weight = S(0);                    ///< m a |g'|
  PendulumTerms<S> tilt;              ///< g' off the x axis: e = m a (g'_x - |g'|), f = -m a g'_y
  PendulumTerms<S> centrifugal;       ///< of u, across the body
  PendulumTerms<S> euler;             ///< of ou
  PendulumTerms<S> gravity_gradient;  ///< 0 unless the guide has one
};

namespace detail {

/// The moments of inertia that matter and the products of inertia, over a common divisor. P is
/// StaticZero for a body without products.
template <class S, class P>
struct PendulumShape {
  S moment;    ///< m a
  S b_less_a;  ///< Theta_B - Theta_A
  Components<P> phi;
};

/// PendulumTerms whose members are each a number or StaticZero.
template <class E, class F, class H, class K>
struct PlaneTerms {
  E e;
  F f;
  H h;
  K k;

  template <class E2, class F2, class H2, class K2>
  friend auto operator+(const PlaneTerms& a, const PlaneTerms<E2, F2, H2, K2>& b) {
    using Sum = PlaneTerms<Total<E, E2>, Total<F, F2>, Total<H, H2>, Total<K, K2>>;
    return Sum{Total<E, E2>(a.e + b.e), Total<F, F2>(a.f + b.f), Total<H, H2>(a.h + b.h),
               Total<K, K2>(a.k + b.k)};
  }
};

/// The moment of a force field  G r dm  on the body, from the four numbers of G that matter.
///
/// G = u^2 - u u^t gives the centrifugal terms, the gravity gradient G the tidal terms.
template <class S, class P, class A>
[[nodiscard]] auto gradient_terms(const PendulumShape<S, P>& body, const A& yy_less_xx, const A& xy,
                                  const A& xz, const A& yz) {
  using E = Product<A, P>;
  const Components<P>& phi = body.phi;
  const S& d = body.b_less_a;
  return PlaneTerms<E, E, A, A>{E(xz * phi.y + yz * phi.x), E(xz * phi.x - yz * phi.y),
                                A(A(-A(xy * d)) - E(yy_less_xx * phi.z)),
                                A(E(E(xy * phi.z) * S(2)) - A(A(yy_less_xx * d) / S(2)))};
}

template <class S, class P, class A>
[[nodiscard]] auto centrifugal_terms(const PendulumShape<S, P>& body, const Components<A>& u) {
  return gradient_terms(body, A(A(u.x - u.y) * A(u.x + u.y)), A(-A(u.x * u.y)), A(-A(u.x * u.z)),
                        A(-A(u.y * u.z)));
}

template <class S, class P, class A>
[[nodiscard]] auto euler_terms(const PendulumShape<S, P>& body, const Components<A>& du) {
  using E = Product<A, P>;
  const Components<P>& phi = body.phi;
  return PlaneTerms<E, E, StaticZero, StaticZero>{
      E(phi.x * du.x - phi.y * du.y), E(E(-E(phi.x * du.y)) - E(phi.y * du.x)), {}, {}};
}

/// The moment of a gravity gradient G.
template <class S, class P>
[[nodiscard]] auto tidal_terms(const PendulumShape<S, P>& body, const Matrix3<S>& G) {
  return gradient_terms(body, S(G(1, 1) - G(0, 0)), S(G(0, 1)), S(G(0, 2)), S(G(1, 2)));
}

/// The value as a number: 0 for StaticZero.
template <class S, class F>
[[nodiscard]] PendulumTerms<S> terms(const PlaneTerms<F, F, S, S>& t) {
  return {S(S(0) + t.e), S(S(0) + t.f), t.h, t.k};
}
template <class S>
[[nodiscard]] PendulumTerms<S> terms(const PlaneTerms<S, S, StaticZero, StaticZero>& t) {
  return {t.e, t.f, S(0), S(0)};
}

template <class S>
[[nodiscard]] PendulumShape<S, S> shape(const PendulumBody<S>& body) {
  return {body.mass * body.arm, body.theta_b - body.theta_a, {body.phi_a, body.phi_b, body.phi_c}};
}

/// e sin(phi) + f cos(phi) + h cos(2 phi) + k sin(2 phi), where each of the four is a number or
/// StaticZero.
template <class A, class E, class F, class H, class K>
[[nodiscard]] A restoring_moment(const E& e, const F& f, const H& h, const K& twice_k,
                                 const A& phi) {
  using std::cos, std::sin;
  const A s = sin(phi);
  if constexpr (is_static_zero<F> && is_static_zero<H> && is_static_zero<K>) {
    return s * e;
  } else {
    const A c = cos(phi);
    const Product<A, F> across(c * f);
    const Product<A, H> aside(A((c - s) * (c + s)) * h);
    return A(s * A(e + Product<A, K>(c * twice_k))) +
           Total<decltype(across), decltype(aside)>(across + aside);
  }
}

}  // namespace detail

/// E, F, H and K of (23) by their origin:
///
///   E =  m a g'_x - Phi_A (u_z u_y - ou_x) - Phi_B (u_z u_x + ou_y)
///   F = -m a g'_y - Phi_A (u_z u_x + ou_y) + Phi_B (u_z u_y - ou_x)
///   H = Phi_C (u_y^2 - u_x^2) + (Theta_B - Theta_A) u_x u_y
///   K = -2 Phi_C u_x u_y + (Theta_A - Theta_B) (u_x^2 - u_y^2)/2
///
/// and from a gravity gradient G
///
///   E += G_xz Phi_B + G_yz Phi_A,   H -= G_xy (Theta_B - Theta_A) + (G_yy - G_xx) Phi_C
///   F += G_xz Phi_A - G_yz Phi_B,   K += 2 G_xy Phi_C - (G_yy - G_xx) (Theta_B - Theta_A)/2
///
/// Source : paper 002 (23) and the lines below it, with the printed v terms inside g'
/// Error  : <= 6u of the terms added, in each number
template <class S>
[[nodiscard]] PendulumParts<S> parts(const PendulumBody<S>& body, const PendulumGuide<S>& guide) {
  using std::sqrt;
  const Vector3<S>& u = guide.angular_velocity;
  const Vector3<S>& du = guide.angular_acceleration;
  const Vector3<S>& g = guide.effective_gravity;
  const S moment = body.mass * body.arm;

  PendulumParts<S> result;
  const S aside2 = g.y() * g.y() + g.z() * g.z();
  const S g_norm = sqrt(S(g.x() * g.x() + aside2));
  result.weight = moment * g_norm;
  result.tilt.e =
      g.x() > S(0) ? S(-moment * aside2 / (g_norm + g.x())) : S(moment * (g.x() - g_norm));
  result.tilt.f = -moment * g.y();
  const detail::PendulumShape<S, S> shape = detail::shape(body);
  result.centrifugal = detail::terms(detail::centrifugal_terms(shape, detail::components(u)));
  result.euler = detail::terms(detail::euler_terms(shape, detail::components(du)));
  if (guide.gravity_gradient) {
    result.gravity_gradient = detail::terms(detail::tidal_terms(shape, *guide.gravity_gradient));
  }
  return result;
}

/// The coefficients of (23), E split into the weight and the rest.
///
/// Units  : N m
template <class S = double>
struct PendulumCoefficients {
  S weight = S(0);   ///< m a |g'|
  S delta_e = S(0);  ///< E - weight
  S f = S(0);        ///< F
  S h = S(0);        ///< H
  S k = S(0);        ///< K

  [[nodiscard]] S e() const { return weight + delta_e; }

  /// The restoring moment  E sin(phi) + F cos(phi) + H cos(2 phi) + K sin(2 phi).
  ///
  /// Error : <= 4u (|E sin phi| + |F cos phi| + |H cos 2phi| + |K sin 2phi|)
  template <class A>
  [[nodiscard]] A moment(const A& phi) const {
    return detail::restoring_moment(e(), f, h, S(2 * k), phi);
  }

  /// d moment / d phi.
  template <class A>
  [[nodiscard]] A stiffness(const A& phi) const {
    using std::cos, std::sin;
    const A s = sin(phi);
    const A c = cos(phi);
    const A c2 = (c - s) * (c + s);
    const A s2 = s * c * S(2);
    return c * e() - s * f - s2 * S(2 * h) + c2 * S(2 * k);
  }

  /// The potential of the moment, 0 at phi = 0:
  ///   2 E sin^2(phi/2) + F sin(phi) + H sin(phi) cos(phi) + K sin^2(phi)
  template <class A>
  [[nodiscard]] A potential(const A& phi) const {
    using std::cos, std::sin;
    const A half = sin(A(phi / S(2)));
    const A s = sin(phi);
    const A c = cos(phi);
    return half * half * S(2 * e()) + s * f + s * c * h + s * s * k;
  }
};

template <class S>
[[nodiscard]] PendulumCoefficients<S> coefficients(const PendulumParts<S>& p) {
  const PendulumTerms<S> small = p.tilt + p.centrifugal + p.euler + p.gravity_gradient;
  return {p.weight, small.e, small.f, small.h, small.k};
}

template <class S>
[[nodiscard]] PendulumCoefficients<S> coefficients(const PendulumBody<S>& body,
                                                   const PendulumGuide<S>& guide) {
  return coefficients(parts(body, guide));
}

/// Turn of the body's axis A from x towards y, and its rate.       (phi; phi.)  [rad; rad/s]
template <class S = double>
using PendulumState = Eigen::Matrix<S, 2, 1>;

/// The conserved energy of a steady pendulum without damping:  Theta_C phi.^2/2 + potential(phi).
/// [J]
template <class S, class A>
[[nodiscard]] A energy(const PendulumBody<S>& body, const PendulumCoefficients<S>& c,
                       const PendulumState<A>& state) {
  const A potential = c.potential(state[0]);
  return potential + state[1] * state[1] * S(body.theta_c / S(2));
}

struct NoDamping {};

namespace detail {

template <class Motion>
inline constexpr bool is_steady_pendulum_guide = false;
template <class S>
inline constexpr bool is_steady_pendulum_guide<PendulumGuide<S>> = true;
template <class S>
inline constexpr bool is_steady_pendulum_guide<RestingPendulumGuide<S>> = true;

/// E, F, H, 2K and ou_z over Theta_C: numbers, or StaticZero.
template <class E, class F, class H, class K, class D>
struct PendulumEquation {
  E e;
  F f;
  H h;
  K twice_k;
  D drive;
};

template <class S, class P>
[[nodiscard]] auto pendulum_equation(const PendulumShape<S, P>& over_theta,
                                     const PendulumGuide<S>& guide) {
  const Vector3<S>& g = guide.effective_gravity;
  const auto turning = centrifugal_terms(over_theta, components(guide.angular_velocity)) +
                       euler_terms(over_theta, components(guide.angular_acceleration));
  PendulumTerms<S> sum = terms(turning);
  if (guide.gravity_gradient) {
    sum = sum + terms(tidal_terms(over_theta, *guide.gravity_gradient));
  }
  return PendulumEquation<S, S, S, S, S>{S(over_theta.moment * g.x() + sum.e),
                                         S(sum.f - over_theta.moment * g.y()), sum.h, S(2 * sum.k),
                                         guide.angular_acceleration.z()};
}

template <class S, class P>
[[nodiscard]] PendulumEquation<S, StaticZero, StaticZero, StaticZero, StaticZero> pendulum_equation(
    const PendulumShape<S, P>& over_theta, const RestingPendulumGuide<S>& guide) {
  return {S(over_theta.moment * guide.gravity), {}, {}, {}, {}};
}

/// The equation, if it is constant in time.
template <class Shape, class Motion>
[[nodiscard]] auto steady_equation(const Shape& over_theta, const Motion& motion) {
  if constexpr (is_steady_pendulum_guide<Motion>) {
    return pendulum_equation(over_theta, motion);
  } else {
    return StaticZero{};
  }
}

}  // namespace detail

/// The equation of motion as a vector field  (time, state) -> d state/dt:
///
///   Theta_C phi.. + f(phi.) + E sin phi + F cos phi + H cos 2phi + K sin 2phi = -Theta_C ou_z
///
/// Motion is the guide's: a PendulumGuide for a steady guide, a RestingPendulumGuide, or a function
/// of time that returns one of them. Damping is a function phi. -> f(phi.) in N m, with f(w) w >= 0
/// for a brake. Phi_A .. Phi_C are left out for a body with Without<ProductsOfInertia>.
///
/// Source : paper 002 (23)
/// Error  : that of PendulumCoefficients::moment
/// Cost   : one sine, one cosine and 14 flops when the guide is steady, some 30 to 50 flops more
///          when not
/// Throws : InvalidInput if Without<ProductsOfInertia> is given and a product of inertia is not 0
template <class S, class Motion = PendulumGuide<S>, class Damping = NoDamping, class... Known>
class PendulumField {
  static constexpr bool steady = detail::is_steady_pendulum_guide<Motion>;

 public:
  explicit PendulumField(const PendulumBody<S>& body, Motion motion, Damping damping = {},
                         Known... /*known*/)
      : theta_c_(body.theta_c),
        shape_(known_shape(body)),
        motion_(std::move(motion)),
        damping_(std::move(damping)),
        steady_(detail::steady_equation(shape_, motion_)) {}

  template <class A>
  [[nodiscard]] PendulumState<A> operator()(const S& time, const PendulumState<A>& state) const {
    if constexpr (steady) {
      return rate(steady_, state);
    } else {
      return rate(detail::pendulum_equation(shape_, motion_(time)), state);
    }
  }

  /// The Taylor series of the motion, for TaylorSteps.
  [[nodiscard]] detail::PendulumSeries series() const
      requires(steady&& std::is_same_v<S, double>&& std::is_same_v<Damping, NoDamping>) {
    const auto& [e, f, h, twice_k, drive] = steady_;
    return {e, 0.0 + f, (0.0 + twice_k) / 2, 0.0 + h, 0.0 + drive};
  }

  /// The terms of (23) that the field computes: see kreisel::terms.
  [[nodiscard]] Terms terms() const {
    constexpr bool moves = !detail::is_static_zero<decltype(Equation::h)>;
    constexpr bool crooked = moves && !principal;
    constexpr bool damped = !std::is_same_v<Damping, NoDamping>;
    const char* const at_rest = moves ? "" : "the guide rests, gravity straight down";
    const std::string of_products =
        moves ? detail::reason_for<ProductsOfInertia, Known...>() : std::string(at_rest);
    Terms list;
    list.add("relative", "Theta_C phi..");
    list.add("guide", "(Theta_B - Theta_A) of u x (u x r): in H, K", moves, at_rest);
    list.add("guide", "products of inertia: in E, F, H, K", crooked, of_products);
    list.add("guide", "Theta_C ou_z", moves, at_rest);
    list.add("load", "m a g'_x: in E");
    list.add("load", "m a g'_y: in F", moves, at_rest);
    list.add("load", "damping", damped, damped ? "" : "NoDamping");
    return list;
  }

 private:
  static constexpr bool principal = detail::principal<Known...>;
  using Shape = detail::PendulumShape<S, std::conditional_t<principal, detail::StaticZero, S>>;

  [[nodiscard]] static Shape known_shape(const PendulumBody<S>& body) {
    const S moment = body.mass * body.arm / body.theta_c;
    const S b_less_a = (body.theta_b - body.theta_a) / body.theta_c;
    if constexpr (principal) {
      if (body.phi_a != S(0) || body.phi_b != S(0) || body.phi_c != S(0)) {
        throw InvalidInput(
            "pendulum: Without<ProductsOfInertia> was given, but phi_a, phi_b and phi_c are not "
            "all 0");
      }
      return {moment, b_less_a, {}};
    } else {
      const S& c = body.theta_c;
      return {moment, b_less_a, {S(body.phi_a / c), S(body.phi_b / c), S(body.phi_c / c)}};
    }
  }

  template <class E, class A>
  [[nodiscard]] PendulumState<A> rate(const E& equation, const PendulumState<A>& state) const {
    const auto& [e, f, h, twice_k, drive] = equation;
    A resistance = detail::restoring_moment(e, f, h, twice_k, state[0]);
    if constexpr (!std::is_same_v<Damping, NoDamping>) resistance += damping_(state[1]) / theta_c_;
    const A acceleration = -A(resistance + drive);
    return {state[1], acceleration};
  }

  [[nodiscard]] static auto motion_of(const Motion& motion) {
    if constexpr (steady) {
      return motion;
    } else {
      return motion(S(0));
    }
  }
  using Equation = decltype(detail::pendulum_equation(std::declval<const Shape&>(),
                                                      motion_of(std::declval<const Motion&>())));

  S theta_c_;
  Shape shape_;
  Motion motion_;
  [[no_unique_address]] Damping damping_;
  decltype(detail::steady_equation(std::declval<Shape>(), std::declval<Motion>())) steady_;
};

/// The linearized equation  Theta_C phi.. + (E + 2K) phi = -(F + H), undamped, ou = 0.
///
/// Source : paper 002 section 5, below (23)
template <class S = double>
struct LinearPendulum {
  S theta_c;
  S stiffness;  ///< E + 2K
  S bias;       ///< F + H

  [[nodiscard]] S acceleration(const S& phi) const { return -(stiffness * phi + bias) / theta_c; }

  /// phi_0 = -(F + H)/(E + 2K); none if E + 2K = 0. Unstable if E + 2K < 0.
  [[nodiscard]] std::optional<S> equilibrium() const {
    if (stiffness == S(0)) return {};
    return S(S(0) - bias / stiffness);
  }

  /// T = 2 pi sqrt(Theta_C/(E + 2K)); none unless E + 2K > 0.
  [[nodiscard]] std::optional<S> period() const {
    using std::acos, std::sqrt;
    if (!(stiffness > S(0))) return {};
    return S(S(2) * acos(S(-1)) * sqrt(S(theta_c / stiffness)));
  }
};

template <class S>
[[nodiscard]] LinearPendulum<S> linearized(const PendulumBody<S>& body,
                                           const PendulumCoefficients<S>& c) {
  return {body.theta_c, c.e() + S(2) * c.k, c.f + c.h};
}

/// The period of the simple pendulum,  T_00 = 2 pi sqrt(Theta_C/(m a g')).
template <class S>
[[nodiscard]] S simple_period(const PendulumBody<S>& body, const PendulumCoefficients<S>& c) {
  using std::acos, std::sqrt;
  return S(2) * acos(S(-1)) * sqrt(S(body.theta_c / c.weight));
}

/// Equilibrium to first order in u^2, principal axes:
///
///   phi_0 = (Theta_B - Theta_A) u^2 sin(2 theta) sin(alpha)/(2 m a g')
///         = -(Theta_B - Theta_A) u_x u_y/(m a g')
///
/// Source : paper 002 (24). With alpha = 90 (axis east-west) the lower end swings north in the
///          northern hemisphere
/// Error  : O(u^4) and the terms with Phi; deviation() returns the difference
template <class S>
[[nodiscard]] S formula_24(const PendulumBody<S>& body, const PendulumGuide<S>& guide) {
  const Vector3<S>& u = guide.angular_velocity;
  return -((body.theta_b - body.theta_a) * (u.x() * u.y())) / parts(body, guide).weight;
}

/// Relative change of the period to first order in u^2, principal axes:  T_0 = T_00 (1 + z),
///
///   z = (Theta_B - Theta_A) u^2 (sin^2 theta - cos^2 theta sin^2 alpha)/(2 m a g')
///
/// Source : paper 002 (25) corrected: theta is the latitude, while the paper prints sin and cos of
///          the colatitude; the root ends before the bracket
/// Error  : as formula_24
template <class S>
[[nodiscard]] S formula_25(const PendulumBody<S>& body, const PendulumGuide<S>& guide) {
  const Vector3<S>& u = guide.angular_velocity;
  const S u2 = (u.x() - u.y()) * (u.x() + u.y());
  return (body.theta_b - body.theta_a) * u2 / (S(2) * parts(body, guide).weight);
}

}  // namespace kreisel
