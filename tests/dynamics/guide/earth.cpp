#include <GeographicLib/NormalGravity.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include <dynamics/guide/earth.hpp>
#include <dynamics/guide/normal_gravity.hpp>

#include <support/near.hpp>
#include <support/worst.hpp>

namespace data = boost::unit_test::data;
using namespace kreisel;
using Exact = boost::multiprecision::cpp_bin_float_50;

namespace {

constexpr double u = 0x1p-53;

/// |value - truth| <= k u |scale|.
test::Verdict near(double value, double truth, double scale, double k) {
  return test::near(value, truth, std::abs(scale), k);
}

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "nothing was thrown";
}

EarthSite<double> random_site(unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  EarthSite<double> site;
  site.latitude = uniform(-90, 90);
  site.azimuth = uniform(-360, 360);
  site.height = uniform(-500, 9000);
  return site;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sine_and_cosine_of_degrees)

BOOST_AUTO_TEST_CASE(are_exact_if_possible) {
  const double half_root = std::sqrt(0.5);
  struct Row {
    double angle, sine, cosine;
  };
  for (const Row& row :
       {Row{0, 0, 1}, Row{30, 0.5, std::sqrt(0.75)}, Row{45, half_root, half_root},
        Row{60, std::sqrt(0.75), 0.5}, Row{90, 1, 0}, Row{120, std::sqrt(0.75), -0.5},
        Row{135, half_root, -half_root}, Row{150, 0.5, -std::sqrt(0.75)}, Row{180, 0, -1},
        Row{225, -half_root, -half_root}, Row{270, -1, 0}, Row{330, -0.5, std::sqrt(0.75)},
        Row{360, 0, 1}, Row{1e12 * 360 + 90, 1, 0}}) {
    for (const double sign : {1.0, -1.0}) {
      const auto [sine, cosine] = sine_cosine_degrees(sign * row.angle);
      BOOST_TEST(sine == sign * row.sine);
      BOOST_TEST(cosine == row.cosine);
    }
  }
  BOOST_TEST(!std::signbit(sine_cosine_degrees(180.0).sine));
}

BOOST_AUTO_TEST_CASE(err_by_less_than_three_units) {
  const Exact degree = acos(Exact(-1)) / 180;
  std::mt19937_64 engine(1);
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double size = std::pow(10.0, std::uniform_real_distribution<double>(-8, 3)(engine));
    const double angle = std::uniform_real_distribution<double>(-size, size)(engine);
    const auto [sine, cosine] = sine_cosine_degrees(angle);
    const Exact exact_sine = sin(Exact(Exact(angle) * degree));
    const Exact exact_cosine = cos(Exact(Exact(angle) * degree));
    const Exact error_s = abs(Exact((sine - exact_sine) / exact_sine));
    const Exact error_c = abs(Exact((cosine - exact_cosine) / exact_cosine));
    worst = test::worst_of(worst, error_s.convert_to<double>(), error_c.convert_to<double>());
  }
  std::cout << "sine_cosine_degrees: worst relative error " << worst / u << " u\n";
  BOOST_TEST(worst < 3 * u);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(site_with_known_gravity)

// Anchor: at 45 degrees north, axis pointing east: x down, y north, z east.
BOOST_AUTO_TEST_CASE(east_west_axis_in_the_north) {
  const EarthSite<double> site{.latitude = 45, .azimuth = 90};
  const EarthGuide<double> guide = earth_guide(site, 9.81);
  const Vector3<double>& w = guide.angular_velocity;
  BOOST_TEST(near(w.x(), -7.292115e-5 * std::sqrt(0.5), w.x(), 2));
  BOOST_TEST(w.y() == -w.x());  // so that K of (23) is exactly 0
  BOOST_TEST(w.z() == 0);
  BOOST_TEST((guide.effective_gravity == Vector3<double>(9.81, 0, 0)));
}

