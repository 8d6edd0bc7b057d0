#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <sstream>
#include <tuple>
#include <type_traits>

#include <dynamics/guide/ellipsoid.hpp>
#include <dynamics/guide/motion.hpp>
#include <dynamics/guide/power_series.hpp>
#include <dynamics/guide/series.hpp>
#include <dynamics/inertia.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// A Kepler orbit by its elements, with the mean rates of node and perigee about an oblate planet.
///
/// Frame  : the planet's centre, z to its pole
/// Units  : metre, radian, m^3/s^2
template <class S = double>
struct OrbitElements {
  S semi_major_axis = S(0);
  S eccentricity = S(0);
  S inclination = S(0);
  S node = S(0);                      ///< of the ascending node, from x
  S perigee = S(0);                   ///< argument, from the node
  S anomaly = S(0);                   ///< TRUE anomaly at t = 0, from the perigee
  S parameter = S(Wgs84::parameter);  ///< mu; the default is the earth's, as is `radius`
  S j2 = S(0);                        ///< 0: node and perigee are fixed; the earth's is Wgs84::j2
  S radius = S(Wgs84::radius);
};

/// Refuses elements that do not describe an ellipse.
///
/// Throws : InvalidInput, naming element, value and range
template <class S>
void check(const OrbitElements<S>& orbit) {
  const auto refuse = [](const char* key, const S& value, const char* allowed) {
    std::ostringstream text;
    text.precision(10);
    text << key << " = " << value << " must be " << allowed;
    throw InvalidInput(text.str());
  };
  const auto finite = [](const S& x) { return x - x == S(0); };
  const auto positive = [&](const char* key, const S& x) {
    if (!(x > S(0) && finite(x))) refuse(key, x, "a finite number above 0");
  };
  positive("semi_major_axis", orbit.semi_major_axis);
  if (!(orbit.eccentricity >= S(0) && orbit.eccentricity < S(1))) {
    refuse("eccentricity", orbit.eccentricity, "from 0 to below 1");
  }
  positive("mu", orbit.parameter);
  positive("radius", orbit.radius);
  const auto number = [&](const char* key, const S& x) {
    if (!finite(x)) refuse(key, x, "a finite number");
  };
  number("inclination", orbit.inclination);
  number("node", orbit.node);
  number("perigee", orbit.perigee);
  number("anomaly", orbit.anomaly);
  number("j2", orbit.j2);
}

namespace detail {

/// The value of a dual number, or the first coefficient of a series.
template <class N>
[[nodiscard]] auto leading(const N& x) {
  if constexpr (std::is_same_v<N, PowerSeries>) {
    return x[0];
  } else {
    return number_in(x);
  }
}

/// E - sin E without cancellation, for E from 0 to pi.
template <class R>
[[nodiscard]] R less_sine(const R& E) {
  using std::sin;
  if (E > R(1)) return E - sin(E);
  R term = E * E * E / R(6);
  R sum(0);
  for (int k = 4; sum + term != sum; k += 2) {
    sum += term;
    term *= -E * E / R(k * (k + 1));
  }
  return sum;
}

/// The eccentric anomaly of a mean anomaly M from 0 to pi. On the convex side Newton's method
/// decreases monotonically to the root, until rounding stops it.
template <class R>
[[nodiscard]] R eccentric_anomaly_of_half(const R& M, const R& e) {
  using std::acos;
  using std::cbrt;
  using std::sin;
  // E - sin E >= E^3/pi^2 up to pi.
  R E = std::min(R(acos(R(-1))), R(M + e));
  E = std::min(E, std::min(R(M / (R(1) - e)), R(cbrt(R(R(10) * M)))));
  while (E > R(0)) {
    const R s = sin(E / R(2));
    const R off = (R(1) - e) * E + e * less_sine(E) - M;
    const R next = E - off / (R(1) - e + R(2) * e * s * s);
    if (!(next < E)) break;
    E = next;
  }
  return E;
}

/// Solves Kepler's equation  E - e sin E = M.
///
/// For dual numbers and series the derivatives are those of the implicit function: each Newton step
/// in these numbers doubles the correct order.
///
/// Error  : <= 4u of E, if M is exact                        (tests/dynamics/guide/orbit.cpp)
template <class N>
[[nodiscard]] N eccentric_anomaly(const N& M, const N& e) {
  using std::acos;
  using std::cos;
  using std::floor;
  using std::sin;
  const auto mean = leading(M);
  using R = std::decay_t<decltype(mean)>;
  const R turn = R(2) * acos(R(-1));
  const R turns = turn * floor(R(mean / turn + R(0.5)));
  const R rest = mean - turns;
  const R half = eccentric_anomaly_of_half<R>(rest < R(0) ? R(-rest) : rest, leading(e));
  const R plain = rest < R(0) ? R(-half) : half;
  if constexpr (std::is_same_v<N, R>) {
    return plain;
  } else {
    N E(plain);
    for (int order = 1; order <= PowerSeries::most_order; order *= 2) {
      const N off = E - e * sin(E) - (M - N(turns));
      E -= (off - N(leading(off))) / (N(1) - e * cos(E));
    }
    return E;
  }
}

}  // namespace detail

