#pragma once

#include <Eigen/Geometry>

#include <vector>

#include <motor/motor.hpp>

namespace kreisel::detail {

/// The numbers of a constraint, for checks: all are finite, no direction is 0, lengths are positive.
struct ConstraintNumbers {
  std::vector<double> all = {};
  std::vector<Vector3<double>> directions = {};
  std::vector<double> lengths = {};

  void add(double number) { all.push_back(number); }
  void add(const Vector3<double>& v) { all.insert(all.end(), v.begin(), v.end()); }
  void add_direction(const Vector3<double>& v) {
    add(v);
    directions.push_back(v);
  }
  void add_length(double length) {
    add(length);
    lengths.push_back(length);
  }
  void add_attitude(const Eigen::Quaterniond& q) {
    all.insert(all.end(), q.coeffs().begin(), q.coeffs().end());
    directions.emplace_back(q.norm(), 0, 0);
  }
};

}  // namespace kreisel::detail
