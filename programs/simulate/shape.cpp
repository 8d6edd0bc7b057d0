#include "shape.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

#include <dynamics/tree/joint/list.hpp>

using namespace kreisel;

using Eigen::Matrix3d;
using Eigen::Vector3d;
using kreisel::BodyDescription;
using kreisel::BodyTree;
using kreisel::JointKind;

namespace {

/// The greatest distance between a joint and a body's centre that counts as 0, as a share of the
/// parts that rotate there.
constexpr double at_centre = 0.05;

std::size_t slot(int i) { return static_cast<std::size_t>(i); }

kreisel::detail::JointParts parts(const kreisel::Joint& joint) {
  return kreisel::joint_type(joint.kind).parts(joint);
}

/// True if a body rotates about axes alone.
bool turns(const BodyDescription& body) {
  const auto all = parts(body.joint);
  return std::all_of(all.begin(), all.end(), [](const auto& part) {
    return part.kind == kreisel::detail::LinkKind::revolute;
  });
}

Vector3d centre(const BodyDescription& body) {
  const auto& T = body.inertia.value;
  return T.mass > 0 ? Vector3d(T.first_moment / T.mass) : Vector3d(Vector3d::Zero());
}

/// True if a body is drawn as a wheel on the axis of its joint.
bool is_wheel(const BodyDescription& body, bool has_children) {
  if (body.rotor) return true;
  if (body.joint.kind != JointKind::revolute || has_children) return false;
  const Vector3d axis = last_axis(body);
  const Matrix3d tensor = body.inertia.value.tensor.matrix();
  return centre(body).cross(axis).norm() <= 1e-6 * std::sqrt(tensor.trace()) &&
         (tensor * axis).cross(axis).norm() <= 1e-6 * tensor.trace();
}

/// The solid with the body's mean squares of mass coordinates. These are half the trace of the
/// tensor minus the moment about the axis, divided by the mass. Half the side squared is 3 of them
/// in a box, 5 in an ellipsoid; in a cylinder 4 across, 3 along.
Shape solid(const BodyDescription& body, bool wheel) {
  const auto& T = body.inertia.value;
  Shape shape{"ellipsoid", Matrix3d::Identity(), centre(body), Vector3d::Zero()};
  if (!(T.mass > 0)) return shape;
  const Matrix3d tensor =
      T.tensor.matrix() - T.mass / 2 * kreisel::offset_product(shape.centre, shape.centre).matrix();
  // The largest moment is the last, so that a wheel gets its axis as the third one.
  const Vector3d axis = wheel ? last_axis(body) : Vector3d(Vector3d::Zero());
  const Matrix3d marked = tensor + 2 * tensor.trace() * axis * axis.transpose();
  shape.axes = Eigen::SelfAdjointEigenSolver<Matrix3d>(marked).eigenvectors();
  const Vector3d moments = (shape.axes.transpose() * tensor * shape.axes).diagonal();
  Vector3d squares = (Vector3d::Constant(moments.sum() / 2) - moments).cwiseMax(0) / T.mass;
  const auto same = [&squares](int i, int k) {
    return std::abs(squares[i] - squares[k]) <= 1e-3 * squares.sum();
  };
  if (wheel || (same(0, 1) && !same(1, 2))) {
    shape.form = "cylinder";
  } else if (same(1, 2) && !same(0, 1)) {
    shape.form = "cylinder";
    const Matrix3d axes = shape.axes;
    shape.axes << axes.col(1), axes.col(2), axes.col(0);
    squares = Vector3d(squares[1], squares[2], squares[0]);
  } else if (!same(0, 1)) {
    shape.form = "box";
  }
  if (shape.form == "cylinder") {
    shape.half = Vector3d(4, 4, 3).cwiseProduct(squares).cwiseSqrt();
  } else {
    shape.half = ((shape.form == "box" ? 3 : 5) * squares).cwiseSqrt();
  }
  return shape;
}

/// The greatest distance of its points from the body's origin.
double reach(const Shape& shape) {
  const Vector3d& half = shape.half;
  if (shape.form == "cylinder") {
    return shape.centre.norm() + std::hypot(std::max(half.x(), half.y()), half.z());
  }
  return shape.centre.norm() + (shape.form == "box" ? half.norm() : half.maxCoeff());
}

/// A ring in the plane of its own axis and of the axis of the held body, which contains both
/// bearings.
Shape ring(const BodyDescription& body, const Vector3d& held_axis, double inside) {
  const Vector3d axis = last_axis(body);
  Vector3d normal = axis.cross(held_axis);
  normal = normal.norm() > 1e-6 ? normal.normalized() : axis.unitOrthogonal();
  Matrix3d axes;
  axes << axis, normal.cross(axis), normal;
  const double outside = 1.2 * inside;
  return {"ring", axes, Vector3d::Zero(), {outside, outside, 0.06 * inside}};
}

bool holds_a_joint(const Shape& shape, const std::vector<Vector3d>& joints) {
  return std::any_of(joints.begin(), joints.end(), [&shape](const Vector3d& joint) {
    const Vector3d there = shape.axes.transpose() * (joint - shape.centre);
    return (there.array().abs() < 0.99 * shape.half.array()).all();
  });
}

}  // namespace

Vector3d last_axis(const BodyDescription& body) {
  const auto& joint = body.joint;
  const Vector3d axis = parts(joint).back().axis;
  if (axis.isZero()) return Vector3d::UnitZ();
  return joint.orientation.normalized().conjugate() * axis.normalized();
}

std::vector<Shape> shapes(const BodyTree& tree) {
  const int n = static_cast<int>(tree.bodies().size());
  std::vector<Shape> all(slot(n));
  std::vector<std::vector<int>> children(slot(n));
  for (int i = n - 1; i >= 0; --i) {  // children come after their parents
    const BodyDescription& body = tree.body(i);
    if (body.parent != "guide") children[slot(tree.index(body.parent))].push_back(i);
    double inside = 0;
    Vector3d held_axis = Vector3d::Zero();
    std::vector<Vector3d> joints;
    for (const int child : children[slot(i)]) {
      const auto& joint = tree.body(child).joint;
      joints.push_back(joint.position);
      const double needed = reach(all[slot(child)]);
      if (!turns(tree.body(child)) || joint.position.norm() > at_centre * needed) continue;
      if (needed < inside) continue;
      inside = needed;
      held_axis = joint.axis.normalized();
    }
    Shape& shape = all[slot(i)];
    const bool is_ring = turns(body) && inside > 0 && centre(body).norm() <= at_centre * inside;
    const bool wheel = is_wheel(body, !joints.empty());
    shape = is_ring ? ring(body, held_axis, inside) : solid(body, wheel);
    shape.holds_a_joint = !is_ring && holds_a_joint(shape, joints);
    shape.mark = shape.centre.norm() > at_centre * shape.half.maxCoeff()
                     ? shape.centre
                     : Vector3d(shape.axes.col(2) * shape.half.z());
    if (is_ring || wheel) {
      const double length = 1.2 * (is_ring ? shape.half.x() : reach(shape));
      shape.axle = length * last_axis(body);
      shape.axle_begin = is_ring ? shape.half.x() / length : 0;
      if (wheel) shape.mark = shape.axle;
    }
  }
  return all;
}
