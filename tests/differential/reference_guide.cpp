#include "reference_guide.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "reference_numbers.hpp"

namespace differential::reference {

namespace {

constexpr Real pi = 3.14159265358979323846264338327950288L;

struct Oscillation {
  Vec value;
  Vec rate;
};

Oscillation at(const Series& s, Real t, bool degrees = false) {
  Oscillation sum{wide(radian(s.constant, degrees)), Vec::Zero()};
  for (const Series::Term& term : s.terms) {
    const auto w = Real(term.frequency.radian());
    const Real angle = w * t + Real(term.phase.radian());
    const Vec amplitude = wide(radian(term.amplitude, degrees));
    sum.value += std::sin(angle) * amplitude;
    sum.rate += w * std::cos(angle) * amplitude;
  }
  return sum;
}

/// The numbers of a link in the state.
Eigen::Index state_size(const Link& link) {
  if (link.kind == LinkKind::course) return 5;
  return link.kind == LinkKind::rotating || link.kind == LinkKind::harmonic ? 10 : 0;
}

/// Sine and cosine of degrees, exact at multiples of 90.
std::pair<Real, Real> sine_cosine(double degrees) {
  const Real quarter = std::round(Real(degrees) / 90);
  const Real rest = (Real(degrees) - 90 * quarter) * (pi / 180);
  Real s = std::sin(rest);
  Real c = std::cos(rest);
  for (int i = (static_cast<int>(quarter) % 4 + 4) % 4; i > 0; --i) {
    const Real old = s;
    s = c;
    c = -old;
  }
  return {s, c};
}

Real rate_of(const Link& link) { return link.rate ? Real(link.rate->radian()) : earth_rate; }

bool has_number(const Link& link) { return !link.gravity.empty() && link.gravity.front() != '"'; }

/// Axes of the guide on axes of the earth, z to the pole and x in the meridian. The plumb line is
/// turned by `tilt` from the normal at the latitude.
Mat site_axes(const Link& link, Real tilt) {
  const auto [sl, cl] = sine_cosine(link.latitude);
  const auto [sa, ca] = sine_cosine(link.azimuth);
  const Vec up0(cl, 0, sl);
  const Vec north0(-sl, 0, cl);
  const Vec down = std::sin(tilt) * north0 - std::cos(tilt) * up0;
  const Vec north = std::cos(tilt) * north0 + std::sin(tilt) * up0;
  const Vec east(0, 1, 0);
  Mat axes;
  axes.col(0) = down;
  axes.col(2) = ca * north + sa * east;
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Motion earth(const Link& link, Real t) {
  const Real u = rate_of(link);
  Motion motion;
  if (has_number(link)) {
    // The guide's own axes at t = 0 are the inertial ones; the origin rests.
    const Mat axes = site_axes(link, 0);
    const Vec w = axes.transpose() * Vec(0, 0, u);
    motion.w = w;
    if (u != 0) {
      motion.R = Eigen::AngleAxis<Real>(w.norm() * t, w.normalized()).toRotationMatrix();
    }
    return motion;
  }
  const auto [sl, cl] = sine_cosine(link.latitude);
  const Real e2 = flattening * (2 - flattening);
  const Real n = equator / std::sqrt(1 - e2 * sl * sl);
  const auto h = Real(link.height);
  const Vec place((n + h) * cl, 0, (n * (1 - e2) + h) * sl);
  const Vec effective = ellipsoid_gravitation(place) + Vec(u * u * place.x(), 0, 0);
  const Vec up(cl, 0, sl);
  const Vec north(-sl, 0, cl);
  const Real tilt = std::atan2(effective.dot(north), -effective.dot(up));
  const Mat turn = Eigen::AngleAxis<Real>(u * t, Vec::UnitZ()).toRotationMatrix();
  motion.R = turn * site_axes(link, tilt);
  motion.w = Vec(0, 0, u);
  motion.x = turn * place;
  motion.v = motion.w.cross(motion.x);
  motion.a = motion.w.cross(motion.v);
  return motion;
}

/// About an axis on inertial axes, after the rotation `from`.
Motion logged(const Log& log, Real t) {
  const auto f = Real(log.frequency);
  const Real angle = f * t + Real(log.phase);
  const Real s = std::sin(angle);
  const Real ds = f * std::cos(angle);
  const Real dds = -f * f * s;
  const Mat from = unit_quaternion(log.from).toRotationMatrix();
  const Vec axis = from * wide(log.axis).normalized();
  const auto A = Real(log.amplitude);
  return {Eigen::AngleAxis<Real>(A * s, axis).toRotationMatrix() * from,
          A * ds * axis,
          A * dds * axis,
          s * wide(log.shift),
          ds * wide(log.shift),
          dds * wide(log.shift)};
}

/// Rotations about z, then the new y, then the new x.
Motion moved(const Link& link, Real t) {
  const Course position = course_of(link.position, t, t);
  Motion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    const Course angle = course_of(link.angles[i], t, t);
    const Vec axis = motion.R * Vec::Unit(2 - static_cast<int>(i));
    const Vec rate = angle.rate.x() * axis;
    motion.dw += angle.second_rate.x() * axis + motion.w.cross(rate);
    motion.w += rate;
    motion.R = Eigen::AngleAxis<Real>(angle.value.x(), axis).toRotationMatrix() * motion.R;
  }
  motion.x = position.value;
  motion.v = position.rate;
  motion.a = position.second_rate;
  return motion;
}

constexpr Real earth_gm = 3.986004418e14L;
constexpr Real earth_j2 = 1.08262982131e-3L;

/// The eccentric anomaly by bisection.
Real eccentric_anomaly(Real M, Real e) {
  Real low = M - e;
  Real high = M + e;
  for (int i = 0; i < 80; ++i) {
    const Real middle = (low + high) / 2;
    (middle - e * std::sin(middle) < M ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// Kepler's motion in the plane of the orbit, x to the perigee, with axes along radius and normal.
Motion in_plane(const Orbit& o, Real n, Real t) {
  const Real e = o.eccentricity;
  const Real a = o.semi_major_axis;
  const Real b = a * std::sqrt(1 - e * e);
  const Real f = o.anomaly.radian();
  const Real start = std::atan2(std::sqrt(1 - e * e) * std::sin(f), e + std::cos(f));
  const Real E = eccentric_anomaly(start - e * std::sin(start) + n * t, e);
  const Vec x(a * (std::cos(E) - e), b * std::sin(E), 0);
  const Real r = x.norm();
  const Real rate = n * a / r;
  const Vec v(-a * std::sin(E) * rate, b * std::cos(E) * rate, 0);
  const Vec out = x / r;
  const Vec h = x.cross(v);
  Motion motion;
  motion.R << out, Vec::UnitZ().cross(out), Vec::UnitZ();
  motion.w = h / (r * r);
  motion.dw = -2 * x.dot(v) / (r * r) * motion.w;
  motion.x = x;
  motion.v = v;
  motion.a = -earth_gm / (r * r * r) * x;
  return motion;
}

/// Gravitation of a planet from its centre.
Vec planet_gravitation(const Vec& p, const Vec& pole, bool oblate) {
  const Real r = p.norm();
  const Real s = p.dot(pole) / r;
  const Real k = oblate ? Real(1.5) * earth_j2 * (equator / r) * (equator / r) : 0;
  return -earth_gm / (r * r) * ((1 + k * (1 - 5 * s * s)) * p / r + 2 * k * s * pole);
}

/// Node, inclination and perigee turn one after the other.
Motion along_orbit(const Orbit& o, Real t) {
  const Real a = o.semi_major_axis;
  const Real n = std::sqrt(earth_gm / (a * a * a));
  const Real p = a * (1 - Real(o.eccentricity) * o.eccentricity);
  const Real k = o.j2 ? n * earth_j2 * (equator / p) * (equator / p) : 0;
  const Real c = std::cos(Real(o.inclination.radian()));
  const Real node = Real(-1.5) * k * c;
  const Real perigee = Real(0.75) * k * (5 * c * c - 1);
  const Motion plane = on(turning(Vec::UnitZ(), o.node.radian() + node * t, node),
                          turning(Vec::UnitX(), o.inclination.radian(), 0));
  const Motion apse = on(plane, turning(Vec::UnitZ(), o.perigee.radian() + perigee * t, perigee));
  return on(apse, in_plane(o, n, t));
}

}  // namespace

Motion turning(const Vec& axis, Real angle, Real rate, Real rate_of_rate) {
  return {Eigen::AngleAxis<Real>(angle, axis).toRotationMatrix(), rate * axis, rate_of_rate * axis};
}

Motion on(const Motion& base, const Motion& own) {
  const Vec x = base.R * own.x;
  const Vec v = base.R * own.v;
  const Vec w = base.R * own.w;
  Motion sum;
  sum.R = base.R * own.R;
  sum.w = base.w + w;
  sum.dw = base.dw + base.R * own.dw + base.w.cross(w);
  sum.x = base.x + x;
  sum.v = base.v + base.w.cross(x) + v;
  sum.a = base.a + base.dw.cross(x) + base.w.cross(base.w.cross(x)) + 2 * base.w.cross(v) +
          base.R * own.a;
  sum.down = base.down + base.R * own.down;
  return sum;
}

Course course_of(const Signal& signal, Real t, Real within) {
  Course sum;
  const Jumps& jumps = signal.jumps;
  for (std::size_t i = 0; i < jumps.times.size(); ++i) {
    const Real begin(jumps.times[i]);
    if (within < begin) {
      if (i == 0 && jumps.is_broken_line) sum.value = wide(jumps.values[0]);
      break;
    }
    sum.value = wide(jumps.values[i]);
    sum.rate.setZero();
    if (!jumps.is_broken_line || i + 1 == jumps.times.size()) continue;
    sum.rate = (wide(jumps.values[i + 1]) - sum.value) / (Real(jumps.times[i + 1]) - begin);
    sum.value += (t - begin) * sum.rate;
  }
  sum.value += wide(signal.series.constant) + t * wide(signal.rate);
  sum.rate += wide(signal.rate);
  for (const Series::Term& term : signal.series.terms) {
    const auto w = Real(term.frequency.radian());
    const Real angle = w * t + Real(term.phase.radian());
    sum.value += std::sin(angle) * wide(term.amplitude);
    sum.rate += w * std::cos(angle) * wide(term.amplitude);
    sum.second_rate -= w * w * std::sin(angle) * wide(term.amplitude);
    sum.third_rate -= w * w * w * std::cos(angle) * wide(term.amplitude);
  }
  return sum;
}

Quat unit_quaternion(const std::optional<Eigen::Vector4d>& q) {
  if (!q) return Quat::Identity();
  const Eigen::Quaterniond unit =
      Eigen::Quaterniond((*q)[0], (*q)[1], (*q)[2], (*q)[3]).normalized();
  return unit.cast<Real>().normalized();
}

Vec ellipsoid_gravitation(const Vec& place) {
  constexpr Real gm = 3.986004418e14L;
  constexpr Real rate = 7.292115e-5L;
  const Real b = equator * (1 - flattening);
  const Real E = std::sqrt(equator * equator - b * b);
  const auto q_of = [E](Real u) {
    return ((1 + 3 * u * u / (E * E)) * std::atan(E / u) - 3 * u / E) / 2;
  };
  const Real rho = std::hypot(place.x(), place.y());
  const Real d = place.squaredNorm() - E * E;
  const Real u = std::sqrt((d + std::sqrt(d * d + 4 * E * E * place.z() * place.z())) / 2);
  const Real v = std::sqrt(u * u + E * E);
  const Real sin_beta = place.z() / u;
  const Real cos_beta = rho / v;
  const Real w = std::sqrt((u * u + E * E * sin_beta * sin_beta) / (v * v));
  const Real q = q_of(u);
  const Real q0 = q_of(b);
  const Real dq = 3 * (1 + u * u / (E * E)) * (1 - u / E * std::atan(E / u)) - 1;
  const Real spin = rate * rate * equator * equator;
  const Real along_u =
      -(gm / (v * v) + spin * E / (v * v) * dq / q0 * (sin_beta * sin_beta / 2 - 1 / Real(6))) / w;
  const Real along_beta = spin / v * q / q0 * sin_beta * cos_beta / w;
  const Real outwards = (along_u * u / v * cos_beta - along_beta * sin_beta) / w;
  const Real poleward = (along_u * sin_beta + along_beta * u / v * cos_beta) / w;
  const Real x = rho > 0 ? place.x() / rho : 1;
  const Real y = rho > 0 ? place.y() / rho : 0;
  return {outwards * x, outwards * y, poleward};
}

Guide::Guide(const Scene& scene) : scene_(scene) {
  for (const Link& link : scene.guide) size_ += state_size(link);
}

void Guide::start(State& y) const {
  Eigen::Index begin = 0;
  for (const Link& link : scene_.guide) {
    if (state_size(link) == 0) continue;
    if (link.kind == LinkKind::course) {
      const Vehicle& vehicle = link.vehicle;
      y.segment<5>(begin) << Real(vehicle.latitude.radian()), Real(vehicle.longitude.radian()),
          Real(vehicle.heading.radian()), Real(vehicle.height), Real(vehicle.speed);
      begin += 5;
      continue;
    }
    y.segment<4>(begin) = unit_quaternion(link.attitude).coeffs();
    y.segment<3>(begin + 4) = wide(link.origin_position);
    y.segment<3>(begin + 7) = wide(link.origin_velocity);
    begin += 10;
  }
}

Motion Guide::own(const Link& link, Real t, const Real* y, Real* rates) const {
  if (link.kind == LinkKind::earth) return earth(link, t);
  if (link.is_logged()) return logged(link.log, t);
  if (link.kind == LinkKind::motion) return moved(link, t);
  if (link.kind == LinkKind::inertial) return {};
  if (link.kind == LinkKind::orbit) return along_orbit(link.orbit, t);
  if (link.kind == LinkKind::course) return along_course(link, t, within_, y, rates);
  const Oscillation u =
      link.kind == LinkKind::harmonic
          ? differential::reference::at(link.turning, t, link.turns_in_degrees)
          : Oscillation{wide(radian(link.angular_velocity, link.turns_in_degrees)), Vec::Zero()};
  const Vec push = link.kind == LinkKind::harmonic
                       ? differential::reference::at(link.pushing, t).value
                       : wide(link.origin_acceleration);
  const Quat q(y[3], y[0], y[1], y[2]);
  const Mat R = q.normalized().toRotationMatrix();
  const Vec v(y[7], y[8], y[9]);
  Motion motion{R, R * u.value, R * u.rate, Vec(y[4], y[5], y[6]), v, R * push};
  const Quat dq = q * Quat(0, u.value.x() / 2, u.value.y() / 2, u.value.z() / 2);
  for (int i = 0; i < 4; ++i) rates[i] = dq.coeffs()[i];
  for (int i = 0; i < 3; ++i) {
    rates[4 + i] = v[i];
    rates[7 + i] = motion.a[i];
  }
  return motion;
}

Motion Guide::at(Real t, const State& y, State& rates) const {
  Motion whole;
  Eigen::Index begin = 0;
  for (const Link& link : scene_.guide) {
    whole = on(whole, own(link, t, y.data() + begin, rates.data() + begin));
    begin += state_size(link);
  }
  return whole;
}

void Guide::project(State& y) const {
  Eigen::Index begin = 0;
  for (const Link& link : scene_.guide) {
    if (state_size(link) == 10) y.segment<4>(begin).normalize();
    begin += state_size(link);
  }
}

bool Guide::has_gradient() const {
  const bool planet = scene_.gravity == GravityKind::point || scene_.gravity == GravityKind::j2;
  if (scene_.gravity == GravityKind::orbit) return scene_.gradient.value_or(true);
  return planet && scene_.gradient.value_or(false);
}

Real Guide::depth(const Motion& motion, const Vec& place) const {
  const bool planet = scene_.gravity == GravityKind::point || scene_.gravity == GravityKind::j2;
  return planet ? (motion.x + place - wide(scene_.gravity_vector)).norm() : place.norm();
}

Vec Guide::gravity(Real t, const Motion& motion, const Vec& place) const {
  const Vec given = wide(scene_.gravity_vector);
  const bool on_course = !scene_.guide.empty() && scene_.guide.front().kind == LinkKind::course;
  const bool on_earth =
      on_course || (!scene_.guide.empty() && scene_.guide.front().kind == LinkKind::earth);
  switch (scene_.gravity) {
    case GravityKind::none: return Vec::Zero();
    case GravityKind::uniform: return motion.R * given;
    case GravityKind::inertial: return given;
    case GravityKind::earth: return ellipsoid_gravitation(motion.x + place);
    case GravityKind::earth_j2: return planet_gravitation(motion.x + place, Vec::UnitZ(), true);
    case GravityKind::point:
    case GravityKind::j2:
      return planet_gravitation(motion.x + place - given, wide(scene_.pole).normalized(),
                                scene_.gravity == GravityKind::j2);
    case GravityKind::orbit:
      return planet_gravitation(motion.x + place, Vec::UnitZ(), scene_.guide.front().orbit.j2);
    case GravityKind::not_given: break;
  }
  if (!on_earth) return Vec::Zero();
  const Link& site = scene_.guide.front();
  if (site.gravity == "\"normal\"") return ellipsoid_gravitation(motion.x + place);
  if (!has_number(site)) return Vec::Zero();
  const Vec down(std::stold(site.gravity), 0, 0);
  if (!on_course) return earth(site, t).R * down;
  // The number includes the centrifugal acceleration, which the motion has too.
  return down.x() * motion.down - earth_rate * earth_rate * Vec(motion.x.x(), motion.x.y(), 0);
}

}  // namespace differential::reference
