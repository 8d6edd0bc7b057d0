#include <cmath>

#include "generate_parts.hpp"

namespace differential {

namespace {

Link moving(Random& r) {
  Link link{.kind = LinkKind::motion};
  const double size = r.pick({0.1, 1.0});
  if (r.chance(0.7)) link.position = smooth_signal(r, size, [&r] { return direction(r); });
  for (Signal& angle : link.angles) {
    if (r.chance(0.4)) continue;
    angle = smooth_signal(r, 0.2, [&r] { return Vector(sign(r) * Vector::UnitX()); });
  }
  return link;
}

/// The start of a frame that is given by its rates.
void add_frame_start(Random& r, Link& link) {
  if (r.chance(0.75)) return;
  if (r.chance(0.7)) link.attitude = attitude(r);
  if (r.chance(0.3)) link.origin_position = vector(r, 0.1, 10);
  if (r.chance(0.5)) link.origin_velocity = vector(r, 0.1, 10);
}

Link rotating(Random& r) {
  Link link{.kind = LinkKind::rotating};
  link.turns_in_degrees = r.chance(0.15);
  link.angular_velocity = link.turns_in_degrees ? Vector(vector(r, 1, 100)) : vector(r, 0.01, 30);
  add_frame_start(r, link);
  if (r.chance(0.3)) link.origin_acceleration = vector(r, 0.1, 20);
  return link;
}

Link harmonic(Random& r) {
  Link link{.kind = LinkKind::harmonic};
  const double frequency = plain(r, 0.1, 10);
  const bool turns = r.chance(0.8);
  link.turns_in_degrees = turns && r.chance(0.15);
  const double size = r.pick({0.1, 0.157, 1.0});
  if (turns) link.turning = series(r, link.turns_in_degrees ? 50 * size : size, frequency);
  add_frame_start(r, link);
  if (!turns || r.chance(0.3)) link.pushing = series(r, 1, frequency);
  return link;
}

/// The header and the columns.
void spell_columns(Random& r, Spelling& how, bool of_rates) {
  how.header = r.pick(
      {LogHeader::usual, LogHeader::usual, LogHeader::named, LogHeader::numbered, LogHeader::none});
  how.header_is_comment = how.header != LogHeader::none && r.chance(0.3);
  if (how.header != LogHeader::none && r.chance(0.2)) how.lines_after = r.pick({1, 2});
  how.lines_before = r.pick({0, 0, 1, 3});
  how.columns_reversed = r.chance(0.4);
  how.has_other_column = r.chance(0.2);
  how.has_angles = !of_rates && r.chance(0.3);
  how.in_degrees = (of_rates || how.has_angles) && r.chance(0.4);
}

/// The time; whole nanoseconds since 1970 now and then.
void spell_time(Random& r, Spelling& how) {
  how.time_unit = r.pick<std::string>({"s", "ms", "us", "ns"});
  if (r.chance(0.4)) how.time_zero = r.chance(0.5) ? 1'311'868'163'869'712'345 : 100'000'000'000;
  how.begins_at_zero = r.chance(0.2);
  how.has_window = r.chance(0.2) && !how.begins_at_zero;
  if (r.chance(0.2)) {
    how.longest_gap = r.chance(0.5) ? "\"any\"" : "1";
  }
  if (r.chance(0.2)) how.duplicates = r.pick<std::string>({"first", "last", "mean"});
}

/// Another spelling of a log than the plainest.
void spell(Random& r, Log& log, bool of_rates) {
  Spelling& how = log.spelling;
  how.separator = r.pick({',', ';', '\t', ' '});
  how.says_separator = r.chance(0.3);
  how.decimal_comma = how.separator != ',' && r.chance(0.5);
  how.ends_with_cr = r.chance(0.3);
  spell_columns(r, how, of_rates);
  spell_time(r, how);
  if (r.chance(0.2)) how.sigma = r.pick<std::string>({"0", "[0, 0]", "1e-12", "[1e-12, 1e-11]"});
}

Link logged(Random& r, LinkKind kind) {
  Link link{.kind = kind};
  link.log.axis = unit(r);
  link.log.amplitude = r.pick({0.05, 0.1, 0.2});
  link.log.frequency = plain(r, 0.3, 3);
  link.log.phase = phase(r).radian();
  if (r.chance(0.5)) link.log.shift = vector(r, 0.1, 2);
  link.log.step = 0.01 / link.log.frequency;
  if (r.chance(0.5)) spell(r, link.log, kind == LinkKind::rates);
  // Angles describe any attitude except near gimbal lock.
  if (!link.log.spelling.has_angles && r.chance(0.3)) link.log.from = attitude(r);
  return link;
}

Link rates(Random& r) {
  Link link = logged(r, LinkKind::rates);
  link.log.is_kinematic = r.chance(0.3);
  return link;
}

Link orbit(Random& r) {
  Link link{.kind = LinkKind::orbit};
  const auto element = [&r] { return r.chance(0.4) ? Angle{} : angle(r); };
  link.orbit = {.semi_major_axis = r.pick({7e6, 8.5e6, 4.2164e7}),
                .eccentricity = r.chance(0.4) ? 0 : rounded(r.between(0, 0.3), 3),
                .inclination = element(),
                .node = element(),
                .perigee = element(),
                .anomaly = element(),
                .j2 = r.chance(0.3)};
  return link;
}

/// Limits the vertical acceleration to half of gravity's: in free fall no bank is coordinated.
void limit_acceleration(Signal& climb) {
  double most = 0;
  for (const Series::Term& term : climb.series.terms) {
    most += std::abs(term.amplitude.x() * term.frequency.radian());
  }
  for (Series::Term& term : climb.series.terms) term.amplitude *= 5 / std::max(most, 5.0);
}

/// Banks a vehicle without lateral apparent gravity. Its turn and climb are smooth then.
void coordinate(Random& r, Vehicle& vehicle) {
  const auto along = [&r] { return Vector(sign(r) * Vector::UnitX()); };
  vehicle.is_coordinated = true;
  vehicle.bank = {};
  if (!vehicle.turn_rate.empty()) vehicle.turn_rate = smooth_signal(r, 0.1, along);
  if (!vehicle.climb.empty()) {
    vehicle.climb = smooth_signal(r, 1, along);
    limit_acceleration(vehicle.climb);
  }
  Jumps& jumps = vehicle.acceleration.jumps;
  jumps.is_broken_line = jumps.is_broken_line || !jumps.times.empty();
}

/// A ship or an aircraft, away from the poles, where the reference has singular angles.
Link course(Random& r) {
  Link link{.kind = LinkKind::course};
  const auto along = [&r] { return Vector(sign(r) * Vector::UnitX()); };
  const auto in_steps = [&r, &along](double size, bool is_line) {
    Signal s = any_signal(r, size, along);
    s.jumps.is_broken_line = s.jumps.is_broken_line || is_line;
    return s;
  };
  Vehicle& vehicle = link.vehicle;
  vehicle.latitude = r.chance(0.5) ? Angle{r.pick({0.0, 30.0, 50.0, -70.0}), true}
                                   : Angle{rounded(r.between(-1.2, 1.2), 3)};
  if (r.chance(0.4)) vehicle.longitude = angle(r);
  vehicle.heading = r.chance(0.6) ? Angle{90.0 * r.below(4), true} : angle(r);
  vehicle.height = r.pick({0.0, 0.0, 100.0, 10000.0});
  vehicle.speed = r.pick({0.0, 10.0, 10.0, 250.0, -5.0});
  if (r.chance(0.5)) vehicle.turn_rate = in_steps(r.pick({0.01, 0.1}), true);
  if (r.chance(0.4)) vehicle.acceleration = in_steps(0.5, false);
  if (r.chance(0.3)) vehicle.climb = in_steps(1, true);
  if (r.chance(0.3)) vehicle.bank = smooth_signal(r, 0.2, along);
  if (r.chance(0.3)) coordinate(r, vehicle);
  link.gravity = r.pick<const char*>({"\"normal\"", "\"normal\"", "9.81", "\"none\"", ""});
  return link;
}

Link any_link(Random& r, bool first) {
  if (first && r.chance(0.1)) return course(r);
  if (first && r.chance(0.08)) return orbit(r);
  const double u = r.uniform();
  if (u < 0.25) return rotating(r);
  if (u < 0.45) return harmonic(r);
  if (u < 0.55) return moving(r);
  if (u < 0.75 && first) return earth(r);
  if (u < 0.83) return logged(r, LinkKind::table);
  if (u < 0.9 && first) return rates(r);
  return u < 0.93 ? Link{} : rotating(r);
}

/// A planet some earth's radii away.
void add_planet(Random& r, Scene& scene) {
  scene.gravity = r.chance(0.5) ? GravityKind::point : GravityKind::j2;
  scene.gravity_vector = r.pick({6.4e6, 7e6, 2e7}) * direction(r);
  scene.pole = direction(r);
  if (r.chance(0.7)) scene.gradient = r.chance(0.7);
}

}  // namespace

Link earth(Random& r) {
  Link link{.kind = LinkKind::earth};
  link.latitude =
      r.chance(0.5) ? r.pick({0.0, 30.0, 45.0, 50.0, 90.0, -90.0}) : rounded(r.between(-90, 90), 3);
  link.azimuth = r.chance(0.7) ? 90.0 * r.below(4) : rounded(r.between(0, 360), 3);
  link.height = r.chance(0.7) ? 0 : r.pick({100.0, 1000.0, 10000.0});
  if (r.chance(0.15)) {
    link.rate = r.pick<Angle>({{0}, {1e-4}, {1e-3}, {0.00417807, true}, {0.01, true}});
  }
  link.gravity = r.pick<const char*>({"\"normal\"", "\"normal\"", "9.81", "\"none\"", ""});
  return link;
}

void add_guide(Random& r, Scene& scene) {
  if (r.chance(0.3)) return;
  scene.guide.push_back(any_link(r, true));
  while (scene.guide.size() < 3 && r.chance(0.15)) scene.guide.push_back(any_link(r, false));
  scene.chain_in_chain = scene.guide.size() > 1 && r.chance(0.3);
}

void add_gravity_of_log(Random& r, Scene& scene) {
  if (scene.guide.empty() || scene.guide.front().kind != LinkKind::rates) return;
  Log& log = scene.guide.front().log;
  if (log.is_kinematic) return;
  log.says_gravity =
      !log.shift.isZero(0) && (scene.gravity != GravityKind::inertial || r.chance(0.3));
  log.gravity = log.says_gravity ? Vector(9.81 * direction(r)) : scene.gravity_vector;
}

void add_gravity(Random& r, Scene& scene) {
  if (!scene.guide.empty() && scene.guide.front().kind == LinkKind::orbit && r.chance(0.8)) {
    scene.gravity = GravityKind::orbit;
    if (r.chance(0.4)) scene.gradient = r.chance(0.5);
    return;
  }
  const bool on_earth = !scene.guide.empty() && (scene.guide.front().kind == LinkKind::earth ||
                                                 scene.guide.front().kind == LinkKind::course);
  if (on_earth) {
    if (scene.guide.front().gravity == "\"none\"" && r.chance(0.5)) {
      scene.gravity = r.chance(0.7) ? GravityKind::earth : GravityKind::earth_j2;
    }
    return;
  }
  if (r.chance(0.3)) return;
  const bool of_log = !scene.guide.empty() && scene.guide.front().kind == LinkKind::rates;
  if (!of_log && r.chance(0.1)) return add_planet(r, scene);
  scene.gravity = r.chance(0.1)   ? GravityKind::none
                  : r.chance(0.5) ? GravityKind::uniform
                                  : GravityKind::inertial;
  scene.gravity_vector = r.pick({1.0, 9.81, 9.81, 9.81}) * direction(r);
}

}  // namespace differential