/// A point of an orbit and the rotation of the orbit's axes at one time. The axis x is the outward
/// radius, z the orbit's normal, y completes them.
///
/// Frame  : all vectors on the orbit's axes
template <class N>
struct OrbitPoint {
  Matrix3<N> axes;  ///< orbit's axes to inertial ones
  N radius, radius_rate, radius_acceleration;
  Vector3<N> u, du;  ///< angular velocity of the axes, and its rate
  Vector3<N> pole;
  /// The contribution of the orbit's precession to the inertial acceleration of the point, in
  /// addition to the Kepler acceleration -mu/r^2 x. 0 without J2.
  Vector3<N> precession;
};

/// The motion along an orbit, in closed form:
///
///   r = a (1 - e cos E),   E - e sin E = M,   M = M(0) + n t,   n^2 a^3 = mu
///
/// With J2 node and perigee precess at their mean rates; the mean anomaly keeps the rate n:
///
///   node' = -(3/2) n J2 (R/p)^2 cos i,   perigee' = (3/4) n J2 (R/p)^2 (5 cos^2 i - 1),
///   p = a (1 - e^2)
///
/// Source : D. A. Vallado, Fundamentals of Astrodynamics and Applications, 9.6 (rates), 2.2
///          (Kepler)
/// Error  : <= 8u of r and v, plus the effect of the rounding of n t
///                                                           (tests/dynamics/guide/orbit.cpp)
/// Throws : InvalidInput as check() does
template <class S = double>
class Orbit {
 public:
  using Scalar = S;

  explicit Orbit(const OrbitElements<S>& elements) : elements_(elements) {
    check(elements);
    using std::atan2;
    using std::cos;
    using std::sin;
    using std::sqrt;
    const S& e = elements.eccentricity;
    const S& a = elements.semi_major_axis;
    mean_motion_ = sqrt(elements.parameter / a) / a;
    minor_ = sqrt((S(1) - e) * (S(1) + e));
    const S half = elements.anomaly / S(2);
    // E lies in the same half turn as the true anomaly.
    const S turned = S(2) * atan2(S(sqrt(S(1) - e) * sin(half)), S(sqrt(S(1) + e) * cos(half)));
    mean_anomaly_ = turned - e * sin(turned);
    const S flat = elements.radius / (a * minor_ * minor_);
    const S rate = S(0.75) * mean_motion_ * elements.j2 * flat * flat;
    const S c = cos(elements.inclination);
    node_rate_ = S(-2) * rate * c;
    perigee_rate_ = rate * (S(5) * c * c - S(1));
    precesses_ = elements.j2 != S(0);
  }

  [[nodiscard]] const OrbitElements<S>& elements() const { return elements_; }
  [[nodiscard]] bool precesses() const { return precesses_; }
  [[nodiscard]] S mean_motion() const { return mean_motion_; }
  [[nodiscard]] S node_rate() const { return node_rate_; }
  [[nodiscard]] S perigee_rate() const { return perigee_rate_; }

