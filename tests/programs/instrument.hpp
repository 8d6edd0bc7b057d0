#pragma once

#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include <dynamics/guide/ellipsoid.hpp>
#include <motor/motor.hpp>

#include <support/json.hpp>

/// A row of the table of instruments, and means to write one.

namespace kreisel::test {

inline const double pi = std::acos(-1.0);
inline const double degree = pi / 180;
inline constexpr double earth_rate = Wgs84::rotation_rate;

/// A quantity of a scene by its law and by the exact equations.
struct Instrument {
  const char* scene;
  /// Options of the program for a small quantity that is `size` times the one of the scene or of the
  /// first size.
  std::function<std::string(double size)> options;
  std::function<double(const Json& answer)> measured;
  std::function<double(double size)> law;
  /// The part of the law that the first term left out takes, as far as it is known.
  std::function<double(double size)> rest;
  double order;  ///< of the part left out in the size; 0 if the law is exact
  double bound;  ///< of this part at size 1
  bool analyzed = false;
};

inline std::string set(const std::string& key, const std::string& value) {
  return " --set '" + key + "=" + value + "'";
}
inline std::string set(const std::string& key, double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return set(key, text.str());
}
inline std::string set(const std::string& key, const Vector3<double>& v) {
  std::ostringstream text;
  text.precision(17);
  text << '[' << v.x() << ", " << v.y() << ", " << v.z() << ']';
  return set(key, text.str());
}
inline std::string until(double t_end) {
  std::ostringstream text;
  text.precision(17);
  text << " --t-end " << t_end;
  return text.str();
}

/// A number of the answer, by the path to it.
inline std::function<double(const Json&)> at(const std::string& path) {
  return [path](const Json& answer) { return answer.at(Json::json_pointer(path)).get<double>(); };
}

/// The frequency of the equilibrium's root that is nearest to one.
inline double frequency_near(const Json& answer, double wanted) {
  double nearest = INFINITY;
  for (const Json& root : answer.at("equilibria").at(0).at("roots")) {
    const auto found = root.at("frequency").get<double>();
    if (std::abs(found - wanted) < std::abs(nearest - wanted)) nearest = found;
  }
  return nearest;
}

inline std::function<double(const Json&)> frequency(double wanted) {
  return [wanted](const Json& answer) { return frequency_near(answer, wanted); };
}

inline std::function<double(double)> constant(double value) {
  return [value](double) { return value; };
}

inline std::string no_options(double /*size*/) { return {}; }

}  // namespace kreisel::test
