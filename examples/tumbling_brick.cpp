#include <GeographicLib/Geocentric.hpp>
#include <fmt/core.h>

#include <cmath>
#include <exception>
#include <vector>

#include <dynamics/guide/earth_frame.hpp>
#include <dynamics/load/oblate_gravitation.hpp>
#include <dynamics/rigid/free_body.hpp>
#include <dynamics/step/integrator.hpp>
#include <motor/attitude.hpp>

// A brick falls from 30000 ft over the equator and tumbles, without air: check case 2 of NASA's
// NESC, a case for the comparison of flight simulators. Prints, every 0.1 s, its attitude against
// the local level below it and its body rates against the inertial frame. The guide is the earth at the point of release, so the fall is small in it. The level below the
// brick turns by the fall's deflection to the east, 6e-5 degrees after 30 s. All decimals except
// the last are certain: the closed form of the tumbling agrees to 5.5e-13 degrees
// (tests/examples/examples.cpp).

using namespace kreisel;

namespace {

constexpr double degree = 0.017453292519943295;

/// North, east and down at the brick, as columns on the axes of the earth.
Matrix3<double> level(const Vector3<double>& p_Earth) {
  double latitude = 0, longitude = 0, height = 0;
  std::vector<double> east_north_up(9);
  GeographicLib::Geocentric::WGS84().Reverse(p_Earth.x(), p_Earth.y(), p_Earth.z(), latitude,
                                             longitude, height, east_north_up);
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const RowMajor enu = Eigen::Map<const RowMajor>(east_north_up.data());
  return (Matrix3<double>() << enu.col(1), enu.col(0), -enu.col(2)).finished();
}

void run() {
  constexpr double slug_ft2 = 1.3558179483314004;  // kg m^2
  const Vector3<double> moments = slug_ft2 * Vector3<double>(0.00189422, 0.006211019, 0.007194665);
  const auto brick = InertiaTensor<Body>::about_centre(2.26796, Vector3<double>::Zero(),
                                                       Matrix3<double>(moments.asDiagonal()));

  // The guide's axes are down, west and north; the brick's axes are along north, east and down.
  const EarthSite<double> release{.latitude = 0, .azimuth = 0, .height = 30000 * 0.3048};
  const auto earth = earth_frame(release);
  const FreeBody body(brick, earth, OblateGravitation<>{});
  decltype(body)::State start;
  const Matrix3<double> along_level = (Matrix3<double>() << 0, 0, 1, 0, -1, 0, 1, 0, 0).finished();
  start.attitude = along_level;
  const Vector3<double> rates = degree * Vector3<double>(10, 20, 30);  // against the inertial frame
  start.velocity.value.resultant = rates - along_level.transpose() * earth(0).V.value.resultant;

  const Pose<double> site = earth.X.value;  // the guide on the axes of the earth
  fmt::print("t,yaw_deg,pitch_deg,roll_deg,p_deg_s,q_deg_s,r_deg_s\n");
  Integrator fall(body, 0, start);
  for (int i = 0; i <= 300; ++i) {
    const double t = i / 10.0;
    const auto [attitude, position, velocity] = fall.to(t);
    const Matrix3<double> to_earth = site.rotation * Pose<double>::from(attitude).rotation;
    const auto angles =
        YawPitchRoll<double>::of(level(site.point(position)).transpose() * to_earth);
    const auto s = body.situation(t, fall.state());
    const Vector3<double> w = (velocity + s.X.inverse() * s.guide.V).value.resultant;
    fmt::print("{:.1f},{:.12f},{:.12f},{:.12f},{:.12f},{:.12f},{:.12f}\n", t, angles.yaw / degree,
               angles.pitch / degree + 0.0, angles.roll / degree + 0.0, w.x() / degree,
               w.y() / degree, w.z() / degree);
  }
}

}  // namespace

int main() {
  try {
    run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "tumbling_brick: {}\n", error.what());
    return 3;
  }
}