BOOST_AUTO_TEST_CASE(default_rotation_rate_is_the_decimal) {
  BOOST_TEST(EarthSite<double>{}.rotation_rate == 7.292115e-5);
  BOOST_TEST(EarthSite<long double>{}.rotation_rate == 7.292115e-5L);
  BOOST_TEST(abs(Exact(EarthSite<Exact>{}.rotation_rate - Exact("7.292115e-5"))) < Exact("1e-53"));
}

// Axes from the compass: z level with the azimuth, x down, y = z x x; the earth's axis points north
// and up.
BOOST_DATA_TEST_CASE(rotation_follows_the_earths_axis, data::xrange(100u), seed) {
  const EarthSite<double> site = random_site(seed);
  const double degree = std::numbers::pi / 180;
  const double azimuth = site.azimuth * degree;
  const double latitude = site.latitude * degree;
  const Vector3<double> down(0, 0,
                             -1);  // (north, east, up) has the left hand: take (east, north, up)
  const Vector3<double> z(std::sin(azimuth), std::cos(azimuth), 0);
  const Vector3<double> y = z.cross(down);
  const Vector3<double> axis(0, std::cos(latitude), std::sin(latitude));
  const Vector3<double> w = earth_rotation(site) / site.rotation_rate;
  BOOST_TEST(near(w.x(), axis.dot(down), 1, 16));
  BOOST_TEST(near(w.y(), axis.dot(y), 1, 16));
  BOOST_TEST(near(w.z(), axis.dot(z), 1, 16));
}

BOOST_AUTO_TEST_CASE(invalid_sites_are_refused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](const EarthSite<double>& site, double gravity = 9.81) {
    return message_of([&] { (void)earth_guide(site, gravity); });
  };
  BOOST_TEST(refusal({.latitude = 91}) == "latitude = 91 degrees lies outside [-90, 90] degrees");
  BOOST_TEST(refusal({.latitude = nan}) == "latitude = nan degrees lies outside [-90, 90] degrees");
  BOOST_TEST(refusal({.azimuth = 1000}) ==
             "azimuth = 1000 degrees lies outside [-360, 360] degrees");
  BOOST_TEST(refusal({.height = -20000}) == "height = -20000 m lies outside [-11000, 10000000] m");
  BOOST_TEST(refusal({.rotation_rate = std::numeric_limits<double>::infinity()}) ==
             "rotation_rate = inf rad/s lies outside [-1000, 1000] rad/s");
  BOOST_TEST(refusal({}, 0) == "gravity = 0 m/s^2 must be a finite number above 0");
  BOOST_TEST(refusal({}, -9.81) == "gravity = -9.81 m/s^2 must be a finite number above 0");
  BOOST_TEST(refusal({}, nan) == "gravity = nan m/s^2 must be a finite number above 0");
  BOOST_TEST(refusal({}) == "nothing was thrown");
  BOOST_CHECK_THROW((void)normal_gravity({.latitude = -90.001}), InvalidInput);
}

BOOST_AUTO_TEST_SUITE_END()

BOOST_AUTO_TEST_SUITE(wgs84)

BOOST_DATA_TEST_CASE(gravity_on_the_ellipsoid_is_somiglianas,
                     data::make({-90.0, -47.3, 0.0, 30.0, 45.0, 52.38, 90.0}), latitude) {
  EarthSite<double> site{.latitude = latitude};
  const auto& wgs84 = GeographicLib::NormalGravity::WGS84();
  site.rotation_rate = wgs84.AngularVelocity();
  const NormalGravity at = normal_gravity(site);
  BOOST_TEST(near(at.magnitude, wgs84.SurfaceGravity(latitude), 10, 16));
  BOOST_TEST(near(at.tilt, 0, 1, 16));
  BOOST_TEST(near(at.latitude_of_vertical, latitude, 90, 16));
}

// The two constants of the definition, m/s^2.
BOOST_AUTO_TEST_CASE(equator_and_pole_have_the_published_values) {
  const EarthSite<double> equator{.latitude = 0};
  const EarthSite<double> pole{.latitude = 90};
  BOOST_TEST(std::abs(normal_gravity(equator).magnitude - 9.7803253359) < 1e-9);
  BOOST_TEST(std::abs(normal_gravity(pole).magnitude - 9.8321849378) < 1e-9);
}

