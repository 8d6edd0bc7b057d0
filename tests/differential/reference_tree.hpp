#pragma once

#include <array>
#include <utility>
#include <vector>

#include "reference.hpp"
#include "reference_guide.hpp"

namespace differential::reference {

/// The bodies of a scene in a frame that does not rotate, with the guide's origin as its origin.
///
/// State  : the guide's state. For each body: position of the centre of mass, attitude (x, y, z,
///          w), velocity, and angular velocity on body axes. Angles of joints about axes, because
///          full rotations count in springs and screws
/// Method : M a + J^t l = f, J a = g, solved as one system; g from differentiating each joint's
///          conditions twice
class Tree {
 public:
  explicit Tree(const Scene& scene);

  [[nodiscard]] State start();
  void rates(Real t, const State& y, State& result);
  /// Projects positions and velocities onto the joints' conditions by the least change in the
  /// metric of the masses.
  void project(Real t, State& y);
  [[nodiscard]] JointValues values(Real t, const State& y);
  /// Sizes of the parts of energy and momenta, all counted as positive.
  [[nodiscard]] Sizes sizes(Real t, const State& y);
  /// The force of each body's parent through the joint: force, then torque about the body's origin,
  /// on body axes.
  [[nodiscard]] std::vector<double> reactions(Real t, const State& y);
  /// Takes functions of time on the pieces that contain t: the middle of a step.
  void stay_within(Real t) {
    within_ = t;
    guide_.stay_within(t);
  }
  /// Takes the samples of servos that are due at t. start() has taken those of the start.
  void sample(Real t, State& y);
  /// Readings of the scene's sensors: three numbers for each vector, for an attitude the quaternion
  /// x, y, z, w.
  [[nodiscard]] std::vector<double> readings(Real t, const State& y);
  /// True if an element has a force at the start, with room to move. A spring's ends are apart, and
  /// a mount is rotated by less than 2 rad.
  [[nodiscard]] bool element_works(const Element& element);
  /// False once a mount was rotated by 3 rad, where the library ends a run.
  [[nodiscard]] bool mounts_hold() const { return mounts_hold_; }
  /// Poses of all bodies in the guide at the start: attitude, and position of the origin.
  [[nodiscard]] std::vector<std::pair<Mat, Vec>> start_poses();
  /// The singular values of all conditions at the start, each condition with the length 1;
  /// 0 for each one that follows from others.
  [[nodiscard]] Eigen::VectorXd condition_values();
  /// True if some motion that all conditions allow moves no inertia at the start.
  [[nodiscard]] bool has_idle_motion();
  /// Approximate number of operations of one evaluation.
  [[nodiscard]] double work() const;

 private:
  /// The constant data of a body.
  struct Part {
    Real mass = 0;
    Vec centre = Vec::Zero();
    Mat inertia = Mat::Zero();
    /// Columns: six equal masses at these points and opposite to them have the same inertia.
    Mat masses = Mat::Zero();
    Mat zero = Mat::Identity();     ///< the body's axes at zero coordinates, in the parent's
    Vec axis = Vec::Zero();         ///< unit vectors on the parent's axes
    Vec second_axis = Vec::Zero();  ///< of a planar joint the first direction in its plane
    Real pitch = 0;
    Vec position = Vec::Zero();
    Vec start_place = Vec::Zero();  ///< of the joint's start, on the parent's axes
    Mat start_turn = Mat::Identity();
    Eigen::Index angles = 0;  ///< place of the joint's angles in the state
    bool held = false;
    bool driven = false;
    Real speed = 0;
  };

  /// A body, or the guide, at one time.
  struct Pose {
    Mat R = Mat::Identity();
    Vec x = Vec::Zero();
    Vec v = Vec::Zero();
    Vec w = Vec::Zero();  ///< on inertial axes
  };