  template <class N>
  [[nodiscard]] OrbitPoint<N> at(const N& t) const {
    using std::cos;
    using std::sin;
    const N e(elements_.eccentricity);
    const N a(elements_.semi_major_axis);
    const N E = detail::eccentric_anomaly<N>(N(mean_anomaly_) + N(mean_motion_) * t, e);
    const N s = sin(E / N(2));
    const N fall = N(2) * s * s;  // 1 - cos E
    const N near = N(1) - e;
    const N share = near + e * fall;  // r/a
    const N cos_f = (near - fall) / share;
    const N sin_f = N(minor_) * sin(E) / share;

    OrbitPoint<N> point;
    point.radius = a * share;
    const N speed = a * N(mean_motion_);
    const N f_rate = N(mean_motion_) * N(minor_) / (share * share);
    point.radius_rate = speed * e * sin(E) / share;
    point.radius_acceleration = speed * N(mean_motion_) * e * cos_f / (share * share);
    const N f_acceleration = N(-2) * f_rate * point.radius_rate / point.radius;
    set_turning(t, {cos_f, sin_f}, f_rate, f_acceleration, point);
    return point;
  }

 private:
  template <class N>
  struct Direction {
    N cosine, sine;
  };

  template <class N>
  void set_turning(const N& t, const Direction<N>& f, const N& f_rate, const N& f_acceleration,
                   OrbitPoint<N>& point) const {
    using std::cos;
    using std::sin;
    N perigee(elements_.perigee);
    N node(elements_.node);
    if (precesses_) {
      perigee += N(perigee_rate_) * t;
      node += N(node_rate_) * t;
    }
    const N cp = cos(perigee), sp = sin(perigee);
    const N c = cp * f.cosine - sp * f.sine;  // of the angle from the node
    const N s = sp * f.cosine + cp * f.sine;
    const N ci = cos(N(elements_.inclination)), si = sin(N(elements_.inclination));
    const N cn = cos(node), sn = sin(node);
    point.axes << cn * c - sn * s * ci, -cn * s - sn * c * ci, sn * si,  //
        sn * c + cn * s * ci, -sn * s + cn * c * ci, -cn * si,           //
        s * si, c * si, ci;
    point.pole = Vector3<N>(s * si, c * si, ci);
    const N zero(0);
    point.u = Vector3<N>(zero, zero, f_rate);
    point.du = Vector3<N>(zero, zero, f_acceleration);
    point.precession = Vector3<N>(zero, zero, zero);
    if (!precesses_) return;
    const N along = f_rate + N(perigee_rate_);
    const Vector3<N> z(zero, zero, N(1));
    const Vector3<N> w = N(node_rate_) * point.pole + N(perigee_rate_) * z;
    point.u += w;
    // The pole is fixed: relative to the axes it rotates at -along about z.
    point.du += N(node_rate_) * along * Vector3<N>(c * si, -s * si, zero);
    const Vector3<N> r(point.radius, zero, zero);
    const Vector3<N> v(point.radius_rate, point.radius * f_rate, zero);
    const Vector3<N> dw = N(perigee_rate_) * N(node_rate_) * point.pole.cross(z);
    point.precession = N(2) * w.cross(v) + dw.cross(r) + w.cross(Vector3<N>(w.cross(r)));
  }

  OrbitElements<S> elements_;
  S mean_motion_ = S(0), mean_anomaly_ = S(0);
  S minor_ = S(1);  ///< sqrt(1 - e^2)
  S node_rate_ = S(0), perigee_rate_ = S(0);
  bool precesses_ = false;
};

namespace detail {

/// True if N is another number type than S: dual numbers and series.
template <class N, class S>
inline constexpr bool is_other_number =
    !std::is_convertible_v<N, S> && std::is_constructible_v<N, S>;

}  // namespace detail

