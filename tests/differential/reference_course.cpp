#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "jet.hpp"
#include "reference_guide.hpp"

/// Vehicles over the earth.

namespace differential::reference {

namespace {

struct Turn {
  Real angle;
  Real rate;
  Real second_rate;
};

Turn given_bank(const Signal& bank, Real t, Real within) {
  const Course course = course_of(bank, t, within);
  return {course.value.x(), course.rate.x(), course.second_rate.x()};
}

Jet jet_of(const Signal& signal, Real t, Real within) {
  const Course c = course_of(signal, t, within);
  return Jet({c.value.x(), c.rate.x(), c.second_rate.x() / 2, c.third_rate.x() / 6});
}

/// Latitude, heading, height and speed of a vehicle, and their rates.
struct Way {
  Jet lat, heading, h, v;
  Jet dlat, dlon, dheading;
};

/// Each round gives one order more.
Way way_of(const Vehicle& vehicle, Real t, Real within, const Real* y) {
  const Jet turn = jet_of(vehicle.turn_rate, t, within);
  const Jet climb = jet_of(vehicle.climb, t, within);
  const Jet acceleration = jet_of(vehicle.acceleration, t, within);
  const Real e2 = flattening * (2 - flattening);
  Way way{y[0], y[2], y[3], y[4], 0, 0, 0};
  const auto integrate = [](Jet& x, const Jet& rate) {
    for (std::size_t k = 1; k < Jet::size; ++k) x[k] = rate[k - 1] / Real(k);
  };
  integrate(way.h, climb);
  integrate(way.v, acceleration);
  for (std::size_t round = 0; round < Jet::size; ++round) {
    const Jet s = sin(way.lat);
    const Jet w = Jet(1) - Jet(e2) * s * s;
    const Jet N = Jet(equator) / sqrt(w);
    way.dlat = way.v * cos(way.heading) / (N * Jet(1 - e2) / w + way.h);
    way.dlon = way.v * sin(way.heading) / ((N + way.h) * cos(way.lat));
    way.dheading = turn + way.dlon * s;
    integrate(way.lat, way.dlat);
    integrate(way.heading, way.dheading);
  }
  return way;
}

/// Gravity of the rotating ellipsoid to the north and upwards.
std::array<Real, 2> normal_gravity(Real lat, Real h) {
  const Real e2 = flattening * (2 - flattening);
  const Real s = std::sin(lat), c = std::cos(lat);
  const Real N = equator / std::sqrt(1 - e2 * s * s);
  const Vec place((N + h) * c, 0, (N * (1 - e2) + h) * s);
  const Vec g = ellipsoid_gravitation(place) + earth_rate * earth_rate * Vec(place.x(), 0, 0);
  return {g.dot(Vec(-s, 0, c)), g.dot(Vec(c, 0, s))};
}

/// The same along the way. Differences suffice, because latitude and height change slowly.
std::array<Jet, 2> gravity_along(const Way& way) {
  constexpr Real a = 1e-3L, b = 10;
  const auto at = [&](int i, int k) {
    return normal_gravity(way.lat[0] + Real(i) * a, way.h[0] + Real(k) * b);
  };
  const Jet x = (way.lat - Jet(way.lat[0])) / Jet(a);
  const Jet z = (way.h - Jet(way.h[0])) / Jet(b);
  const auto mid = at(0, 0), up = at(0, 1), low = at(0, -1);
  const std::array<std::array<Real, 2>, 4> along{at(-2, 0), at(-1, 0), at(1, 0), at(2, 0)};
  std::array<Jet, 2> g;
  for (std::size_t i = 0; i < 2; ++i) {
    const Real first = (8 * (along[2][i] - along[1][i]) - (along[3][i] - along[0][i])) / 12;
    const Real second = along[2][i] + along[1][i] - 2 * mid[i];
    const Real mixed = (at(1, 1)[i] - at(1, -1)[i] - at(-1, 1)[i] + at(-1, -1)[i]) / 4;
    const Real by_height = (up[i] - low[i]) / 2, twice = up[i] + low[i] - 2 * mid[i];
    g[i] = Jet(mid[i]) + x * (Jet(first) + x * Jet(second / 2) + z * Jet(mixed)) +
           z * (Jet(by_height) + z * Jet(twice / 2));
  }
  return g;
}

/// The bank in which apparent gravity has no lateral component. The accelerations are those of
/// inertial navigation, to the north, to the east and upwards:
///
///   f_N = v_N' + v_E (lon' + 2u) sin(lat) + lat' h'
///   f_E = v_E' - (lon' + 2u) (v_N sin(lat) - h' cos(lat))
///   f_U = h'' - v_E (lon' + 2u) cos(lat) - v_N lat'
Turn coordinated_bank(const Link& link, Real t, Real within, const Real* y) {
  const Way way = way_of(link.vehicle, t, within, y);
  const Jet climb = jet_of(link.vehicle.climb, t, within);
  const Jet s = sin(way.lat), c = cos(way.lat);
  const Jet ahead_n = cos(way.heading), ahead_e = sin(way.heading);
  const Jet north = way.v * ahead_n, east = way.v * ahead_e;
  const Jet turn = way.dlon + Jet(2 * earth_rate);
  const bool has_number = !link.gravity.empty() && link.gravity.front() != '"';
  const auto g = has_number ? std::array<Jet, 2>{0, -std::stold(link.gravity)} : gravity_along(way);
  const Jet to_north = g[0] - north.rate() - east * turn * s - way.dlat * climb;
  const Jet to_east = turn * (north * s - climb * c) - east.rate();
  const Jet upwards = g[1] - climb.rate() + east * turn * c + north * way.dlat;
  const Jet left = ahead_e * to_north - ahead_n * to_east;
  const Jet down = Jet(0) - upwards;
  const Jet rate = (down * left.rate() - left * down.rate()) / (down * down + left * left);
  return {std::atan2(left[0], down[0]), rate[0], rate[1]};
}

}  // namespace

// By the rates of latitude, longitude and heading:
//
//   lat' = v cos(hdg)/(M + h),   lon' = v sin(hdg)/((N + h) cos(lat)),
//   hdg' = turn_rate + lon' sin(lat)
Motion along_course(const Link& link, Real t, Real within, const Real* y, Real* rates) {
  const Vehicle& vehicle = link.vehicle;
  const Real lat = y[0], heading = y[2], h = y[3], v = y[4];
  const Course turn = course_of(vehicle.turn_rate, t, within);
  const Course climb = course_of(vehicle.climb, t, within);
  const Real dv = course_of(vehicle.acceleration, t, within).value.x();
  const Real dh = climb.value.x();
  const Real e2 = flattening * (2 - flattening);
  const Real s = std::sin(lat), c = std::cos(lat);
  const Real w = 1 - e2 * s * s;
  const Real N = equator / std::sqrt(w);
  const Real M = N * (1 - e2) / w;
  const Real north = v * std::cos(heading), east = v * std::sin(heading);
  const Real dlat = north / (M + h);
  const Real dlon = east / ((N + h) * c);
  const Real dheading = turn.value.x() + dlon * s;
  const Real numbers[] = {dlat, dlon, dheading, dh, dv};
  std::copy(std::begin(numbers), std::end(numbers), rates);

  const Real dnorth = dv * std::cos(heading) - east * dheading;
  const Real deast = dv * std::sin(heading) + north * dheading;
  const Real dN = N * e2 * s * c * dlat / w;
  const Real dM = 3 * M * e2 * s * c * dlat / w;
  const Real ddlat = (dnorth - dlat * (dM + dh)) / (M + h);
  const Real ddlon = (deast - dlon * ((dN + dh) * c - (N + h) * s * dlat)) / ((N + h) * c);
  const Real ddheading = turn.rate.x() + ddlon * s + dlon * c * dlat;

  // x up, y east, z north
  Motion place =
      on(turning(Vec::UnitZ(), y[1], dlon, ddlon), turning(-Vec::UnitY(), lat, dlat, ddlat));
  place.x = place.R * Vec((N + h) - N * e2 * s * s, 0, -N * e2 * s * c);
  place.v = place.R * Vec(dh, east, north);
  place.a = place.R * Vec(climb.rate.x(), deast, dnorth) + place.w.cross(place.v);
  Motion level;  // x down, y west, z north
  level.R = Vec(-1, -1, 1).asDiagonal();
  level.down = -Vec::UnitX();  // of the local axes
  const Turn bank = vehicle.is_coordinated ? coordinated_bank(link, t, within, y)
                                           : given_bank(vehicle.bank, t, within);
  const Motion banked = turning(Vec::UnitZ(), bank.angle, bank.rate, bank.second_rate);
  const Motion headed = on(place, turning(Vec::UnitX(), -heading, -dheading, -ddheading));
  return on(turning(Vec::UnitZ(), earth_rate * t, earth_rate), on(on(headed, level), banked));
}

}  // namespace differential::reference
