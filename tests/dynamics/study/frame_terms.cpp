// The six kinds of terms of paper 000 in numbers, against its rows (27), corrected.

#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <vector>

#include <dynamics/study/frame_terms.hpp>

using namespace kreisel;

namespace {

BodyDescription body(const std::string& name, const std::string& parent,
                     const Vector3<double>& axis, const Vector3<double>& moments) {
  BodyDescription result;
  result.name = name;
  result.parent = parent;
  result.joint = {.kind = JointKind::revolute, .axis = axis};
  result.inertia = {{1, {0, 0, 0}, {moments.x(), moments.y(), moments.z()}}};
  return result;
}

constexpr double C_6 = 0.02, C_8 = 0.03, J = 0.01;

/// The frames 4, 5 and 7 of the paper's platform with the rotors 6 and 8, on a guide in its place.
/// The housings are isotropic, so that H_1 = H_2.
std::vector<BodyDescription> twin_gyros() {
  const Vector3<double> even(J, J, J);
  std::vector<BodyDescription> bodies{
      body("4", "guide", {0, 1, 0}, even), body("5", "4", {0, 0, 1}, even),
      body("6", "5", {1, 0, 0}, {C_6, C_6, C_6}), body("7", "4", {0, 0, -1}, even),
      body("8", "7", {-1, 0, 0}, {C_8, C_8, C_8})};
  for (const std::size_t i : {2, 4}) bodies[i].rotor = Rotor{.mode = RotorMode::regulated};
  return bodies;
}

void check_row(const Eigen::VectorXd& found, const Vector3<double>& rows, const char* what) {
  const Vector3<double> frames(found[0], found[1], found[3]);
  BOOST_TEST((frames - rows).norm() <= 2e-7 + 1e-12 * rows.norm(), what << ": " << frames);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(terms_of_frames_with_rotors)

// At angles of 1e-4 rad the restraint's terms of second order are below 1e-7 N m.
BOOST_AUTO_TEST_CASE(are_the_rows_of_the_platform) {
  const FrameTermsOf terms(twin_gyros());
  BOOST_TEST(terms.has_rotors());
  const double L_6 = C_6 * 300, L_8 = C_8 * 250;
  const Vector3<double> W(0.3, -0.2, 0.5), dW(1.1, 0.7, -0.4);
  const Eigen::Vector<double, 5> q(1e-4, -2e-4, 7, 3e-4, -5), v(0.2, -0.1, 300, 0.4, 250),
      dv(2, -3, 0, 1, 0);
  const FrameTerms found = terms({W, dW}, q, v, dv);
  const double J_4 = J + 2 * J + C_6 + C_8, J_5 = J + C_6, J_7 = J + C_8;
  check_row(found.inertia, {J_4 * dv[0], J_5 * dv[1], J_7 * dv[3]}, "J q''");
  check_row(found.gyroscopic, {L_6 * v[1] + L_8 * v[3], -L_6 * v[0], -L_8 * v[0]}, "L q'");
  check_row(found.restraint, {(L_6 - L_8) * W.x() * q[0], L_6 * W.x() * q[1], -L_8 * W.x() * q[3]},
            "L W q");
  check_row(found.guide_inertia, {J_4 * dW.y(), J_5 * dW.z(), -J_7 * dW.z()}, "J W.");
  check_row(found.guide_gyroscopic, {(L_6 - L_8) * W.z(), -L_6 * W.y(), -L_8 * W.y()}, "L W");
}

// Spheres feel no change of W at first order. A flat rotor does, by the difference of its moments.
BOOST_AUTO_TEST_CASE(changes_of_the_guide_act_with_an_angle) {
  std::vector<BodyDescription> bodies = twin_gyros();
  bodies[2].inertia.value.tensor = {C_6, C_6 / 2, C_6 / 2, 0, 0, 0};
  const FrameTermsOf terms(bodies);
  const Vector3<double> dW(1.1, 0, 0);
  const Eigen::Vector<double, 5> q(0, 1e-4, 0, 0, 0), v(0, 0, 0, 0, 0), dv = v;
  const FrameTerms found = terms({{0, 0, 0}, dW}, q, v, dv);
  BOOST_TEST(std::abs(found.guide_change[0] - C_6 / 2 * dW.x() * q[1]) < 1e-12);
  BOOST_TEST(std::abs(found.left_out[0]) < 1e-12);
}

// The parts of any tree sum to its inverse dynamics, and J W W is left out.
BOOST_AUTO_TEST_CASE(sum_to_the_inverse_dynamics) {
  const FrameTermsOf terms(twin_gyros());
  const Eigen::Vector<double, 5> q(0.3, -0.4, 2, 0.5, 1), v(0.2, -0.1, 30, 0.4, 25),
      dv(2, -3, 0, 1, 0);
  const FrameTurning<double> guide{{0.3, -0.2, 0.5}, {1, 2, 3}};
  const FrameTerms f = terms(guide, q, v, dv);
  const BodySystem system(
      [&](double) {
        FrameMotion<Guide, Inertial> motion;
        motion.V.value.resultant = guide.u;
        motion.dV.value.resultant = guide.du;
        return motion;
      },
      twin_gyros());
  BodyWorkspace w = system.workspace();
  Eigen::VectorXd y(10), wanted;
  y << q, v;
  system.joint_forces(0, y, dv, wanted, w);
  const Eigen::VectorXd sum = f.inertia + f.gyroscopic + f.restraint + f.guide_change +
                              f.guide_inertia + f.guide_gyroscopic + f.left_out;
  for (const int i : {0, 1, 3}) BOOST_TEST(std::abs(sum[i] - wanted[i]) < 1e-12);
  BOOST_TEST(f.left_out.norm() > 1e-3);
}

BOOST_AUTO_TEST_SUITE_END()
