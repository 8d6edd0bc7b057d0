#include "generate.hpp"

#include <algorithm>
#include <cmath>

#include "reference.hpp"
#include "reference_guide.hpp"

namespace differential {

namespace {

/// Rounded to a number of digits, as typed.
double rounded(double x, int digits) {
  if (x == 0) return 0;
  const double unit = std::pow(10, std::floor(std::log10(std::abs(x))) - digits + 1);
  const double scaled = std::round(x / unit);
  return unit < 1 ? scaled / std::round(1 / unit) : scaled * unit;
}

/// A typical size, most often 1.
double plain(Random& r, double least = 0.01, double most = 100) {
  if (r.chance(0.4)) return 1;
  if (r.chance(0.4)) return std::clamp(r.pick({0.1, 0.2, 0.5, 2.0, 5.0, 10.0}), least, most);
  return rounded(r.spread(least, most), r.chance(0.7) ? 2 : 15);
}

double sign(Random& r) { return r.chance(0.5) ? 1 : -1; }

Vector unit(Random& r) {
  Vector v = Vector::Zero();
  v[r.below(3)] = sign(r);
  return v;
}

/// A direction, mostly along an axis.
Vector direction(Random& r) {
  if (r.chance(0.75)) return unit(r);
  if (r.chance(0.5)) return {sign(r), sign(r), r.chance(0.5) ? 0 : 1.0};
  Vector v;
  do {
    for (double& x : v) x = rounded(r.between(-1, 1), 3);
  } while (v.norm() < 0.1);
  return v;
}

Vector vector(Random& r, double least = 0.01, double most = 10) {
  if (r.chance(0.2)) return Vector::Zero();
  return plain(r, least, most) * direction(r);
}

Eigen::Vector4d attitude(Random& r) {
  const double half = std::sqrt(0.5);
  if (r.chance(0.15)) return {1, 0, 0, 0};
  if (r.chance(0.3)) {
    Eigen::Vector4d q = Eigen::Vector4d::Zero();
    q[r.below(3) + 1] = r.chance(0.5) ? 1 : half;  // half or quarter turns
    q[0] = q.squaredNorm() < 0.9 ? sign(r) * half : 0;
    return q;
  }
  Eigen::Vector4d q;
  for (double& x : q) x = r.between(-1, 1);
  return q.normalized();
}

Angle phase(Random& r) {
  if (r.chance(0.7)) return {90.0 * r.below(5), true};
  return {rounded(r.between(-3, 3), 3), false};
}

Angle angle(Random& r) {
  if (r.chance(0.3)) return {0, r.chance(0.5)};
  if (r.chance(0.3)) return {r.pick({90.0, -90.0, 180.0, 45.0, 360.0, 30.0}), true};
  if (r.chance(0.15)) return {sign(r) * r.pick({1e-20, 1e-14, 1e-9, 1e-6}), false};
  return {rounded(r.between(-3, 3), 2), false};
}

double speed(Random& r) {
  if (r.chance(0.5)) return 0;
  if (r.chance(0.08)) return sign(r) * r.pick({1e-12, 1e-6, 1e3});
  return sign(r) * plain(r, 0.01, 30);
}

/// An angular rate; most users write radian.
Angle rate(Random& r, bool degrees = false) {
  if (degrees) return {r.pick({0.0, 1.0, 10.0, 90.0, -360.0, 720.0}), true};
  return {speed(r), false};
}

/// Oscillations, often of one frequency.
Series series(Random& r, double size, double frequency) {
  Series s;
  if (r.chance(0.25)) s.constant = size * vector(r, 0.1, 3);
  const int terms = r.below(3) + (s.constant.isZero(0) ? 1 : 0);
  for (int i = 0; i < terms; ++i) {
    const double w = r.chance(0.6) ? frequency : plain(r, 0.1, 10);
    const bool degrees = r.chance(0.1);
    const Angle turning{degrees ? rounded(w / 0.0174533, 3) : w, degrees};
    s.terms.push_back({size * plain(r, 0.1, 3) * direction(r), turning, phase(r)});
  }
  return s;
}

/// A function of time of about this size, along the direction that `along` draws.
template <class Along>
Signal smooth_signal(Random& r, double size, const Along& along) {
  Signal s;
  if (r.chance(0.5)) s.series.constant = size * plain(r, 0.1, 3) * along();
  if (r.chance(0.4)) s.rate = 0.3 * size * plain(r, 0.1, 3) * along();
  const int terms = r.below(3);
  for (int i = 0; i < terms; ++i) {
    s.series.terms.push_back({size * plain(r, 0.1, 3) * along(), {plain(r, 0.1, 10)}, phase(r)});
  }
  return s;
}

/// The same, or one that jumps a few times in the first seconds.
template <class Along>
Signal any_signal(Random& r, double size, const Along& along) {
  if (r.chance(0.4)) return smooth_signal(r, size, along);
  Signal s;
  s.jumps.is_broken_line = r.chance(0.5);
  double t = r.pick({0.0, 0.0, 0.1, -1.0});
  const int count = 1 + r.below(4);
  for (int i = 0; i < count; ++i) {
    s.jumps.times.push_back(t);
    s.jumps.values.push_back(size * plain(r, 0.1, 3) * along());
    t += rounded(r.pick({0.05, 0.3, 1.0, 2.5}) * r.between(0.5, 1), 2);
  }
  return s;
}

/// A scalar function of time.
Signal number_signal(Random& r, double size) {
  return any_signal(r, size, [&r] { return Vector(sign(r) * Vector::UnitX()); });
}

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

void add_guide(Random& r, Scene& scene) {
  if (r.chance(0.3)) return;
  scene.guide.push_back(any_link(r, true));
  while (scene.guide.size() < 3 && r.chance(0.15)) scene.guide.push_back(any_link(r, false));
  scene.chain_in_chain = scene.guide.size() > 1 && r.chance(0.3);
  // The reference takes a number on the axes of the whole guide.
  Link& first = scene.guide.front();
  const bool is_level = scene.guide.size() == 1 && first.vehicle.bank.empty();
  if (first.kind == LinkKind::course && !is_level && first.gravity == "9.81") {
    first.gravity = "\"normal\"";
  }
}

/// The acceleration that accelerometers do not measure.
void add_gravity_of_log(Random& r, Scene& scene) {
  if (scene.guide.empty() || scene.guide.front().kind != LinkKind::rates) return;
  Log& log = scene.guide.front().log;
  if (log.is_kinematic) return;
  log.says_gravity =
      !log.shift.isZero(0) && (scene.gravity != GravityKind::inertial || r.chance(0.3));
  log.gravity = log.says_gravity ? Vector(9.81 * direction(r)) : scene.gravity_vector;
}

/// A planet some earth's radii away.
void add_planet(Random& r, Scene& scene) {
  scene.gravity = r.chance(0.5) ? GravityKind::point : GravityKind::j2;
  scene.gravity_vector = r.pick({6.4e6, 7e6, 2e7}) * direction(r);
  scene.pole = direction(r);
  if (r.chance(0.7)) scene.gradient = r.chance(0.7);
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

/// Principal moments, often equal, or six entries of a tensor that a body may have.
std::vector<double> inertia(Random& r, double size) {
  const auto moment = [&r, size] { return size * plain(r, 0.1, 10); };
  const double a = moment();
  if (r.chance(0.3)) return {a, a, a};
  if (r.chance(0.3)) return {a, a, a * r.pick({0.1, 0.5, 1.5, 1.9})};
  const double A = moment();
  const double B = moment();
  if (r.chance(0.75)) return {A + a, B + a, A + B};
  const double least = std::min({a, A, B});
  const auto product = [&r, least] { return least * rounded(r.between(-0.4, 0.4), 2); };
  return {A + a, B + a, A + B, product(), product(), product()};
}

void add_mass(Random& r, Body& body) {
  body.mass = plain(r);
  const double size = body.mass * r.pick({0.1, 0.01, 1.0});
  body.inertia = inertia(r, size);
  if (r.chance(0.7)) body.centre = vector(r, 0.01, 1);
}

/// The kind of joint after `free` at a share of the list, from 0 to 1.
JointKind later_kind(double share) {
  const auto& types = kreisel::joint_types();
  const auto first = static_cast<std::size_t>(JointKind::free) + 1;
  return types[first + static_cast<std::size_t>(share * double(types.size() - first))].kind;
}

void add_joint(Random& r, Body& body) {
  const double u = r.uniform();
  body.kind = u < 0.36   ? JointKind::revolute
              : u < 0.45 ? later_kind((u - 0.36) / 0.09)
              : u < 0.60 ? JointKind::prismatic
              : u < 0.75 ? JointKind::universal
              : u < 0.87 ? JointKind::spherical
              : u < 0.96 ? JointKind::free
                         : JointKind::fixed;
  body.axis = direction(r);
  do {
    body.second_axis = direction(r);
  } while (body.axis.normalized().cross(body.second_axis.normalized()).norm() < 0.1);
  const kreisel::JointType& type = kreisel::joint_type(body.kind);
  if (type.has_pitch) body.pitch = sign(r) * plain(r, 0.01, 1);
  const bool optional = type.second_axis == kreisel::JointType::Axis::optional;
  if (optional && r.chance(0.5)) body.second_axis.setZero();
  if (r.chance(0.5)) body.position = vector(r, 0.1, 2);
  if (r.chance(0.1)) body.orientation = attitude(r);
}

void add_initial(Random& r, Body& body) {
  if (r.chance(0.15)) return;
  const int n = single_coordinates(body.kind);
  const bool moves = r.chance(0.5);
  const bool in_degrees = !slides(body.kind) && r.chance(0.15);
  for (const auto& quantity : kreisel::joint_type(body.kind).coordinates) {
    for (int i = 0; i < quantity.count() && n > 0; ++i) {
      if (quantity.unit == "m") {
        body.displacement.push_back(r.chance(0.5) ? 0 : angle(r).radian());
      } else {
        body.angle.push_back(angle(r));
        body.angle.back().degrees = body.angle.front().degrees;
      }
      if (moves) body.rate.push_back(rate(r, in_degrees));
    }
  }
  if (n > 0 || body.kind == JointKind::fixed) return;
  if (r.chance(0.5)) body.attitude = attitude(r);
  if (moves) body.angular_velocity = rate(r, in_degrees).value * direction(r);
  body.turns_in_degrees = in_degrees;
  if (body.kind != JointKind::free) return;
  if (r.chance(0.5)) body.place = vector(r, 0.1, 3);
  if (moves) body.velocity = speed(r) * direction(r);
}

/// A number for each coordinate: the first, and all others.
std::vector<double> for_each_coordinate(int n, double first, double others) {
  std::vector<double> numbers(static_cast<std::size_t>(n), others);
  numbers.front() = first;
  return numbers;
}

/// A damper by its ratio to the critical one of a joint of that inertia.
void add_damping(Random& r, Body& body, int n) {
  const double ratio =
      r.chance(0.6) ? r.pick({1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0}) : r.spread(1e-4, 10);
  const double stiffness = body.stiffness.empty() ? 1 : std::abs(body.stiffness.front());
  const double inertia = slides(body.kind) ? body.mass : body.inertia.front();
  const double damping = rounded(2 * ratio * std::sqrt(stiffness * inertia), 3);
  body.damping = for_each_coordinate(std::max(n, 1), damping, r.chance(0.5) ? damping : 0);
}

void add_joint_forces(Random& r, Body& body) {
  const int n = single_coordinates(body.kind);
  if (n > 0 && r.chance(0.3)) {
    const double stiffness =
        r.chance(0.7) ? plain(r, 0.1, 100) : r.pick({1e3, 1e4, 1e6, 1e8, 1e10});
    body.stiffness = for_each_coordinate(n, stiffness, r.chance(0.5) ? stiffness : 1);
    if (r.chance(0.3)) {
      const bool degrees = !slides(body.kind) && r.chance(0.3);
      body.rest.assign(static_cast<std::size_t>(n), {0, degrees});
      body.rest.front().value = rounded(r.between(-1, 1), 1) * (degrees ? 50 : 1);
    }
  }
  const double damped = body.stiffness.empty() ? 0.2 : 0.6;
  if ((n > 0 || body.kind == JointKind::spherical) && r.chance(damped)) add_damping(r, body, n);
  if (n > 0 && r.chance(0.1)) {
    body.force = for_each_coordinate(n, sign(r) * plain(r, 0.1, 10), 0);
  }
  if (n == 1 && r.chance(0.15)) body.force_in_time = number_signal(r, 1);
}

void add_loads(Random& r, Body& body) {
  if (r.chance(0.85)) return;
  do {
    Load load;
    load.force = vector(r, 0.1, 10);
    if (r.chance(0.5)) load.torque = vector(r, 0.01, 3);
    if (r.chance(0.3)) load.point = vector(r, 0.1, 1);
    load.axes = r.pick({Axes::body, Axes::guide, Axes::inertial});
    if (r.chance(0.3)) load.force_in_time = any_signal(r, 1, [&r] { return direction(r); });
    body.loads.push_back(load);
  } while (r.chance(0.15));
}

/// A drag or a magnet on some bodies that are no rotors.
void add_other_loads(Random& r, Body& body) {
  if (body.rotor || r.chance(0.9)) return;
  Load load;
  load.kind = r.chance(0.5) ? LoadKind::drag : LoadKind::magnet;
  if (load.kind == LoadKind::drag) {
    load.linear = body.mass * vector(r, 0.01, 1).cwiseAbs();
    load.quadratic = body.mass * vector(r, 0.01, 1).cwiseAbs();
    load.angular = body.inertia.front() * vector(r, 0.01, 1).cwiseAbs();
    if (r.chance(0.4)) load.point = vector(r, 0.1, 1);
  } else {
    load.moment = body.inertia.front() * vector(r, 0.1, 10);
    do {
      load.field = any_signal(r, 1, [&r] { return direction(r); });
    } while (load.field.empty());
  }
  body.loads.push_back(load);
}

/// Sets the start of a drive to its motion.
void start_motion(Body& body, double t) {
  const reference::Course start = reference::course_of(body.motion, t, t);
  const auto value = static_cast<double>(start.value.x());
  if (!body.is_rate) body.angle = {{value, false}};
  body.rate = {{body.is_rate ? value : static_cast<double>(start.rate.x()), false}};
}

/// Prescribes the angle, or its rate, which may be a broken line.
void add_motion(Random& r, Body& body) {
  body.is_rate = r.chance(0.5);
  do {
    const auto along = [&r] { return Vector(sign(r) * Vector::UnitX()); };
    body.motion = body.is_rate ? any_signal(r, 1, along) : smooth_signal(r, 0.3, along);
  } while (body.motion.empty() ||
           (!body.motion.jumps.times.empty() && !body.motion.jumps.is_broken_line));
  start_motion(body, 0);
}

/// Locks the joint or drives it.
void add_rule(Random& r, Body& body) {
  if (r.chance(0.04)) {
    body.hold = true;
    body.rate.clear();
    body.angular_velocity.setZero();
    body.velocity.setZero();
  } else if (body.kind == JointKind::revolute && r.chance(0.12)) {
    body.drive = true;
    if (r.chance(0.5)) add_motion(r, body);
  }
}

/// A wheel on the body before it.
Body rotor(Random& r, int carrier) {
  Body body;
  body.parent = carrier;
  body.kind = JointKind::revolute;
  const int along = r.below(3);
  body.axis = Vector::Unit(along);
  if (r.chance(0.3)) body.position = vector(r, 0.1, 1);
  body.mass = plain(r, 0.1, 10);
  const double about = r.pick({0.001, 0.01, 0.1, 1.0});
  const double across = about * r.pick({0.5, 0.6, 1.0, 3.0});
  body.inertia = {across, across, across};
  body.inertia[static_cast<std::size_t>(along)] = about;
  Rotor rotor;
  rotor.mode = r.pick({RotorMode::free, RotorMode::regulated, RotorMode::torque});
  rotor.speed = {sign(r) * r.pick({1.0, 10.0, 50.0, 100.0, 300.0}), false};
  if (r.chance(0.15)) rotor.speed = {sign(r) * r.pick({360.0, 3600.0}), true};
  rotor.speed_is_initial = r.chance(0.15);
  if (rotor.mode == RotorMode::torque) rotor.torque = r.chance(0.5) ? 0 : sign(r) * about;
  if (rotor.mode == RotorMode::torque && r.chance(0.4)) {
    rotor.torque_in_time = number_signal(r, about);
  }
  if (rotor.mode != RotorMode::free && r.chance(0.2)) body.damping = {0.01 * about};
  body.rotor = rotor;
  return body;
}

void add_body(Random& r, Scene& scene) {
  Body body;
  const int before = static_cast<int>(scene.bodies.size());
  if (before > 0) {
    body.parent = r.chance(0.7) ? before - 1 : r.below(before + 1) - 1;
    if (body.parent >= 0 && scene.bodies[static_cast<std::size_t>(body.parent)].rotor) {
      body.parent = -1;
    }
  }
  add_joint(r, body);
  add_mass(r, body);
  add_initial(r, body);
  add_joint_forces(r, body);
  add_loads(r, body);
  add_rule(r, body);
  scene.bodies.push_back(body);
}

void add_bodies(Random& r, Scene& scene) {
  const int bodies = r.chance(0.45) ? 1 : r.chance(0.7) ? 2 : 3;
  for (int i = 0; i < bodies; ++i) add_body(r, scene);
  if (r.chance(0.2)) {
    const int carrier = static_cast<int>(scene.bodies.size()) - 1;
    scene.bodies.push_back(rotor(r, carrier));
  }
}

/// A pendulum or a chain of two on any guide: the usual first scene.
void add_pendulums(Random& r, Scene& scene) {
  const Vector axis = unit(r);
  const int links = r.chance(0.7) ? 1 : 2;
  Vector down = scene.gravity_vector.isZero(0) ? -Vector::UnitZ() : scene.gravity_vector;
  down.normalize();
  const double length = plain(r, 0.1, 10);
  for (int i = 0; i < links; ++i) {
    Body body;
    body.parent = i - 1;
    body.axis = axis;
    body.mass = plain(r, 0.1, 10);
    body.centre = length * down;
    if (i > 0) body.position = length * down;
    const bool points = r.chance(0.3) && std::abs(axis.dot(down)) < 0.1;
    body.inertia = points ? std::vector<double>{0, 0, 0} : inertia(r, 0.1 * length * length);
    if (r.chance(0.6)) body.angle = {angle(r)};
    if (r.chance(0.2)) body.rate = {rate(r)};
    if (r.chance(0.4)) body.damping = {r.pick({1e-3, 0.01, 0.1, 1.0})};
    scene.bodies.push_back(body);
  }
}

Link aligned_link(Random& r) {
  const double u = r.uniform();
  if (u < 0.3) return earth(r);
  Link link{.kind = u < 0.5 ? LinkKind::rotating : LinkKind::harmonic};
  link.angular_velocity = r.pick({1.0, 0.5, 0.1, 3.0}) * unit(r);
  if (r.chance(0.3)) link.angular_velocity += unit(r);
  const double frequency = r.pick({1.0, 0.785, 2.0});
  const int terms = 1 + r.below(2);
  for (int i = 0; i < terms; ++i) {
    const double amplitude = r.pick({0.157, 0.1, 1.0});
    const Angle phase{90.0 * r.below(4), true};
    (r.chance(0.8) ? link.turning : link.pushing)
        .terms.push_back({amplitude * unit(r), {frequency}, phase});
  }
  return link;
}

/// Bodies at rest or nearly so, with axes along those of the guide: cases at the edge to 0.
void add_resting_bodies(Random& r, Scene& scene) {
  scene.guide = {aligned_link(r)};
  scene.gravity = GravityKind::not_given;
  const Vector down = scene.guide.front().kind == LinkKind::earth ? Vector::UnitX() : unit(r);
  if (scene.guide.front().kind != LinkKind::earth && r.chance(0.7)) {
    scene.gravity = r.pick({GravityKind::inertial, GravityKind::uniform});
    scene.gravity_vector = 9.81 * down;
  }
  const int bodies = r.chance(0.7) ? 1 : 2;
  for (int i = 0; i < bodies; ++i) {
    Body body;
    body.parent = i - 1;
    body.kind = r.pick({JointKind::revolute, JointKind::revolute, JointKind::universal,
                        JointKind::spherical, JointKind::prismatic});
    const int along = r.below(3);
    body.axis = sign(r) * Vector::Unit(along);
    body.second_axis = Vector::Unit((along + 1 + r.below(2)) % 3);
    body.inertia = inertia(r, 1);
    if (r.chance(0.6)) body.centre = 0.5 * down;
    if (i > 0) body.position = down;
    const int n = single_coordinates(body.kind);
    for (int k = 0; k < n && !slides(body.kind); ++k) {
      const bool off = r.chance(0.2);
      body.angle.push_back(
          {off ? sign(r) * r.pick({1e-20, 1e-14, 1e-9, 1e-6}) : 90.0 * r.below(4), !off});
      body.angle.back().degrees = body.angle.front().degrees;
    }
    if (n > 0 && r.chance(0.3)) add_damping(r, body, n);
    scene.bodies.push_back(body);
  }
}

/// Two rings and a rotor.
void add_cardan_gyro(Random& r, Scene& scene) {
  const int first = r.below(3);
  const bool massless = r.chance(0.1);
  for (int i = 0; i < 2; ++i) {
    Body ring;
    ring.parent = i - 1;
    ring.axis = Vector::Unit((first + i) % 3);
    ring.mass = plain(r, 0.1, 2);
    ring.inertia = inertia(r, 0.005);
    if (massless) {
      ring.mass = 0;
      ring.inertia = {0, 0, 0};
    }
    ring.angle = {angle(r)};
    if (r.chance(0.3)) ring.rate = {rate(r)};
    if (!massless) add_joint_forces(r, ring);
    scene.bodies.push_back(ring);
  }
  Body wheel = rotor(r, 1);
  const auto along = static_cast<std::size_t>((first + 2) % 3);
  wheel.axis = Vector::Unit(static_cast<int>(along));
  wheel.inertia = {0.005, 0.005, 0.005};
  wheel.inertia[along] = 0.008;
  scene.bodies.push_back(wheel);
}

/// A number of either sign that is not small relative to `size`.
double small(Random& r, double size) { return sign(r) * size * r.between(0.5, 1); }

/// Rings with small motions about a rotor, as in the equations of the papers.
void add_small_gimbals(Random& r, Scene& scene, bool symmetric) {
  const int first = r.below(3);
  const double size = r.pick({0.01, 0.03});
  for (int i = 0; i < 2; ++i) {
    Body ring;
    ring.parent = i - 1;
    ring.axis = Vector::Unit((first + i) % 3);
    ring.mass = plain(r, 0.1, 2);
    ring.inertia = {0.002, 0.002, 0.002};
    for (double& moment : ring.inertia) moment = 0.002 * rounded(r.between(1, 1.5), 2);
    ring.angle = {{small(r, size), false}};
    if (r.chance(0.5)) ring.rate = {{small(r, size), false}};
    if (r.chance(0.5)) ring.stiffness = {r.pick({0.01, 0.1, 0.5})};
    if (r.chance(0.5)) ring.damping = {r.pick({1e-4, 1e-3})};
    scene.bodies.push_back(ring);
  }
  Body wheel;
  wheel.parent = 1;
  const auto along = static_cast<std::size_t>((first + 2) % 3);
  wheel.axis = Vector::Unit(static_cast<int>(along));
  wheel.inertia = {0.005, 0.005, 0.005};
  wheel.inertia[along] = 0.008;
  if (!symmetric) wheel.inertia[static_cast<std::size_t>(first)] = 0.0055;
  const double speed = sign(r) * r.pick({10.0, 30.0, 100.0});
  if (symmetric) {
    wheel.rotor =
        Rotor{.mode = r.pick({RotorMode::free, RotorMode::regulated}), .speed = {speed, false}};
  } else {
    wheel.drive = true;
    wheel.rate = {{speed, false}};
    wheel.angle = {angle(r)};
  }
  scene.bodies.push_back(wheel);
  scene.model = symmetric ? "foeppl" : "fuchs-weigand";
}

/// Pendulums with small swings about a rest position, on a guide that may turn about the vertical.
void add_small_pendulums(Random& r, Scene& scene) {
  const int along = r.below(3);
  const Vector down = sign(r) * Vector::Unit(along);
  scene.gravity = r.pick({GravityKind::uniform, GravityKind::inertial});
  scene.gravity_vector = 9.81 * down;
  if (r.chance(0.6)) {
    scene.guide = {Link{.kind = LinkKind::rotating}};
    scene.guide.front().angular_velocity = r.pick({0.1, 1.0, 3.0}) * down;
  }
  const int bodies = 1 + r.below(3);
  for (int i = 0; i < bodies; ++i) {
    Body body;
    body.parent = i - 1;
    body.kind = r.chance(0.6) ? JointKind::revolute : JointKind::universal;
    const int across = 1 + r.below(2);
    body.axis = sign(r) * Vector::Unit((along + across) % 3);
    body.second_axis = Vector::Unit((along + 3 - across) % 3);
    body.mass = plain(r, 0.1, 10);
    body.centre = plain(r, 0.2, 2) * down;
    if (i > 0) body.position = plain(r, 0.2, 2) * down;
    for (double& moment : body.inertia) moment = body.mass * rounded(r.between(0.1, 0.15), 2);
    for (int k = 0; k < single_coordinates(body.kind); ++k) {
      body.angle.push_back({small(r, 0.01), false});
    }
    if (r.chance(0.3)) add_damping(r, body, single_coordinates(body.kind));
    scene.bodies.push_back(body);
  }
  scene.model = "linear";
}

/// A fast rotor in rings; the inner ring has an unbalance.
void add_fast_gyro(Random& r, Scene& scene) {
  add_small_gimbals(r, scene, true);
  for (Body& body : scene.bodies) body.stiffness.clear(), body.damping.clear(), body.rate.clear();
  scene.bodies.back().rotor->mode = RotorMode::regulated;
  scene.bodies.back().rotor->speed = {sign(r) * r.pick({1000.0, 2000.0}), false};
  const auto axis = scene.bodies.back().axis;
  scene.bodies[1].centre = 0.05 * axis;
  scene.gravity = GravityKind::uniform;
  scene.gravity_vector = 9.81 * scene.bodies[0].axis;
  scene.model = "precession";
}

void add_approximation(Random& r, Scene& scene) {
  scene.guide.clear();
  const auto needs_guide = {GravityKind::earth, GravityKind::earth_j2, GravityKind::orbit};
  if (std::count(needs_guide.begin(), needs_guide.end(), scene.gravity) > 0) {
    scene.gravity = GravityKind::not_given;
  }
  const double u = r.uniform();
  if (u < 0.4) {
    add_small_pendulums(r, scene);
  } else if (u < 0.85) {
    add_small_gimbals(r, scene, r.chance(0.5));
  } else {
    add_fast_gyro(r, scene);
  }
  scene.t_end = r.pick({0.1, 0.5, 1.0});
}

/// Any frame that a sensor may name.
int frame(Random& r, const Scene& scene) {
  return r.below(static_cast<int>(scene.bodies.size()) + 2) - 2;
}

Sensor sensor(Random& r, const Scene& scene) {
  Sensor result;
  result.kind = r.pick({SensorKind::gyro, SensorKind::accelerometer, SensorKind::accelerometer,
                        SensorKind::point, SensorKind::attitude, SensorKind::reaction});
  result.body = r.below(static_cast<int>(scene.bodies.size()));
  const bool is_point = result.kind == SensorKind::point;
  const bool is_attitude = result.kind == SensorKind::attitude;
  if (!is_attitude && r.chance(0.7)) result.at = vector(r, 0.1, 3);
  result.at_by_name = !is_attitude && r.chance(0.3);
  if (!is_point && !is_attitude && r.chance(0.3)) result.axes = attitude(r);
  if (is_point || is_attitude) result.against = frame(r, scene);
  // With logged rates the position of the guide in the inertial frame is unknown.
  const bool is_lost = !scene.guide.empty() && scene.guide.front().kind == LinkKind::rates;
  if (is_point && is_lost && result.against == inertial_frame) result.against = guide_frame;
  result.on = is_point && r.chance(0.5) ? frame(r, scene) : result.against;
  const bool integrates =
      result.kind == SensorKind::gyro || result.kind == SensorKind::accelerometer;
  const bool suits = integrates && scene.model.empty() && scene.t_end <= 5;
  if (suits && r.chance(0.3)) {
    result.increments = r.pick<std::string>({"true", "true", "\"uncompensated\""});
  }
  const bool is_sampled = !result.increments.empty() || (scene.model.empty() && r.chance(0.1));
  if (is_sampled) result.period = scene.t_end / 8;
  return result;
}

/// A sensor of an element's force; `at` is a point of the second body.
Sensor sensor_of_element(Random& r, const Scene& scene) {
  Sensor result{.kind = SensorKind::reaction};
  result.element = r.below(static_cast<int>(scene.elements.size()));
  result.body = std::max(0, scene.elements[static_cast<std::size_t>(result.element)].bodies[1]);
  result.at = vector(r, 0.1, 3);
  if (r.chance(0.3)) result.axes = attitude(r);
  return result;
}

void add_sensors(Random& r, Scene& scene) {
  if (r.chance(0.6)) return;
  do {
    scene.sensors.push_back(sensor(r, scene));
  } while (r.chance(0.6));
}

/// A number of an element's tensor.
double stiffness(Random& r) { return r.pick({1.0, 10.0, 30.0, 100.0, 1e3}); }

Eigen::Matrix3d diagonal(Random& r) {
  return Vector(stiffness(r), stiffness(r), stiffness(r)).asDiagonal();
}

/// A spring whose ends are off all axes, so that no motion about an axis lets them meet.
Element spring(Random& r) {
  Element result;
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  for (double& x : result.at[1]) x += sign(r) * rounded(r.between(0.05, 0.1), 3);
  if (r.chance(0.2)) {
    result.table = {{0, -10}, {1, 0}, {2, 30}};
  } else {
    result.stiffness = stiffness(r);
    if (r.chance(0.6)) result.length = plain(r, 0.1, 2);
  }
  if (r.chance(0.4)) result.damping = r.pick({0.1, 1.0, 10.0});
  return result;
}

/// A mount; tensors that depend on the rotation only sometimes, as it must stay below 3 rad.
Element mount(Random& r) {
  Element result{.kind = ElementKind::mount};
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  if (r.chance(0.4)) result.axes = attitude(r);
  result.linear = diagonal(r);
  if (r.chance(0.3)) {
    const double across = r.pick({0.5, 3.0});
    result.linear(0, 1) = across;
    result.linear(1, 0) = r.chance(0.5) ? -across : across;
  }
  if (r.chance(0.4)) {
    result.turning = diagonal(r);
    if (r.chance(0.5)) result.coupling = Vector(0.3, 0.1, -0.2).asDiagonal();
    if (r.chance(0.3)) result.torque = vector(r, 0.1, 2);
  }
  if (r.chance(0.5)) result.linear_damping = Vector(1, 0.5, 2) * r.pick({0.1, 1.0});
  if (r.chance(0.3)) result.turning_damping = Vector(0.2, 0.1, 0.5);
  if (r.chance(0.3)) result.force = vector(r, 0.1, 10);
  return result;
}

/// A rope that is slack or taut at the start.
Element rope(Random& r) {
  Element result{.kind = ElementKind::rope};
  result.at = {vector(r, 0.1, 2), vector(r, 0.1, 2)};
  for (double& x : result.at[1]) x += sign(r) * rounded(r.between(0.05, 0.1), 3);
  result.stiffness = stiffness(r);
  result.length = plain(r, 0.1, 2);
  if (r.chance(0.4)) result.damping = r.pick({0.1, 1.0, 10.0});
  return result;
}

Element gear(Random& r) {
  Element result{.kind = ElementKind::gear};
  result.stiffness = stiffness(r);
  if (r.chance(0.4)) result.damping = r.pick({0.1, 1.0});
  if (r.chance(0.7)) result.ratio = sign(r) * r.pick({0.5, 2.0, 3.0});
  return result;
}

/// The bodies that an element of this kind may join. Rotors take none.
std::vector<int> joinable(const Scene& scene, ElementKind kind) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const Body& body = scene.bodies[static_cast<std::size_t>(i)];
    const bool has_one = kreisel::joint_type(body.kind).rate_count() == 1;
    if (!body.rotor && (has_one || kind != ElementKind::gear)) result.push_back(i);
  }
  if (kind != ElementKind::gear) result.push_back(guide_frame);
  return result;
}

void add_elements(Random& r, Scene& scene) {
  if (r.chance(0.7)) return;
  do {
    const double u = r.uniform();
    Element element = u < 0.3 ? spring(r) : u < 0.45 ? rope(r) : u < 0.75 ? mount(r) : gear(r);
    const std::vector<int> all = joinable(scene, element.kind);
    if (all.size() < 2) return;
    const int first = r.below(static_cast<int>(all.size()));
    const int second =
        (first + 1 + r.below(static_cast<int>(all.size()) - 1)) % static_cast<int>(all.size());
    element.bodies = {all[static_cast<std::size_t>(first)], all[static_cast<std::size_t>(second)]};
    scene.elements.push_back(element);
    if (!last_element_works(scene)) {
      scene.elements.pop_back();
    } else if (r.chance(0.5)) {
      scene.sensors.push_back(sensor_of_element(r, scene));
    }
  } while (r.chance(0.4));
}

/// True if a body's joint may be a constraint: it has no forces, and nothing else refers to it.
bool may_be_loose(const Scene& scene, int index) {
  const Body& b = scene.bodies[static_cast<std::size_t>(index)];
  const bool is_kind = b.kind == JointKind::revolute || b.kind == JointKind::prismatic ||
                       b.kind == JointKind::spherical || b.kind == JointKind::fixed;
  const bool is_free_of_forces = b.stiffness.empty() && b.damping.empty() && b.force.empty() &&
                                 b.force_in_time.empty() && !b.rotor && !b.drive && !b.hold;
  const bool is_geared =
      std::any_of(scene.elements.begin(), scene.elements.end(), [index](const Element& element) {
        return element.kind == ElementKind::gear &&
               (element.bodies[0] == index || element.bodies[1] == index);
      });
  const bool is_read =
      std::any_of(scene.sensors.begin(), scene.sensors.end(), [index](const Sensor& sensor) {
        return sensor.kind == SensorKind::reaction && sensor.body == index;
      });
  return is_kind && is_free_of_forces && b.mass > 0 && !is_geared && !is_read;
}

/// Makes some joints constraints.
void loosen_joints(Random& r, Scene& scene) {
  if (scene.reports || scene.has_log() || r.chance(0.7)) return;
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (may_be_loose(scene, i) && r.chance(0.4))
      scene.bodies[static_cast<std::size_t>(i)].loose = true;
  }
}

