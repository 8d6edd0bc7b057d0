#pragma once

#include <Eigen/Core>

#include <functional>
#include <variant>

namespace kreisel {

/// A controller with proportional, integral and derivative part, one channel for each reading:
///
///   u = P e + I s + D d,   s' = e,   d = (e - f)/tau,   f' = d
///
/// Sampled with the period T:
///
///   s_k = s_k-1 + T e_k,   d_k = a d_k-1 + (1 - a) (e_k - e_k-1)/T,   a = exp(-T/tau)
///
/// All memory begins with 0. The integral does not drive an output beyond its limit: s grows in that
/// direction until the output is at the limit. In a continuous law its growth fades out,
///
///   s' = e max(0, 1 - 1e6 (|u|/limit - 1))   where |u| > limit and e drives the output further.
///
/// The field is continuous there, so that an output may stay at its limit without chatter.
///
/// Units : u per e; u per e and second; u s per e; s
struct PidLaw {
  double proportional = 0;
  double integral = 0;
  double derivative = 0;
  double filter = 0;  ///< tau; above 0 for a continuous derivative
};

/// A linear law,
///
///   x' = A x + B e,   u = C x + D e,
///
/// or, sampled,  x_k+1 = A x_k + B e_k,  u_k = C x_k + D e_k.
struct StateSpaceLaw {
  Eigen::MatrixXd A = {};
  Eigen::MatrixXd B = {};
  Eigen::MatrixXd C = {};
  Eigen::MatrixXd D = {};
  Eigen::VectorXd initial = {};  ///< x at the start; empty: 0
};

/// Any law:  fills the outputs u and the derivatives of the memory x, or, sampled, the next x. Both
/// have their sizes and are 0. It has no linear equations.
struct CallableLaw {
  int memory = 0;
  std::function<void(double t, const Eigen::VectorXd& e, const Eigen::VectorXd& x,
                     Eigen::VectorXd& u, Eigen::VectorXd& dx)>
      law = nullptr;
  Eigen::VectorXd initial = {};  ///< x at the start; empty: 0
};

using ControlLaw = std::variant<PidLaw, StateSpaceLaw, CallableLaw>;

}  // namespace kreisel