/// The frame that moves along an orbit: x outwards along the radius, z along the orbit's normal, y
/// completes them (on a circle it is along the velocity). I has the planet's centre as origin, z to
/// the pole.
///
/// Units  : metre, rad/s, m/s, rad/s^2, m/s^2, second
/// Error  : that of Orbit; the sum of its series <= 40u of the acceleration
///                                                           (tests/dynamics/guide/orbit.cpp)
template <class G = Guide, class I = Inertial, class S = double>
class OrbitFrame {
 public:
  explicit OrbitFrame(const OrbitElements<S>& elements) : orbit_(elements) {}

  [[nodiscard]] const Orbit<S>& orbit() const { return orbit_; }

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const { return at<S>(t); }
  template <class N>
  requires(detail::is_other_number<N, S>) [[nodiscard]] FrameMotion<G, I, N> operator()(
      const N& t) const {
    return at<N>(t);
  }

  [[nodiscard]] FrameTurning<S> turning(const S& t) const {
    const OrbitPoint<S> point = orbit_.at(t);
    return {point.u, point.du};
  }

  /// The series of u and g', as AnalyticGuide requires.
  [[nodiscard]] GuideSeries series(
      double t, double h, int order,
      const detail::Components<double>& g) const requires std::is_same_v<S, double> {
    const auto motion = at(PowerSeries::time(t, h, order));
    const auto& R = motion.X.value.rotation;
    const Vector3<PowerSeries> a = motion.origin_acceleration();
    const Vector3<PowerSeries>& u = motion.V.value.resultant;
    GuideSeries result;
    for (int i = 0; i < 3; ++i) {
      const PowerSeries down = R(0, i) * g.x + R(1, i) * g.y + R(2, i) * g.z - a[i];
      const auto component = [i](detail::Components<double>& v) -> double& {
        return i == 0 ? v.x : i == 1 ? v.y : v.z;
      };
      for (int k = 0; k <= order; ++k) {
        component(result.u[static_cast<std::size_t>(k)]) = u[i][k];
        component(result.g[static_cast<std::size_t>(k)]) = down[k];
      }
    }
    return result;
  }

 private:
  template <class N>
  [[nodiscard]] FrameMotion<G, I, N> at(const N& t) const {
    const OrbitPoint<N> point = orbit_.at(t);
    const auto& [r, dr, ddr] = std::tie(point.radius, point.radius_rate, point.radius_acceleration);
    const Vector3<N>& u = point.u;
    const Vector3<N>& du = point.du;
    FrameMotion<G, I, N> motion;
    motion.X.value.rotation = point.axes;
    motion.X.value.translation =
        Vector3<N>(r * point.axes(0, 0), r * point.axes(1, 0), r * point.axes(2, 0));
    motion.V.value = {u, Vector3<N>(dr, r * u[2], -(r * u[1]))};
    motion.dV.value = {du, Vector3<N>(ddr, dr * u[2] + r * du[2], -(dr * u[1]) - r * du[1])};
    return motion;
  }

  Orbit<S> orbit_;
};

/// The axes of an orbit relative to the frame that moves with the orbit's origin without rotation.
/// Attitude and angular velocity are those of OrbitFrame; the origin is at rest.
///
/// Motions near the origin keep their digits, because no forces as large as gravity act there. The
/// gravitation for this guide is OrbitGravitation.
///
/// Units  : rad/s, rad/s^2, second
template <class G = Guide, class I = Inertial, class S = double>
class OrbitAxes {
 public:
  explicit OrbitAxes(const OrbitElements<S>& elements) : orbit_(elements) {}

  [[nodiscard]] FrameMotion<G, I, S> operator()(const S& t) const { return at<S>(t); }
  template <class N>
  requires(detail::is_other_number<N, S>) [[nodiscard]] FrameMotion<G, I, N> operator()(
      const N& t) const {
    return at<N>(t);
  }

 private:
  template <class N>
  [[nodiscard]] FrameMotion<G, I, N> at(const N& t) const {
    const OrbitPoint<N> point = orbit_.at(t);
    FrameMotion<G, I, N> motion;
    motion.X.value.rotation = point.axes;
    motion.V.value.resultant = point.u;
    motion.dV.value.resultant = point.du;
    return motion;
  }

  Orbit<S> orbit_;
};

}  // namespace kreisel
