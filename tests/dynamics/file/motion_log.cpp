#include <boost/test/unit_test.hpp>

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <dynamics/file/motion_log.hpp>
#include <motor/attitude.hpp>

#include <support/scratch.hpp>

using namespace kreisel;
using test::Scratch;

namespace {

/// The error message for a text, without the folder; empty if it is read.
std::string complaint(const std::string& text, const LogOptions& options = {}) {
  const Scratch folder;
  try {
    (void)read_motion_log(folder.write("log.csv", text), options);
    return "";
  } catch (const InvalidInput& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(motion_log)

BOOST_AUTO_TEST_CASE(all_digits_of_a_motion_are_read) {
  MotionLog<> log;
  for (int i = 0; i < 9; ++i) {
    const double t = 0.1 * i;
    log.times.push_back(t);
    log.attitudes.emplace_back(
        YawPitchRoll<double>{0.1 * t, 0.2 * std::sin(t), std::cos(3 * t)}.rotation());
    log.positions.emplace_back(5 * t, std::sin(t), std::cos(t));
  }
  const Scratch scratch;
  const auto path = scratch.path() / "log.csv";
  std::ofstream out(path);
  out.precision(17);
  out << "t, qw, qx, qy, qz, x, y, z\n";
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    const Eigen::Quaterniond& q = log.attitudes[i];
    const Vector3<double>& x = log.positions[i];
    out << log.times[i] << ',' << q.w() << ',' << q.x() << ',' << q.y() << ',' << q.z() << ','
        << x.x() << ',' << x.y() << ',' << x.z() << '\n';
  }
  out.close();
  const LoggedMotion read = read_motion_log(path);
  BOOST_TEST(read.motion.times == log.times);
  for (std::size_t i = 0; i < log.times.size(); ++i) {
    BOOST_TEST(read.motion.attitudes[i].coeffs() == log.attitudes[i].coeffs());
    BOOST_TEST(read.motion.positions[i] == log.positions[i]);
    BOOST_TEST(read.lines[i] == i + 2);
  }
}

BOOST_AUTO_TEST_CASE(angles_turn_about_z_then_y_then_x) {
  const std::string text =
      "t;surge;sway;heave;roll;pitch;yaw\n0.0;1.00;2.00;3.00;5.0;-20.0;170.0\n"
      "0.1;1.00;2.00;3.00;5.0;-20.0;170.0\n0.2;1.00;2.00;3.00;5.0;-20.0;190.0\n"
      "0.3;1.00;2.00;3.00;5.0;-20.0;-150.0\n";
  LogOptions options;
  options.degrees = true;
  const Scratch folder;
  const LoggedMotion log = read_motion_log(folder.write("log.csv", text), options);
  constexpr double degree = 3.14159265358979323846 / 180;
  const Eigen::Quaterniond expected(
      YawPitchRoll<double>{170 * degree, -20 * degree, 5 * degree}.rotation());
  BOOST_TEST(log.motion.attitudes[1].angularDistance(expected) < 1e-14);
  BOOST_TEST(log.motion.positions[1] == Vector3<double>(1, 2, 3));
  // Written to a tenth of a degree and to centimetres.
  BOOST_TEST(std::abs(log.attitude_resolution / (0.05 * degree) - 1) < 1e-14);
  BOOST_TEST(log.position_resolution == 0.01);
  BOOST_TEST(log.time_resolution == 0.1);
}

BOOST_AUTO_TEST_CASE(a_quaternion_may_change_its_sign) {
  BOOST_TEST(complaint("t,qw,qx,qy,qz\n0,1,0,0,0\n1,-1,0,0,0\n2,1,0,0,0\n3,-1,0,0,0\n") == "");
}

BOOST_AUTO_TEST_CASE(logs_without_a_motion_are_refused) {
  BOOST_TEST(complaint("t,qw,qx,qy,qz\n0,1,0,0,0\n1,1,0,0,0\n") ==
             "log.csv: 2 rows where a motion needs 4 or more");
  BOOST_TEST(complaint("t,qw,qx,qy,qz\n0,1,0,0,0\n\n1,0,1,0,0\n2,0,1,0,0\n3,0,1,0,0\n") ==
             "log.csv:4: the attitude turns by more than 90 degrees between line 2 (t = 0 s) and "
             "line 4 (t = 1 s): the log is too coarse; check  columns  and  angles");
  BOOST_TEST(complaint("t,qw,qx,qy,qz,x\n0,1,0,0,0,0\n")
                 .starts_with("log.csv:1: no column for y, z among"));
}

BOOST_AUTO_TEST_SUITE_END()