  /// A body against its parent or another body, on inertial axes. `base` is the other one, -1 for the
  /// guide. The origin stands for the point of the body that a constraint takes.
  struct Relative {
    int body = 0;
    int base = -1;
    Vec arm;    ///< the body's origin from its centre of mass
    Vec reach;  ///< the same point from the parent's centre of mass
    Vec place;  ///< the body's origin from the joint's point on the parent
    Vec off;    ///< the same from its place in a locked joint
    Vec v;      ///< seen from the parent
    Vec w;
    Mat turn;  ///< parent's axes from the body's, divided by `zero`
    Vec axis;
    Vec second_axis;
    Real near = 0;  ///< the state's first angle of the joint
  };

  /// The data of a constraint at the start, and its rows.
  struct Hold {
    Mat attitude = Mat::Identity();  ///< the second body's axes on the first's
    Eigen::Index first_row = 0;
    Eigen::Index rows = 0;
  };

  /// A frame at one time, on inertial axes; its origin against the guide's.
  struct Frame {
    Mat R = Mat::Identity();
    Vec x = Vec::Zero();
    Vec v = Vec::Zero();
    Vec a = Vec::Zero();
    Vec w = Vec::Zero();
    Vec dw = Vec::Zero();
  };

  /// The values of a body as in a free joint to the guide.
  [[nodiscard]] State free_values(int body, const Motion& guide) const;
  /// The contact of a wheel, and its rate.
  [[nodiscard]] std::pair<Vec, Vec> contact_of(const Constraint& c) const;

  [[nodiscard]] Frame frame(int index, const Motion& guide, const State& accelerations) const;
  [[nodiscard]] Frame at_point(int body, const Vec& at, const State& accelerations) const;

  /// The direction of a plumb line from a point of the guide, on inertial axes.
  [[nodiscard]] Vec plumb_line(Real t, const Motion& guide, const Vec& pivot, Real length) const;
  /// The direction of a swing; NaN if it is not clear.
  [[nodiscard]] Real azimuth(Real t, const Sensor& sensor, const Motion& guide,
                             const Frame& point) const;

  void read(const State& y, const Motion& guide);
  [[nodiscard]] Pose pose(const State& y, int body) const;
  [[nodiscard]] const Pose& parent(int body) const;
  [[nodiscard]] Relative relative(int body) const;
  [[nodiscard]] Eigen::Index at(int body) const { return guide_.size() + 13 * body; }

  void assemble(const Motion& guide);
  /// Speed and acceleration of a driven joint.
  [[nodiscard]] std::pair<Real, Real> drive(int body) const;
  void add_rows(int body, const Relative& r, const Motion& guide);
  void add_translation(const Relative& r, const Motion& guide, const Vec& n);
  void add_rotation(const Relative& r, const Motion& guide, const Vec& n, Real extra, Real off,
                    Real speed);
  /// A point of the second body against one of the first.
  [[nodiscard]] Relative between(const Constraint& c) const;
  void start_constraints(const State& y);
  void add_constraint_rows(const Motion& guide);
  void add_joint_rows(const Constraint& c, const Hold& hold, const Motion& guide);
  void add_parallel(const Relative& r, const Motion& guide, const Vec& axis, const Vec& image);
  void add_equal_attitude(const Relative& r, const Hold& hold, const Motion& guide);
  void add_distance(const Constraint& c, const Motion& guide);
  void add_gear_row(const Constraint& c, const Motion& guide);
  void add_rolling_rows(const Constraint& c, const Motion& guide);
  void add_blade_row(const Constraint& c, const Motion& guide);
  /// The velocities of two bodies at a common point are the same along n.
  ///
  /// dpoint, dn : rates of the point, which may move in both bodies, and of the direction
  void add_contact(const std::array<int, 2>& bodies, const Vec& point, const Vec& dpoint,
                   const Vec& n, const Vec& dn, const Motion& guide);
  /// Adds the forces of constraints to the balance of the bodies. `multipliers` are those of all
  /// conditions, and the matrix is the assembled one.
  void add_constraint_forces(const State& multipliers);
  void add_forces(Real t, const State& y, const Motion& guide);
  void add_joint_force(Real t, int body, const State& y);
  void add_gravity(int body, Real t, const Motion& guide);
  void add_torque(int body, const Vec& torque);
  void add_force(int body, const Relative& r, const Vec& force);
  void assemble_start();
  /// The guide or a body, relative to whose centre of mass points are given.
  [[nodiscard]] Pose pose_of(int body) const;
  [[nodiscard]] Vec centre_of(int body) const;
  /// Force and torque of an element on its second body about its point, on inertial axes.
  [[nodiscard]] std::pair<Vec, Vec> element_force(const Element& element) const;
  [[nodiscard]] std::pair<Vec, Vec> mount_force(const Element& element) const;
  [[nodiscard]] Vec spring_force(const Element& element) const;
  void add_on_body(int body, const Vec& point, const Vec& force, const Vec& torque);
  /// Adds the springs and mounts.
  void add_elements();
  void add_gears(const State& y);

