#include <fmt/core.h>

#include <array>

#include "toml.hpp"

namespace differential {

namespace {

std::string angles(const std::array<Signal, 3>& signals) {
  Inline table;
  static const char* const names[] = {"yaw", "pitch", "roll"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!signals[i].empty()) table.add(names[i], number_signal(signals[i]));
  }
  return table.text();
}

/// The motion of a frame by its rates.
Keys moving_keys(const Link& link, const char* kind, const std::string& turning,
                 const std::string& pushing) {
  Keys result{{"kind", kind},
              {angle_key("angular_velocity", link.turns_in_degrees), turning},
              {"origin_acceleration", pushing}};
  if (link.attitude) result.emplace_back("attitude", list(*link.attitude));
  const auto add = [&result](const char* key, const Vector& v) {
    if (!v.isZero(0)) result.emplace_back(key, list(v));
  };
  add("origin_position", link.origin_position);
  add("origin_velocity", link.origin_velocity);
  return result;
}

Keys orbit_keys(const Orbit& orbit) {
  Keys result{{"kind", "\"orbit\""}, {"semi_major_axis", text(orbit.semi_major_axis)}};
  const auto add = [&result](const char* key, const Angle& angle) {
    result.emplace_back(angle_key(key, angle.degrees), text(angle.value));
  };
  if (orbit.eccentricity != 0) result.emplace_back("eccentricity", text(orbit.eccentricity));
  add("inclination", orbit.inclination);
  add("node", orbit.node);
  add("perigee", orbit.perigee);
  add("anomaly", orbit.anomaly);
  result.emplace_back("mu", "3.986004418e14");
  if (orbit.j2) result.emplace_back("j2", "true");
  return result;
}

Keys course_keys(const Link& link) {
  const Vehicle& vehicle = link.vehicle;
  Keys result{
      {"kind", "\"course\""}, {"height", text(vehicle.height)}, {"speed", text(vehicle.speed)}};
  const auto add_angle = [&result](const char* key, const Angle& angle) {
    result.emplace_back(angle_key(key, angle.degrees), text(angle.value));
  };
  add_angle("latitude", vehicle.latitude);
  add_angle("longitude", vehicle.longitude);
  add_angle("heading", vehicle.heading);
  const auto add = [&result](const char* key, const Signal& s) {
    if (!s.empty()) result.emplace_back(key, number_signal(s));
  };
  add("turn_rate", vehicle.turn_rate);
  add("acceleration", vehicle.acceleration);
  add("climb", vehicle.climb);
  add("bank", vehicle.bank);
  if (vehicle.is_coordinated) result.emplace_back("bank", "\"coordinated\"");
  if (!link.gravity.empty()) result.emplace_back("gravity", link.gravity);
  return result;
}

/// The keys of a guide frame.
Keys keys(const Link& link, std::size_t index, double t_end) {
  switch (link.kind) {
    case LinkKind::inertial: return {{"kind", "\"inertial\""}};
    case LinkKind::rotating:
      return moving_keys(link, "\"rotating\"", list(link.angular_velocity),
                         list(link.origin_acceleration));
    case LinkKind::harmonic:
      return moving_keys(link, "\"harmonic\"", series(link.turning), series(link.pushing));
    case LinkKind::table: return link.log.keys(log_name(index), t_end, false);
    case LinkKind::rates: return link.log.keys(log_name(index), t_end, true);
    case LinkKind::motion:
      return {{"kind", "\"motion\""},
              {"position", vector_signal(link.position)},
              {"angles", angles(link.angles)}};
    case LinkKind::orbit: return orbit_keys(link.orbit);
    case LinkKind::course: return course_keys(link);
    case LinkKind::earth: break;
  }
  Keys result{{"kind", "\"earth\""},
              {"latitude_deg", text(link.latitude)},
              {"height", text(link.height)},
              {"azimuth_deg", text(link.azimuth)}};
  if (link.rate) result.emplace_back(angle_key("rate", link.rate->degrees), text(link.rate->value));
  if (!link.gravity.empty()) result.emplace_back("gravity", link.gravity);
  return result;
}

std::string planet(const Scene& scene) {
  const bool oblate = scene.gravity == GravityKind::j2;
  std::string result = std::string("[gravity]\nkind = \"") + (oblate ? "j2" : "point") +
                       "\"\nmu = 3.986004418e14\ncentre = " + list(scene.gravity_vector) + "\n";
  if (!oblate) return result;
  return result + "j2 = 1.08262982131e-3\nradius = 6378137\npole = " + list(scene.pole) + "\n";
}

}  // namespace

std::string log_name(std::size_t link) { return fmt::format("log{}.csv", link); }

std::string guide(const Scene& scene) {
  if (scene.guide.empty()) return {};
  std::string result = "[guide]\n";
  if (scene.guide.size() == 1) {
    for (const auto& [key, value] : keys(scene.guide.front(), 0, scene.t_end)) {
      result += key + " = " + value + "\n";
    }
    return result;
  }
  result += "kind = \"chain\"\nlinks = [\n";
  for (std::size_t i = 0; i < scene.guide.size(); ++i) {
    Inline table;
    for (const auto& [key, value] : keys(scene.guide[i], i, scene.t_end)) table.add(key, value);
    if (scene.chain_in_chain && i == 1) result += "  { kind = \"chain\", links = [\n";
    result += "  " + table.text() + ",\n";
  }
  return result + (scene.chain_in_chain ? "  ] },\n]\n" : "]\n");
}

std::string gravity(const Scene& scene) {
  const std::string gradient =
      scene.gradient ? std::string("gradient = ") + (*scene.gradient ? "true\n" : "false\n") : "";
  switch (scene.gravity) {
    case GravityKind::not_given: return {};
    case GravityKind::none: return "[gravity]\nkind = \"none\"\n";
    case GravityKind::earth: return "[gravity]\nkind = \"earth\"\n";
    case GravityKind::earth_j2: return "[gravity]\nkind = \"earth\"\nfield = \"j2\"\n";
    case GravityKind::point:
    case GravityKind::j2: return planet(scene) + gradient;
    case GravityKind::orbit: return "[gravity]\nkind = \"orbit\"\n" + gradient;
    case GravityKind::uniform:
      return "[gravity]\nkind = \"uniform\"\nvector = " + list(scene.gravity_vector) + "\n";
    case GravityKind::inertial: break;
  }
  return "[gravity]\nkind = \"inertial\"\nvector = " + list(scene.gravity_vector) + "\n";
}

}  // namespace differential