BOOST_DATA_TEST_CASE(gravity_is_gravitation_and_centrifugal, data::xrange(50u), seed) {
  EarthSite<double> site = random_site(seed);
  const auto& wgs84 = GeographicLib::NormalGravity::WGS84();
  site.rotation_rate = wgs84.AngularVelocity();
  const NormalGravity at = normal_gravity(site);
  double north = 0;
  double up = 0;
  wgs84.Gravity(site.latitude, site.height, north, up);
  BOOST_TEST(near(at.effective().x(), north, 10, 16));
  BOOST_TEST(at.effective().y() == 0);
  BOOST_TEST(near(at.effective().z(), up, 10, 16));
  BOOST_TEST(near(at.centrifugal.norm(),
                  site.rotation_rate * site.rotation_rate * 6.4e6 *
                      std::cos(site.latitude * std::numbers::pi / 180),
                  0.034, 0.01 / u));
}

BOOST_AUTO_TEST_CASE(centrifugal_part_follows_the_rotation_rate) {
  EarthSite<double> site{.latitude = 0};
  const double g = normal_gravity(site).magnitude;
  site.rotation_rate = 0;
  const NormalGravity still = normal_gravity(site);
  BOOST_TEST(near(still.magnitude - g, 7.292115e-5 * 7.292115e-5 * 6378137, 10, 4));
  BOOST_TEST((still.guide.angular_velocity == Vector3<double>::Zero()));
  // At 45 degrees the surface of the rotating ellipsoid is not level without rotation.
  site.latitude = 45;
  const double pull = 7.292115e-5 * 7.292115e-5 * 6378137 / 2;
  BOOST_TEST(near(normal_gravity(site).tilt, pull / 9.81, pull / 9.81, 0.01 / u));
  // 17 rotations a day: gravity vanishes at the equator.
  site.latitude = 0;
  site.rotation_rate = 17.1 * 7.292115e-5;
  BOOST_TEST(message_of([&] { (void)normal_gravity(site); }).find("gravity does not point down") !=
             std::string::npos);
}

// The plumb line is curved towards the pole above: 0.171" per km at 45 degrees (Heiskanen and
// Moritz, 5-5).
BOOST_AUTO_TEST_CASE(vertical_tilts_with_height) {
  const NormalGravity at = normal_gravity({.latitude = 45, .azimuth = 90, .height = 1000});
  const double second = std::numbers::pi / 180 / 3600;
  BOOST_TEST(near(at.tilt, -0.171 * second, 0.171 * second, 0.01 / u));
  BOOST_TEST(at.latitude_of_vertical > 45);
  // u on the guide's axes is that of a site with this latitude and known gravity.
  EarthSite<double> observed{.latitude = at.latitude_of_vertical, .azimuth = 90};
  const EarthGuide<double> same = earth_guide(observed, at.magnitude);
  BOOST_TEST((same.angular_velocity - at.guide.angular_velocity).norm() <= 8 * u * 7.3e-5);
  BOOST_TEST((same.effective_gravity == at.guide.effective_gravity));
}

BOOST_DATA_TEST_CASE(rotation_keeps_its_size_and_axes, data::xrange(50u), seed) {
  const EarthSite<double> site = random_site(seed);
  const NormalGravity at = normal_gravity(site);
  EarthSite<double> observed = site;
  observed.latitude = at.latitude_of_vertical;
  BOOST_TEST((at.guide.angular_velocity - earth_rotation(observed)).norm() <= 16 * u * 7.3e-5);
}

