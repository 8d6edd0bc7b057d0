#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <string>
#include <vector>

#include <dynamics/guide/earth.hpp>
#include <dynamics/pendulum/pendulum.hpp>
#include <motor/error.hpp>

#include <support/json.hpp>
#include <support/near.hpp>
#include <support/sample.hpp>

/// The pendulums of the reference files, and random pendulums of point masses.
namespace kreisel::test::pendulum {

using Exact = boost::multiprecision::cpp_bin_float_50;
using test::Json;

constexpr double u = 0x1p-53;

/// |value - truth| <= k u scale with u = 2^-53, whatever precision value and truth have.
inline Verdict near(const Exact& value, const Exact& truth, const Exact& scale, double k) {
  return test::near(value, truth, Exact(abs(scale)), k * u / test::u<Exact>.convert_to<double>());
}

inline Exact number(const Json& text) { return Exact(text.get<std::string>()); }

/// The S nearest to the written number.
template <class S>
S decimal(const Json& text) {
  return static_cast<S>(number(text));
}

inline const std::vector<Json>& cases() {
  static const std::vector<Json> all = [] {
    std::vector<Json> list;
    for (const char* name : {"pendulum.json", "pendulum-extra.json"}) {
      const Json file = reference_file(name);
      for (const Json& one : file.at("cases")) list.push_back(one);
    }
    return list;
  }();
  return all;
}

template <class S>
struct Given {
  PendulumBody<S> body;
  PendulumGuide<S> guide;
  EarthSite<S> site;
  S gravity;
};

/// The inputs of a case read directly into S, as in a program.
template <class S>
Given<S> given(const Json& c) {
  const Json& i = c.at("inputs");
  const auto get = [&](const char* key) { return decimal<S>(i.at(key)); };
  const PendulumBody<S> body{get("m"),   get("a"),   get("ThA"), get("ThB"),
                             get("ThC"), get("PhA"), get("PhB"), get("PhC")};
  EarthSite<S> site;
  site.latitude = get("latitude_deg");
  site.azimuth = get("alpha_deg");
  site.rotation_rate = get("u");
  const S gravity = get("g_eff");
  return {body, pendulum_guide(earth_guide(site, gravity)), site, gravity};
}

inline Vector3<Exact> vector(Sample& sample, double size) {
  const double x = sample.uniform(-size, size);
  const double y = sample.uniform(-size, size);
  const double z = sample.uniform(-size, size);
  return {Exact(x), Exact(y), Exact(z)};
}

struct PointMass {
  Exact mass;
  Vector3<Exact> place;  // body axes, from the pivot
};

/// A body of point masses whose centre of mass lies on the axis A.
inline std::vector<PointMass> random_points(Sample& sample) {
  std::vector<PointMass> points;
  Exact mass = 0;
  Vector3<Exact> moment = Vector3<Exact>::Zero();
  for (int i = 0; i < 6; ++i) {
    PointMass p{Exact(sample.uniform(0.1, 1)), vector(sample, 0.4)};
    mass += p.mass;
    moment += p.mass * p.place;
    points.push_back(p);
  }
  const Exact arm = sample.uniform(0.1, 0.8);
  for (PointMass& p : points) p.place += Vector3<Exact>(arm, 0, 0) - moment / mass;
  return points;
}

inline PendulumBody<Exact> body_of(const std::vector<PointMass>& points) {
  PendulumBody<Exact> body{0, 0, 0, 0, 0, 0, 0, 0};
  Exact moment = 0;
  for (const auto& [m, p] : points) {
    const Exact x = p.x();
    const Exact y = p.y();
    const Exact z = p.z();
    body.mass += m;
    moment += m * x;
    body.theta_a += m * (y * y + z * z);
    body.theta_b += m * (x * x + z * z);
    body.theta_c += m * (x * x + y * y);
    body.phi_a += m * y * z;
    body.phi_b += m * z * x;
    body.phi_c += m * x * y;
  }
  body.arm = moment / body.mass;
  return body;
}

/// The message of a refused action.
inline std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace kreisel::test::pendulum