void add_solve(Random& r, Scene& scene) {
  scene.tolerance = r.pick({1e-10, 1e-10, 1e-8, 1e-6, 1e-9, 1e-3, 1e-12});
  scene.t_end = r.chance(0.85) ? r.pick({0.1, 1.0, 2.0, 5.0, 10.0, 20.0})
                               : r.pick({1e-6, 1e-3, 60.0, 1e3, 1e4});
  const bool harmonic = std::any_of(scene.guide.begin(), scene.guide.end(), [](const Link& link) {
    return link.kind == LinkKind::harmonic;
  });
  if (harmonic) scene.t_end = std::min(scene.t_end, 1e3);
  const bool is_course = !scene.guide.empty() && scene.guide.front().kind == LinkKind::course;
  if (is_course) scene.t_end = std::min(scene.t_end, 100.0);  // its turn rate may grow
  if (scene.has_log()) scene.t_end = std::min(scene.t_end, 10.0);
  scene.outputs = r.pick({1, 2, 20, 20, 20, 100});
  scene.reports = r.chance(0.3);
  if (r.chance(0.2)) {
    scene.method = r.pick<std::string>({"auto", "automatic", "closed form", "taylor", "verner98",
                                        "gauss16", "radau13", "splitting"});
  }
}

/// Writes some of the smooth functions of time as logs.
void add_logs_of_signals(Random& r, Scene& scene) {
  int count = 0;
  const auto take = [&](Signal& s) {
    if (s.empty() || !s.jumps.times.empty() || r.chance(0.6)) return;
    s.file = "s" + std::to_string(count++) + ".csv";
    scene.t_end = std::min(scene.t_end, 10.0);
  };
  for (Body& body : scene.bodies) {
    take(body.force_in_time);
    take(body.motion);
    if (body.rotor) take(body.rotor->torque_in_time);
    for (Load& load : body.loads) {
      take(load.force_in_time);
      take(load.field);
    }
  }
}

