#pragma once

#include <Eigen/Geometry>

#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include <motor/attitude.hpp>
#include <motor/error.hpp>

namespace kreisel {

/// The directions in which a state can move. Each quaternion has three small angles on the turned
/// body's axes in place of its four numbers.
///
///   y -> (.., q exp(theta/2), ..),   dy = E eta,   E = dy/d eta
///
/// Linear equations in eta have no spurious zero roots of a quaternion's norm.
///
/// Units  : radian for the angles; those of the state for the rest
class Tangent {
 public:
  /// `quaternions` are the positions in y at which a quaternion (x, y, z, w) begins.
  ///
  /// Throws : InvalidInput if they overlap or exceed the state's number of components
  Tangent(int components, std::vector<int> quaternions)
      : components_(components), quaternions_(std::move(quaternions)) {
    int free = 0;
    for (const int at : quaternions_) {
      if (at < free || at + 4 > components) {
        std::ostringstream text;
        text << "a quaternion at component " << at << " does not fit into a state of " << components
             << ", or overlaps the one before";
        throw InvalidInput(text.str());
      }
      free = at + 4;
    }
  }

  /// The number of components of eta.
  [[nodiscard]] int dimension() const {
    return components_ - static_cast<int>(quaternions_.size());
  }

  [[nodiscard]] const std::vector<int>& quaternions() const { return quaternions_; }

  /// E at y. E is linear in the quaternions. At a rate of y, with 0 for the constant entries, it is
  /// therefore the rate of E.
  [[nodiscard]] Eigen::MatrixXd basis(const Eigen::VectorXd& y) const { return filled(y, 1); }
  [[nodiscard]] Eigen::MatrixXd basis_rate(const Eigen::VectorXd& dy) const {
    return filled(dy, 0);
  }

  /// The left inverse of the basis: P E = 1, eta = P (rate).
  [[nodiscard]] Eigen::MatrixXd inverse(const Eigen::VectorXd& y) const {
    Eigen::MatrixXd P = basis(y).transpose();
    for (std::size_t i = 0; i < quaternions_.size(); ++i) {
      const int at = quaternions_[i];
      P.middleRows(at - static_cast<int>(i), 3) *= 4 / y.segment(at, 4).squaredNorm();
    }
    return P;
  }

  /// y after a finite move.
  template <class Vector>
  [[nodiscard]] Vector moved(const Vector& y, const Eigen::VectorXd& eta) const {
    Vector result = y;
    int from = 0;
    int to = 0;
    const auto copy = [&](int end) {
      for (; to < end; ++to, ++from) result[to] += eta[from];
    };
    for (const int at : quaternions_) {
      copy(at);
      const Eigen::Quaterniond q(y[at + 3], y[at], y[at + 1], y[at + 2]);
      const Eigen::Quaterniond after =
          rotated(q, Vector3<double>(eta[from], eta[from + 1], eta[from + 2]));
      for (int k = 0; k < 4; ++k) result[at + k] = after.coeffs()[k];
      to += 4;
      from += 3;
    }
    copy(components_);
    return result;
  }

  /// The move from one state to another:  moved(y, between(y, other)) is other.
  [[nodiscard]] Eigen::VectorXd between(const Eigen::VectorXd& y,
                                        const Eigen::VectorXd& other) const {
    Eigen::VectorXd eta(dimension());
    int from = 0;
    int to = 0;
    const auto subtract = [&](int end) {
      for (; from < end; ++from, ++to) eta[to] = other[from] - y[from];
    };
    for (const int at : quaternions_) {
      subtract(at);
      const Eigen::Quaterniond q(y[at + 3], y[at], y[at + 1], y[at + 2]);
      const Eigen::Quaterniond p(other[at + 3], other[at], other[at + 1], other[at + 2]);
      Eigen::Quaterniond turn = q.conjugate() * p;
      if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
      const double sine = turn.vec().norm();
      const double angle = 2 * std::atan2(sine, turn.w());
      eta.segment<3>(to) = (sine > 0 ? angle / sine : 2) * turn.vec();
      from += 4;
      to += 3;
    }
    subtract(components_);
    return eta;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd filled(const Eigen::VectorXd& y, double rest) const {
    Eigen::MatrixXd E = Eigen::MatrixXd::Zero(components_, dimension());
    int column = 0;
    int row = 0;
    const auto diagonal = [&](int end) {
      for (; row < end; ++row, ++column) E(row, column) = rest;
    };
    for (const int at : quaternions_) {
      diagonal(at);
      const Eigen::Quaterniond q(y[at + 3], y[at], y[at + 1], y[at + 2]);
      for (int i = 0; i < 3; ++i) {
        E.block<4, 1>(row, column + i) =
            attitude_rate(q, Vector3<double>(Vector3<double>::Unit(i)));
      }
      row += 4;
      column += 3;
    }
    diagonal(components_);
    return E;
  }

  int components_;
  std::vector<int> quaternions_;
};

}  // namespace kreisel