  /// The memory of a servo: integral, filter or derivative, the error before, the output that is
  /// held, and those that wait, the latest first.
  struct Memory {
    Eigen::Index at = 0;
    Eigen::Index size = 4;
  };
  [[nodiscard]] Real servo_error(const Servo& servo, const State& y) const;
  void sample_servo(const Servo& servo, Real e, Real* memory) const;
  /// Sets the outputs of the servos. Needs poses.
  void set_servo_outputs(const State& y);
  /// The angle by which the ends of a mount are rotated. Needs poses.
  [[nodiscard]] Real rotation_of(const Element& mount) const;
  /// The length of a rope that its servos pay out.
  [[nodiscard]] Real paid_out(const Element& element) const;
  /// at_joints : those at joints, too; else loads alone
  void add_servos(bool at_joints);
  void add_servo_load(const Servo& servo, Real u);
  void set_servo_rates(const State& y, State& result) const;
  /// The joint force Q_a of a gear.
  [[nodiscard]] Real gear_force(const Element& element, const State& y) const;
  [[nodiscard]] std::pair<Real, Real> coordinate_of(int body, const State& y) const;
  void add_along_joint(int body, Real force);
  [[nodiscard]] Real element_energy(const Element& element, const State& y) const;
  /// The six numbers of a sensor on an element.
  [[nodiscard]] std::pair<Vec, Vec> constraint_reading(const Sensor& sensor,
                                                       const State& multipliers);
  [[nodiscard]] std::pair<Vec, Vec> element_reading(const Sensor& sensor, const State& y) const;
  void add_drag(const Load& load, int body, const Motion& guide);
  void add_load(Real t, const Load& load, int body, const Motion& guide);
  void solve();
  [[nodiscard]] Vec turned_off(int body, const Relative& r) const;
  [[nodiscard]] std::pair<Real, Real> angles_of(int body, const Relative& r) const;
  /// The directions of a planar joint, on inertial axes.
  [[nodiscard]] std::pair<Vec, Vec> plane_of(int body, const Relative& r) const;
  void start_body(int body, State& y, std::vector<Pose>& poses);

  const Scene& scene_;
  Guide guide_;
  std::vector<Part> parts_;
  std::vector<int> parents_;
  std::vector<Hold> holds_;
  std::vector<Memory> memories_;
  Eigen::Index size_ = 0;
  Real within_ = 0;
  Real now_ = 0;
  // Data of one evaluation.
  Pose guide_pose_;
  std::vector<Pose> poses_;
  std::vector<Real> first_angles_;
  std::vector<Real> outputs_;  ///< of the servos
  bool mounts_hold_ = true;
  Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix_;
  State right_;
  std::vector<Eigen::Index> pivots_;  ///< columns
  State solution_;
  std::vector<Real> off_place_;  ///< violation of each condition
  std::vector<Real> off_velocity_;
  Eigen::Index rows_ = 0;
};

}  // namespace differential::reference