/// Moves the run to a later time, unless the guide is given by its start at t = 0.
void add_begin(Random& r, Scene& scene) {
  const bool has_start = std::any_of(scene.guide.begin(), scene.guide.end(), [](const Link& link) {
    return link.kind == LinkKind::rotating || link.kind == LinkKind::harmonic ||
           link.kind == LinkKind::course;
  });
  if (has_start || r.chance(0.7)) return;
  scene.t_begin = r.pick({0.5, 1.0, 3.0});
  scene.t_end += scene.t_begin;
  for (Body& body : scene.bodies) {
    if (!body.motion.empty()) start_motion(body, scene.t_begin);
  }
}

}  // namespace

Scene generate(Random r) {
  Scene scene;
  add_guide(r, scene);
  add_gravity(r, scene);
  add_gravity_of_log(r, scene);
  if (r.chance(0.1)) scene.title = "Made by chance";
  const double u = r.uniform();
  if (u < 0.06) {
    add_approximation(r, scene);
    scene.outputs = 20;
    return scene;
  }
  if (u < 0.2) {
    add_pendulums(r, scene);
  } else if (u < 0.35) {
    add_cardan_gyro(r, scene);
  } else if (u < 0.5) {
    add_resting_bodies(r, scene);
  } else {
    add_bodies(r, scene);
  }
  add_solve(r, scene);
  add_sensors(r, scene);
  for (Body& body : scene.bodies) body.has_units = r.chance(0.1);
  for (Body& body : scene.bodies) add_other_loads(r, body);
  add_logs_of_signals(r, scene);
  add_begin(r, scene);
  add_elements(r, scene);
  loosen_joints(r, scene);
  return scene;
}

}  // namespace differential
