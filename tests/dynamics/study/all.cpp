#include <boost/test/unit_test.hpp>

#include <dynamics/rigid/euler_top.hpp>
#include <dynamics/study/all.hpp>

using namespace kreisel;

// One header is enough to study a scene. A top that turns by w about its greatest axis has small
// deviations with p' = (B - C)/A w q and q' = (C - A)/B w p.
BOOST_AUTO_TEST_CASE(study_from_one_header) {
  const EulerTop top({1, 2, 3});
  const auto y = EulerTop::to_vector({Eigen::Quaterniond::Identity(), {0, 0, 2}});
  const auto linear = linearize<Inertial, Body>(top, 0, y, {0});
  BOOST_TEST(linear.A.rows() == 6);
  BOOST_TEST(linear.A(3, 4) == -2);
  BOOST_TEST(linear.A(4, 3) == 2);
}
