#include <boost/test/unit_test.hpp>

#include <dynamics/all.hpp>

using namespace kreisel;

// One header is enough to put a body on a guide and compute its motion.
BOOST_AUTO_TEST_CASE(motion_from_one_header) {
  const AnyGuide turntable = RotatingFrame<>{.angular_velocity = {0, 0, 0.1}};
  const auto rod = InertiaTensor<Body>::about_origin(
      1, {0, 0, -1}, Matrix3<double>(Vector3<double>(1.1, 1.1, 0.1).asDiagonal()));
  const FixedPointBody pendulum(rod, {0, 0, 0}, turntable, UniformGravity<Guide>{{0, 0, -9.81}});
  const auto run = solve(pendulum, {}, {.t_end = 1, .output_step = 0.5});
  BOOST_TEST(run.times.size() == 3U);
  BOOST_TEST(run.report.tolerance_kept);
}