// The potential of the level ellipsoid in zonal harmonics, differentiated in 50 digits.
Exact potential(const Exact& x, const Exact& y, const Exact& z) {
  const auto& wgs84 = GeographicLib::NormalGravity::WGS84();
  const Exact r2 = x * x + y * y + z * z;
  const Exact r = sqrt(r2);
  const Exact t = z / r;
  const Exact ratio2 = Exact(wgs84.EquatorialRadius()) * Exact(wgs84.EquatorialRadius()) / r2;
  Exact before = 1;
  Exact legendre = t;  // P_1
  Exact power = 1;
  Exact sum = 1;
  for (int n = 2; n <= 16; ++n) {
    const Exact next = ((2 * n - 1) * t * legendre - (n - 1) * before) / n;
    before = legendre;
    legendre = next;
    if (n % 2 == 0) {
      power *= ratio2;
      sum -= Exact(wgs84.DynamicalFormFactor(n)) * power * legendre;
    }
  }
  return Exact(wgs84.MassConstant()) / r * sum;
}

BOOST_DATA_TEST_CASE(gradient_has_eleven_digits, data::xrange(12u), seed) {
  const EarthSite<double> site = random_site(seed);
  const NormalGravity at = normal_gravity(site);
  const Matrix3<double>& gradient = at.guide.gravity_gradient;
  const double scale = gradient.norm();

  Vector3<double> p;
  GeographicLib::Geocentric::WGS84().Forward(site.latitude, 0, site.height, p.x(), p.y(), p.z());
  // Guide axes in the geocentric frame, from the effective vertical's latitude.
  const auto [s, c] = sine_cosine_degrees(at.latitude_of_vertical);
  const auto [sa, ca] = sine_cosine_degrees(site.azimuth);
  const Vector3<double> down(-c, 0, -s);
  const Vector3<double> north(-s, 0, c);
  const Vector3<double> east(0, 1, 0);
  const std::array<Vector3<double>, 3> axes{down, sa * north - ca * east, ca * north + sa * east};

  const Exact h("1e-12");
  const auto value = [&](const std::array<Exact, 3>& q) { return potential(q[0], q[1], q[2]); };
  const auto second = [&](const Vector3<double>& a, const Vector3<double>& b) {
    const auto shifted = [&](int i, int j) {
      std::array<Exact, 3> q;
      for (int k = 0; k < 3; ++k) {
        q[static_cast<std::size_t>(k)] = Exact(p[k]) + h * (i * Exact(a[k]) + j * Exact(b[k]));
      }
      return value(q);
    };
    const Exact result =
        (shifted(1, 1) - shifted(1, -1) - shifted(-1, 1) + shifted(-1, -1)) / (4 * h * h);
    return result.convert_to<double>();
  };
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double truth =
          second(axes[static_cast<std::size_t>(i)], axes[static_cast<std::size_t>(j)]);
      worst = test::worst_of(worst, std::abs(gradient(i, j) - truth) / scale);
    }
  }
  const double trace = std::abs(gradient.trace()) / scale;
  std::cout << "gradient: error " << std::setprecision(2) << worst << ", trace " << trace << '\n';
  BOOST_TEST(worst < 5e-12);
  BOOST_TEST(trace < 5e-12);
  BOOST_TEST((gradient == gradient.transpose()));
}

BOOST_DATA_TEST_CASE(spherical_gradient_is_right_to_one_per_cent, data::xrange(50u), seed) {
  const EarthSite<double> site = random_site(seed);
  const Matrix3<double> ellipsoid = normal_gravity(site).guide.gravity_gradient;
  const Matrix3<double> sphere = earth_guide(site, 9.81).gravity_gradient;
  BOOST_TEST((ellipsoid - sphere).norm() < 0.01 * ellipsoid.norm());
}

// Eastward, nothing changes by symmetry: the meridian is a plane of symmetry.
BOOST_AUTO_TEST_CASE(east_west_gradient_lies_in_the_meridian) {
  const auto gradient =
      normal_gravity({.latitude = 40, .azimuth = 90, .height = 500}).guide.gravity_gradient;
  BOOST_TEST(gradient(0, 2) == 0);
  BOOST_TEST(gradient(1, 2) == 0);
  BOOST_TEST(gradient(0, 1) > 0);  // gravity grows towards the pole
}

BOOST_AUTO_TEST_SUITE_END()
